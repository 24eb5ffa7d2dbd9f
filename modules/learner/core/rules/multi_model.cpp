// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/rules/multi_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tread::learner {
namespace {

/// A pattern that hardly drives may still cross a border [m].
constexpr double kLeastMetres = 0.05;
/// Way after which older changes fade [m].
constexpr double kLongestWay = 2000.0;
/// Centre and scatter of new surfaces are kept to this [1]: their digits stand in the state file.
constexpr double kCentreStep = 1e-6;
constexpr double kScatterStep = 1e-3;

/// Beginnings are cut to multiples of so many samples.
constexpr Eigen::Index kPartStep = 4;
/// What weighs less adds nothing to a covariance [1].
constexpr double kLeastWeight = 1e-6;
/// No execution counts for more than this in the scatter [1].
constexpr double kMostError = 1e3;

double rounded(double number, double step) {
  return step * std::round(number / step);
}

std::string percent(double probability) {
  return std::to_string(std::lround(100.0 * probability)) + " %";
}

/// The upper triangle of a symmetric matrix.
PoseCovariance upperTriangle(const Eigen::Matrix3d& covariance) {
  return {covariance(0, 0), covariance(0, 1), covariance(0, 2),
          covariance(1, 1), covariance(1, 2), covariance(2, 2)};
}

/// J P J', P the covariance of the corrections of a pattern.
Eigen::Matrix3d spreadOfEnd(const Eigen::Matrix<double, 3, TwistCorrection::kAll>& J,
                            const ByVelocity<Eigen::MatrixXd>& covariance, size_t pattern) {
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (size_t velocity = 0; velocity < kVelocities; ++velocity) {
    const Eigen::MatrixXd& P = covariance[velocity];
    const auto first = kTerms * static_cast<Eigen::Index>(velocity);
    const auto place = [&](Eigen::Index i) {
      return i < kTerms ? i : kTerms + static_cast<Eigen::Index>(pattern);
    };
    const auto column = [&](Eigen::Index i) {
      return i < kTerms ? first + i
                        : TwistCorrection::kCommon + static_cast<Eigen::Index>(velocity);
    };
    for (Eigen::Index i = 0; i <= kTerms; ++i)
      for (Eigen::Index j = 0; j <= kTerms; ++j)
        spread += P(place(i), place(j)) * J.col(column(i)) * J.col(column(j)).transpose();
  }
  return spread;
}

}  // namespace

void Scatter::add(size_t pattern, const Eigen::Vector4d& squared_error, double longest_memory) {
  auto of_pattern = sums.col(static_cast<Eigen::Index>(pattern));
  of_pattern[0] += 1.0;
  of_pattern.tail<kQuantities>() += squared_error;
  const double count = sums.row(0).sum();
  if (count > longest_memory) sums *= longest_memory / count;
}

Scatter::Factors Scatter::expected(double prior) const {
  const Eigen::VectorXd all = sums.rowwise().sum();
  const Eigen::Array4d mean = (prior + all.tail<kQuantities>().array()) / (prior + all[0]);
  Factors factors(kQuantities, sums.cols());
  for (Eigen::Index p = 0; p < sums.cols(); ++p) {
    Eigen::Array4d own =
        (prior * mean + sums.col(p).tail<kQuantities>().array()) / (prior + sums(0, p));
    own.head<3>() /= mean.head<3>().max(1.0);
    factors.col(p) = own.max(kLeastNoise).min(kMostNoise).unaryExpr([](double factor) {
      return rounded(factor, kScatterStep);
    });
  }
  return factors;
}

MultiModel::MultiModel(const RuleConfig& config, const PatternSet& shipped)
    : config_(config.ground),
      model_(std::make_shared<GroundModel>(config.ground, shipped)),
      scatter_(model_->patterns()),
      expected_scatter_(scatter_.expected(config_.noise_prior)),
      near_(*model_, config_, priorOfNew(Distance::kNear)),
      far_(*model_, config_, priorOfNew(Distance::kFar)),
      effects_(config_) {
  SurfacePrior of_shipped = priorOfNew(Distance::kNear);
  of_shipped.residual = config_.shipped_spread;
  for (size_t term = 0; term < config_.common.size(); ++term)
    of_shipped.common.data()[term] =
        config_.shipped_spread * config_.common[term] * config_.common[term];
  surfaces_.push_back({Surface(*model_, config_, of_shipped), 1.0 - config_.fresh, 0, 0});
  fresh_.push_back({near_, config_.fresh * (1.0 - config_.far), clock_, clock_});
  fresh_.push_back({far_, config_.fresh * config_.far, clock_, clock_});
  predictMixture();
}

