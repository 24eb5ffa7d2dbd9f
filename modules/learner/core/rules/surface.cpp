// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/rules/surface.hpp"

#include <algorithm>

#include <Eigen/LU>

#include "common/geometry/se2.hpp"

namespace tread::learner {
namespace {

constexpr double kLargestTwist = 100.0;
/// Upper limit of a part's misfit, in variances of noise [1].
constexpr double kMostMisfit = 25.0;
/// Executions, including faded ones, from which a part has information about its scatter.
constexpr double kRepeated = 2.0;
/// Smaller weights are ignored in a density or in the noise [1].
constexpr double kLeastInDensity = 1e-6;
constexpr double kLeastInNoise = 0.01;
/// [s] that every vehicle needs to settle.
constexpr double kSettles = 0.05;
/// Weight of the class's own steady twist in the usual entry before its patterns, in executions
/// [1].
constexpr double kUsualEntries = 0.5;
/// Upper limit of a ground's corrections.
constexpr double kLargestCorrection = 1e9;

/// Logarithm of the density of a mixture of Student's t with the same degrees of freedom.
template <int kAxes>
class LogMixture {
 public:
  LogMixture(double freedom, size_t components)
      : freedom_(freedom),
        square_(static_cast<Eigen::Index>(components)),
        squared_peak_(square_.size()) {}
  /// `y` from its centre, `scale` its scale matrix.
  void add(double weight, const Eigen::Matrix<double, kAxes, 1>& y,
           const Eigen::Matrix<double, kAxes, kAxes>& scale) {
    square_[at_] = y.dot(scale.inverse() * y);
    squared_peak_[at_++] = weight * weight / scale.determinant();
  }
  double value() const {
    const double half = 0.5 * (freedom_ + kAxes);
    const Eigen::ArrayXd logs = 0.5 * squared_peak_.log() - half * (1.0 + square_ / freedom_).log();
    const double highest = logs.maxCoeff();
    return std::lgamma(half) - std::lgamma(0.5 * freedom_) -
           0.5 * kAxes * std::log(freedom_ * kPi) + highest +
           std::log((logs - highest).exp().sum());
  }

