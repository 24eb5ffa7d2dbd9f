// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/search.hpp"

#include <algorithm>
#include <cmath>

#include "common/soundness/core/log_validation.hpp"
#include "modules/identification/core/candidates.hpp"
#include "modules/identification/core/lag_structure.hpp"
#include "modules/identification/core/moved_terms.hpp"
#include "modules/identification/core/rest.hpp"
#include "modules/identification/core/search_steps.hpp"
#include "modules/identification/core/unnamed.hpp"

namespace tread::gap {
namespace {

constexpr double kSame = 1.0;         // [nats] within which two terms are equivalent
constexpr double kEdge = 0.05;        // minimum share of a drive before and after a change
constexpr size_t kRenewed = 10;       // directions simulated again in a screening
constexpr size_t kFittedInBrief = 8;  // candidates fitted in a screening of a brief drive

bool hasVanished(const ModelDocument& model, const Candidate& candidate) {
  const double size =
      *findParameter(model, candidate.path()) - (candidate.value - candidate.change);
  return isVanishing(candidate.effect, candidate.parameter, size);
}

class EffectSelection {
 public:
  EffectSelection(const Fitter& fitter, const SearchSettings& settings, SearchMemory& memory,
                  const Progress& say)
      : fitter_(fitter), settings_(settings), memory_(memory), say_(say) {}

  FoundTerms run(const ModelDocument& model) {
    calibrate(model);
    takeInAccepted();
    if (settings_.all_sized && !result_.unsized.empty()) return std::move(result_);
    Screening screening = test(memory_.calibrated);
    result_.record.candidates = screening.tests;
    const Screening first = screening;
    if (!significant(screening).empty() && !underWay().isCutShort()) {
      freeNuisanceTerms();
      screening = test(memory_.with_nuisance);
      // Each addition frees another path: see search().
      while (mayAdd(settings_.most + nuisance_terms_) && addBest(screening)) {
        renewLikeliest(screening);
        screening = test(memory_.with_nuisance);
      }
      prune(screening);
      if (!underWay().isCutShort() && addBesideLags()) prune(screening);
      noteDetectable(test(memory_.with_nuisance));
      if (foundNothing() && !underWay().isCutShort()) searchWithoutNuisance(first);
    } else if (!result_.effects.empty()) {
      prune(screening);
    }
    return std::move(result_);
  }

 private:
  FitState& state() { return result_.state; }
  const FitState& state() const { return result_.state; }
  SearchState underWay() { return {fitter_, settings_, say_, result_}; }

  bool mayAdd(size_t most) { return result_.effects.size() < most && !underWay().isCutShort(); }

  /// No effect, no re-estimated term, and none that is negligible.
  bool foundNothing() const {
    const bool only_accepted = std::all_of(
        result_.effects.begin(), result_.effects.end(),
        [this](const std::string& effect) { return contains(settings_.accepted, effect); });
    return only_accepted && result_.record.negligible.empty() && result_.released.empty();
  }

  /// Nuisance terms together can imitate an effect and then be removed one by one as superfluous:
  /// searches again with only what the first test shows.
  void searchWithoutNuisance(Screening screening) {
    state() = result_.calibrated;
    SensitivityCache cache = memory_.calibrated;
    while (mayAdd(settings_.most) && addBest(screening)) {
      cache.renew(fitter_, state(), likeliestOf(screening));
      screening = test(cache);
    }
    if (!result_.effects.empty()) prune(screening);
  }

  void calibrate(const ModelDocument& model) {
    std::vector<FreeParameter> given = givenParameters(model, settings_.calibrate);
    const std::vector<FreeParameter> rest = restParameters(fitter_, model);
    const std::vector<FreeParameter> terms = termParameters(model, settings_.calibrate);
    given.insert(given.end(), rest.begin(), rest.end());
    given.insert(given.end(), terms.begin(), terms.end());
    state() = fitter_.start(model, given);
    settle(state());
    result_.calibrated = state();
  }

