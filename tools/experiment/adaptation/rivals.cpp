// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/experiment/adaptation/rivals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <Eigen/SVD>

#include "common/recordings/sessions.hpp"

namespace tread::adaptation {
namespace {

constexpr size_t kRun = 31;  // pieces of a run that tuning begins with a fresh rival
constexpr size_t kLeastSessions = 3;

/// Beyond so many standard deviations an innovation counts linearly (Huber): poses jump at times.
constexpr double kHuber = 2.5;

/// How much more a sample is taken to scatter, its innovation y of variance S being what it is.
double inflation(double y, double S) {
  return std::max(1.0, std::abs(y) / (kHuber * std::sqrt(S)));
}

double logDensity(double y, double S) {
  const double sigmas = std::abs(y) / std::sqrt(S);
  const double loss = sigmas <= kHuber ? 0.5 * sigmas * sigmas : kHuber * (sigmas - 0.5 * kHuber);
  return -0.5 * std::log(2.0 * kPi * S) - loss;
}

/// A run of samples as rows of functions, so that tuning computes them once.
struct Rows {
  std::vector<Eigen::VectorXd> functions;
  std::vector<double> residuals, noise;
};

/// Runs of all sessions; those of session i only, or of all others.
std::vector<Rows> runsOf(const std::vector<Sample>& session, const Functions& functions,
                         Eigen::Index axis) {
  std::vector<Rows> runs;
  for (size_t i = 0; i < session.size(); ++i) {
    if (i % kRun == 0) runs.emplace_back();
    runs.back().functions.push_back(LinearRival::row(functions, session[i]));
    runs.back().residuals.push_back(session[i].residual[axis]);
    runs.back().noise.push_back(session[i].noise[axis]);
  }
  return runs;
}

/// One step of the filter; the logarithm of the density that it expected.
double step(const LinearTuning& tuning, const Eigen::VectorXd& h, double residual, double noise,
            Eigen::VectorXd& x, Eigen::MatrixXd& P) {
  P /= tuning.forgetting;
  if (tuning.walk > 0.0) P.diagonal() += tuning.walk * tuning.deviation.cwiseAbs2();
  const Eigen::VectorXd Ph = P * h;
  const double expected = h.dot(Ph) + tuning.noise * noise;
  const double y = residual - h.dot(x);
  const double S = h.dot(Ph) + inflation(y, expected) * tuning.noise * noise;
  x += y / S * Ph;
  P -= Ph * Ph.transpose() / S;
  return logDensity(y, expected);
}

double logLikelihood(const LinearTuning& tuning, const std::vector<Rows>& runs) {
  double sum = 0.0;
  for (const Rows& run : runs) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(tuning.deviation.size());
    Eigen::MatrixXd P = tuning.deviation.cwiseAbs2().asDiagonal();
    for (size_t i = 0; i < run.functions.size(); ++i)
      sum += step(tuning, run.functions[i], run.residuals[i], run.noise[i], x, P);
  }
  return sum;
}

/// Climbs one number after the other, by factors that become finer.
template <class Goal>
void climb(std::vector<double*> numbers, const Goal& goal) {
  double best = goal();
  for (const double factor : {3.0, 3.0, 1.7, 1.3})
    for (double* number : numbers)
      for (const double by : {factor, 1.0 / factor})
        for (int times = 0; times < 4; ++times) {
          const double before = *number;
          *number *= by;
          const double now = goal();
          if (now > best) {
            best = now;
            continue;
          }
          *number = before;
          break;
        }
}

/// What may change from execution to execution.
enum class Change { kNever, kForget, kWalk };

LinearTuning tuned(LinearTuning tuning, const std::vector<Rows>& runs, Change change) {
  LinearTuning best = tuning;
  double highest = -std::numeric_limits<double>::infinity();
  const std::vector<double> candidates = change == Change::kNever
                                             ? std::vector<double>{0.0}
                                             : std::vector<double>{0.0, 0.003, 0.01, 0.03, 0.1};
  for (const double rate : candidates) {
    LinearTuning one = tuning;
    if (change == Change::kForget) one.forgetting = 1.0 - rate;
    if (change == Change::kWalk) one.walk = rate;
    std::vector<double*> numbers{&one.noise};
    for (double& deviation : one.deviation) numbers.push_back(&deviation);
    climb(numbers, [&] { return logLikelihood(one, runs); });
    const double reached = logLikelihood(one, runs);
    if (reached <= highest) continue;
    highest = reached;
    best = one;
  }
  return best;
}

/// Tunes on all runs of all sessions.
std::unique_ptr<AxisRival> linearRival(size_t axis, const Functions& functions,
                                       const Eigen::VectorXd& deviation, Change change,
                                       const TrainingSamples& training) {
  LinearTuning tuning{deviation};
  if (training.size() >= kLeastSessions) {
    std::vector<Rows> runs;
    for (const std::vector<Sample>& session : training)
      for (Rows& run : runsOf(session, functions, static_cast<Eigen::Index>(axis)))
        runs.push_back(std::move(run));
    tuning = tuned(tuning, runs, change);
  }
  return std::make_unique<LinearRival>(axis, functions, tuning);
}

std::unique_ptr<AxisRival> gainRival(size_t axis, Change change, const TrainingSamples& training) {
  if (axis == 1) return nullptr;  // what goes sideways has no gain
  const Functions own = [axis](const Eigen::Vector2d& speed) {
    return Eigen::VectorXd::Constant(1, speed[axis == 0 ? 0 : 1]);
  };
  return linearRival(axis, own, Eigen::VectorXd::Constant(1, axis == 0 ? 0.08 : 0.16), change,
                     training);
}

Functions slipTerms(size_t axis) {
  return [axis](const Eigen::Vector2d& speed) -> Eigen::VectorXd {
    const double v = speed[0], w = speed[1];
    if (axis == 0) return Eigen::Vector3d(v, std::abs(w) * v, w);
    if (axis == 1) return Eigen::Vector3d(v * w, v, w);
    return Eigen::Vector3d(w, std::abs(v) * w, v);
  };
}

std::unique_ptr<AxisRival> slipRival(size_t axis, const TrainingSamples& training) {
  const Eigen::Vector3d deviations[] = {
      {0.06, 0.09, 0.03}, {0.09, 0.012, 0.05}, {0.16, 0.05, 0.012}};
  return linearRival(axis, slipTerms(axis), deviations[axis], Change::kForget, training);
}

/// Mean of |v| and |w| over training samples, at least 0.1: the scale of length.
Eigen::Vector2d largestSpeed(const TrainingSamples& training) {
  Eigen::Vector2d largest(0.1, 0.1);
  for (const std::vector<Sample>& session : training)
    for (const Sample& sample : session) largest = largest.cwiseMax(sample.meanSpeed());
  return largest;
}

/// Random Fourier features of a squared exponential kernel over the speed.
class RandomFeatures {
 public:
  RandomFeatures(const Eigen::Vector2d& length, uint64_t seed) {
    std::mt19937_64 random(seed);
    const auto uniform = [&] {
      return (static_cast<double>(random() >> 11) + 0.5) / 9007199254740992.0;
    };
    for (Eigen::Index i = 0; i < kCount; ++i) {
      const double radius = std::sqrt(-2.0 * std::log(uniform()));
      const double angle = 2.0 * kPi * uniform();
      frequencies_(i, 0) = radius * std::cos(angle) / length[0];
      frequencies_(i, 1) = radius * std::sin(angle) / length[1];
      phases_[i] = 2.0 * kPi * uniform();
    }
  }
  static constexpr Eigen::Index kCount = 48;
  Eigen::VectorXd operator()(const Eigen::Vector2d& speed) const {
    return std::sqrt(2.0 / kCount) * (frequencies_ * speed + phases_).array().cos().matrix();
  }