 private:
  double freedom_;
  Eigen::Index at_ = 0;
  Eigen::ArrayXd square_;        ///< y' scale^-1 y
  Eigen::ArrayXd squared_peak_;  ///< weight^2 / det(scale)
};

template <int kAxes>
struct MomentSum {
  using Vector = Eigen::Matrix<double, kAxes, 1>;
  using Block = Eigen::Matrix<double, kAxes, kAxes>;
  void add(double weight, const Vector& m, const Block& C) {
    total += weight;
    mean += weight * m;
    square += weight * (C + m * m.transpose());
  }
  Block covariance() const { return square / total - mean * mean.transpose() / (total * total); }
  double total = 0.0;
  Vector mean = Vector::Zero();
  Block square = Block::Zero();
};

using One = Eigen::Matrix<double, 1, 1>;

Eigen::Vector3d inPath(const PatternPart& part, const Eigen::Vector3d& body) {
  Eigen::Vector3d turned = body;
  turned.head<2>() = part.to_path * body.head<2>();
  return turned;
}

}  // namespace

Eigen::Vector3d plausible(const Eigen::Vector3d& twist) {
  return twist.cwiseMax(-kLargestTwist).cwiseMin(kLargestTwist);
}

SetCorrection SetCorrection::none(size_t patterns) {
  SetCorrection none;
  none.common.setZero();
  none.own.setZero(TwistCorrection::kOwn, static_cast<Eigen::Index>(patterns));
  return none;
}

Surface::Surface(std::shared_ptr<const GroundModel> model, const GroundConfig& config,
                 SurfacePrior expectation)
    : model_(std::move(model)), expectation_(std::move(expectation)) {
  follow(config);
}

Surface::Measured& Surface::measuredOf(const PatternPart& part, bool entered) {
  for (Measured& measured : measured_)
    if (measured.part.pattern == part.pattern && measured.part.first == part.first &&
        measured.part.samples == part.samples && measured.entered == entered)
      return measured;
  measured_.push_back({part, entered});
  return measured_.back();
}

void Surface::add(const GroundConfig& config, const TwistSample& sample) {
  Measured& measured = measuredOf(sample.part, sample.entry.allFinite());
  const Eigen::Vector3d deviation = sample.deviation();
  expected_noise_ = noise_;
  measured.count += 1.0;
  measured.sum += deviation;
  measured.squares += deviation.cwiseAbs2();
  if (measured.entered) {
    const Eigen::Vector3d entry = inPath(sample.part, sample.entry);
    measured.entries += entry;
    measured.entry_squares += entry.cwiseAbs2();
    measured.products += entry.cwiseProduct(deviation);
  }
  executions_ += 1.0;
  if (executions_ > config.longest_memory) {
    const double kept = config.longest_memory / executions_;
    for (Measured& each : measured_) {
      each.count *= kept;
      each.sum *= kept;
      each.squares *= kept;
      each.entries *= kept;
      each.entry_squares *= kept;
      each.products *= kept;
    }
    executions_ = config.longest_memory;
  }
  follow(config);
}

void Surface::expect(const GroundConfig& config, const Eigen::Matrix3Xd& scatter) {
  expectation_.scatter = scatter;
  follow(config);
}

/// The usual entry before the patterns of each class.
void Surface::followEntries() {
  std::vector<double> counts(model_->classes(), kUsualEntries);
  std::vector<Eigen::Vector3d> sums(counts.size(), Eigen::Vector3d::Zero());
  entries_.assign(counts.size(), {});
  for (const Measured& measured : measured_) {
    if (!measured.entered) continue;
    const size_t c = measured.part.entry_class;
    const Eigen::Matrix3d to_body = measured.part.toBody();
    counts[c] += measured.count;
    sums[c] += to_body * measured.entries;
    entries_[c].variance += to_body.cwiseAbs2() * measured.entry_squares;
  }
  for (size_t c = 0; c < counts.size(); ++c) {
    entries_[c].mean = sums[c] / counts[c];
    entries_[c].variance =
        (entries_[c].variance / counts[c] - entries_[c].mean.cwiseAbs2()).cwiseMax(0.0);
  }
  for (Measured& measured : measured_) {
    if (!measured.entered) continue;
    const PatternPart& part = measured.part;
    measured.part.entry = part.settling * (measured.entries / measured.count -
                                           inPath(part, entries_[part.entry_class].mean));
  }
}

TwistSample Surface::asUsual(const TwistSample& sample) const {
  if (!sample.entry.allFinite()) return sample;
  TwistSample usual = sample;
  PatternPart& part = usual.part;
  part.entry = part.settling * inPath(part, sample.entry - entries_[part.entry_class].mean);
  usual.mean_twist -= kSettles * (part.toBody() * part.entry);
  return usual;
}

void Surface::follow(const GroundConfig& config) {
  followEntries();
  regress();
  correct();
  estimateNoise(config);
}

namespace {

/// Covariances of the measurements with a part, by kind of spread.
template <class Bank, class Measured, class Covariance>
typename Bank::Cross crossOf(const std::vector<Measured>& measured, Covariance&& covariance) {
  constexpr Eigen::Index kAxes = Bank::Block::RowsAtCompileTime;
  typename Bank::Cross cross;
  const auto n = static_cast<Eigen::Index>(measured.size());
  for (auto& one : cross) one.resize(kAxes * n, kAxes);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto blocks = covariance(measured[static_cast<size_t>(i)].part);
    for (size_t kind = 0; kind < cross.size(); ++kind)
      cross[kind].template middleRows<kAxes>(kAxes * i) = blocks[kind];
  }
  return cross;
}

}  // namespace

VelocityBank::Cross Surface::velocityCross(const PatternPart& part) const {
  return crossOf<VelocityBank>(
      measured_, [&](const PatternPart& other) { return model_->velocity(other, part); });
}

YawBank::Cross Surface::yawCross(const PatternPart& part) const {
  return crossOf<YawBank>(measured_,
                          [&](const PatternPart& other) { return model_->yaw(other, part); });
}

