// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/discovery.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <tuple>

#include "modules/identification/core/adequacy.hpp"
#include "modules/identification/core/atlas.hpp"
#include "modules/identification/core/atlas_maps.hpp"
#include "modules/identification/core/dead_reckoning.hpp"
#include "modules/identification/core/end_errors.hpp"
#include "modules/identification/core/enough_driving.hpp"
#include "modules/identification/core/moments.hpp"
#include "modules/identification/core/pruning.hpp"
#include "modules/identification/core/student.hpp"
#include "modules/identification/core/unseen.hpp"
#include "modules/identification/core/verdict.hpp"

namespace tread::gap {
namespace {

constexpr int kLeastHalf = 10;           // blocks from which effects can be chosen, too
constexpr double kAdequacyAlpha = 0.01;  // with the tests' 2 %: 3 % false alarms altogether
constexpr double kMomentNats = 10.0;     // 2 nats times what correlated ground takes off
constexpr double kMoved = 4.0;           // standard errors; a few terms are looked at in each log
constexpr double kInvisible = 2.0;       // times its typical size: not excited

std::string text(const char* format, double a, double b) {
  char line[200];
  std::snprintf(line, sizeof line, format, a, b);
  return line;
}

class Discovery {
 public:
  Discovery(const GapTask& task, const Progress& say)
      : task_(task),
        say_(say),
        rows_(task.train, {}),
        fitter_(rows_, task.threads),
        all_(rows_.rows().size(), 1) {
    measured_ = measuredBlocks(rows_);
    settings_.seed = task.seed;
    settings_.calibrate = task.calibrate;
    if (task.keep_small) settings_.least_gain = 0.0;
    for (const Decision& decision : task.decisions)
      (decision.accepted ? settings_.accepted : settings_.rejected).push_back(decision.effect);
    settings_.all_sized = true;
  }

  Finding run() {
    finding_.seed = task_.seed;
    finding_.before = task_.model;
    finding_.after = task_.model;
    finding_.hygiene = task_.hygiene;
    finding_.decisions = task_.decisions;
    finding_.blocks = static_cast<size_t>(measured_);
    finding_.block_length = rows_.blockLength();
    if (cannotTell()) return std::move(finding_);
    say_(text("1 calibrate: %.0f rows in %.0f blocks", static_cast<double>(rows_.rows().size()),
              measured_));
    say_("2-5 test, refit, validate, prune");
    result_ = search(fitter_, task_.model, all_, settings_, memory_, say_);
    requireSized();
    // What was seen but does not matter is no rest without a name.
    const FitState tested = result_.state;
    if (!result_.effects.empty() && !task_.keep_small && !isConfirmed()) forgetEffects();
    finding_.after = result_.state.model;
    describeEffects();
    say_("6 adequacy");
    const Adequacy adequacy = testAdequacy(fitter_, tested, all_, kAdequacyAlpha, task_.seed);
    finding_.adequacy_p = adequacy.p_value;
    finding_.unexplained = adequacy.unexplained;
    say_("7 error on driving that was not used");
    finding_.gap = task_.test.empty() ? nestedGap() : testGap();
    finding_.gap->floor = deadReckoningFloor(task_.test.empty() ? task_.train : task_.test);
    finding_.atlas = residualAtlas(rows_, task_.model, finding_.after);
    finding_.maps = residualMaps(rows_, task_.model, finding_.after);
    ShownExecutions shown = shownExecutions(unseen_, task_.model, residualNoise());
    finding_.overlays = std::move(shown.overlays);
    finding_.places = std::move(shown.places);
    judge(finding_, kAdequacyAlpha, settings_.least_gain);
    return std::move(finding_);
  }

 private:
  bool cannotTell() {
    finding_.verdict = Verdict::kCannotTell;
    for (const HygieneNote& note : task_.hygiene)
      if (note.fatal) {
        finding_.reason = note.log + ": " + note.what;
        return true;
      }
    finding_.reason = tooLittleDriving(rows_);
    return !finding_.reason.empty();
  }