SurfacePrior MultiModel::priorOfNew(Distance distance) const {
  std::vector<const Surface*> met;
  for (const Hypothesis& known : surfaces_)
    // The shipped set's ground counts when the vehicle was really on it.
    if (known.surface.executions() >= static_cast<double>(config_.settled_after))
      met.push_back(&known.surface);
  const auto K = static_cast<double>(met.size());
  const double share = config_.shared / (1.0 - config_.shared + K * config_.shared);
  SurfacePrior prior;
  prior.residual = (1.0 - config_.shared) * (1.0 + share);
  for (size_t velocity = 0; velocity < kVelocities; ++velocity) {
    Eigen::VectorXd& centre = prior.centre[velocity];
    centre.setZero(model_->dimension());
    for (const Surface* surface : met) centre += share * surface->mean()[velocity];
    for (Eigen::Index i = 0; i < kTerms; ++i) {
      const size_t term = 3 * velocity + static_cast<size_t>(i);
      const double all = config_.common[term] * config_.common[term];
      const double vehicle = config_.vehicle[term] * config_.vehicle[term];
      const bool near = distance == Distance::kNear;
      const double of_mean = near ? config_.shared * all : vehicle;
      const double of_ground = near ? (1.0 - config_.shared) * all : all;
      const double g = of_mean / (of_ground + K * of_mean);
      double variance = of_ground * (1.0 + g);
      centre[i] = 0.0;
      for (const Surface* surface : met) {
        centre[i] += g * surface->mean()[velocity][i];
        variance += g * g * surface->covariance()[velocity](i, i);
      }
      prior.common(i, static_cast<Eigen::Index>(velocity)) =
          rounded(variance, kCentreStep) + kCentreStep;
    }
    for (double& number : centre) number = rounded(number, kCentreStep);
  }
  prior.scatter = expected_scatter_.topRows<3>();
  return prior;
}

void MultiModel::expectNew() {
  expected_scatter_ = scatter_.expected(config_.noise_prior);
  near_ = Surface(*model_, config_, priorOfNew(Distance::kNear));
  far_ = Surface(*model_, config_, priorOfNew(Distance::kFar));
}

double MultiModel::hazard(double metres) const {
  const double rate =
      (config_.change_prior + changes_) / (config_.change_prior * config_.change_metres + metres_);
  return 1.0 - std::exp(-std::max(metres, kLeastMetres) * rate);
}

/// A change counts when another hypothesis is sure: single odd executions do not.
void MultiModel::countChange(double metres) {
  metres_ += metres;
  for (const auto* hypotheses : {&surfaces_, &fresh_})
    for (const Hypothesis& hypothesis : *hypotheses) {
      if (hypothesis.weight < config_.sure || hypothesis.since == ground_) continue;
      ground_ = hypothesis.since;
      changes_ += 1.0;
    }
  if (metres_ < kLongestWay) return;
  changes_ *= kLongestWay / metres_;
  metres_ = kLongestWay;
}

/// w^-, and a fresh hypothesis that begins now.
void MultiModel::expectChange(double metres) {
  const double h = hazard(metres);
  const double known = h * (1.0 - config_.fresh) / static_cast<double>(surfaces_.size());
  changed_.clear();
  for (Hypothesis& hypothesis : surfaces_) {
    hypothesis.weight = (1.0 - h) * hypothesis.weight + known;
    changed_.push_back(known / hypothesis.weight);
  }
  for (Hypothesis& hypothesis : fresh_) {
    hypothesis.weight *= 1.0 - h;
    changed_.push_back(0.0);
  }
  fresh_.push_back({near_, h * config_.fresh * (1.0 - config_.far), clock_, clock_});
  fresh_.push_back({far_, h * config_.fresh * config_.far, clock_, clock_});
  changed_.insert(changed_.end(), {1.0, 1.0});
}