void Surface::regress() {
  auto posterior = std::make_shared<Posterior>(
      Posterior{VelocityBank(expectation_.velocity), YawBank(expectation_.yaw)});
  const auto n = static_cast<Eigen::Index>(measured_.size());
  velocity_noise_.resize(2, n);
  yaw_noise_.resize(n);
  Eigen::VectorXd velocity(2 * n), yaw(n);
  VelocityBank::Grams velocity_grams;
  YawBank::Grams yaw_grams;
  for (auto& gram : velocity_grams) gram.resize(2 * n, 2 * n);
  for (auto& gram : yaw_grams) gram.resize(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Measured& measured = measured_[static_cast<size_t>(i)];
    const Eigen::Vector3d mean = measured.sum / measured.count - kSettles * measured.part.entry -
                                 expectation_.centre.added(measured.part);
    velocity.segment<2>(2 * i) = mean.head<2>();
    yaw[i] = mean[2];
    for (Eigen::Index axis = 0; axis < 2; ++axis)
      velocity_noise_(axis, i) = expected_noise_[axis] * R(measured.part, axis) / measured.count;
    yaw_noise_[i] = expected_noise_[2] * R(measured.part, 2) / measured.count;
    for (Eigen::Index j = 0; j <= i; ++j) {
      const PatternPart& a = measured.part;
      const PatternPart& b = measured_[static_cast<size_t>(j)].part;
      const VelocityBank::Blocks of_velocity = model_->velocity(a, b);
      const YawBank::Blocks of_yaw = model_->yaw(a, b);
      for (size_t kind = 0; kind < of_velocity.size(); ++kind)
        velocity_grams[kind].block<2, 2>(2 * i, 2 * j) = of_velocity[kind];
      for (size_t kind = 0; kind < of_yaw.size(); ++kind)
        yaw_grams[kind](i, j) = of_yaw[kind](0, 0);
    }
  }
  // Decompositions read only the lower triangle.
  posterior->velocity.regress(velocity_grams, velocity, velocity_noise_.reshaped());
  posterior->yaw.regress(yaw_grams, yaw, yaw_noise_);
  posterior_ = std::move(posterior);
}

/// The expectation of all corrections: contributions of each kind of spread.
void Surface::correct() {
  correction_ = expectation_.centre;
  const auto& spread = model_->spread();
  const Eigen::VectorXd& gain = posterior_->velocity.meanAlpha(0);
  const Eigen::VectorXd& turns = posterior_->velocity.meanAlpha(1);
  const Eigen::VectorXd& own = posterior_->velocity.meanAlpha(2);
  const Eigen::VectorXd& lag = posterior_->velocity.meanAlpha(3);
  const Eigen::VectorXd& entry = posterior_->velocity.meanAlpha(4);
  const Eigen::VectorXd& yaw = posterior_->yaw.meanAlpha(0);
  const Eigen::VectorXd& bias = posterior_->yaw.meanAlpha(1);
  const Eigen::VectorXd& yaw_own = posterior_->yaw.meanAlpha(2);
  const Eigen::VectorXd& yaw_lag = posterior_->yaw.meanAlpha(3);
  const Eigen::VectorXd& yaw_entry = posterior_->yaw.meanAlpha(4);
  Eigen::Matrix<double, TwistCorrection::kCommon, 1> common;
  common.setZero();
  constexpr int kLag = TwistCorrection::kLag;
  constexpr int kTurns = TwistCorrection::kTurnLoss;
  double lasts = 0.0, turn_lasts = 0.0;
  const double bias_apart = model_->biasApart();
  for (size_t i = 0; i < measured_.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const PatternPart& part = measured_[i].part;
    const auto column = static_cast<Eigen::Index>(part.pattern);
    common.head<kTurns>() += part.velocity.leftCols<kTurns>().transpose() * gain.segment<2>(2 * at);
    common.segment<kLag - kTurns>(kTurns) +=
        part.velocity.middleCols<kLag - kTurns>(kTurns).transpose() * turns.segment<2>(2 * at);
    common[kLag] += part.velocity.col(kLag).dot(lag.segment<2>(2 * at));
    lasts += part.entry.head<2>().dot(entry.segment<2>(2 * at));
    turn_lasts += part.entry[2] * yaw_entry[at];
    common.segment<2>(TwistCorrection::kYaw) += part.yaw.head<2>().transpose() * yaw[at];
    common.segment<2>(TwistCorrection::kBiasX) += part.yaw.segment<2>(2).transpose() * bias[at];
    common[TwistCorrection::kYawLag] += part.yaw[4] * yaw_lag[at];
    const Eigen::Vector2d towards = part.own.transpose() * own.segment<2>(2 * at);
    for (int k = 0; k < 2; ++k)
      correction_.own.row(k) +=
          towards[k] * model_->alike(static_cast<TwistCorrection::Own>(k)).col(column).transpose();
    correction_.own.row(TwistCorrection::kYawOwn) +=
        part.yaw_own * yaw_own[at] *
        model_->alike(TwistCorrection::kYawOwn).col(column).transpose();
    correction_.own.row(TwistCorrection::kBiasOwn) +=
        bias_apart * part.bias_own * bias[at] *
        model_->alike(TwistCorrection::kBiasOwn).col(column).transpose();
  }
  correction_.common += spread.cwiseProduct(common);
  lasts_ = squared(GroundModel::kEntrySpread) * Eigen::Vector3d(lasts, lasts, turn_lasts);
}