  /// Includes effects that a person has accepted, before any test.
  void takeInAccepted() {
    for (const std::string& effect : settings_.accepted) {
      if (isOn(effectNamed(effect), state().model)) continue;
      const std::string why = takeIn(fitter_, state(), effect);
      if (why.empty())
        result_.effects.push_back(effect);
      else
        result_.unsized[effect] = why;
    }
    result_.calibrated = state();
  }

  /// Fits, re-estimates the noise and fits again, because the noise of a worse fit is too large.
  void settle(FitState& fitted) const {
    fitter_.fitRoughly(fitted);
    fitter_.renewNoise(fitted);
    fitter_.fit(fitted);
    if (fitted.jacobian.rows() == 0) fitter_.renewJacobian(fitted);
  }

  Screening test(SensitivityCache& cache) const {
    Screening screening = screen(fitter_, state(), settings_, !has_nuisance_, cache);
    if (fitter_.data().isBrief()) judgeFitted(screening);
    return screening;
  }

  /// Judges the likeliest candidates by what is left once they are fitted: in a brief drive the
  /// misfit from a large effect counts as noise and hides it.
  void judgeFitted(Screening& screening) const {
    size_t fits = 0;
    for (const size_t i : screening.best) {
      const Candidate& candidate = screening.candidates[i];
      if (!candidate.change_point.empty()) continue;
      if (fits++ == kFittedInBrief) break;
      FitState with = state();
      addCandidate(fitter_, with, candidate, screening.sizes[i]);
      settle(with);
      if (hasVanished(with.model, candidate)) continue;
      FitState lacking = state();
      lacking.scales = with.scales;
      fitter_.fitRoughly(lacking);
      const Gain gain = gainOf(fitter_, heldOutLoss(fitter_, lacking), heldOutLoss(fitter_, with));
      const ScoreTest test = testOfFitted(with, candidate.path());
      screening.evidence[i] = std::max(
          screening.evidence[i], evidenceOfGain(test, 0, gain.value, neededFor(screening, i)));
    }
  }

  /// A fitted parameter's blocks, beside the others.
  ScoreTest testOfFitted(const FitState& with, const std::string& path) const {
    const auto is_it = [&path](const FreeParameter& parameter) { return parameter.path == path; };
    const auto at = std::find_if(with.free.begin(), with.free.end(), is_it) - with.free.begin();
    const Eigen::VectorXd direction = with.jacobian.col(at);
    FitState others = with;
    fitter_.release(others, static_cast<size_t>(at));
    return ScoreTest(fitter_, others, direction);
  }

  /// Smallest sizes detectable in addition to the found effects, which would otherwise hide them.
  void noteDetectable(const Screening& last) {
    for (CandidateTest& first : result_.record.candidates)
      for (const CandidateTest& now : last.tests)
        if (now.effect == first.effect) first.detectable = now.detectable;
  }

  /// The most probable candidates of the last screening get directions at the present model.
  void renewLikeliest(const Screening& screening) {
    memory_.with_nuisance.renew(fitter_, state(), likeliestOf(screening));
  }

  std::vector<Candidate> likeliestOf(const Screening& screening) const {
    std::vector<Candidate> likeliest;
    for (size_t i : screening.best)
      if (likeliest.size() < kRenewed &&
          !isOn(effectNamed(screening.candidates[i].effect), state().model))
        likeliest.push_back(screening.candidates[i]);
    return likeliest;
  }

  void freeNuisanceTerms() {
    for (const Effect* effect : nuisanceEffects()) {
      // Free numbers of the nominal model have the same influence.
      if (settings_.calibrate && !effect->search.nominal.empty()) continue;
      if (!effect->isOf(state().model.vehicle.layout())) continue;
      if (contains(settings_.rejected, effect->name)) continue;
      if (isOn(*effect, state().model)) continue;
      FreeParameter parameter =
          freeParameter(state().model, effect->name + "." + effect->parameters.front().name);
      parameter.expected = 0.0;
      fitter_.add(state(), parameter, 0.0);
      result_.effects.push_back(effect->name);
      ++nuisance_terms_;
    }
    settle(state());
    has_nuisance_ = true;
  }