/// w, from w^- and the densities of an execution.
void MultiModel::weigh(const TwistSample& sample) {
  double highest = -std::numeric_limits<double>::infinity();  // of those that are possible
  std::vector<double> logs;
  for (const auto* hypotheses : {&surfaces_, &fresh_})
    for (const Hypothesis& hypothesis : *hypotheses) {
      logs.push_back(hypothesis.surface.logDensity(sample));
      if (hypothesis.weight > 0.0) highest = std::max(highest, logs.back());
    }
  double total = 0.0;
  double changed = 0.0;
  size_t i = 0;
  for (auto* hypotheses : {&surfaces_, &fresh_})
    for (Hypothesis& hypothesis : *hypotheses) {
      if (hypothesis.weight > 0.0) hypothesis.weight *= std::exp(logs[i] - highest);
      total += hypothesis.weight;
      changed += hypothesis.weight * changed_[i++];
    }
  scaleWeights(total);
  change_probability_ = changed / total;
}

void MultiModel::scaleWeights(double total) {
  for (auto* hypotheses : {&surfaces_, &fresh_})
    for (Hypothesis& hypothesis : *hypotheses) hypothesis.weight /= total;
}

void MultiModel::update(const TwistSample& sample) {
  for (Hypothesis& hypothesis : fresh_) hypothesis.surface.add(*model_, config_, sample);
  for (Hypothesis& hypothesis : surfaces_) {
    if (hypothesis.weight < config_.sure) continue;
    hypothesis.surface.add(*model_, config_, sample);
    hypothesis.last_met = clock_;
  }
}

const MultiModel::Hypothesis& MultiModel::likeliest() const {
  const Hypothesis* likeliest = &surfaces_.front();
  for (const auto* hypotheses : {&surfaces_, &fresh_})
    for (const Hypothesis& hypothesis : *hypotheses)
      if (hypothesis.weight > likeliest->weight) likeliest = &hypothesis;
  return *likeliest;
}

/// What executions scatter about the likeliest ground: new ground is expected to be like that.
void MultiModel::followScatter(const TwistSample& sample, const Eigen::Vector3d& effect,
                               const Pose2& end) {
  const PatternPart& part = sample.part;
  const TwistProfile& profile = model_->profile(part.pattern);
  if (part.samples < profile.samples()) return;
  const Surface& ground = likeliest().surface;
  const auto& x = ground.mean();
  // Where this mean twist would end if it were steady beside the profile.
  const Eigen::Vector3d apart = sample.mean_twist + effect - part.mean - ground.added(part);
  const Eigen::Vector3d moved = profile.endLever() * apart;
  const Pose2 expected = profile.integrateEnd(correctionOf(x, part.pattern));
  const double dx = end.x - expected.x - moved[0];
  const double dy = end.y - expected.y - moved[1];
  Eigen::Vector4d errors;
  errors << ground.squaredError(sample), 0.5 * (dx * dx + dy * dy) / part.shape;
  // No number from a wild measurement may stay for ever.
  scatter_.add(part.pattern, errors.cwiseMin(kMostError), config_.longest_memory);
}

void MultiModel::forgetWeakest() {
  while (static_cast<int64_t>(fresh_.size()) > config_.moments) {
    // The newest two have had no time to prove themselves.
    const auto weakest = std::min_element(
        fresh_.begin(), fresh_.end() - 2,
        [](const Hypothesis& a, const Hypothesis& b) { return a.weight < b.weight; });
    const double left = 1.0 - weakest->weight;
    fresh_.erase(weakest);
    scaleWeights(left);
  }
}

/// Never the shipped one.
std::vector<MultiModel::Hypothesis>::iterator MultiModel::metLongestAgo() {
  return std::min_element(
      surfaces_.begin() + 1, surfaces_.end(),
      [](const Hypothesis& a, const Hypothesis& b) { return a.last_met < b.last_met; });
}