 private:
  Eigen::Matrix<double, kCount, 2> frequencies_;
  Eigen::Matrix<double, kCount, 1> phases_;
};

/// Weights of a session's residual map, drawn to zero by `deviation`.
Eigen::VectorXd mapOf(const std::vector<Sample>& session, const Functions& features,
                      Eigen::Index axis, double deviation) {
  constexpr Eigen::Index kCount = RandomFeatures::kCount;
  Eigen::MatrixXd information = Eigen::MatrixXd::Identity(kCount, kCount) / (deviation * deviation);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(kCount);
  for (const Sample& sample : session) {
    const Eigen::VectorXd h = LinearRival::row(features, sample);
    information += h * h.transpose() / sample.noise[axis];
    sum += h * sample.residual[axis] / sample.noise[axis];
  }
  return information.ldlt().solve(sum);
}

/// The functions in which maps differ most, and how much each is in them.
struct Basis {
  Eigen::MatrixXd directions;  ///< features x count
  Eigen::VectorXd deviation;
};

Basis basisOf(const std::vector<Eigen::VectorXd>& maps, Eigen::Index count) {
  Eigen::MatrixXd all(static_cast<Eigen::Index>(maps.size()), RandomFeatures::kCount);
  for (size_t i = 0; i < maps.size(); ++i) all.row(static_cast<Eigen::Index>(i)) = maps[i];
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(all, Eigen::ComputeThinV);
  count = std::min(count, svd.singularValues().size());
  return {svd.matrixV().leftCols(count),
          (svd.singularValues().head(count) / std::sqrt(static_cast<double>(maps.size())))
              .cwiseMax(1e-4)};
}

Functions functionsOf(const Functions& features, const Basis& basis) {
  return [features, directions = basis.directions](const Eigen::Vector2d& speed) {
    return Eigen::VectorXd(directions.transpose() * features(speed));
  };
}

/// The number of functions, forgetting and noise by sessions that the basis was not learned from.
std::unique_ptr<AxisRival> basisRival(size_t axis, const TrainingSamples& training, uint64_t seed) {
  if (training.size() < kLeastSessions) return nullptr;  // one ground teaches no difference
  const auto column = static_cast<Eigen::Index>(axis);
  const Functions features = RandomFeatures(0.6 * largestSpeed(training), seed + axis);
  std::vector<Eigen::VectorXd> maps;
  constexpr double kMapDeviation = 0.3;
  for (const std::vector<Sample>& session : training)
    maps.push_back(mapOf(session, features, column, kMapDeviation));
  LinearTuning best;
  Eigen::Index best_count = 1;
  double highest = -std::numeric_limits<double>::infinity();
  for (Eigen::Index count = 1; count <= 4; ++count) {
    std::vector<std::vector<Rows>> runs;
    std::vector<Eigen::VectorXd> deviations;
    for (size_t left_out = 0; left_out < training.size(); ++left_out) {
      std::vector<Eigen::VectorXd> others = maps;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(left_out));
      const Basis basis = basisOf(others, count);
      runs.push_back(runsOf(training[left_out], functionsOf(features, basis), column));
      deviations.push_back(basis.deviation);
    }
    if (deviations.front().size() < count) break;
    for (const double forgetting : {1.0, 0.99, 0.97, 0.9}) {
      // A factor on all prior deviations and one on the noise.
      double scale = 1.0, noise = 1.0;
      const auto goal = [&] {
        double sum = 0.0;
        for (size_t i = 0; i < runs.size(); ++i)
          sum += logLikelihood({scale * deviations[i], forgetting, 0.0, noise}, runs[i]);
        return sum;
      };
      climb({&scale, &noise}, goal);
      const double reached = goal();
      if (reached <= highest) continue;
      highest = reached;
      best_count = count;
      best = {Eigen::VectorXd::Constant(1, scale), forgetting, 0.0, noise};
    }
  }
  const Basis basis = basisOf(maps, best_count);
  best.deviation = best.deviation[0] * basis.deviation;
  return std::make_unique<LinearRival>(axis, functionsOf(features, basis), best);
}