/// Growth of the squared errors of executions due to their entries.
Eigen::Vector3d Surface::growthByEntries(const Measured& measured,
                                         const Eigen::Vector3d& moved) const {
  const PatternPart& part = measured.part;
  const double n = measured.count;
  // Change of the twist per unit of an entry deviation.
  const Eigen::Vector3d adds = part.settling * (lasts_.array() + kSettles).matrix();
  const Eigen::Vector3d usual = inPath(part, entries_[part.entry_class].mean);
  const Eigen::Vector3d sum = measured.entries - n * usual;
  const Eigen::Vector3d squares =
      measured.entry_squares - 2.0 * usual.cwiseProduct(measured.entries) + n * usual.cwiseAbs2();
  const Eigen::Vector3d products =
      measured.products - usual.cwiseProduct(measured.sum) - moved.cwiseProduct(sum);
  return adds.cwiseProduct(adds.cwiseProduct(squares) - 2.0 * products);
}

void Surface::estimateNoise(const GroundConfig& config) {
  const double a0 = 0.5 * config.noise_prior;
  certainty_.setConstant(a0);
  Eigen::Vector3d b = Eigen::Vector3d::Constant(a0);
  if (!measured_.empty()) {
    const Eigen::VectorXd velocity =
        posterior_->velocity.doubt(velocity_noise_.reshaped(), kLeastInNoise);
    const Eigen::VectorXd yaw = posterior_->yaw.doubt(yaw_noise_, kLeastInNoise);
    // Differences between executions of one part are noise, on any ground. Only if their mean is
    // missed by much more than that, the ground's estimate is wrong.
    Eigen::Vector3d repeated = Eigen::Vector3d::Constant(a0);
    Eigen::Vector3d apart = b;
    for (const Measured& measured : measured_) {
      if (measured.count < kRepeated) continue;
      const Eigen::Vector3d within = squaresWithin(measured);
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        repeated[axis] += 0.5 * (measured.count - 1.0);
        apart[axis] += 0.5 * within[axis] / R(measured.part, axis);
      }
    }
    for (size_t i = 0; i < measured_.size(); ++i) {
      const Measured& measured = measured_[i];
      const auto at = static_cast<Eigen::Index>(i);
      const Eigen::Vector3d moved = correction_.added(measured.part);
      const Eigen::Vector3d doubt(velocity[2 * at], velocity[2 * at + 1], yaw[at]);
      Eigen::Vector3d error = measured.squares - 2.0 * moved.cwiseProduct(measured.sum) +
                              measured.count * (moved.cwiseAbs2() + doubt);
      if (measured.entered) error += growthByEntries(measured, moved);
      const Eigen::Vector3d within = squaresWithin(measured);
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        certainty_[axis] += 0.5 * measured.count;
        double misfit = (error[axis] - within[axis]) / R(measured.part, axis);
        if (measured.count >= kRepeated)
          misfit = std::min(misfit, kMostMisfit * apart[axis] / repeated[axis]);
        b[axis] += 0.5 * std::max(0.0, within[axis] / R(measured.part, axis) + misfit);
      }
    }
  }
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    noise_[axis] = std::clamp(b[axis] / certainty_[axis], kLeastNoise, kMostNoise);
    certainty_[axis] = std::min(certainty_[axis], 0.5 * config.most_freedom);
  }
}

/// Squares of the deviations of a part about their mean, minus the part that its entries explain.
Eigen::Vector3d Surface::squaresWithin(const Measured& measured) const {
  const double n = measured.count;
  Eigen::Vector3d squares = measured.squares - measured.sum.cwiseAbs2() / n;
  if (measured.entered) squares += growthByEntries(measured, measured.sum / n);
  return squares.cwiseMax(0.0);
}