  /// A refitted candidate, and its gain on held-out blocks.
  struct Trial {
    size_t candidate = 0;
    FitState state;
    Eigen::VectorXd loss;
    Gain gain;
    std::string refused;
  };

  /// Whether hardly any driving is before a time, or after it.
  bool isAtEdge(double time) const {
    double before = 0.0;
    double all = 0.0;
    for (const Drive& drive : fitter_.data().drives())
      for (const Segment& segment : drive.segments) {
        before += std::clamp(time - segment.begin(), 0.0, segment.end - segment.begin());
        all += segment.end - segment.begin();
      }
    return std::min(before, all - before) < kEdge * all;
  }

  Trial tryOut(const Screening& screening, size_t index, const Eigen::VectorXd& loss_now) const {
    Trial trial;
    trial.candidate = index;
    trial.state = state();
    addCandidate(fitter_, trial.state, screening.candidates[index], screening.sizes[index]);
    fitter_.fitRoughly(trial.state);
    const std::string& change = screening.candidates[index].change_point;
    if (!change.empty()) {
      refineChangePoint(fitter_, trial.state, change);
      fitter_.fitRoughly(trial.state);
      if (isAtEdge(*findParameter(trial.state.model, change)))
        trial.refused = "its influence is nearly constant";
    }
    if (hasVanished(trial.state.model, screening.candidates[index]))
      trial.refused = "its size vanishes in the fit";
    for (const FreeParameter& parameter : trial.state.free)
      if (effectOf(parameter.path) == screening.candidates[index].effect &&
          *findParameter(trial.state.model, parameter.path) != 0.0 &&
          onBound(trial.state.model, parameter))
        trial.refused = parameter.path + " runs to the end of its plausible range";
    trial.loss = heldOutLoss(fitter_, trial.state);
    trial.gain = gainOf(fitter_, loss_now, trial.loss);
    // The refit may keep less than first order promises.
    trial.gain.value = std::min(trial.gain.value, state().loss - trial.state.loss);
    return trial;
  }

  /// Replaces an effect that begins at some time by one that always acts, if that is as good.
  /** A searched time is one more parameter, and any slow change resembles a step. */
  const Trial* plainerThan(const Trial* best, const std::vector<Trial>& trials,
                           const Screening& screening) const {
    const auto isStep = [&screening](const Trial& trial) {
      return !screening.candidates[trial.candidate].change_point.empty();
    };
    if (best == nullptr || !isStep(*best)) return best;
    const Trial* plain = nullptr;
    for (const Trial& trial : trials)
      if (trial.refused.empty() && trial.gain.value > 0.0 && !isStep(trial) &&
          (plain == nullptr || trial.gain.value > plain->gain.value))
        plain = &trial;
    if (plain == nullptr) return best;
    const Gain behind = gainOf(fitter_, plain->loss, best->loss);
    return behind.value < behind.error ? plain : best;
  }

  /// A given term that replaces a new one with the same influence.
  const Trial* givenInstead(const Trial* best, const std::vector<Trial>& trials,
                            const Screening& screening) const {
    if (best == nullptr || screening.candidates[best->candidate].release) return best;
    const Trial* given = nullptr;
    for (const Trial& trial : trials)
      if (trial.refused.empty() && trial.gain.value > 0.0 &&
          screening.candidates[trial.candidate].release &&
          gainOf(fitter_, trial.loss, best->loss).value < kSame &&
          (given == nullptr || trial.gain.value > given->gain.value))
        given = &trial;
    return given == nullptr ? best : given;
  }