double kernel(const KernelTuning& tuning, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const double squared = (a - b).cwiseQuotient(tuning.length).squaredNorm();
  return tuning.deviation * tuning.deviation * std::exp(-0.5 * squared);
}

double kernel(const KernelTuning& tuning, const Sample& a, const Eigen::Vector2d& b) {
  double sum = 0.0;
  for (const Eigen::Vector2d& part : a.speeds) sum += kernel(tuning, part, b);
  return sum / static_cast<double>(kParts);
}

double kernel(const KernelTuning& tuning, const Sample& a, const Sample& b) {
  double sum = 0.0;
  for (const Eigen::Vector2d& part : b.speeds) sum += kernel(tuning, a, part);
  return sum / static_cast<double>(kParts);
}

std::unique_ptr<AxisRival> gpRival(size_t axis, const TrainingSamples& training) {
  KernelTuning tuning;
  tuning.length = 0.6 * largestSpeed(training);
  if (training.size() >= kLeastSessions)
    climb({&tuning.deviation, &tuning.length[0], &tuning.length[1], &tuning.noise}, [&] {
      double sum = 0.0;
      for (const std::vector<Sample>& session : training)
        for (size_t begin = 0; begin < session.size(); begin += kRun)
          sum += GaussianProcess::logLikelihood(axis, tuning, &session[begin],
                                                std::min(kRun, session.size() - begin));
      return sum;
    });
  return std::make_unique<GaussianProcess>(axis, tuning);
}

std::unique_ptr<AxisRival> axisRival(const std::string& name, size_t axis,
                                     const TrainingSamples& training, uint64_t seed) {
  if (name == "constant") return gainRival(axis, Change::kNever, training);
  if (name == "kalman") return gainRival(axis, Change::kWalk, training);
  if (name == "slip") return slipRival(axis, training);
  if (name == "basis") return basisRival(axis, training, seed);
  if (name == "gp") return gpRival(axis, training);
  throw std::invalid_argument("there is no rival '" + name + "'");
}

}  // namespace

LinearRival::LinearRival(size_t axis, Functions functions, const LinearTuning& tuning,
                         const Eigen::VectorXd& start)
    : axis_(static_cast<Eigen::Index>(axis)),
      functions_(std::move(functions)),
      tuning_(tuning),
      x_(start.size() > 0 ? start : Eigen::VectorXd::Zero(tuning.deviation.size())),
      P_(tuning.deviation.cwiseAbs2().asDiagonal()) {}

