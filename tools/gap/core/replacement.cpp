// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/core/replacement.hpp"

#include <algorithm>
#include <set>

#include "tools/gap/core/pruning.hpp"

namespace tread::gap {
namespace {

constexpr double kHopeless = 2.5;       // standard errors by which a pair is better in first order
constexpr double kHopelessNats = 20.0;  // and what rounding of that order may cost
constexpr double kBearableNats = 10.0;  // that simplicity may cost
constexpr double kImitated = 0.35;  // uniqueness below which the found effects imitate another one

/// An effect that the found ones can imitate, and what it would change.
struct Single {
  Candidate candidate;
  Eigen::VectorXd direction;
};

/// One of each such effect.
std::vector<Single> imitated(const Fitter& fitter, const std::vector<char>& mask,
                             const FitState& state, const std::vector<std::string>& rejected) {
  auto candidates = candidatesFor(state, excitationOf(fitter.rows(), state.model));
  leaveOut(candidates, rejected);
  const Eigen::MatrixXd directions = directionsOf(fitter, state, candidates);
  const ScoreTest test(fitter.rows(), state, directions, mask);
  std::vector<Single> chosen;
  std::set<std::string> names;
  for (size_t i = 0; i < candidates.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const Effect& effect = effectNamed(candidates[i].effect);
    // A second change of ground is part of an effect that is on.
    if (isOn(effect, state.model.vehicle.effects, state.model.measurement)) continue;
    if (test.uniqueness(at) < kImitated && names.insert(effect.name).second)
      chosen.push_back({candidates[i], directions.col(at)});
  }
  return chosen;
}

/// The state with one effect in the place of two, in first order and without a simulation.
FitState linearlyReplaced(const Fitter& fitter, const std::vector<char>& mask,
                          const FitState& state, const Single& single, const std::string& a,
                          const std::string& b) {
  FitState reduced = withoutLinearly(fitter, withoutLinearly(fitter, state, a), b);
  reduced.free.push_back(
      freeParameter(reduced.model, single.candidate.effect + "." + single.candidate.parameter));
  reduced.jacobian.conservativeResize(reduced.predicted.size(), reduced.jacobian.cols() + 1);
  reduced.jacobian.rightCols(1) = single.direction;
  followLinearly(fitter, reduced, mask);
  return reduced;
}

class Replacement {
 public:
  Replacement(const Fitter& fitter, const std::vector<char>& mask, SearchResult& result,
              const Progress& say)
      : fitter_(fitter), mask_(mask), result_(result), say_(say) {}

  /// True if a pair went.
  bool replaceOne() {
    if (result_.effects.size() < 2) return false;
    const std::vector<Single> singles = imitated(fitter_, mask_, result_.state, result_.rejected);
    if (singles.empty()) return false;
    const Eigen::VectorXd loss = heldOutLoss(fitter_.rows(), result_.state, mask_);
    for (const Single& single : singles)
      for (size_t a = 0; a < result_.effects.size(); ++a)
        for (size_t b = a + 1; b < result_.effects.size(); ++b)
          if (tryOne(single, result_.effects[a], result_.effects[b], loss)) return true;
    return false;
  }

 private:
  bool tryOne(const Single& imitated_one, const std::string& a, const std::string& b,
              const Eigen::VectorXd& loss) {
    if (contains(result_.accepted, a) || contains(result_.accepted, b)) return false;
    const std::vector<char> counts = blocksThatCount(fitter_.rows(), mask_);
    const FitState nearly = linearlyReplaced(fitter_, mask_, result_.state, imitated_one, a, b);
    const Gain first_order = gainOf(heldOutLoss(fitter_.rows(), nearly, mask_), loss, counts);
    if (first_order.value > kHopeless * first_order.error + kHopelessNats) return false;
    const Candidate& single = imitated_one.candidate;
    const FitState reduced = switchedOff(fitter_, result_.state, {a, b});
    const ScoreTest test(fitter_.rows(), reduced, directionsOf(fitter_, reduced, {single}), mask_);
    FitState tried = reduced;
    addCandidate(fitter_, tried, single, test.size(0), mask_);
    fitter_.fitRoughly(tried, mask_);
    for (const FreeParameter& parameter : tried.free)
      if (parameter.path.compare(0, single.effect.size(), single.effect) == 0 &&
          onBound(tried.model, parameter))
        return false;
    // What does not fit as well needs no validation; that is in first order and may be mistaken.
    if (tried.loss - result_.state.loss > 2.0 * kBearableNats) return false;
    const Gain pair_gain = gainOf(heldOutLoss(fitter_.rows(), tried, mask_), loss,
                                  blocksThatCount(fitter_.rows(), mask_));
    // A moment may be set anywhere: an effect with one has to be clearly better than two without.
    const double bearable =
        single.moment.empty() ? std::min(pair_gain.error, kBearableNats) : -pair_gain.error;
    if (pair_gain.value > bearable) return false;
    replace(single.effect, a, b, std::move(tried), pair_gain);
    return true;
  }

  /// By value: the names come from the list that changes.
  void replace(const std::string& single, const std::string a, const std::string b, FitState state,
               const Gain& pair_gain) {
    LadderStep step;
    step.effect = single;
    step.gain = -pair_gain.value;
    step.gain_error = pair_gain.error;
    step.remark = "in the place of " + a + " and " + b;
    result_.ladder.push_back(step);
    say_("  = " + single + " " + step.remark);
    auto& effects = result_.effects;
    effects.erase(std::remove(effects.begin(), effects.end(), a), effects.end());
    effects.erase(std::remove(effects.begin(), effects.end(), b), effects.end());
    effects.push_back(single);
    result_.replaced[single] = {a, b};
    result_.state = std::move(state);
  }

  const Fitter& fitter_;
  const std::vector<char>& mask_;
  SearchResult& result_;
  const Progress& say_;
};

}  // namespace

void replacePairs(const Fitter& fitter, const std::vector<char>& mask, SearchResult& result,
                  const Progress& say) {
  Replacement replacement(fitter, mask, result, say);
  while (replacement.replaceOne()) continue;
}

}  // namespace tread::gap