  /// An accepted effect without a size would be a claim about nothing.
  void requireSized() {
    for (const FreeParameter& parameter : result_.state.free) {
      const std::string effect = parameter.path.substr(0, parameter.path.find('.'));
      if (isNew(effect) && contains(settings_.accepted, effect) &&
          *findParameter(result_.state.model, parameter.path) != 0.0 &&
          onBound(result_.state.model, parameter))
        result_.unsized[effect] = "its size runs to the end of its plausible range";
    }
    for (const auto& [effect, why] : result_.unsized)
      throw std::invalid_argument(effect + ": accepted, but this drive cannot size it: " + why +
                                  "; drive what shows it, or do not accept it");
  }

  /// Whether the end error falls, by more than its standard error over blocks, on halves of the
  /// driving that the sizes of the effects were not fitted to. Effects of the INS, which may move
  /// no pose, may lessen what is left of the yaw rate.
  bool isConfirmed() const {
    const auto blocks = static_cast<Eigen::Index>(rows_.blocks());
    Eigen::MatrixXd with = Eigen::MatrixXd::Zero(blocks, 3);
    for (int half : {0, 1}) addMissed(refitted(fitter_, result_, halfMask(half)), 1 - half, with);
    Eigen::MatrixXd lacking = Eigen::MatrixXd::Zero(blocks, 3);
    const FitState others = lackingEffects();
    for (int half : {0, 1}) addMissed(others, half, lacking);
    const bool measurement =
        std::all_of(result_.effects.begin(), result_.effects.end(), [](const std::string& effect) {
          return effectNamed(effect).kind == EffectKind::kMeasurement;
        });
    const std::vector<char> every(static_cast<size_t>(blocks), 1);
    for (Eigen::Index i = 0; i < (measurement ? 3 : 2); ++i) {
      const Gain gain = gainOf(lacking.col(i), with.col(i), every);
      if (gain.value > gain.error) return true;
    }
    return false;
  }

  /// The result with its given, released and accepted terms alone.
  FitState lackingEffects() const {
    if (result_.released.empty()) return result_.calibrated;
    std::vector<std::string> found;
    for (const std::string& effect : result_.effects)
      if (!contains(settings_.accepted, effect)) found.push_back(effect);
    FitState state = switchedOff(fitter_, result_.state, found);
    fitter_.fit(state, all_);
    return state;
  }

  /// Adds what a state misses on every other block: position, yaw and yaw rate (blocks x 3).
  void addMissed(const FitState& state, int half, Eigen::MatrixXd& sums) const {
    for (const EndError& error : endErrors(rows_, state.model))
      if (error.block % 2 == half)
        sums.row(error.block).head(2) += Eigen::RowVector2d(error.position, error.yaw);
    const Eigen::VectorXd residuals = rows_.residuals(state.predicted);
    for (size_t i = 0; i < rows_.rows().size(); ++i) {
      const Row& row = rows_.rows()[i];
      if (row.channel == Channel::kYawRate && row.block % 2 == half)
        sums(row.block, 2) += std::abs(residuals[static_cast<Eigen::Index>(i)]);
    }
  }

  std::vector<char> halfMask(int half) const {
    std::vector<char> mask(all_.size());
    for (size_t i = 0; i < mask.size(); ++i) mask[i] = rows_.rows()[i].block % 2 == half;
    return mask;
  }

  void forgetEffects() {
    std::vector<std::string> kept;
    for (const std::string& effect : result_.effects) {
      if (contains(settings_.accepted, effect)) {
        kept.push_back(effect);
        continue;
      }
      say_("  - " + effect + ": does not lessen the end error on driving it was not fitted to");
      result_.negligible.push_back(effect);
    }
    result_.effects = kept;
    result_.state = lackingEffects();
  }