  /// Refits the most promising effects and adds the one with the largest gain on held-out blocks;
  /// if none is admissible, tries the next ones.
  bool addBest(const Screening& screening) {
    const std::vector<size_t> found = significant(screening);
    if (found.empty()) return false;
    const Eigen::VectorXd now = heldOutLoss(fitter_, state());
    std::vector<Trial> trials;
    const Trial* best = nullptr;
    for (size_t begin = 0; begin < found.size() && best == nullptr; begin += settings_.tried) {
      const size_t end = std::min(found.size(), begin + settings_.tried);
      for (size_t i = begin; i < end && !underWay().isCutShort(); ++i)
        trials.push_back(tryOut(screening, found[i], now));
      for (const Trial& trial : trials)
        if (trial.refused.empty() && trial.gain.value > 0.0 &&
            (best == nullptr || trial.gain.value > best->gain.value))
          best = &trial;
    }
    best = plainerThan(givenInstead(best, trials, screening), trials, screening);
    noteTrials(screening, trials, best);
    if (best == nullptr) return false;
    const Candidate& added = screening.candidates[best->candidate];
    state() = best->state;
    settle(state());
    // Effects that were removed earlier, with other terms present, are included again.
    for (std::vector<std::string>* told : {&result_.record.negligible, &result_.record.at_bound})
      told->erase(std::remove(told->begin(), told->end(), added.effect), told->end());
    if (added.release && !contains(result_.released, added.effect))
      result_.released.push_back(added.effect);
    if (!added.release && !contains(result_.effects, added.effect))
      result_.effects.push_back(added.effect);
    return true;
  }

  /// A delay that was superfluous with the first lags may not be with the final ones.
  bool addBesideLags() {
    if (std::none_of(result_.effects.begin(), result_.effects.end(),
                     [](const std::string& effect) { return isLag(effectNamed(effect)); }))
      return false;
    const auto isDelay = [](const Effect& effect) {
      return effect.search.late_by == LateBy::kCommand || effect.search.late_by == LateBy::kPoses;
    };
    const std::deque<Effect>& all = effectCatalogue();
    if (std::all_of(all.begin(), all.end(), [&](const Effect& effect) {
          return !isDelay(effect) || isOn(effect, state().model);
        }))
      return false;
    SensitivityCache cache = memory_.with_nuisance;
    Screening screening = test(cache);
    for (size_t i = 0; i < screening.candidates.size(); ++i) {
      const Candidate& candidate = screening.candidates[i];
      // Searches for nothing else: other candidates were tested before.
      if (candidate.release || !isDelay(effectNamed(candidate.effect))) screening.evidence[i] = 0.0;
    }
    return addBest(screening);
  }

  void noteTrials(const Screening& screening, const std::vector<Trial>& trials, const Trial* best) {
    SearchStep step;
    for (const Trial& trial : trials) {
      const Candidate& candidate = screening.candidates[trial.candidate];
      const std::string& effect = candidate.effect;
      const double score = screening.scores[trial.candidate];
      const double p_value = pValueOf(screening, score, screening.evidence[trial.candidate]);
      if (&trial == best) {
        step = {effect,
                false,
                score,
                p_value,
                trial.gain.value,
                trial.gain.error,
                std::move(step.runner_ups),
                candidate.release ? "is not what the model says" : ""};
      } else if (!trial.refused.empty() && candidate.release) {
        continue;  // the term keeps the model's value
      } else if (!trial.refused.empty()) {
        result_.record.steps.push_back({effect, true, score, p_value, 0.0, 0.0, {}, trial.refused});
      } else if (best != nullptr) {
        const Gain behind = gainOf(fitter_, trial.loss, best->loss);
        step.runner_ups.push_back({effect, behind.value, behind.error});
      }
    }
    if (best == nullptr) return;
    result_.evidence[step.effect].runner_ups = step.runner_ups;
    result_.evidence[step.effect].p_value = step.p_value;
    result_.record.steps.push_back(step);
    say_("  + " + step.effect + ": score " + fixed(step.score, 1) + ", held-out gain " +
         fixed(step.gain, 1) + " +- " + fixed(step.gain_error, 1));
  }

