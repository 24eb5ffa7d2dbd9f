// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/core/search.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "tools/gap/core/acceptance.hpp"
#include "tools/gap/core/detectable.hpp"
#include "tools/gap/core/moments.hpp"
#include "tools/gap/core/pruning.hpp"
#include "tools/gap/core/replacement.hpp"

namespace tread::gap {
namespace {

constexpr size_t kRenewed = 10;          // directions that are simulated again in a round
constexpr double kVanished = 2e-3;       // of an effect's typical size
constexpr double kPowerQuantile = 0.84;  // normal: 80 % power

/// Plain causes that everything else must be told from.
const std::vector<std::string>& coverPaths() {
  static const std::vector<std::string> paths{"slip_ratio.slip", "track_width.widening",
                                              "actuator_lag.lag", "command_delay.delay",
                                              "ins_latency.latency"};
  return paths;
}

std::string effectOf(const std::string& path) {
  return path.substr(0, path.find('.'));
}

bool hasVanished(const ModelDocument& model, const Candidate& candidate) {
  const EffectParameter& known = parameterNamed(effectNamed(candidate.effect), candidate.parameter);
  const double size = *findParameter(model, candidate.effect + "." + candidate.parameter) -
                      (candidate.value - candidate.change);
  return std::abs(size) < kVanished * std::abs(known.typical);
}

/// A test of all candidates, and for each effect the candidate with the largest score.
struct Round {
  std::vector<Candidate> candidates;
  std::vector<double> scores;
  std::vector<double> sizes;
  std::vector<double> chance;
  std::vector<double> evidence;  ///< over what is needed: above 1 chance is no explanation
  std::vector<double> promise;   ///< gain in first order [nats]
  double overdispersion = 1.0;
  std::vector<size_t> best;  ///< of each effect, largest score first
  std::vector<CandidateTest> tests;
};

std::vector<size_t> bestOfEffects(const Round& round) {
  std::map<std::string, size_t> best;
  for (size_t i = 0; i < round.candidates.size(); ++i) {
    const auto known = best.emplace(round.candidates[i].effect, i).first;
    if (std::abs(round.scores[i]) > std::abs(round.scores[known->second])) known->second = i;
  }
  std::vector<size_t> order;
  for (const auto& [effect, index] : best) order.push_back(index);
  std::stable_sort(order.begin(), order.end(), [&round](size_t a, size_t b) {
    return std::abs(round.scores[a]) > std::abs(round.scores[b]);
  });
  return order;
}

class Search {
 public:
  Search(const Fitter& fitter, const std::vector<char>& mask, const SearchSettings& settings,
         SearchMemory& memory, const Progress& say)
      : fitter_(fitter), mask_(mask), settings_(settings), memory_(memory), say_(say) {}

  SearchResult run(const ModelDocument& model) {
    calibrate(model);
    takeInAccepted();
    if (settings_.all_sized && !result_.unsized.empty()) return std::move(result_);
    Round round = test(memory_.calibrated);
    result_.tests = round.tests;
    if (!significant(round).empty()) {
      cover();
      round = test(memory_.covered);
      while (result_.effects.size() < settings_.most + covered_ && addBest(round)) {
        renewLikeliest(round);
        round = test(memory_.covered);
      }
      prune(round);
      noteDetectable(test(memory_.covered));
    } else if (!result_.effects.empty()) {
      prune(round);
    }
    return std::move(result_);
  }

 private:
  FitState& state() { return result_.state; }
  const FitState& state() const { return result_.state; }

  void calibrate(const ModelDocument& model) {
    state() = fitter_.start(model, givenParameters(model, settings_.calibrate), mask_);
    settle(state());
    result_.calibrated = state();
  }

  /// What a person has accepted is there before anything is tested.
  void takeInAccepted() {
    result_.accepted = settings_.accepted;
    result_.rejected = settings_.rejected;
    for (const std::string& effect : settings_.accepted) {
      if (isOn(effectNamed(effect), state().model.vehicle.effects, state().model.measurement))
        continue;
      const std::string why = takeIn(fitter_, state(), effect, mask_);
      if (why.empty())
        result_.effects.push_back(effect);
      else
        result_.unsized[effect] = why;
    }
    result_.calibrated = state();
  }