void MultiModel::forgetOldest() {
  const auto oldest = metLongestAgo();
  const double left = 1.0 - oldest->weight;
  surfaces_.erase(oldest);
  scaleWeights(left);
}

/// Hypotheses that began about the same time know the same: together they are one surface.
bool MultiModel::rememberSettled() {
  const auto lighter = [](const Hypothesis& a, const Hypothesis& b) { return a.weight < b.weight; };
  const auto begin_settled =
      std::stable_partition(fresh_.begin(), fresh_.end(), [this](const Hypothesis& hypothesis) {
        return hypothesis.surface.executions() < static_cast<double>(config_.settled_after);
      });
  double together = 0.0;
  for (auto settled = begin_settled; settled != fresh_.end(); ++settled)
    together += settled->weight;
  if (together < config_.sure) return false;
  Hypothesis likeliest = std::move(*std::max_element(begin_settled, fresh_.end(), lighter));
  likeliest.weight = together;
  likeliest.last_met = clock_;
  fresh_.erase(begin_settled, fresh_.end());
  const auto most = static_cast<size_t>(config_.capacity) + 1;
  // More than there is room for are those of a state from before the capacity was lowered.
  while (surfaces_.size() > most) forgetOldest();
  if (surfaces_.size() < most) {
    surfaces_.push_back(std::move(likeliest));
    return true;
  }
  // The others keep their numbers.
  const auto oldest = metLongestAgo();
  const double left = 1.0 - oldest->weight;
  *oldest = std::move(likeliest);
  scaleWeights(left);
  return true;
}

template <class Take>
void MultiModel::forEachAhead(Take&& take) const {
  const double h = hazard(config_.ahead);
  const double known = h * (1.0 - config_.fresh) / static_cast<double>(surfaces_.size());
  for (const Hypothesis& hypothesis : surfaces_)
    take((1.0 - h) * hypothesis.weight + known, hypothesis.surface);
  for (const Hypothesis& hypothesis : fresh_)
    take((1.0 - h) * hypothesis.weight, hypothesis.surface);
  take(h * config_.fresh * (1.0 - config_.far), near_);
  take(h * config_.fresh * config_.far, far_);
}

/// Mean and covariance of the corrections on the next metres.
void MultiModel::predictMixture() {
  for (size_t velocity = 0; velocity < kVelocities; ++velocity) {
    mean_[velocity].setZero(model_->dimension());
    covariance_[velocity].setZero(model_->dimension(), model_->dimension());
  }
  forEachAhead([this](double weight, const Surface& surface) {
    for (size_t velocity = 0; velocity < kVelocities; ++velocity)
      mean_[velocity] += weight * surface.mean()[velocity];
  });
  forEachAhead([this](double weight, const Surface& surface) {
    if (weight < kLeastWeight) return;
    for (size_t velocity = 0; velocity < kVelocities; ++velocity) {
      const Eigen::VectorXd apart = surface.mean()[velocity] - mean_[velocity];
      covariance_[velocity] += weight * surface.covariance()[velocity];
      for (Eigen::Index j = 0; j < apart.size(); ++j)
        covariance_[velocity].col(j) += weight * apart[j] * apart;
    }
  });
  const Eigen::Vector2d gains = effects_.gainsNow();
  mean_[0][0] += gains[0];
  mean_[2][0] += gains[1];
}