  void describeEffects() {
    const FitState& state = result_.state;
    const Eigen::MatrixXd covariance = parameterCovariance(rows_, state, all_);
    const double quantile = studentQuantile(measured_ - 1);
    std::map<std::string, std::vector<Estimate>> estimates;
    for (size_t i = 0; i < state.free.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      const Estimate estimate = estimateOf(state.free[i], quantile * std::sqrt(covariance(at, at)));
      const std::string effect = state.free[i].path.substr(0, state.free[i].path.find('.'));
      if (isNew(effect))
        estimates[effect].push_back(estimate);
      else
        finding_.calibrated.push_back(estimate);
      if (!isNew(effect))
        finding_.calibrated.back().moved = hasMoved(estimate, std::sqrt(covariance(at, at)));
    }
    for (const std::string& path : changePointsOn(state.model)) {
      const std::string effect = path.substr(0, path.find('.'));
      if (isNew(effect)) estimates[effect].push_back(momentEstimate(path));
    }
    for (const std::string& name : result_.effects) describe(name, estimates[name]);
    finding_.negligible = result_.negligible;
    finding_.at_bound = result_.at_bound;
    finding_.ladder = result_.ladder;
    finding_.candidates = result_.tests;
    for (const CandidateTest& test : result_.tests)
      if (!isNew(test.effect) && !isGiven(test.effect) && !isExcited(test))
        finding_.not_excited.push_back(test.effect);
    documentAfter(covariance);
  }

  /// Whether a term of the model is another one now, or a number of which it says how sure it is.
  bool hasMoved(const Estimate& estimate, double error) const {
    const bool number = estimate.parameter.find('.') == std::string::npos;
    if (number && settings_.calibrate) return false;
    const ParameterCovariance& known = task_.model.covariance;
    double variance = error * error;
    for (size_t i = 0; i < known.parameters.size(); ++i)
      if (known.parameters[i] == estimate.parameter) variance += known.matrix[i][i];
    return std::abs(estimate.value - estimate.before) > kMoved * std::sqrt(variance);
  }

  bool isGiven(const std::string& effect) const {
    return isOn(effectNamed(effect), task_.model.vehicle.effects, task_.model.measurement);
  }

  static bool isExcited(const CandidateTest& test) {
    const double typical = parameterNamed(effectNamed(test.effect), test.parameter).typical;
    return test.detectable <= kInvisible * std::abs(typical);
  }

  bool isNew(const std::string& effect) const {
    return std::find(result_.effects.begin(), result_.effects.end(), effect) !=
           result_.effects.end();
  }

  Estimate estimateOf(const FreeParameter& parameter, double half) const {
    Estimate estimate;
    estimate.parameter = parameter.path;
    estimate.value = *findParameter(result_.state.model, parameter.path);
    estimate.before = *findParameter(task_.model, parameter.path);
    estimate.low = estimate.value - half;
    estimate.high = estimate.value + half;
    const size_t dot = parameter.path.find('.');
    if (dot != std::string::npos)
      estimate.unit =
          parameterNamed(effectNamed(parameter.path.substr(0, dot)), parameter.path.substr(dot + 1))
              .unit;
    else
      estimate.unit = parameter.path == "lag" || parameter.path == "delay" ? "s" : "1";
    return estimate;
  }

  Estimate momentEstimate(const std::string& path) const {
    Estimate estimate;
    estimate.parameter = path;
    estimate.unit = "s";
    estimate.value = *findParameter(result_.state.model, path);
    std::tie(estimate.low, estimate.high) =
        momentInterval(fitter_, result_.state, path, all_, kMomentNats);
    return estimate;
  }

  void describe(const std::string& name, std::vector<Estimate> parameters) {
    FoundEffect effect;
    effect.name = name;
    effect.kind = effectNamed(name).kind;
    effect.parameters = std::move(parameters);
    effect.group = confoundedEffects(name, result_.state.model.measurement);
    for (const std::string& pair : result_.replaced[name]) effect.group.push_back(pair);
    // What came in beside it later does not stand in its place.
    for (const RunnerUp& other : result_.runner_ups[name])
      if (!isNew(other.effect) && !contains(result_.released, other.effect))
        effect.runner_ups.push_back(other);
    effect.score = result_.scores[name];
    effect.p_value = result_.p_values[name];
    effect.gain = result_.gains[name].value;
    effect.gain_error = result_.gains[name].error;
    effect.accepted = contains(settings_.accepted, name);
    if (effect.accepted) {
      effect.group.clear();  // decided
      effect.runner_ups.clear();
    }
    effect.group.erase(std::remove_if(effect.group.begin(), effect.group.end(),
                                      [this](const std::string& other) {
                                        return contains(settings_.rejected, other);
                                      }),
                       effect.group.end());
    finding_.effects.push_back(std::move(effect));
  }

