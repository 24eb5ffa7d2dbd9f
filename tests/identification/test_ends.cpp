// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <map>
#include <random>
#include <set>

#include <catch2/catch.hpp>

#include "core_rig.hpp"
#include "modules/identification/core/candidates.hpp"
#include "modules/identification/core/discovery.hpp"

// A search ends: by itself, and when its time is over.

using namespace tread;
using namespace tread::gap;
using samples::kSilent;
using samples::Rig;

namespace {

/// Random models and logs, determined by the seed.
class RandomCase {
 public:
  explicit RandomCase(uint64_t seed) : random_(seed) {}

  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_() >> 11U) * 0x1p-53;
  }
  size_t below(size_t count) { return random_() % count; }

  /// Switches some effects of the catalogue on, at .2 to 1.5 times their typical sizes.
  void turnOn(ModelDocument& model, size_t most) {
    std::vector<const Effect*> all;
    for (const Effect& effect : effectCatalogue())
      if (effect.isOf(model.vehicle.layout())) all.push_back(&effect);
    for (size_t i = below(most + 1); i > 0; --i) {
      const Effect& effect = *all[below(all.size())];
      for (const EffectParameter& parameter : effect.parameters) {
        const double sign = parameter.min < 0.0 && below(2) == 0 ? -1.0 : 1.0;
        const double size = parameter.role == ParameterRole::kStrength
                                ? sign * between(0.2, 1.5) * parameter.typical
                                : parameter.typical;
        *findParameter(model, effect.name + "." + parameter.name) =
            std::clamp(size, parameter.min, parameter.max);
      }
    }
  }

  /// The synthetic vehicle with some terms, most of them with uncertainties.
  ModelDocument model() {
    ModelDocument model = syntheticVehicle();
    turnOn(model, 4);
    ParameterCovariance& known = model.covariance;
    for (const FreeParameter& term : givenParameters(model, false))
      if (below(4) != 0) known.parameters.push_back(term.path);
    const size_t size = known.parameters.size();
    known.matrix.assign(size, std::vector<double>(size, 0.0));
    for (size_t i = 0; i < size; ++i)
      known.matrix[i][i] =
          std::pow(between(0.02, 0.5) * *findParameter(model, known.parameters[i]), 2);
    return model;
  }

 private:
  std::mt19937_64 random_;
};

/// Largest number of times that one effect was added.
size_t mostAdded(const FoundTerms& found) {
  std::map<std::string, size_t> added;
  size_t most = 0;
  for (const SearchStep& step : found.record.steps)
    if (!step.removed) most = std::max(most, ++added[step.effect]);
  return most;
}

/// Whether a path is free twice.
bool hasTwice(const FitState& state) {
  std::set<std::string> paths;
  return std::any_of(state.free.begin(), state.free.end(), [&paths](const FreeParameter& free) {
    return !paths.insert(free.path).second;
  });
}

}  // namespace

TEST_CASE("searches over models and logs drawn at random end, and have no term twice") {
  constexpr uint64_t kCases = 250;
  // Reasons: free with or without nuisance terms, with lags, at two change points, as given terms.
  constexpr size_t kMostAdded = 6;
  constexpr int kMostAsked = 1000;
  for (uint64_t seed = 1; seed <= kCases; ++seed) {
    INFO("seed " << seed);
    RandomCase draw(seed);
    const ModelDocument model = draw.model();
    ModelDocument truth = model;
    draw.turnOn(truth, 3);
    const std::vector<Drive> drives{syntheticDrive(truth, draw.between(40.0, 100.0), seed)};
    const Observations data(drives, {});
    const Fitter fitter(data);
    SearchSettings settings;
    settings.draws = 199;
    settings.calibrate = draw.below(4) == 0;
    int asked = 0;
    settings.is_over = [&asked] { return ++asked > kMostAsked; };
    SearchMemory memory;
    const FoundTerms found = search(fitter, model, settings, memory, kSilent);
    CHECK_FALSE(found.record.cut_short);
    CHECK(asked <= kMostAsked);
    CHECK(mostAdded(found) <= kMostAdded);
    CHECK_FALSE(hasTwice(found.state));
    const std::set<std::string> once(found.effects.begin(), found.effects.end());
    CHECK(once.size() == found.effects.size());
  }
}

TEST_CASE("a term that a fit took to nothing is not offered again") {
  const Rig rig({}, 60.0, 1);
  FitState state = rig.fitter.start(syntheticVehicle(), {});
  const Excitation most = excitationOf(rig.data, state.model);
  const auto offered = [&](const std::string& effect) {
    const std::vector<Candidate> all = candidatesFor(state, most);
    return std::any_of(all.begin(), all.end(),
                       [&](const Candidate& candidate) { return candidate.effect == effect; }) ||
           !candidatesOf(effect, state, most).empty();
  };
  REQUIRE(offered("speed_saturation"));
  REQUIRE(offered("thermal_derating"));
  for (const char* path : {"speed_saturation.inverse_limit", "thermal_derating.loss"})
    rig.fitter.add(state, freeParameter(state.model, path), 0.0);
  CHECK_FALSE(offered("speed_saturation"));
  CHECK_FALSE(offered("thermal_derating"));
  CHECK(offered("track_width"));
}

TEST_CASE("a search whose time is over ends with what it has found until then") {
  const Rig rig({{"motor_deadband.speed", 0.1}, {"lever_arm_y.offset", 0.2}}, 300.0, 2);
  const auto foundIn = [&rig](int asks) {
    SearchSettings settings;
    settings.is_over = [asks, asked = 0]() mutable { return ++asked > asks; };
    SearchMemory memory;
    return search(rig.fitter, syntheticVehicle(), settings, memory, kSilent);
  };
  const FoundTerms whole = foundIn(1000);
  CHECK_FALSE(whole.record.cut_short);
  CHECK(whole.effects.size() == 2);
  const FoundTerms first = foundIn(6);
  CHECK(first.record.cut_short);
  CHECK(first.effects.size() == 1);
  const FoundTerms none = foundIn(0);
  CHECK(none.record.cut_short);
  CHECK(none.effects.empty());
}

TEST_CASE("a finding that was cut short is partial with what it has, and else cannot tell") {
  GapTask task;
  task.model = syntheticVehicle();
  task.train.push_back(
      syntheticDrive(samples::vehicleWith({{"motor_deadband.speed", 0.1}}), 300.0, 2));
  task.is_over = [] { return true; };
  const GapFinding nothing = findGap(task, kSilent);
  CHECK(nothing.verdict == GapVerdict::kCannotTell);
  CHECK(nothing.reason.find("time limit") != std::string::npos);
  REQUIRE(nothing.gap);
  CHECK_FALSE(nothing.gap->structure_nested);
  task.is_over = [asked = 0]() mutable { return ++asked > 6; };
  const GapFinding some = findGap(task, kSilent);
  CHECK(some.verdict == GapVerdict::kPartial);
  CHECK(some.search.cut_short);
  CHECK(some.identified.effects.size() == 1);
}
