// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Steps of a search beside adding and removing: taking in what a person has accepted, one effect in
// the place of two, and the proof on driving that sizes were not fitted to.
#include "modules/identification/core/search_steps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "modules/identification/core/candidates.hpp"
#include "modules/identification/core/end_errors.hpp"
#include "modules/identification/core/evidence.hpp"
#include "modules/identification/core/moved_terms.hpp"
#include "modules/identification/core/pruning.hpp"

namespace tread::gap {
namespace {

constexpr double kUnsized = 2.0;    // times its typical size: limit of the 95 % interval
constexpr double kConfirmed = 2.5;  // standard errors, on rows that were not used for the sizes

/// The most promising candidate; `candidates` if none would change anything.
size_t mostPromising(const ScoreTest& test) {
  const auto count = static_cast<size_t>(test.candidates());
  size_t best = count;
  double promise = 0.0;
  for (size_t i = 0; i < count; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    if (test.uniqueness(at) <= 0.0 || (best < count && test.promise(at) <= promise)) continue;
    best = i;
    promise = test.promise(at);
  }
  return best;
}

std::string reasonNotSized(const Fitter& fitter, const FitState& state,
                           const Candidate& candidate) {
  const std::string strength = candidate.path();
  const Eigen::MatrixXd covariance = parameterCovariance(fitter, state);
  const double typical = parameterNamed(effectNamed(candidate.effect), candidate.parameter).typical;
  for (size_t i = 0; i < state.free.size(); ++i) {
    if (state.free[i].path != strength) continue;
    const auto at = static_cast<Eigen::Index>(i);
    if (isVanishing(candidate.effect, candidate.parameter, *findParameter(state.model, strength)))
      return "its size vanishes in the fit";
    if (onBound(state.model, state.free[i]))
      return "its size runs to the end of its plausible range";
    if (!(1.96 * std::sqrt(covariance(at, at)) < kUnsized * std::abs(typical)))
      return "nothing in this drive makes it visible";
  }
  return "";
}

constexpr double kHopeless = 2.5;       // standard errors by which a pair is better in first order
constexpr double kHopelessNats = 20.0;  // and the rounding error of that order
constexpr double kBearableNats = 10.0;  // that simplicity may cost
constexpr double kInWheels = 0.7;       // of an effect: counts as shown by the wheels
constexpr double kImitated =
    0.35;  // uniqueness below which the found effects can imitate another one

/// An effect that the found ones can imitate, and its direction.
struct Single {
  Candidate candidate;
  Eigen::VectorXd direction;
};

/// The candidates for a state, including effects that only replace others.
std::vector<Candidate> allCandidates(const SearchState& search, const FitState& state) {
  const Excitation most = excitationOf(search.data(), state.model);
  auto candidates = candidatesFor(state, most);
  for (const Effect& effect : effectCatalogue())
    if (effect.search.in_place)
      for (Candidate& candidate : candidatesOf(effect.name, state, most))
        candidates.push_back(std::move(candidate));
  leaveOut(candidates, search.settings.rejected);
  return candidates;
}

/// One candidate of each such effect.
std::vector<Single> imitated(const SearchState& search) {
  const Fitter& fitter = search.fitter;
  const FitState& state = search.result.state;
  const auto candidates = allCandidates(search, state);
  const Eigen::MatrixXd directions = directionsOf(fitter, state, candidates);
  const ScoreTest test(fitter, state, directions);
  std::vector<Single> chosen;
  std::set<std::string> names;
  for (size_t i = 0; i < candidates.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const Effect& effect = effectNamed(candidates[i].effect);
    // A change early in the drive has more parameters than the two, and is not simpler.
    if (!candidates[i].change_point.empty()) continue;
    if (isOn(effect, state.model)) continue;
    if (test.uniqueness(at) < kImitated && names.insert(effect.name).second)
      chosen.push_back({candidates[i], directions.col(at)});
  }
  return chosen;
}

/// The state with one effect replacing two, in first order and without a simulation.
FitState linearlyReplaced(const Fitter& fitter, const FitState& state, const Single& single,
                          const std::string& a, const std::string& b) {
  FitState reduced = withoutLinearly(fitter, withoutLinearly(fitter, state, a), b);
  reduced.free.push_back(freeParameter(reduced.model, single.candidate.path()));
  reduced.jacobian.conservativeResize(reduced.predicted.size(), reduced.jacobian.cols() + 1);
  reduced.jacobian.rightCols(1) = single.direction;
  followLinearly(fitter, reduced);
  return reduced;
}

/// Losses of a state on every block, with its own parameters and with those from other blocks.
struct BlockLosses {
  Eigen::VectorXd fitted;
  Eigen::VectorXd held_out;
};

/// Loss of every block with the state's own parameters (blocks x 1) [nats].
Eigen::VectorXd fittedLoss(const Fitter& fitter, const FitState& state) {
  const Observations& data = fitter.data();
  const Eigen::VectorXd residuals = data.residuals(state.predicted);
  Eigen::VectorXd loss = Eigen::VectorXd::Zero(data.blocks());
  for (size_t i = 0; i < data.all().size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    if (fitter.mask()[i]) loss[data.all()[i].block] += lossOf(residuals[at], state.scales[at]);
  }
  return loss;
}

/// Whether a pair is so much better than its replacement that the error of first order does not
/// matter.
bool isHopeless(const Gain& gain, double rounding) {
  return gain.value > kHopeless * gain.error + rounding;
}

/// One effect that replaces two.
struct Exchange {
  std::string single;
  std::string a;
  std::string b;
  FitState state;
  Gain pair_gain;
  bool by_wheels = false;
};

/// Keeps the exchange of two effects for one if it is acceptable and the best so far.
void tryExchange(const SearchState& search, const Single& imitated_one, const std::string& a,
                 const std::string& b, const BlockLosses& loss, std::optional<Exchange>& best) {
  if (search.isAccepted(a) || search.isAccepted(b)) return;
  const Fitter& fitter = search.fitter;
  const FitState& state = search.result.state;
  const FitState nearly = linearlyReplaced(fitter, state, imitated_one, a, b);
  // An effect that is far worse on the rows it was fitted to needs no validation.
  const Gain fitted = gainOf(fitter, fittedLoss(fitter, nearly), loss.fitted);
  if (isHopeless(fitted, 2.0 * kHopelessNats)) return;
  const Gain first_order = gainOf(fitter, heldOutLoss(fitter, nearly), loss.held_out);
  if (isHopeless(first_order, kHopelessNats)) return;
  const Candidate& single = imitated_one.candidate;
  FitState tried = switchedOff(fitter, state, {a, b});
  const ScoreTest test(fitter, tried, directionsOf(fitter, tried, {single}));
  addCandidate(fitter, tried, single, test.size(0));
  fitter.fitRoughly(tried);
  for (const FreeParameter& parameter : tried.free)
    if (effectOf(parameter.path) == single.effect && onBound(tried.model, parameter)) return;
  // A worse fit needs no validation; that comparison is in first order and may be wrong.
  if (tried.loss - state.loss > 2.0 * kBearableNats) return;
  if (best && tried.loss >= best->state.loss) return;
  const Gain pair_gain = gainOf(fitter, heldOutLoss(fitter, tried), loss.held_out);
  if (pair_gain.value > std::min(pair_gain.error, kBearableNats)) return;
  best = Exchange{single.effect, a, b, std::move(tried), pair_gain};
}

/// Whether a fit took one of these effects to the end of its plausible range.
bool anyOnBound(const FitState& state, const std::vector<std::string>& effects) {
  return std::any_of(state.free.begin(), state.free.end(), [&](const FreeParameter& parameter) {
    return contains(effects, effectOf(parameter.path)) && onBound(state.model, parameter);
  });
}

/// Switches a candidate's effect on, at its first-order size, and fits.
void takeCandidate(const Fitter& fitter, FitState& state, const Candidate& candidate) {
  const ScoreTest test(fitter, state, directionsOf(fitter, state, {candidate}));
  addCandidate(fitter, state, candidate, test.size(0));
  fitter.fitRoughly(state);
}

/// Whether a state explains as much as that of a result: by its fit, and on held-out blocks.
bool isLevel(const Fitter& fitter, const FitState& tried, const FitState& now) {
  if (tried.loss - now.loss > 2.0 * kBearableNats) return false;
  const Gain behind = gainOf(fitter, heldOutLoss(fitter, tried), heldOutLoss(fitter, now));
  return behind.value <= std::min(behind.error, kBearableNats);
}

/// Members of a group of one kind.
std::vector<std::string> membersOf(const ConfoundedGroup& group, EffectKind kind) {
  std::vector<std::string> members;
  for (const std::string& member : group.members)
    if (const Effect* effect = findEffect(member); effect != nullptr && effect->kind() == kind)
      members.push_back(member);
  return members;
}

/// Whether all of these effects were chosen by the search itself.
bool isAllFound(const SearchState& search, const std::vector<std::string>& effects) {
  return std::all_of(effects.begin(), effects.end(), [&search](const std::string& effect) {
    return contains(search.result.effects, effect) && !search.isAccepted(effect);
  });
}

/// The state with the vehicle's members of a group replacing the INS's; nullopt if a person has
/// rejected one, or its size is implausible.
std::optional<FitState> withVehicleInstead(const SearchState& search,
                                           const std::vector<std::string>& instrument,
                                           const std::vector<std::string>& vehicle) {
  const Fitter& fitter = search.fitter;
  FitState tried = switchedOff(fitter, search.result.state, instrument);
  for (const std::string& effect : vehicle) {
    if (isOn(effectNamed(effect), tried.model)) continue;
    if (contains(search.settings.rejected, effect)) return std::nullopt;
    const auto candidates = candidatesOf(effect, tried, excitationOf(fitter.data(), tried.model));
    if (candidates.empty()) return std::nullopt;
    takeCandidate(fitter, tried, candidates.front());
  }
  fitter.fit(tried);
  if (anyOnBound(tried, vehicle)) return std::nullopt;
  return tried;
}

/// Whether the wheels show most of an effect that should not be visible in them.
bool isInWheels(const SearchState& search, const std::string& effect) {
  if (effectNamed(effect).search.in_wheels.empty()) return false;
  const auto shown = evidenceBy(EvidenceSource::kWheels, search.fitter, search.result.state,
                                search.result.effects);
  const auto found = shown.find(effect);
  return found != shown.end() && found->second.value > kInWheels && found->second.low > 0.0;
}

/// An effect that may replace another one.
struct Substitute {
  Candidate candidate;
  std::string other;
  bool shown_by_wheels = false;  ///< it need not be better
};

/// Adds, as candidates, the effects that explain an effect below the wheels if the wheels show it.
void addShownByWheels(const SearchState& search, const std::string& other,
                      std::vector<Substitute>& all) {
  const FitState& state = search.result.state;
  if (!isInWheels(search, other)) return;
  for (const std::string& name : effectNamed(other).search.in_wheels) {
    if (contains(search.settings.rejected, name) || isOn(effectNamed(name), state.model)) continue;
    for (Candidate& candidate : candidatesOf(name, state, excitationOf(search.data(), state.model)))
      all.push_back({std::move(candidate), other, true});
  }
}

std::vector<Substitute> substitutes(const SearchState& search) {
  std::vector<Substitute> all;
  const std::vector<Single> singles = imitated(search);
  for (const std::string& other : search.result.effects) {
    if (search.isAccepted(other)) continue;
    addShownByWheels(search, other, all);
    for (const Single& single : singles)
      if (effectNamed(single.candidate.effect).search.in_place)
        all.push_back({single.candidate, other});
  }
  return all;
}

/// Whether a substitute explains more, by its fit without a loss on held-out blocks; or as much, if
/// the wheels support it.
bool isBetter(const SearchState& search, const FitState& tried, const BlockLosses& loss,
              bool shown_by_wheels) {
  const double least = shown_by_wheels ? -2.0 * kBearableNats : 2.0 * kBearableNats;
  if (!(search.result.state.loss - tried.loss > least)) return false;
  const Gain gain = gainOf(search.fitter, loss.held_out, heldOutLoss(search.fitter, tried));
  return gain.value > -gain.error;
}

/// One effect that replaces a worse one with the same influence; the best of them.
std::optional<Exchange> betterOne(const SearchState& search) {
  const Fitter& fitter = search.fitter;
  const FitState& state = search.result.state;
  if (search.result.effects.empty() || search.isCutShort()) return std::nullopt;
  const BlockLosses loss{{}, heldOutLoss(fitter, state)};
  std::optional<Exchange> best;
  for (const Substitute& one : substitutes(search)) {
    if (search.isCutShort()) break;
    FitState tried = switchedOff(fitter, state, {one.other});
    const ScoreTest test(fitter, tried, directionsOf(fitter, tried, {one.candidate}));
    addCandidate(fitter, tried, one.candidate, test.size(0));
    fitter.fitRoughly(tried);
    if (best && tried.loss >= best->state.loss) continue;
    if (isBetter(search, tried, loss, one.shown_by_wheels))
      best =
          Exchange{one.candidate.effect, one.other, "", std::move(tried), {}, one.shown_by_wheels};
  }
  return best;
}

/// The exchange whose single effect fits best, if any is acceptable.
std::optional<Exchange> bestExchange(const SearchState& search) {
  const std::vector<std::string>& effects = search.result.effects;
  if (effects.size() < 2 || search.isCutShort()) return std::nullopt;
  const std::vector<Single> singles = imitated(search);
  if (singles.empty()) return std::nullopt;
  const FitState& state = search.result.state;
  const BlockLosses loss{fittedLoss(search.fitter, state), heldOutLoss(search.fitter, state)};
  std::optional<Exchange> best;
  for (const Single& single : singles)
    for (size_t a = 0; a < effects.size(); ++a)
      for (size_t b = a + 1; b < effects.size() && !search.isCutShort(); ++b)
        tryExchange(search, single, effects[a], effects[b], loss, best);
  return best;
}

/// Adds a state's errors on alternate blocks: position, yaw, yaw rate and nats (blocks x 4).
void addMissed(const Fitter& fitter, const FitState& state, const Eigen::VectorXd& scales, int half,
               Eigen::MatrixXd& sums) {
  const Observations& data = fitter.data();
  for (const ExecutionError& error : endErrors(data, state.model))
    if (error.block % 2 == half)
      sums.row(error.block).head(2) += Eigen::RowVector2d(error.position, error.yaw);
  const Eigen::VectorXd residuals = data.residuals(fitter.predict(state.model));
  for (size_t i = 0; i < data.all().size(); ++i) {
    const Observation& row = data.all()[i];
    const auto at = static_cast<Eigen::Index>(i);
    if (row.block % 2 != half) continue;
    if (row.channel == ObservedRate::kYawRate) sums(row.block, 2) += std::abs(residuals[at]);
    sums(row.block, 3) += lossOf(residuals[at], scales[at]);
  }
}

/// The result with only its given, released and accepted terms.
FitState withoutFound(const SearchState& search) {
  const FoundTerms& result = search.result;
  if (result.released.empty()) return result.calibrated;
  std::vector<std::string> found;
  for (const std::string& effect : result.effects)
    if (!search.isAccepted(effect)) found.push_back(effect);
  FitState state = switchedOff(search.fitter, result.state, found);
  search.fitter.fit(state);
  return state;
}

bool isConfirmed(const SearchState& search, const FitState& lacking) {
  const Observations& data = search.data();
  const FoundTerms& result = search.result;
  const Eigen::MatrixXd with =
      missedOnOtherHalves(search.fitter, result.state, result.state.scales);
  const Eigen::MatrixXd without = missedOnOtherHalves(search.fitter, lacking, result.state.scales);
  const bool measurement =
      std::all_of(result.effects.begin(), result.effects.end(), [](const std::string& effect) {
        return effectNamed(effect).kind() == EffectKind::kMeasurement;
      });
  const std::vector<char> every(static_cast<size_t>(data.blocks()), 1);
  for (Eigen::Index i = 0; i < (measurement ? 3 : 2); ++i) {
    const Gain gain = gainOf(without.col(i), with.col(i), every);
    if (gain.value > data.dependence() * gain.error) return true;
  }
  // The ends of executions scatter more than rows do: an effect that is highly significant in the
  // rows is real.
  const Gain nats = gainOf(without.col(3), with.col(3), every);
  return nats.value > kConfirmed * data.dependence() * nats.error;
}

}  // namespace

std::string takeIn(const Fitter& fitter, FitState& state, const std::string& effect) {
  const auto candidates = candidatesOf(effect, state, excitationOf(fitter.data(), state.model));
  if (candidates.empty()) return "it is a number of the nominal model, which is free";
  const ScoreTest test(fitter, state, directionsOf(fitter, state, candidates));
  const size_t best = mostPromising(test);
  if (best == candidates.size())
    return "it changes nothing that this drive shows, or nothing that the model's other free "
           "terms do not";
  FitState tried = state;
  addCandidate(fitter, tried, candidates[best], test.size(static_cast<Eigen::Index>(best)));
  fitter.fitRoughly(tried);
  if (!candidates[best].change_point.empty())
    refineChangePoint(fitter, tried, candidates[best].change_point);
  fitter.renewNoise(tried);
  fitter.fit(tried);
  const std::string why = reasonNotSized(fitter, tried, candidates[best]);
  if (why.empty()) state = std::move(tried);
  return why;
}

void replacePairs(const SearchState& search) {
  const auto exchangeFor = [&search](const Exchange& exchange) {
    std::vector<std::string> replaced{exchange.a};
    if (!exchange.b.empty()) replaced.push_back(exchange.b);
    const std::string remark =
        "in the place of " + exchange.a + (exchange.b.empty() ? "" : " and " + exchange.b);
    search.result.record.steps.push_back({exchange.single,
                                          false,
                                          0.0,
                                          1.0,
                                          -exchange.pair_gain.value,
                                          exchange.pair_gain.error,
                                          {},
                                          remark});
    search.say("  = " + exchange.single + " " + remark);
    auto& effects = search.result.effects;
    for (const std::string& gone : replaced)
      effects.erase(std::remove(effects.begin(), effects.end(), gone), effects.end());
    effects.push_back(exchange.single);
    EffectEvidence& evidence = search.result.evidence[exchange.single];
    if (replaced.size() > 1)
      evidence.replaced = replaced;
    else
      evidence.p_value = search.result.evidence[exchange.a].p_value;
    evidence.by_wheels = exchange.by_wheels;
    search.result.state = exchange.state;
  };
  // Each exchange removes an effect, or adds one that nothing else replaces.
  while (const auto exchange = bestExchange(search)) exchangeFor(*exchange);
  while (const auto exchange = betterOne(search)) exchangeFor(*exchange);
}

bool putVehicleFirst(const SearchState& search) {
  bool any = false;
  for (const ConfoundedGroup& group : confoundedGroups()) {
    const std::vector<std::string> instrument = membersOf(group, EffectKind::kMeasurement);
    if (!group.together || !isAllFound(search, instrument) || search.isCutShort()) continue;
    const std::vector<std::string> vehicle = membersOf(group, EffectKind::kVehicle);
    std::optional<FitState> tried = withVehicleInstead(search, instrument, vehicle);
    if (!tried || !isLevel(search.fitter, *tried, search.result.state)) continue;
    FoundTerms& result = search.result;
    for (size_t i = 0; i < vehicle.size(); ++i) {
      if (isOn(effectNamed(vehicle[i]), result.state.model)) continue;
      result.effects.push_back(vehicle[i]);
      result.evidence[vehicle[i]].p_value = 1.0;  // chosen, not tested yet: pruning tests it
      result.evidence[vehicle[i]].replaced = {instrument[std::min(i, instrument.size() - 1)]};
      const std::string remark = "the vehicle before the INS: in the place of " +
                                 result.evidence[vehicle[i]].replaced.front();
      result.record.steps.push_back({vehicle[i], false, 0.0, 1.0, 0.0, 0.0, {}, remark});
      search.say("  = " + vehicle[i] + ": " + remark);
    }
    for (const std::string& gone : instrument)
      result.effects.erase(std::find(result.effects.begin(), result.effects.end(), gone));
    result.state = std::move(*tried);
    any = true;
  }
  return any;
}

namespace {

/// Restores the prior of a term that moved.
void holdAgain(FitState& state, const MovedTerm& term) {
  for (FreeParameter& parameter : state.free)
    if (parameter.path == term.path) {
      parameter.deviation = term.deviation;
      *findParameter(state.model, term.path) = parameter.expected;
    }
}

/// Two changes that one effect may explain: a term that moved, and another one or a found effect.
struct TwoChanges {
  size_t moved = 0;
  std::optional<size_t> also_moved{};
  std::string effect{};
};

std::vector<TwoChanges> pairsOfChanges(const SearchState& search,
                                       const std::vector<MovedTerm>& moved) {
  std::vector<TwoChanges> pairs;
  for (size_t i = 0; i < moved.size(); ++i) {
    for (size_t k = i + 1; k < moved.size(); ++k) pairs.push_back({i, k});
    for (const std::string& effect : search.result.effects)
      if (!search.isAccepted(effect)) pairs.push_back({i, std::nullopt, effect});
  }
  return pairs;
}

/// The state with one effect replacing two changes.
FitState inPlaceOf(const SearchState& search, const TwoChanges& pair,
                   const std::vector<MovedTerm>& moved, const Candidate& candidate) {
  const Fitter& fitter = search.fitter;
  FitState tried = search.result.state;
  holdAgain(tried, moved[pair.moved]);
  if (pair.also_moved) holdAgain(tried, moved[*pair.also_moved]);
  tried = pair.effect.empty() ? tried : switchedOff(fitter, tried, {pair.effect});
  tried.predicted = fitter.predict(tried.model);
  takeCandidate(fitter, tried, candidate);
  return tried;
}

}  // namespace

bool replaceMoved(const SearchState& search, std::vector<MovedTerm>& moved) {
  FoundTerms& result = search.result;
  std::optional<FitState> best;
  std::string single;
  TwoChanges gone;
  const std::vector<TwoChanges> pairs = pairsOfChanges(search, moved);
  if (pairs.empty()) return false;
  const std::vector<Single> singles = imitated(search);
  for (const TwoChanges& pair : pairs)
    for (const Single& one : singles) {
      if (search.isCutShort()) break;
      FitState tried = inPlaceOf(search, pair, moved, one.candidate);
      if (anyOnBound(tried, {one.candidate.effect}) || (best && tried.loss >= best->loss) ||
          !isLevel(search.fitter, tried, result.state))
        continue;
      best = std::move(tried);
      single = one.candidate.effect;
      gone = pair;
    }
  if (!best) return false;
  const std::string other = gone.also_moved ? moved[*gone.also_moved].path : gone.effect;
  const std::string remark =
      "in the place of " + other + " and a change of " + moved[gone.moved].path;
  result.record.steps.push_back({single, false, 0.0, 1.0, 0.0, 0.0, {}, remark});
  search.say("  = " + single + " " + remark);
  auto& effects = result.effects;
  effects.erase(std::remove(effects.begin(), effects.end(), gone.effect), effects.end());
  effects.push_back(single);
  EffectEvidence& evidence = result.evidence[single];
  evidence.p_value = gone.effect.empty() ? 0.0 : result.evidence[gone.effect].p_value;
  search.fitter.fit(*best);
  result.state = std::move(*best);
  if (gone.also_moved) moved.erase(moved.begin() + static_cast<std::ptrdiff_t>(*gone.also_moved));
  moved.erase(moved.begin() + static_cast<std::ptrdiff_t>(gone.moved));
  return true;
}

namespace {

/// Whether a term that the model has would explain as much as a found effect.
bool mayStandFor(const SearchState& search, const std::string& given, const std::string& found) {
  FitState tried = switchedOff(search.fitter, search.result.state, {found});
  for (FreeParameter& parameter : tried.free)
    if (effectOf(parameter.path) == given)
      parameter.deviation = std::numeric_limits<double>::infinity();
  search.fitter.fit(tried);
  return !anyOnBound(tried, {given}) && isLevel(search.fitter, tried, search.result.state);
}

}  // namespace

void noteToldFrom(const SearchState& search) {
  FoundTerms& result = search.result;
  for (const std::string& found : result.effects) {
    if (search.isAccepted(found)) continue;
    for (const std::string& other : confoundedEffects(found, result.state.model.measurement))
      if (!contains(result.effects, other) && isOn(effectNamed(other), result.state.model) &&
          !search.isCutShort() && !mayStandFor(search, other, found))
        result.evidence[found].told_from.push_back(other);
  }
}

namespace {

constexpr double kHalfAsGood = 0.5;  // share of the largest promise from which an effect is fitted
constexpr double kBriefLevel = 2.0;  // standard errors

/// The most promising candidate of each effect that promises at least half of the largest gain in a
/// state; effects that begin at any time are not simpler.
std::vector<Candidate> promisingIn(const SearchState& search, const FitState& state) {
  const auto candidates = allCandidates(search, state);
  const ScoreTest test(search.fitter, state, directionsOf(search.fitter, state, candidates));
  std::map<std::string, size_t> best;
  double most = 0.0;
  const auto promise = [&test](size_t i) { return test.promise(static_cast<Eigen::Index>(i)); };
  for (size_t i = 0; i < candidates.size(); ++i) {
    if (candidates[i].release || !candidates[i].change_point.empty()) continue;
    const auto known = best.emplace(candidates[i].effect, i).first;
    if (promise(i) > promise(known->second)) known->second = i;
    most = std::max(most, promise(i));
  }
  std::vector<Candidate> promising;
  for (const auto& [effect, i] : best)
    if (promise(i) > kHalfAsGood * most) promising.push_back(candidates[i]);
  return promising;
}

/// A found effect, or another one in its place.
struct Contender {
  std::string effect;
  FitState state;
  Eigen::VectorXd loss;  ///< on held-out blocks
};

/// `found` and others in its place, in a state without it.
std::vector<Contender> contendersFor(const SearchState& search, const std::string& found,
                                     const FitState& lacking) {
  const Fitter& fitter = search.fitter;
  const FitState& now = search.result.state;
  std::vector<Contender> all{{found, now, heldOutLoss(fitter, now)}};
  for (const Candidate& candidate : promisingIn(search, lacking)) {
    if (candidate.effect == found || search.isCutShort()) continue;
    FitState tried = lacking;
    takeCandidate(fitter, tried, candidate);
    if (anyOnBound(tried, {candidate.effect})) continue;
    Eigen::VectorXd loss = heldOutLoss(fitter, tried);
    all.push_back({candidate.effect, std::move(tried), std::move(loss)});
  }
  return all;
}

/// Takes the best of several into the result, with those that are level as its runners-up; returns
/// its name. `lacking` is the state without any of them.
std::string takeBest(const SearchState& search, const FitState& lacking,
                     std::vector<Contender> all) {
  FoundTerms& result = search.result;
  const std::string before = all.front().effect;
  const auto best = std::min_element(
      all.begin(), all.end(),
      [](const Contender& a, const Contender& b) { return a.loss.sum() < b.loss.sum(); });
  std::vector<RunnerUp> level;
  for (const Contender& other : all) {
    if (other.effect == best->effect) continue;
    const Gain behind = gainOf(search.fitter, other.loss, best->loss);
    if (behind.value < kBriefLevel * behind.error)
      level.push_back({other.effect, behind.value, kBriefLevel * behind.error});
  }
  if (best->effect != before) {
    const std::string remark = "in the place of " + before;
    EffectEvidence evidence;
    evidence.p_value = result.evidence[before].p_value;
    evidence.gain = gainOf(search.fitter, heldOutLoss(search.fitter, lacking), best->loss);
    result.record.steps.push_back({best->effect,
                                   false,
                                   0.0,
                                   evidence.p_value.value_or(1.0),
                                   evidence.gain.value,
                                   evidence.gain.error,
                                   {},
                                   remark});
    search.say("  = " + best->effect + " " + remark);
    result.evidence[best->effect] = std::move(evidence);
    result.state = std::move(best->state);
    search.fitter.fit(result.state);
  }
  result.evidence[best->effect].runner_ups = std::move(level);
  return best->effect;
}

/// The same for a changed term of the model, with other effects in the place of its change.
void weighChange(const SearchState& search, const MovedTerm& term) {
  FoundTerms& result = search.result;
  const std::string given = effectOf(term.path);
  FitState lacking = result.state;
  holdAgain(lacking, term);
  lacking.predicted = search.fitter.predict(lacking.model);
  search.fitter.fit(lacking);
  const std::string name = takeBest(search, lacking, contendersFor(search, given, lacking));
  if (name == given) return;
  result.effects.push_back(name);
  result.released.erase(std::remove(result.released.begin(), result.released.end(), given),
                        result.released.end());
}

}  // namespace

void weighOthers(const SearchState& search) {
  FoundTerms& result = search.result;
  for (std::string& name : result.effects) {
    if (search.isAccepted(name)) continue;
    const FitState lacking = without(search.fitter, result.state, name);
    name = takeBest(search, lacking, contendersFor(search, name, lacking));
  }
  if (search.settings.calibrate) return;
  for (const MovedTerm& term : freedTerms(search))
    if (findEffectParameter(term.path) != nullptr) weighChange(search, term);
}

Eigen::MatrixXd missedOnOtherHalves(const Fitter& fitter, const FitState& state,
                                    const Eigen::VectorXd& scales) {
  const Observations& data = fitter.data();
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(data.blocks(), 4);
  for (int half : {0, 1}) {
    const Fitter on_half = fitter.onRows(halfMask(data, half));
    FitState fitted = state;
    on_half.fit(fitted);
    addMissed(fitter, fitted, scales, 1 - half, sums);
  }
  return sums;
}

std::vector<char> halfMask(const Observations& data, int half) {
  std::vector<char> mask;
  for (const Observation& row : data.all()) mask.push_back(row.block % 2 == half);
  return mask;
}

void dropUnconfirmed(const SearchState& search) {
  FoundTerms& result = search.result;
  if (result.effects.empty()) return;
  FitState lacking = withoutFound(search);
  if (isConfirmed(search, lacking)) return;
  std::vector<std::string> kept;
  for (const std::string& effect : result.effects) {
    if (search.isAccepted(effect)) {
      kept.push_back(effect);
      continue;
    }
    search.say("  - " + effect + ": does not lessen the end error on driving it was not fitted to");
    result.record.negligible.push_back(effect);
  }
  result.effects = kept;
  result.state = std::move(lacking);
}

}  // namespace tread::gap
