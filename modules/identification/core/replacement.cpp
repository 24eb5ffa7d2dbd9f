// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/search_steps.hpp"

#include <algorithm>
#include <optional>
#include <set>

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
  auto candidates = candidatesFor(state, excitationOf(fitter.data(), state.model));
  leaveOut(candidates, rejected);
  const Eigen::MatrixXd directions = directionsOf(fitter, state, candidates);
  const ScoreTest test(fitter.data(), state, directions, mask);
  std::vector<Single> chosen;
  std::set<std::string> names;
  for (size_t i = 0; i < candidates.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const Effect& effect = effectNamed(candidates[i].effect);
    // A change early in the drive has more numbers than the two, and is no simpler.
    if (!candidates[i].change_point.empty()) continue;
    if (isOn(effect, state.model)) continue;
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
  Replacement(const Fitter& fitter, const std::vector<char>& mask, const SearchSettings& settings,
              SearchResult& result, const Progress& say)
      : fitter_(fitter), mask_(mask), settings_(settings), result_(result), say_(say) {}

  /// True if a pair went: that whose single effect fits best.
  bool replaceOne() {
    if (result_.effects.size() < 2) return false;
    const std::vector<Single> singles = imitated(fitter_, mask_, result_.state, settings_.rejected);
    if (singles.empty()) return false;
    const Eigen::VectorXd loss = heldOutLoss(fitter_.data(), result_.state, mask_);
    for (const Single& single : singles)
      for (size_t a = 0; a < result_.effects.size(); ++a)
        for (size_t b = a + 1; b < result_.effects.size(); ++b)
          tryOne(single, result_.effects[a], result_.effects[b], loss);
    if (!best_) return false;
    replace(*best_);
    best_.reset();
    return true;
  }

 private:
  /// One effect in the place of two.
  struct Exchange {
    std::string single;
    std::string a;
    std::string b;
    FitState state;
    Gain pair_gain;
  };

  /// Keeps the exchange if it is bearable and the best so far.
  void tryOne(const Single& imitated_one, const std::string& a, const std::string& b,
              const Eigen::VectorXd& loss) {
    if (contains(settings_.accepted, a) || contains(settings_.accepted, b)) return;
    const std::vector<char> counts = blocksThatCount(fitter_.data(), mask_);
    const FitState nearly = linearlyReplaced(fitter_, mask_, result_.state, imitated_one, a, b);
    const Gain first_order = gainOf(heldOutLoss(fitter_.data(), nearly, mask_), loss, counts);
    if (first_order.value > kHopeless * first_order.error + kHopelessNats) return;
    const Candidate& single = imitated_one.candidate;
    const FitState reduced = switchedOff(fitter_, result_.state, {a, b});
    const ScoreTest test(fitter_.data(), reduced, directionsOf(fitter_, reduced, {single}), mask_);
    FitState tried = reduced;
    addCandidate(fitter_, tried, single, test.size(0), mask_);
    fitter_.fitRoughly(tried, mask_);
    for (const FreeParameter& parameter : tried.free)
      if (parameter.path.compare(0, single.effect.size(), single.effect) == 0 &&
          onBound(tried.model, parameter))
        return;
    // What does not fit as well needs no validation; that is in first order and may be mistaken.
    if (tried.loss - result_.state.loss > 2.0 * kBearableNats) return;
    if (best_ && tried.loss >= best_->state.loss) return;
    const Gain pair_gain = gainOf(heldOutLoss(fitter_.data(), tried, mask_), loss,
                                  blocksThatCount(fitter_.data(), mask_));
    if (pair_gain.value > std::min(pair_gain.error, kBearableNats)) return;
    best_ = Exchange{single.effect, a, b, std::move(tried), pair_gain};
  }

  void replace(const Exchange& exchange) {
    SearchStep step;
    step.effect = exchange.single;
    step.gain = -exchange.pair_gain.value;
    step.gain_error = exchange.pair_gain.error;
    step.remark = "in the place of " + exchange.a + " and " + exchange.b;
    result_.record.steps.push_back(step);
    say_("  = " + exchange.single + " " + step.remark);
    auto& effects = result_.effects;
    effects.erase(std::remove(effects.begin(), effects.end(), exchange.a), effects.end());
    effects.erase(std::remove(effects.begin(), effects.end(), exchange.b), effects.end());
    effects.push_back(exchange.single);
    result_.evidence[exchange.single].replaced = {exchange.a, exchange.b};
    result_.state = exchange.state;
  }

  const Fitter& fitter_;
  const std::vector<char>& mask_;
  const SearchSettings& settings_;
  SearchResult& result_;
  const Progress& say_;
  std::optional<Exchange> best_;
};

}  // namespace

void replacePairs(const Fitter& fitter, const std::vector<char>& mask,
                  const SearchSettings& settings, SearchResult& result, const Progress& say) {
  Replacement replacement(fitter, mask, settings, result, say);
  while (replacement.replaceOne()) continue;
}

}  // namespace tread::gap