  /// Fit and noise in turn: the noise of a worse fit is too large.
  void settle(FitState& fitted) const {
    fitter_.fitRoughly(fitted, mask_);
    fitter_.renewNoise(fitted, mask_);
    fitter_.fit(fitted, mask_);
    if (fitted.jacobian.rows() == 0) fitter_.renewJacobian(fitted);
  }

  Round test(DirectionBook& book) {
    Round round;
    round.candidates = candidatesFor(state(), book.excitation(fitter_, state()));
    leaveOut(round.candidates, settings_.rejected);
    const ScoreTest test(fitter_.rows(), state(),
                         book.directions(fitter_, state(), round.candidates), mask_);
    round.chance = test.largestByChance(settings_.draws, settings_.seed);
    for (size_t i = 0; i < round.candidates.size(); ++i) {
      round.scores.push_back(test.score(static_cast<Eigen::Index>(i)));
      round.sizes.push_back(test.size(static_cast<Eigen::Index>(i)));
    }
    round.best = bestOfEffects(round);
    round.overdispersion = test.usualOverdispersion();
    for (size_t i = 0; i < round.candidates.size(); ++i) {
      round.evidence.push_back(evidenceOf(test, static_cast<Eigen::Index>(i), round));
      round.promise.push_back(test.promise(static_cast<Eigen::Index>(i)));
    }
    const double needed = criticalScore(round.chance, settings_.alpha) + kPowerQuantile;
    for (size_t i : round.best) {
      const auto at = static_cast<Eigen::Index>(i);
      round.tests.push_back({round.candidates[i].effect, round.candidates[i].parameter,
                             round.scores[i], familyWise(round.chance, round.scores[i]),
                             test.uniqueness(at),
                             detectableSize(round.candidates, test, i, needed)});
    }
    return round;
  }

  /// Evidence for a candidate over what is needed; less than 1 if chance explains it.
  double evidenceOf(const ScoreTest& test, Eigen::Index candidate, const Round& round) const {
    // The first effect is found by blocks alone: that is what keeps false alarms rare. So is a
    // change, which finds a few blocks of chance wherever they are.
    const bool size_counts =
        isCovered() && !hasMoment(round.candidates[static_cast<size_t>(candidate)].effect);
    const Needed needed{criticalScore(round.chance, alpha()), round.overdispersion, size_counts};
    const double found = evidence(test, candidate, needed);
    return familyWise(round.chance, test.score(candidate)) <= alpha() ? std::max(1.0, found)
                                                                      : found;
  }

  /// By blocks, or by its size where that was what convinced.
  double pValueOf(const Round& round, double score, double evidence) const {
    const double by_blocks = familyWise(round.chance, score);
    return by_blocks <= alpha()
               ? by_blocks
               : std::min(by_blocks, chanceOfSize(evidence, round.candidates.size()));
  }

  bool isCovered() const { return has_cover_; }
  double alpha() const { return isCovered() ? settings_.alpha_more : settings_.alpha; }

  /// What could have been seen beside what was found: before, its size hid the rest.
  void noteDetectable(const Round& last) {
    for (CandidateTest& first : result_.tests)
      for (const CandidateTest& now : last.tests)
        if (now.effect == first.effect) first.detectable = now.detectable;
  }

  /// The likeliest candidates of the last round get directions of the model as it is now.
  void renewLikeliest(const Round& round) {
    std::vector<Candidate> likeliest;
    for (size_t i : round.best)
      if (likeliest.size() < kRenewed &&
          !isOn(effectNamed(round.candidates[i].effect), state().model.vehicle.effects,
                state().model.measurement))
        likeliest.push_back(round.candidates[i]);
    memory_.covered.renew(fitter_, state(), likeliest);
  }

