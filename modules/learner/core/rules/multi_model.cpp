// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/rules/multi_model.hpp"
#include "modules/learner/core/rules/ground_scales.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/LU>

namespace tread::learner {
namespace {

/// A pattern that hardly moves may still cross a border [m].
constexpr double kLeastMetres = 0.05;
/// Resolution of the centre of new ground [1], which limits its digits in the state file.
constexpr double kCentreStep = 1e-6;
/// Beginnings are rounded to quarters of a pattern, so that their measurements can be combined.
constexpr Eigen::Index kPartSteps = 4;
/// Less probable fresh ground is dropped: each execution adds a new one [1].
constexpr double kLeastHypothesis = 1e-3;
/// A ground that returns is never exactly the same: deviation relative to the twist [1].
constexpr double kReturned = 0.01;
/// Grounds that differ by less than this share of one execution's deviation are merged [1].
constexpr double kSame = 0.5;
/// Limit of the ratio of two grounds' variances for them to be merged [1].
constexpr double kAsDoubted = 1.5;
/// Weight of the scales' prior, in grounds.
constexpr double kScalePrior = 4.0;
/// Above this probability of a change an execution is uninformative about its context [1].
constexpr double kSurelyChanged = 0.5;
/// Smaller sums of squared corrections count as zero.
constexpr double kLeastAgreed = 1e-12;
/// Probability of a change that was detected [1].
constexpr double kDecided = 0.9;
/// Share of a pattern after a change of ground, which is assumed in its middle [1].
constexpr double kBehindChange = 0.5;

double rounded(double number, double step) {
  return step * std::round(number / step);
}

std::string percent(double probability) {
  return std::to_string(std::lround(100.0 * probability)) + " %";
}

/// Weights from the prior and from the grounds met: `counted` is the prior's weight in grounds.
template <class Scales, class Count>
void learnWeights(Scales& scales, double counted, Count&& count) {
  double total = 0.0;
  for (size_t s = 0; s < scales.size(); ++s) {
    scales[s].weight = counted * scales[s].weight + count(s);
    total += scales[s].weight;
  }
  for (auto& scale : scales) scale.weight /= total;
}

}  // namespace

MultiModel::MultiModel(const RuleConfig& config, const PatternSet& shipped)
    : config_(config.ground),
      model_(std::make_shared<GroundModel>(config.ground, shipped)),
      scatter_(model_->patterns()),
      expected_scatter_(scatter_.expected(config_.noise_prior)),
      new_(model_, config_, expectNewGround()),
      effects_(config_) {
  SurfacePrior of_shipped = new_.expectation();
  of_shipped.velocity = velocityScalesAsShipped();
  of_shipped.yaw = yawScalesAsShipped(config_.lever);
  surfaces_.push_back({Surface(model_, config_, of_shipped), 1.0 - config_.fresh, 0, 0});
  fresh_.push_back({new_, config_.fresh, clock_, clock_});
  mix();
}

/// Expected common part of new ground and the grounds met: sum x_k / (1 + K).
SetCorrection MultiModel::commonOf(const std::vector<const Surface*>& met) const {
  SetCorrection mean = SetCorrection::none(model_->patterns());
  const double share = 1.0 / (1.0 + static_cast<double>(met.size()));
  for (const Surface* surface : met) {
    mean.common += share * surface->correction().common;
    mean.own += share * surface->correction().own;
  }
  // If grounds contradict each other, their mean does not predict the next one. The shipped set
  // counts as one of them; an error of a turn does more harm than one of a gain.
  const auto agreement = [&](const auto& of) {
    const double size = of(mean).squaredNorm();
    double apart = size;
    for (const Surface* surface : met)
      apart += (of(surface->correction()) - of(mean)).squaredNorm();
    const auto grounds = static_cast<double>(met.size());
    return std::max(0.0, 1.0 - apart / (grounds * (grounds + 1.0) * std::max(size, kLeastAgreed)));
  };
  if (met.empty()) return mean;
  mean.common.segment<2>(TwistCorrection::kYaw) *= agreement([](const SetCorrection& x) {
    return Eigen::Vector2d(x.common.segment<2>(TwistCorrection::kYaw));
  });
  mean.common.segment<2>(TwistCorrection::kBiasX) *= agreement([](const SetCorrection& x) {
    return Eigen::Vector2d(x.common.segment<2>(TwistCorrection::kBiasX));
  });
  for (Eigen::Index k = 0; k < TwistCorrection::kOwn; ++k)
    mean.own.row(k) *= agreement(
        [k](const SetCorrection& x) { return Eigen::VectorXd(x.own.row(k).transpose()); });
  return mean;
}

SurfacePrior MultiModel::expectNewGround() const {
  std::vector<const Surface*> met;
  for (const Hypothesis& known : surfaces_)
    // The shipped set's ground counts if the vehicle was really on it.
    if (settled(known.surface)) met.push_back(&known.surface);
  const double share = 1.0 / (1.0 + static_cast<double>(met.size()));
  SurfacePrior prior;
  prior.centre = commonOf(met);
  const auto cut = [](double number) { return rounded(number, kCentreStep); };
  prior.centre.common = prior.centre.common.unaryExpr(cut).eval();
  prior.centre.own = prior.centre.own.unaryExpr(cut).eval();
  prior.velocity = velocityScalesOfNewGround(0.5 * (1.0 + share));
  prior.yaw = yawScalesOfNewGround(config_.lever, 0.5 * (1.0 + share));
  const auto counted = [&](const auto& weightOf) {
    return [this, weightOf](size_t scale) {
      double sum = 0.0;
      for (size_t i = 1; i < surfaces_.size(); ++i) sum += weightOf(surfaces_[i].surface, scale);
      return sum;
    };
  };
  learnWeights(prior.velocity, kScalePrior, counted([](const Surface& surface, size_t scale) {
                 return surface.velocity().weight(scale);
               }));
  learnWeights(prior.yaw, kScalePrior, counted([](const Surface& surface, size_t scale) {
                 return surface.yaw().weight(scale);
               }));
  prior.scatter = expected_scatter_.topRows<3>();
  return prior;
}

void MultiModel::expectNew() {
  expected_scatter_ = scatter_.expected(config_.noise_prior);
  new_ = Surface(model_, config_, expectNewGround());
}

double MultiModel::hazard(double metres) const {
  const double rate =
      (config_.change_prior + changes_) / (config_.change_prior * config_.change_metres + metres_);
  return 1.0 - std::exp(-std::max(metres, kLeastMetres) * rate);
}

bool MultiModel::countChange(double metres) {
  bool none = false;
  metres_ += metres;
  for (const auto* hypotheses : {&surfaces_, &fresh_})
    for (const Hypothesis& hypothesis : *hypotheses) {
      if (hypothesis.weight < config_.sure) continue;
      none = std::exchange(noticed_, false) && hypothesis.since == ground_;
      if (hypothesis.since == ground_) continue;
      ground_ = hypothesis.since;
      changes_ += 1.0;
    }
  if (metres_ >= kLongestWay) {
    changes_ *= kLongestWay / metres_;
    metres_ = kLongestWay;
  }
  return none;
}

void MultiModel::expectChange(double h) {
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
  fresh_.push_back({new_, h * config_.fresh, clock_, clock_});
  changed_.push_back(1.0);
}

void MultiModel::weigh(const TwistSample& sample) {
  double highest = -std::numeric_limits<double>::infinity();
  std::vector<double> logs;
  const Eigen::Vector3d returned(squared(kReturned * sample.part.speed),
                                 squared(kReturned * sample.part.speed),
                                 squared(kReturned * sample.part.turning));
  for (const auto* hypotheses : {&surfaces_, &fresh_})
    for (const Hypothesis& hypothesis : *hypotheses) {
      const bool back = hypotheses == &surfaces_ && hypothesis.weight < 0.5;
      logs.push_back(hypothesis.surface.logDensity(
          sample, back ? returned : Eigen::Vector3d(Eigen::Vector3d::Zero())));
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

void MultiModel::normalizeWeights() {
  double total = 0.0;
  for (auto* hypotheses : {&surfaces_, &fresh_})
    for (Hypothesis& hypothesis : *hypotheses) total += hypothesis.weight;
  scaleWeights(total);
}

void MultiModel::update(const TwistSample& sample) {
  for (Hypothesis& hypothesis : fresh_) hypothesis.surface.add(config_, sample);
  for (Hypothesis& hypothesis : surfaces_) {
    if (hypothesis.weight < config_.sure) continue;
    hypothesis.surface.add(config_, sample);
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

void MultiModel::followScatter(const TwistSample& sample, const Eigen::Vector3d& effect,
                               const Pose2& end) {
  const PatternPart& part = sample.part;
  const TwistProfile& profile = model_->profile(part.pattern);
  if (part.samples < profile.samples()) return;
  const Surface& ground = likeliest().surface;
  // Deviation of the end for a constant deviation of the twist.
  const Eigen::Vector3d apart =
      sample.mean_twist + effect - part.mean - part.toBody() * ground.correction().added(part);
  const Eigen::Vector3d moved = profile.endLever() * apart;
  const Pose2 expected =
      profile.integrateEnd(model_->scale(), ground.correction().of(part.pattern));
  const double dx = end.x - expected.x - moved[0];
  const double dy = end.y - expected.y - moved[1];
  Eigen::Vector4d errors;
  errors << ground.squaredError(sample), 0.5 * (dx * dx + dy * dy) / part.shape;
  scatter_.add(part.pattern, errors.cwiseMin(kMostError), config_.longest_memory);
}

void MultiModel::forgetWeakest() {
  for (auto each = fresh_.begin(); each != fresh_.end();)
    each = each->weight < kLeastHypothesis ? fresh_.erase(each) : each + 1;
  normalizeWeights();
  while (static_cast<int64_t>(fresh_.size()) > config_.moments) {
    const auto weakest = std::min_element(
        fresh_.begin(), fresh_.end() - 1,
        [](const Hypothesis& a, const Hypothesis& b) { return a.weight < b.weight; });
    const double left = 1.0 - weakest->weight;
    fresh_.erase(weakest);
    scaleWeights(left);
  }
}

bool MultiModel::settled(const Surface& surface) const {
  return surface.executions() >= static_cast<double>(config_.settled_after);
}

/// Whether a ground affects all patterns like a remembered one, within half of one execution's
/// deviation.
bool MultiModel::same(const Surface& a, const Surface& b) const {
  Eigen::Array3d over_doubt = Eigen::Array3d::Zero();
  Eigen::Array3d over_noise = Eigen::Array3d::Zero();
  for (size_t p = 0; p < model_->patterns(); ++p) {
    const PatternPart& part = model_->whole(p);
    const Moments of_a = a.expected(part), of_b = b.expected(part);
    const Eigen::Array3d apart = (of_a.mean - of_b.mean).array().square();
    over_doubt += apart / (of_a.covariance + of_b.covariance).diagonal().array();
    over_noise += apart / b.executionNoise(part).array();
  }
  const auto patterns = static_cast<double>(model_->patterns());
  // A ground with few executions is known mostly from the shipped set: there it is all or nothing.
  const bool near = over_noise.mean() < squared(kSame) * patterns;
  return near && (settled(b) || (over_doubt < kAsDoubted * patterns).all());
}

bool MultiModel::rememberSettled() {
  const auto lighter = [](const Hypothesis& a, const Hypothesis& b) { return a.weight < b.weight; };
  const auto begin_settled = std::stable_partition(
      fresh_.begin(), fresh_.end(),
      [this](const Hypothesis& hypothesis) { return !settled(hypothesis.surface); });
  double together = 0.0;
  for (auto settled = begin_settled; settled != fresh_.end(); ++settled)
    together += settled->weight;
  if (together < config_.sure) return false;
  Hypothesis likeliest = std::move(*std::max_element(begin_settled, fresh_.end(), lighter));
  likeliest.weight = together;
  likeliest.last_met = clock_;
  fresh_.erase(begin_settled, fresh_.end());
  for (Hypothesis& known : surfaces_) {
    if (!same(likeliest.surface, known.surface)) continue;
    known.weight += together;
    known.last_met = clock_;
    return false;
  }
  const auto most = static_cast<size_t>(config_.capacity) + 1;
  while (surfaces_.size() >= most) {
    const auto oldest = std::min_element(
        surfaces_.begin() + 1, surfaces_.end(),
        [](const Hypothesis& a, const Hypothesis& b) { return a.last_met < b.last_met; });
    const double left = 1.0 - oldest->weight;
    surfaces_.erase(oldest);
    scaleWeights(left);
  }
  surfaces_.push_back(std::move(likeliest));
  normalizeWeights();
  return true;
}

void MultiModel::mix() {
  mean_ = SetCorrection::none(model_->patterns());
  changed_mean_ = mean_;
  const auto add = [](SetCorrection& sum, double weight, const Surface& surface) {
    sum.common += weight * surface.correction().common;
    sum.own += weight * surface.correction().own;
  };
  const double known = (1.0 - config_.fresh) / static_cast<double>(surfaces_.size());
  for (const Hypothesis& hypothesis : surfaces_) {
    add(mean_, hypothesis.weight, hypothesis.surface);
    add(changed_mean_, known, hypothesis.surface);
  }
  for (const Hypothesis& hypothesis : fresh_) add(mean_, hypothesis.weight, hypothesis.surface);
  add(changed_mean_, config_.fresh, new_);
}

TwistCorrection MultiModel::expected(const PatternPart& part) const {
  const double changed = kBehindChange * hazard(part.metres);
  TwistCorrection correction = mean_.of(part.pattern);
  const TwistCorrection other = changed_mean_.of(part.pattern);
  correction.common += changed * (other.common - correction.common);
  correction.own += changed * (other.own - correction.own);
  return correction;
}

std::optional<MultiModel::Stretch> MultiModel::stretch(const ContextEffects& effects,
                                                       size_t pattern,
                                                       const ConstTrajectory& measured,
                                                       Eigen::Index first,
                                                       Eigen::Index samples) const {
  const Eigen::Vector3d mean_twist = meanTwist(measured, first, samples, model_->period());
  if (!mean_twist.allFinite()) return std::nullopt;
  const PatternPart& whole = model_->whole(pattern);
  const Eigen::Vector3d entry = model_->besideClass(pattern, context_.entry);
  Stretch result;
  result.sample.part =
      first == 0 && samples == whole.samples ? whole : model_->part(pattern, first, samples);
  result.sample.entry = entry.allFinite() ? plausible(entry) : entry;
  result.inputs = effects.inputs(result.sample.part,
                                 model_->period() * static_cast<double>(samples), context_.tilt);
  result.effect = effects.effect(result.inputs);
  result.sample.mean_twist = plausible(mean_twist - result.effect);
  return result;
}

void MultiModel::learn(size_t executed, const ConstTrajectory& measured, RuleNote& note) {
  const PatternPart& whole = model_->whole(executed);
  // Few different lengths of beginnings, so that their measurements can be combined.
  const Eigen::Index step = std::max<Eigen::Index>(1, whole.samples / kPartSteps);
  const Eigen::Index samples = measured.rows() >= whole.samples ? whole.samples
                               : measured.rows() >= step        ? measured.rows() / step * step
                                                                : measured.rows();
  // The part before a change is uninformative about the ground after it.
  const Eigen::Index rows = std::min(measured.rows(), whole.samples);
  const bool decided = context_.changed_after >= 0 && context_.changed_after < rows;
  const Eigen::Index quarter = (context_.changed_after + step - 1) / step * step;
  const bool rounded = quarter < samples;
  const Eigen::Index first = !decided ? 0 : rounded ? quarter : context_.changed_after;
  const Eigen::Index end = decided && !rounded ? rows : samples;
  effects_.meet(context_.voltage);
  const auto of_samples = stretch(executed, measured, first, end - first);
  if (!of_samples) return;  // beyond all numbers
  const auto& [sample, inputs, effect] = *of_samples;
  const bool all = first == 0 && end == whole.samples;
  const Surface& before = likeliest().surface;
  const TwistSample usual = before.asUsual(sample);
  const Moments expected = before.expected(usual.part);
  const Eigen::Matrix3d turn = sample.part.toBody();
  const Eigen::Vector3d beyond = turn * (usual.deviation() - expected.mean);
  Eigen::Matrix3d spread = expected.covariance;
  spread.diagonal() += before.executionNoise(sample.part);
  const Eigen::Vector3d variance = (turn * spread * turn.transpose()).diagonal();
  if (end == whole.samples) {
    const auto of_all = all ? of_samples : stretch(executed, measured, 0, end);
    if (of_all) calibrate(of_all->sample);
  }
  ++clock_;
  expectChange(decided ? kDecided : hazard(sample.part.metres));
  weigh(sample);
  // Only a certain hypothesis counts as another ground: a deviation of a single execution may come
  // from the context.
  if (change_probability_ < kSurelyChanged) effects_.learn(inputs, beyond, variance, ground_);
  context_ = {};
  noticed_ = noticed_ || decided;
  note.no_change = countChange(all ? whole.metres : model_->part(executed, 0, end).metres);
  forgetWeakest();
  update(sample);
  const Eigen::Index last = end - 1;
  if (!decided)
    followScatter(sample, effect, {measured(last, 0), measured(last, 1), measured(last, 2)});
  note.surface_stored = rememberSettled();
  expectNew();
  Surface& of_shipped = surfaces_.front().surface;
  if (!settled(of_shipped)) of_shipped.expect(config_, new_.expectation().scatter);
  mix();
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

TwistCorrection MultiModel::predicted(size_t pattern) const {
  TwistCorrection correction = expected(model_->whole(pattern));
  const Eigen::Vector2d gains = effects_.gainsNow();
  correction.common[TwistCorrection::kGain] += gains[0];
  correction.common[TwistCorrection::kYaw] += gains[1];
  return correction;
}

void MultiModel::predict(size_t pattern, Trajectory prediction) const {
  model_->profile(pattern).integrate(model_->scale(), predicted(pattern), prediction);
}

Pose2 MultiModel::predictEnd(size_t pattern) const {
  return model_->profile(pattern).integrateEnd(model_->scale(), predicted(pattern));
}

void MultiModel::assign(const LearningRule& other) {
  *this = static_cast<const MultiModel&>(other);
}

}  // namespace tread::learner