  void documentAfter(const Eigen::MatrixXd& covariance) {
    ParameterCovariance& known = finding_.after.covariance;
    known = {};
    std::vector<Eigen::Index> sure;
    for (size_t i = 0; i < result_.state.free.size(); ++i) {
      const FreeParameter& parameter = result_.state.free[i];
      const auto at = static_cast<Eigen::Index>(i);
      if (!(std::sqrt(covariance(at, at)) < parameter.max - parameter.min)) continue;
      known.parameters.push_back(parameter.path);
      sure.push_back(at);
    }
    for (Eigen::Index i : sure) {
      known.matrix.emplace_back();
      for (Eigen::Index j : sure) known.matrix.back().push_back(covariance(i, j));
    }
    Envelope envelope;
    for (const auto& motion : rows_.simulate(finding_.after.vehicle))
      for (size_t i = 1; i < motion.size(); ++i) {
        const double dt = motion[i].time - motion[i - 1].time;
        if (dt > 0.0)
          envelope.include(twistTo(between(motion[i - 1].T_map_body, motion[i].T_map_body), dt));
      }
    finding_.after.envelope = envelope;
  }

  Gap testGap() {
    Gap gap;
    const Rows& test = test_rows_.emplace(task_.test, RowSettings{});
    const auto every = [](const EndError&) { return true; };
    gap.before = summaryOf(endErrors(test, task_.model), every);
    unseen_.push_back({&test, finding_.after, endErrors(test, finding_.after), task_.train.size()});
    gap.after = summaryOf(unseen_.back().errors, every);
    return gap;
  }

  /// Alternate blocks: what one half found is judged by the other.
  Gap nestedGap() {
    Gap gap;
    gap.structure_nested = measured_ >= 2 * kLeastHalf;
    gap.before = summaryOf(endErrors(rows_, task_.model), [](const EndError&) { return true; });
    std::vector<EndError> outside;  // of either half
    settings_.all_sized = false;    // half of the driving may not show all
    const Progress silent = [](const std::string&) {};
    for (int half : {0, 1}) {
      const std::vector<char> mask = halfMask(half);
      const ModelDocument model =
          gap.structure_nested
              ? search(fitter_, task_.model, mask, settings_, memory_, silent).state.model
              : refitted(fitter_, result_, mask).model;
      unseen_.push_back({&rows_, model, {}, 0});
      for (const EndError& error : endErrors(rows_, model))
        if (error.block % 2 != half) unseen_.back().errors.push_back(error);
      outside.insert(outside.end(), unseen_.back().errors.begin(), unseen_.back().errors.end());
    }
    gap.after = summaryOf(outside, [](const EndError&) { return true; });
    return gap;
  }

  /// Noise of what the new model leaves, channel by channel.
  Noise residualNoise() const {
    const Eigen::VectorXd predicted = rows_.predict(finding_.after);
    return estimateNoise(rows_.rows(), rows_.residuals(predicted),
                         activityOf(rows_.rows(), predicted), all_);
  }

  const GapTask& task_;
  const Progress& say_;
  Rows rows_;
  Fitter fitter_;
  std::vector<char> all_;
  SearchSettings settings_;
  SearchMemory memory_;
  std::optional<Rows> test_rows_;
  std::vector<Unseen> unseen_;
  SearchResult result_;
  Finding finding_;
  int measured_ = 0;  ///< blocks with rows
};

}  // namespace

Finding findGap(const GapTask& task, const Progress& say) {
  return Discovery(task, say).run();
}

}  // namespace tread::gap