void MultiModel::learn(size_t executed, const ConstTrajectory& measured, RuleNote& note) {
  const PatternPart& whole = model_->whole(executed);
  // Few lengths of beginnings, so that what is measured of them stays together.
  const Eigen::Index samples =
      measured.rows() >= whole.samples
          ? whole.samples
          : std::max<Eigen::Index>(1, measured.rows() / kPartStep * kPartStep);
  const Eigen::Vector3d mean_twist = meanTwist(measured, samples, model_->period());
  if (!mean_twist.allFinite()) return;  // beyond all numbers
  TwistSample sample{samples == whole.samples ? whole : model_->part(executed, samples),
                     mean_twist};
  const ContextEffects::Inputs inputs =
      effects_.inputs(sample.part, model_->period() * static_cast<double>(samples), context_);
  const Eigen::Vector3d effect = effects_.effect(inputs);
  sample.mean_twist = plausible(mean_twist - effect);
  const Surface& before = likeliest().surface;
  const int64_t ground = likeliest().since;
  const Eigen::Vector3d beyond = sample.mean_twist - sample.part.mean - before.added(sample.part);
  const Eigen::Vector3d variance = before.doubt(sample.part) + before.executionNoise(sample.part);
  ++clock_;
  expectChange(sample.part.metres);
  weigh(sample);
  if (likeliest().since == ground) effects_.learn(inputs, beyond, variance, ground);
  context_ = {};
  countChange(sample.part.metres);
  update(sample);
  const Eigen::Index last = samples - 1;
  followScatter(sample, effect, {measured(last, 0), measured(last, 1), measured(last, 2)});
  forgetWeakest();
  note.surface_stored = rememberSettled();
  expectNew();
  // Or calm executions on the shipped set's ground were likelier on new ground, known to be calm.
  Surface& of_shipped = surfaces_.front().surface;
  if (of_shipped.executions() < static_cast<double>(config_.settled_after))
    of_shipped.expect(*model_, config_, near_.prior().scatter);
  predictMixture();
  note.change_probability = change_probability_;
  note.surface = 0;
  note.surface_probability = 0.0;
  for (const Hypothesis& hypothesis : fresh_) note.surface_probability += hypothesis.weight;
  for (size_t k = 0; k < surfaces_.size(); ++k) {
    if (surfaces_[k].weight <= note.surface_probability) continue;
    note.surface = static_cast<int>(k) + 1;
    note.surface_probability = surfaces_[k].weight;
  }
}

std::string MultiModel::reason(const RuleNote& note) const {
  const std::string sure = " (" + percent(note.surface_probability) + ")";
  if (note.surface_stored)
    return "remembered as surface " + std::to_string(note.surface) + " from now on";
  if (note.surface == 1) return "as shipped" + sure;
  return note.surface > 0 ? "as surface " + std::to_string(note.surface) + sure
                          : "unknown ground" + sure;
}

CorrectionVector MultiModel::correctionOf(const ByVelocity<Eigen::VectorXd>& x,
                                          size_t pattern) const {
  CorrectionVector correction;
  for (size_t velocity = 0; velocity < kVelocities; ++velocity) {
    const auto axis = static_cast<Eigen::Index>(velocity);
    correction.segment<kTerms>(kTerms * axis) = x[velocity].head<kTerms>();
    correction[TwistCorrection::kCommon + axis] =
        x[velocity][kTerms + static_cast<Eigen::Index>(pattern)];
  }
  return correction;
}

void MultiModel::predict(size_t pattern, Trajectory prediction) const {
  model_->profile(pattern).integrate(correctionOf(mean_, pattern), prediction);
}

Pose2 MultiModel::predictEnd(size_t pattern) const {
  return model_->profile(pattern).integrateEnd(correctionOf(mean_, pattern));
}

std::optional<PoseCovariance> MultiModel::endCovariance(size_t pattern) const {
  const TwistProfile& profile = model_->profile(pattern);
  Eigen::Vector3d execution = Eigen::Vector3d::Zero();
  forEachAhead([&](double weight, const Surface& surface) {
    execution += weight * surface.executionNoise(model_->whole(pattern));
  });
  Eigen::Matrix3d covariance =
      spreadOfEnd(profile.endResponse(), covariance_, pattern) +
      profile.endLever() * execution.asDiagonal() * profile.endLever().transpose();
  covariance.diagonal().head<2>().array() +=
      model_->whole(pattern).shape * expected_scatter_(3, static_cast<Eigen::Index>(pattern));
  return upperTriangle(0.5 * (covariance + covariance.transpose()));
}

void MultiModel::assign(const LearningRule& other) {
  const auto& rule = static_cast<const MultiModel&>(other);
  surfaces_ = rule.surfaces_;
  fresh_ = rule.fresh_;
  near_ = rule.near_;
  far_ = rule.far_;
  scatter_ = rule.scatter_;
  context_ = rule.context_;
  effects_ = rule.effects_;
  expected_scatter_ = rule.expected_scatter_;
  changes_ = rule.changes_;
  metres_ = rule.metres_;
  ground_ = rule.ground_;
  change_probability_ = rule.change_probability_;
  clock_ = rule.clock_;
  mean_ = rule.mean_;
  covariance_ = rule.covariance_;
}