  /// Of each effect beyond chance the most promising candidate; the most promising effects first.
  std::vector<size_t> significant(const Round& round) const {
    std::map<std::string, size_t> clearest;
    for (size_t i = 0; i < round.candidates.size(); ++i) {
      if (round.evidence[i] < 1.0) continue;
      const auto known = clearest.emplace(round.candidates[i].effect, i).first;
      if (round.promise[i] > round.promise[known->second]) known->second = i;
    }
    std::vector<size_t> found;
    for (const auto& [effect, index] : clearest) found.push_back(index);
    std::stable_sort(found.begin(), found.end(),
                     [&round](size_t a, size_t b) { return round.promise[a] > round.promise[b]; });
    return found;
  }

  void cover() {
    for (const std::string& path : coverPaths()) {
      const std::string effect = effectOf(path);
      // Numbers of the nominal model that are free cover the same.
      if (settings_.calibrate && effect != "ins_latency") continue;
      if (contains(settings_.rejected, effect)) continue;
      if (isOn(effectNamed(effect), state().model.vehicle.effects, state().model.measurement))
        continue;
      FreeParameter parameter = freeParameter(state().model, path);
      parameter.expected = 0.0;
      fitter_.add(state(), parameter, 0.0, mask_);
      result_.effects.push_back(effect);
      ++covered_;
    }
    settle(state());
    has_cover_ = true;
  }

  /// A candidate that was refitted, and what that brings on blocks left out.
  struct Trial {
    size_t candidate = 0;
    FitState state;
    Eigen::VectorXd loss;
    Gain gain;
    std::string refused;
  };

  Trial tryOut(const Round& round, size_t index, const Eigen::VectorXd& loss_now) const {
    Trial trial;
    trial.candidate = index;
    trial.state = state();
    addCandidate(fitter_, trial.state, round.candidates[index], round.sizes[index], mask_);
    fitter_.fitRoughly(trial.state, mask_);
    if (!round.candidates[index].moment.empty()) {
      refineMoment(fitter_, trial.state, round.candidates[index].moment, mask_);
      fitter_.fitRoughly(trial.state, mask_);
    }
    if (hasVanished(trial.state.model, round.candidates[index]))
      trial.refused = "its size vanishes in the fit";
    for (const FreeParameter& parameter : trial.state.free)
      if (effectOf(parameter.path) == round.candidates[index].effect &&
          *findParameter(trial.state.model, parameter.path) != 0.0 &&
          onBound(trial.state.model, parameter))
        trial.refused = parameter.path + " runs to the end of its plausible range";
    trial.loss = heldOutLoss(fitter_.rows(), trial.state, mask_);
    trial.gain = gainOf(loss_now, trial.loss, blocksThatCount(fitter_.rows(), mask_));
    // First order may promise more than the refit keeps.
    trial.gain.value = std::min(trial.gain.value, state().loss - trial.state.loss);
    return trial;
  }

  /// Refits the clearest effects and adds the one that helps most on blocks left out; the next ones
  /// if none of them is possible.
  bool addBest(const Round& round) {
    const std::vector<size_t> found = significant(round);
    if (found.empty()) return false;
    const Eigen::VectorXd now = heldOutLoss(fitter_.rows(), state(), mask_);
    std::vector<Trial> trials;
    const Trial* best = nullptr;
    for (size_t begin = 0; begin < found.size() && best == nullptr; begin += settings_.tried) {
      const size_t end = std::min(found.size(), begin + settings_.tried);
      for (size_t i = begin; i < end; ++i) trials.push_back(tryOut(round, found[i], now));
      for (const Trial& trial : trials)
        if (trial.refused.empty() && trial.gain.value > 0.0 &&
            (best == nullptr || trial.gain.value > best->gain.value))
          best = &trial;
    }
    noteTrials(round, trials, best);
    if (best == nullptr) return false;
    const std::string effect = round.candidates[best->candidate].effect;
    state() = best->state;
    settle(state());
    if (std::find(result_.effects.begin(), result_.effects.end(), effect) == result_.effects.end())
      result_.effects.push_back(effect);
    return true;
  }