double Surface::logDensity(const TwistSample& measured, const Eigen::Vector3d& returned) const {
  const TwistSample sample = asUsual(measured);
  const PatternPart& part = sample.part;
  const Eigen::Vector3d y = sample.deviation() - expectation_.centre.added(part);
  Eigen::Vector3d noise = returned;
  for (Eigen::Index axis = 0; axis < 3; ++axis) noise[axis] += noise_[axis] * R(part, axis);
  const auto velocities = posterior_->velocity.predict(
      velocityCross(part), model_->velocity(part, part), kLeastInDensity);
  LogMixture<2> velocity(certainty_[0] + certainty_[1], velocities.size());
  for (const auto& scale : velocities) {
    const Eigen::Matrix2d spread =
        scale.covariance + Eigen::Matrix2d((scale.noise * noise.head<2>()).asDiagonal());
    velocity.add(scale.weight, y.head<2>() - scale.mean, spread);
  }
  const auto turns =
      posterior_->yaw.predict(yawCross(part), model_->yaw(part, part), kLeastInDensity);
  LogMixture<1> yaw(2.0 * certainty_[2], turns.size());
  for (const auto& scale : turns)
    yaw.add(scale.weight, One(y[2] - scale.mean[0]),
            One(scale.covariance[0] + scale.noise * noise[2]));
  return velocity.value() + yaw.value();
}

Moments Surface::expected(const PatternPart& part, double least) const {
  MomentSum<2> velocity;
  MomentSum<1> yaw;
  for (const auto& scale :
       posterior_->velocity.predict(velocityCross(part), model_->velocity(part, part), least))
    velocity.add(scale.weight, scale.mean, scale.covariance);
  for (const auto& scale : posterior_->yaw.predict(yawCross(part), model_->yaw(part, part), least))
    yaw.add(scale.weight, scale.mean, scale.covariance);
  Moments moments{expectation_.centre.added(part), Eigen::Matrix3d::Zero()};
  moments.mean.head<2>() += velocity.mean / velocity.total;
  moments.mean[2] += yaw.mean[0] / yaw.total;
  moments.covariance.topLeftCorner<2, 2>() = velocity.covariance();
  moments.covariance(2, 2) = yaw.covariance()(0, 0);
  return moments;
}

Eigen::Vector3d Surface::usualNoise(const PatternPart& part) const {
  Eigen::Vector3d noise;
  for (Eigen::Index axis = 0; axis < 3; ++axis) noise[axis] = noise_[axis] * R(part, axis);
  return noise;
}

Eigen::Vector3d Surface::executionNoise(const PatternPart& part) const {
  Eigen::Vector3d noise = usualNoise(part);
  // Ratio of the variance of Student's t to its scale^2: freedom / (freedom - 2).
  noise.array() *= certainty_.array() / (certainty_.array() - 1.0);
  noise.head<2>() *= posterior_->velocity.meanNoise();
  noise[2] *= posterior_->yaw.meanNoise();
  Eigen::Vector3d entry = squared(part.settling) * entries_[part.entry_class].variance;
  entry.head<2>() = part.to_path.cwiseAbs2() * entry.head<2>();
  noise += (lasts_.array() + kSettles).square().matrix().cwiseProduct(entry);
  return noise;
}

Eigen::Vector3d Surface::squaredError(const TwistSample& measured) const {
  const TwistSample sample = asUsual(measured);
  const Moments moments = expected(sample.part);
  const Eigen::Vector3d y = sample.deviation() - moments.mean;
  return (y.cwiseAbs2() + moments.covariance.diagonal()).cwiseQuotient(sample.part.noise);
}

void Surface::save(std::vector<double>& memory) const {
  const auto put = [&](const auto& numbers) {
    for (Eigen::Index i = 0; i < numbers.size(); ++i) memory.push_back(numbers.reshaped()[i]);
  };
  put(expectation_.centre.common);
  put(expectation_.centre.own);
  for (const auto& scale : expectation_.velocity) {
    memory.insert(memory.end(), scale.variance.begin(), scale.variance.end());
    memory.insert(memory.end(), {scale.noise, scale.weight});
  }
  for (const auto& scale : expectation_.yaw) {
    memory.insert(memory.end(), scale.variance.begin(), scale.variance.end());
    memory.insert(memory.end(), {scale.noise, scale.weight});
  }
  put(expectation_.scatter);
  put(expected_noise_);
  memory.push_back(executions_);
  memory.push_back(static_cast<double>(measured_.size()));
  for (const Measured& measured : measured_) {
    memory.insert(memory.end(), {static_cast<double>(measured.part.pattern),
                                 static_cast<double>(measured.part.first),
                                 static_cast<double>(measured.part.samples), measured.count});
    put(measured.sum);
    put(measured.squares);
    memory.push_back(measured.entered ? 1.0 : 0.0);
    put(measured.entries);
    put(measured.entry_squares);
    put(measured.products);
  }
}