// What the rule writes into the state file, and what it takes back from there.

std::vector<double> MultiModel::memory() const {
  std::vector<double> memory{static_cast<double>(clock_), changes_, metres_,
                             static_cast<double>(ground_)};
  memory.insert(memory.end(), scatter_.sums.data(), scatter_.sums.data() + scatter_.sums.size());
  effects_.save(memory);
  for (const auto* hypotheses : {&surfaces_, &fresh_}) {
    memory.push_back(static_cast<double>(hypotheses->size()));
    for (const Hypothesis& hypothesis : *hypotheses) {
      memory.push_back(hypothesis.weight);
      memory.push_back(static_cast<double>(hypothesis.last_met));
      memory.push_back(static_cast<double>(hypothesis.since));
      hypothesis.surface.save(memory);
    }
  }
  return memory;
}

bool MultiModel::restoreHypotheses(std::vector<Hypothesis>& hypotheses, size_t most,
                                   const std::vector<double>& memory, size_t& at) const {
  if (at >= memory.size() || !isCount(memory[at], static_cast<double>(most))) return false;
  const auto count = static_cast<size_t>(memory[at++]);
  hypotheses.clear();
  for (size_t i = 0; i < count; ++i) {
    if (memory.size() < at + 3) return false;
    Hypothesis hypothesis{near_, memory[at]};
    if (!(hypothesis.weight >= 0.0 && hypothesis.weight <= 1.0 + 1e-9)) return false;
    if (!isCount(memory[at + 1], static_cast<double>(clock_))) return false;
    if (!isCount(memory[at + 2], static_cast<double>(clock_))) return false;
    hypothesis.last_met = static_cast<int64_t>(memory[at + 1]);
    hypothesis.since = static_cast<int64_t>(memory[at + 2]);
    at += 3;
    if (!hypothesis.surface.restore(*model_, config_, memory, at)) return false;
    hypotheses.push_back(std::move(hypothesis));
  }
  return true;
}

bool MultiModel::restore(const TrajectoryTable&, const std::vector<double>& memory) {
  for (const double number : memory)
    if (!std::isfinite(number)) return false;
  size_t at = 4 + static_cast<size_t>(scatter_.sums.size());
  if (memory.size() < at || !isCount(memory[0], kMostExecutions)) return false;
  MultiModel rule = *this;
  rule.clock_ = static_cast<int64_t>(memory[0]);
  rule.changes_ = memory[1];
  rule.metres_ = memory[2];
  if (!(rule.changes_ >= 0.0 && rule.changes_ <= kMostExecutions) ||
      !(rule.metres_ >= 0.0 && rule.metres_ <= kLongestWay) || !isCount(memory[3], memory[0]))
    return false;
  rule.ground_ = static_cast<int64_t>(memory[3]);
  std::copy_n(memory.begin() + 4, rule.scatter_.sums.size(), rule.scatter_.sums.data());
  if (rule.scatter_.sums.minCoeff() < 0.0 ||
      rule.scatter_.sums.maxCoeff() > kMostError * kMostExecutions)
    return false;
  if (!rule.effects_.restore(memory, at)) return false;
  if (!rule.restoreHypotheses(rule.surfaces_, GroundConfig::kMostSurfaces + 1, memory, at) ||
      !rule.restoreHypotheses(rule.fresh_, static_cast<size_t>(config_.moments), memory, at) ||
      at != memory.size() || rule.surfaces_.empty())
    return false;
  double total = 0.0;
  for (const auto* hypotheses : {&rule.surfaces_, &rule.fresh_})
    for (const Hypothesis& hypothesis : *hypotheses) total += hypothesis.weight;
  if (std::abs(total - 1.0) > 1e-6) return false;
  rule.expectNew();
  rule.predictMixture();
  assign(rule);
  return true;
}

}  // namespace tread::learner