Eigen::VectorXd LinearRival::row(const Functions& functions, const Sample& sample) {
  Eigen::VectorXd sum = functions(sample.speeds[0]);
  for (size_t part = 1; part < kParts; ++part) sum += functions(sample.speeds[part]);
  return sum / static_cast<double>(kParts);
}

void LinearRival::learn(const Sample& sample) {
  step(tuning_, row(functions_, sample), sample.residual[axis_], sample.noise[axis_], x_, P_);
}

double LinearRival::offset(const Eigen::Vector2d& speed) const {
  return functions_(speed).dot(x_);
}

double GaussianProcess::extend(const Sample& sample) {
  const auto n = static_cast<Eigen::Index>(samples_.size());
  Eigen::VectorXd row(n);
  for (Eigen::Index i = 0; i < n; ++i)
    row[i] = kernel(tuning_, samples_[static_cast<size_t>(i)], sample);
  L_.triangularView<Eigen::Lower>().solveInPlace(row);
  const double own = kernel(tuning_, sample, sample) - row.squaredNorm();
  const double noise = tuning_.noise * sample.noise[axis_];
  const double y = sample.residual[axis_] - row.dot(z_);
  const double S = own + noise * inflation(y, own + noise);
  L_.conservativeResize(n + 1, n + 1);
  L_.row(n).head(n) = row;
  L_(n, n) = std::sqrt(S);
  z_.conservativeResize(n + 1);
  z_[n] = y / L_(n, n);
  samples_.push_back(sample);
  return logDensity(y, own + noise);
}

void GaussianProcess::learn(const Sample& sample) {
  extend(sample);
  weights_ = L_.triangularView<Eigen::Lower>().transpose().solve(z_);
}

double GaussianProcess::offset(const Eigen::Vector2d& speed) const {
  double sum = 0.0;
  for (size_t i = 0; i < samples_.size(); ++i)
    sum += weights_[static_cast<Eigen::Index>(i)] * kernel(tuning_, samples_[i], speed);
  return sum;
}

double GaussianProcess::logLikelihood(size_t axis, const KernelTuning& tuning,
                                      const Sample* samples, size_t count) {
  GaussianProcess process(axis, tuning);
  double sum = 0.0;
  for (size_t i = 0; i < count; ++i) sum += process.extend(samples[i]);
  return sum;
}

Rival::Rival(const Rival& other) {
  for (size_t axis = 0; axis < kAxes; ++axis)
    if (other.axes_[axis]) axes_[axis] = other.axes_[axis]->clone();
}

void Rival::learn(const Sample& sample) {
  for (const auto& axis : axes_)
    if (axis) axis->learn(sample);
}

std::vector<Twist2> Rival::corrected(std::vector<Twist2> twists, const Sample& sample) const {
  for (size_t part = 0; part < kParts; ++part) {
    const auto offset = [&](size_t axis) {
      return axes_[axis] ? axes_[axis]->offset(sample.speeds[part]) : 0.0;
    };
    const Twist2 change{offset(0), offset(1), offset(2)};
    constexpr size_t kPart = kPieceSamples / kParts;
    for (size_t t = part * kPart; t < (part + 1) * kPart; ++t) {
      twists[t].v_x += change.v_x;
      twists[t].v_y += change.v_y;
      twists[t].omega += change.omega;
    }
  }
  return twists;
}

const std::vector<std::string>& rivalNames() {
  static const std::vector<std::string> names{"constant", "kalman", "slip", "gp", "basis"};
  return names;
}

Rival hindsight(const std::vector<Sample>& session) {
  std::array<std::unique_ptr<AxisRival>, kAxes> axes;
  for (size_t axis = 0; axis < kAxes; ++axis) {
    const auto n = static_cast<Eigen::Index>(session.size());
    const Functions terms = slipTerms(axis);
    Eigen::MatrixXd A(n, 3);
    Eigen::VectorXd b(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Sample& sample = session[static_cast<size_t>(i)];
      const double deviation = std::sqrt(sample.noise[static_cast<Eigen::Index>(axis)]);
      A.row(i) = LinearRival::row(terms, sample) / deviation;
      b[i] = sample.residual[static_cast<Eigen::Index>(axis)] / deviation;
    }
    const Eigen::VectorXd x = recordings::huberFit(A, b, Eigen::VectorXd::Ones(n), {1, 0.05});
    axes[axis] =
        std::make_unique<LinearRival>(axis, terms, LinearTuning{Eigen::Vector3d::Zero()}, x);
  }
  return Rival(std::move(axes));
}

Rival tunedRival(const std::string& name, const TrainingSamples& training, uint64_t seed) {
  std::array<std::unique_ptr<AxisRival>, kAxes> axes;
  for (size_t axis = 0; axis < kAxes; ++axis) axes[axis] = axisRival(name, axis, training, seed);
  return Rival(std::move(axes));
}

}  // namespace tread::adaptation