bool Surface::restoreMeasured(const std::vector<double>& memory, size_t& at) {
  constexpr size_t kEach = 20;
  const double parts = memory[at++];
  if (!isCount(parts, static_cast<double>((memory.size() - at) / kEach))) return false;
  measured_.clear();
  double executions = 0.0;
  for (size_t i = 0; i < static_cast<size_t>(parts); ++i, at += kEach) {
    if (!isCount(memory[at], static_cast<double>(model_->patterns()) - 1.0)) return false;
    const auto pattern = static_cast<size_t>(memory[at]);
    const double first = memory[at + 1], samples = memory[at + 2];
    const auto most_samples = static_cast<double>(model_->profile(pattern).samples());
    if (samples < 1.0 || !isCount(samples, most_samples) || !isCount(first, most_samples - samples))
      return false;
    Measured measured{model_->part(pattern, static_cast<Eigen::Index>(first),
                                   static_cast<Eigen::Index>(samples))};
    measured.count = memory[at + 3];
    measured.sum = Eigen::Map<const Eigen::Vector3d>(&memory[at + 4]);
    measured.squares = Eigen::Map<const Eigen::Vector3d>(&memory[at + 7]);
    measured.entered = memory[at + 10] == 1.0;
    measured.entries = Eigen::Map<const Eigen::Vector3d>(&memory[at + 11]);
    measured.entry_squares = Eigen::Map<const Eigen::Vector3d>(&memory[at + 14]);
    measured.products = Eigen::Map<const Eigen::Vector3d>(&memory[at + 17]);
    const double most = kLargestTwist * 3.0;
    if (!(measured.count > 0.0 && measured.count <= kMostExecutions) ||
        measured.squares.minCoeff() < 0.0 ||
        measured.sum.cwiseAbs().maxCoeff() > most * measured.count ||
        !isCount(memory[at + 10], 1.0) || measured.entry_squares.minCoeff() < 0.0 ||
        measured.entries.cwiseAbs().maxCoeff() > most * measured.count ||
        measured.products.cwiseAbs().maxCoeff() > most * most * measured.count)
      return false;
    executions += measured.count;
    measured_.push_back(measured);
  }
  return std::abs(executions - executions_) <= 1e-6 * (1.0 + executions_);
}

bool Surface::restore(const GroundConfig& config, const std::vector<double>& memory, size_t& at) {
  SurfacePrior& e = expectation_;
  const size_t numbers =
      static_cast<size_t>(e.centre.common.size() + e.centre.own.size() + e.scatter.size() + 5) +
      7 * e.velocity.size() + 7 * e.yaw.size();
  if (memory.size() < at + numbers) return false;
  const auto take = [&](auto& matrix) {
    for (double& number : matrix.reshaped()) number = memory[at++];
  };
  const auto takeScales = [&](auto& scales) {
    bool good = true;
    double total = 0.0;
    for (auto& scale : scales) {
      for (double& variance : scale.variance) {
        variance = memory[at++];
        good = good && variance >= 1e-9 && variance <= 1e3;
      }
      scale.noise = memory[at++];
      good = good && scale.noise >= 0.01 && scale.noise <= 100.0;
      scale.weight = memory[at++];
      good = good && scale.weight > 0.0 && scale.weight <= 1.0;
      total += scale.weight;
    }
    return good && std::abs(total - 1.0) < 1e-6;
  };
  take(e.centre.common);
  take(e.centre.own);
  if (!takeScales(e.velocity) || !takeScales(e.yaw)) return false;
  take(e.scatter);
  take(expected_noise_);
  executions_ = memory[at++];
  if (e.centre.common.cwiseAbs().maxCoeff() > kLargestCorrection ||
      e.centre.own.cwiseAbs().maxCoeff() > kLargestCorrection ||
      e.scatter.minCoeff() < kLeastNoise || e.scatter.maxCoeff() > kMostNoise ||
      expected_noise_.minCoeff() < kLeastNoise || expected_noise_.maxCoeff() > kMostNoise ||
      !(executions_ >= 0.0 && executions_ <= kMostExecutions) || !restoreMeasured(memory, at))
    return false;
  follow(config);
  return true;
}

}  // namespace tread::learner