  void prune(const Screening& last) {
    const SearchState search = underWay();
    const Needed needed{criticalScore(last.chance, settings_.alpha_more), last.overdispersion,
                        false, true};
    pruneEffects(search, needed);
    if (chooseLags(search)) pruneEffects(search, needed);
    const size_t before = result_.record.steps.size();
    replacePairs(search);
    if (putVehicleFirst(search) || result_.record.steps.size() > before)
      pruneEffects(search, needed);
    for (const std::string& effect : result_.effects) {
      EffectEvidence& of = result_.evidence[effect];
      const double known = of.p_value.value_or(1.0);
      const double last_p = pValueOf(last, of.score, of.evidence);
      // An effect kept for its gain, not for its score, keeps the p-value of its acceptance.
      of.p_value = of.evidence >= 1.0 || last_p < known ? last_p : known;
    }
    settle(state());
    // The last fit may set a lag to zero.
    for (size_t i = result_.effects.size(); i-- > 0;) {
      const std::string effect = result_.effects[i];
      if (search.isAccepted(effect) || isOn(effectNamed(effect), state().model)) continue;
      state() = switchedOff(fitter_, state(), {effect});
      result_.effects.erase(result_.effects.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }

  const Fitter& fitter_;
  const SearchSettings& settings_;
  SearchMemory& memory_;
  const Progress& say_;
  FoundTerms result_;
  size_t nuisance_terms_ = 0;
  bool has_nuisance_ = false;
};

/// A parameter with the prior from the model's covariance, if it has one.
FreeParameter heldParameter(const ModelDocument& model, const std::string& path) {
  FreeParameter parameter = freeParameter(model, path);
  parameter.deviation = knownDeviation(model, path);
  return parameter;
}

}  // namespace

std::vector<FreeParameter> givenParameters(const ModelDocument& model, bool calibrate) {
  std::vector<FreeParameter> free;
  if (calibrate)
    for (const std::string& number : calibratedNumbers(model.vehicle.layout()))
      free.push_back(freeParameter(model, number));
  const ParameterCovariance& known = model.covariance;
  for (const std::string& path : known.parameters) {
    if (calibrate || path.find('.') != std::string::npos) continue;
    const FreeParameter number = heldParameter(model, path);
    if (std::isfinite(number.deviation)) free.push_back(number);
  }
  for (const Effect& effect : effectCatalogue())
    for (const EffectParameter& parameter : effect.parameters) {
      const std::string path = effect.name + "." + parameter.name;
      if (parameter.role == ParameterRole::kStrength && *findParameter(model, path) != 0.0)
        free.push_back(calibrate ? freeParameter(model, path) : heldParameter(model, path));
    }
  return free;
}

namespace {

FoundTerms searchTwice(const Fitter& fitter, const ModelDocument& model,
                       const SearchSettings& settings, SearchMemory& memory, const Progress& say) {
  FoundTerms found = EffectSelection(fitter, settings, memory, say).run(model);
  if (found.released.empty() || found.record.cut_short) return found;
  // Releasing a given term makes it flexible, which favours it. Fewer effects may suffice with all
  // of the model's priors.
  say("  once more, with all of the model's priors:");
  SearchSettings trusting = settings;
  trusting.release = false;
  SearchMemory again;
  again.calibrated = memory.calibrated;
  const FoundTerms other = EffectSelection(fitter, trusting, again, say).run(model);
  const bool has_new =
      std::any_of(other.effects.begin(), other.effects.end(),
                  [&](const std::string& effect) { return !contains(settings.accepted, effect); });
  if (!has_new || other.record.cut_short ||
      other.effects.size() >= found.effects.size() + found.released.size())
    return found;
  // Each has its own noise: losses are compared with a common one.
  FitState judged = other.state;
  judged.scales = found.state.scales;
  const Gain behind = gainOf(fitter, heldOutLoss(fitter, judged), heldOutLoss(fitter, found.state));
  return behind.value < behind.error ? other : found;
}

}  // namespace

FoundTerms search(const Fitter& fitter, const ModelDocument& model, const SearchSettings& settings,
                  SearchMemory& memory, const Progress& say) {
  FoundTerms found = searchTwice(fitter, model, settings, memory, say);
  reestimateMoved({fitter, settings, say, found}, model);
  if (fitter.data().isBrief()) weighOthers({fitter, settings, say, found});
  noteToldFrom({fitter, settings, say, found});
  return found;
}

FitState refitted(const Fitter& fitter, const FoundTerms& result) {
  FitState state = result.state;
  fitter.fit(state);
  return state;
}

}  // namespace tread::gap