  void noteTrials(const Round& round, const std::vector<Trial>& trials, const Trial* best) {
    LadderStep step;
    for (const Trial& trial : trials) {
      const std::string& effect = round.candidates[trial.candidate].effect;
      if (&trial == best) {
        step.effect = effect;
        step.score = round.scores[trial.candidate];
        step.p_value = pValueOf(round, step.score, round.evidence[trial.candidate]);
        step.gain = trial.gain.value;
        step.gain_error = trial.gain.error;
      } else if (!trial.refused.empty()) {
        LadderStep refused;
        refused.effect = effect;
        refused.score = round.scores[trial.candidate];
        refused.p_value = pValueOf(round, refused.score, round.evidence[trial.candidate]);
        refused.removed = true;
        refused.remark = trial.refused;
        result_.ladder.push_back(refused);
      } else if (best != nullptr) {
        const Gain behind = gainOf(trial.loss, best->loss, blocksThatCount(fitter_.rows(), mask_));
        step.runner_ups.push_back({effect, behind.value, behind.error});
      }
    }
    if (best == nullptr) return;
    result_.runner_ups[step.effect] = step.runner_ups;
    result_.p_values[step.effect] = step.p_value;
    result_.ladder.push_back(step);
    char line[160];
    std::snprintf(line, sizeof line, "  + %s: score %.1f, held-out gain %.1f +- %.1f",
                  step.effect.c_str(), step.score, step.gain, step.gain_error);
    say_(line);
  }

  void prune(const Round& last) {
    const Needed needed{criticalScore(last.chance, alpha()), last.overdispersion, true};
    pruneEffects(fitter_, mask_, needed, settings_.least_gain, result_, say_);
    const size_t before = result_.ladder.size();
    replacePairs(fitter_, mask_, result_, say_);
    if (result_.ladder.size() > before)
      pruneEffects(fitter_, mask_, needed, settings_.least_gain, result_, say_);
    for (const std::string& effect : result_.effects)
      result_.p_values[effect] = pValueOf(last, result_.scores[effect], result_.evidence[effect]);
    settle(state());
  }

  const Fitter& fitter_;
  const std::vector<char>& mask_;
  const SearchSettings& settings_;
  SearchMemory& memory_;
  const Progress& say_;
  SearchResult result_;
  size_t covered_ = 0;
  bool has_cover_ = false;
};

}  // namespace

std::vector<FreeParameter> givenParameters(const ModelDocument& model, bool calibrate) {
  std::vector<FreeParameter> free;
  if (calibrate)
    for (const char* number : {"lag", "delay", "forward_gain", "yaw_gain"})
      free.push_back(freeParameter(model, number));
  const ParameterCovariance& known = model.covariance;
  for (size_t i = 0; !calibrate && i < known.parameters.size(); ++i) {
    if (known.parameters[i].find('.') != std::string::npos) continue;
    FreeParameter number = freeParameter(model, known.parameters[i]);
    number.deviation = std::sqrt(known.matrix[i][i]);
    if (number.deviation > 0.0 && std::isfinite(number.deviation)) free.push_back(number);
  }
  for (const Effect& effect : effectCatalogue())
    for (const EffectParameter& parameter : effect.parameters) {
      const std::string path = effect.name + "." + parameter.name;
      if (parameter.role == ParameterRole::kStrength && *findParameter(model, path) != 0.0)
        free.push_back(freeParameter(model, path));
    }
  return free;
}

SearchResult search(const Fitter& fitter, const ModelDocument& model, const std::vector<char>& mask,
                    const SearchSettings& settings, SearchMemory& memory, const Progress& say) {
  return Search(fitter, mask, settings, memory, say).run(model);
}

FitState refitted(const Fitter& fitter, const SearchResult& result, const std::vector<char>& mask) {
  FitState state = result.state;
  fitter.fit(state, mask);
  return state;
}

}  // namespace tread::gap
