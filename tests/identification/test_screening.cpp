// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <set>
#include <stdexcept>
#include <tuple>

#include "core_rig.hpp"
#include "modules/identification/core/candidates.hpp"
#include "modules/identification/core/pruning.hpp"
#include "modules/identification/core/search_steps.hpp"

using namespace tread;
using namespace tread::gap;
using samples::blockNoise;
using samples::Rig;
using samples::vehicleWith;

namespace {

/// The candidates of the nominal vehicle that are always active.
std::vector<Candidate> steadyCandidates(const Rig& rig, const FitState& state) {
  std::vector<Candidate> steady;
  for (const Candidate& candidate : candidatesFor(state, excitationOf(rig.data, state.model)))
    if (candidate.change_point.empty()) steady.push_back(candidate);
  return steady;
}

const Candidate& ofEffect(const std::vector<Candidate>& candidates, const std::string& effect) {
  return *std::find_if(candidates.begin(), candidates.end(),
                       [&effect](const Candidate& c) { return c.effect == effect; });
}

/// A screening with given candidates: effect, evidence, promise.
Screening madeUp(const std::vector<std::tuple<std::string, double, double>>& rows) {
  Screening screening;
  for (const auto& [effect, evidence, promise] : rows) {
    Candidate candidate;
    candidate.effect = effect;
    screening.candidates.push_back(candidate);
    screening.evidence.push_back(evidence);
    screening.promise.push_back(promise);
  }
  return screening;
}

}  // namespace

TEST_CASE("what a drive demands is the most that it commands and that the model does") {
  const Rig rig({}, 60.0, 1);
  const Drive& drive = rig.drives[0];
  const Excitation most = excitationOf(rig.data, syntheticVehicle());
  double fastest = 0.0;
  for (const CommandSample& sample : drive.segments[0].commands) {
    const TrackCommand asked = syntheticVehicle().vehicle.trackSpeeds(sample.command.tracks());
    fastest = std::max({fastest, std::abs(asked.left), std::abs(asked.right)});
  }
  CHECK(most.track_speed == fastest);
  CHECK(most.begin == 0.0);
  CHECK(most.end == Approx(60.0));
  CHECK(most.omega > 0.5);
  CHECK(most.omega < 2.0 * fastest / 0.8);  // pivoting, without any loss
  CHECK(most.v_omega > 0.0);
  CHECK(most.v_omega < most.omega * fastest);
  CHECK_FALSE(most.voltage);
}

TEST_CASE("candidates are of effects that are off, under their first name, that could be seen") {
  const Rig rig({}, 60.0, 1);
  const ModelDocument model = vehicleWith({{"slip_ratio.slip", 0.05}, {"yaw_pull.pull", 0.01}});
  Excitation most = excitationOf(rig.data, model);
  const auto names = [&] {
    std::set<std::string> all;
    for (const Candidate& candidate : candidatesFor(model, most)) all.insert(candidate.effect);
    return all;
  };
  const std::set<std::string> without = names();
  for (const Effect& effect : effectCatalogue()) {
    INFO(effect.name);
    const bool on = effect.name == "slip_ratio" || effect.name == "yaw_pull";
    const bool needs_voltage =
        std::all_of(effect.parameters.begin(), effect.parameters.end(), [](const auto& parameter) {
          return parameter.needs_voltage || parameter.role == ParameterRole::kShape;
        });
    CHECK((without.count(effect.name) != 0) ==
          (!on && effect.isOf(VehicleLayout::kTracks) && !effect.search.second_name &&
           !effect.search.in_place && !needs_voltage));
  }
}

TEST_CASE("a battery is looked for by its voltage where all drives measure it, else by time") {
  Rig rig({}, 60.0, 1);
  const auto batteryBy = [&] {
    std::set<std::string> parameters;
    for (const Candidate& candidate :
         candidatesFor(syntheticVehicle(), excitationOf(rig.data, syntheticVehicle())))
      if (candidate.effect == "battery_sag") parameters.insert(candidate.parameter);
    return parameters;
  };
  const std::set<std::string> by_time{"per_hour"};
  CHECK(batteryBy() == by_time);
  rig.drives.front().voltage = {{0.0, 25.0}, {30.0, 25.0}};  // stuck
  CHECK(batteryBy() == by_time);
  rig.drives.front().voltage.back().voltage = 24.9;
  CHECK(batteryBy() == std::set<std::string>{"per_drop"});
}

TEST_CASE("a limit is tried below what the drive demands, one that nothing demands not at all") {
  const Rig rig({}, 60.0, 1);
  Excitation most = excitationOf(rig.data, syntheticVehicle());
  int limits = 0;
  for (const Candidate& candidate : candidatesFor(syntheticVehicle(), most)) {
    const EffectParameter& known =
        parameterNamed(effectNamed(candidate.effect), candidate.parameter);
    if (known.limited == LimitedQuantity::kTrackSpeed) {
      CHECK(1.0 / candidate.value < most.track_speed);
      ++limits;
    }
    if (known.limited == LimitedQuantity::kYawRate) {
      CHECK(1.0 / candidate.value < most.omega);
      ++limits;
    }
  }
  CHECK(limits >= 8);
  most.track_speed = most.omega = most.v_omega = 0.0;
  for (const Candidate& candidate : candidatesFor(syntheticVehicle(), most))
    CHECK(parameterNamed(effectNamed(candidate.effect), candidate.parameter).limited ==
          LimitedQuantity::kNone);
}

TEST_CASE("changes are tried all over the drive, a second one only after the first") {
  const Rig rig({}, 200.0, 1);
  const auto times = [&](const ModelDocument& model, const std::string& path) {
    std::set<double> all;
    for (const Candidate& candidate : candidatesFor(model, excitationOf(rig.data, model)))
      if (candidate.change_point == path) all.insert(candidate.since);
    return all;
  };
  const std::set<double> first = times(syntheticVehicle(), "terrain_change.time_1");
  REQUIRE(first.size() >= 10);
  CHECK(*first.begin() > 5.0);
  CHECK(*first.begin() < 20.0);
  CHECK(*first.rbegin() > 180.0);
  CHECK(*first.rbegin() < 195.0);
  CHECK(times(syntheticVehicle(), "terrain_change.time_2").empty());
  const ModelDocument changed =
      vehicleWith({{"terrain_change.slip_1", 0.1}, {"terrain_change.time_1", 100.0}});
  CHECK(times(changed, "terrain_change.time_1").empty());
  const std::set<double> second = times(changed, "terrain_change.time_2");
  REQUIRE_FALSE(second.empty());
  CHECK(*second.begin() > 100.0);
}

TEST_CASE("what is left out is out, and the rest stays in its order") {
  const Rig rig({}, 60.0, 1);
  const Excitation most = excitationOf(rig.data, syntheticVehicle());
  const std::vector<Candidate> all = candidatesFor(syntheticVehicle(), most);
  std::vector<Candidate> some = all;
  leaveOut(some, {"slip_ratio", "terrain_change", "unheard_of"});
  size_t next = 0;
  for (const Candidate& candidate : all) {
    if (candidate.effect == "slip_ratio" || candidate.effect == "terrain_change") continue;
    REQUIRE(next < some.size());
    CHECK(some[next].effect == candidate.effect);
    CHECK(some[next++].value == candidate.value);
  }
  CHECK(next == some.size());
  leaveOut(some, {});
  CHECK(some.size() == next);
}

TEST_CASE("a direction from the cache is the finite difference of predictions") {
  const Rig rig({}, 60.0, 1);
  const FitState state = rig.fitter.start(syntheticVehicle(), {});
  const std::vector<Candidate> candidates = steadyCandidates(rig, state);
  SensitivityCache cache;
  const Eigen::MatrixXd directions = cache.directions(rig.fitter, state, candidates);
  REQUIRE(directions.cols() == static_cast<Eigen::Index>(candidates.size()));
  for (size_t i = 0; i < candidates.size(); ++i) {
    ModelDocument changed = state.model;
    for (const auto& [path, value] : candidates[i].shapes) *findParameter(changed, path) = value;
    *findParameter(changed, candidates[i].effect + "." + candidates[i].parameter) =
        candidates[i].value;
    const Eigen::VectorXd difference =
        (rig.data.predict(changed) - rig.data.predict(state.model)) / candidates[i].change;
    INFO(candidates[i].effect << " at " << candidates[i].value);
    CHECK((directions.col(static_cast<Eigen::Index>(i)) - difference).norm() <=
          1e-9 * difference.norm());
  }
}

TEST_CASE("the cache serves what it knows until it is renewed") {
  const Rig rig({}, 60.0, 1);
  const FitState state = rig.fitter.start(syntheticVehicle(), {});
  const FitState other = rig.fitter.start(vehicleWith({{"yaw_pull.pull", 0.2}}), {});
  const std::vector<Candidate> steady = steadyCandidates(rig, state);
  const std::vector<Candidate> slip{ofEffect(steady, "slip_ratio")};
  SensitivityCache cache;
  const Eigen::MatrixXd known = cache.directions(rig.fitter, state, slip);
  CHECK(cache.directions(rig.fitter, other, slip) == known);
  std::vector<Candidate> more = slip;
  more.push_back(ofEffect(steady, "icr_offset"));
  const Eigen::MatrixXd both = cache.directions(rig.fitter, other, more);
  CHECK(both.col(0) == known.col(0));
  CHECK(both.col(1) == directionsOf(rig.fitter, other, {more[1]}).col(0));
  cache.renew(rig.fitter, other, slip);
  const Eigen::MatrixXd renewed = cache.directions(rig.fitter, state, slip);
  CHECK(renewed == directionsOf(rig.fitter, other, slip));
  CHECK(renewed != known);
  CHECK(cache.directions(rig.fitter, state, {}).cols() == 0);
}

TEST_CASE(
    "a direction from the cache holds for all rows, whichever counted when it was simulated") {
  std::vector<Drive> drives(1);
  for (uint64_t seed = 1; seed <= 8; ++seed)
    drives[0].segments.push_back(syntheticDrive(syntheticVehicle(), 10.0, seed).segments[0]);
  const Observations data(drives, {});
  const Fitter fitter(data);
  const Fitter half = fitter.onRows(halfMask(data, 0));
  const FitState whole = fitter.start(syntheticVehicle(), {});
  const FitState state = half.start(syntheticVehicle(), {});
  REQUIRE(state.predicted != whole.predicted);
  const std::vector<Candidate> candidates =
      candidatesOf("track_width", whole, excitationOf(data, syntheticVehicle()));
  SensitivityCache of_half;
  SensitivityCache of_whole;
  CHECK(of_half.directions(half, state, candidates) ==
        of_whole.directions(fitter, whole, candidates));
}

TEST_CASE("excitation is measured once, with the first state") {
  const Rig rig({}, 60.0, 1);
  const FitState state = rig.fitter.start(syntheticVehicle(), {});
  FitState slow = state;
  slow.model.vehicle.full_speed = 0.1;
  SensitivityCache cache;
  const double first = cache.excitation(rig.fitter, state).track_speed;
  CHECK(cache.excitation(rig.fitter, slow).track_speed == first);
  CHECK(SensitivityCache().excitation(rig.fitter, slow).track_speed < 0.2 * first);
}

TEST_CASE("a held term that may have changed has its own column, one that is not free is refused") {
  const Rig rig({}, 60.0, 1);
  FitState state = rig.fitter.start(vehicleWith({{"slip_ratio.slip", 0.05}}), {});
  FreeParameter slip = freeParameter(state.model, "slip_ratio.slip");
  slip.deviation = 0.01;
  rig.fitter.add(state, slip, 0.05);
  std::vector<Candidate> candidates = candidatesFor(state, excitationOf(rig.data, state.model));
  candidates.erase(std::remove_if(candidates.begin(), candidates.end(),
                                  [](const Candidate& c) { return !c.release; }),
                   candidates.end());
  REQUIRE(candidates.size() == 1);
  CHECK(candidates[0].effect == "slip_ratio");
  SensitivityCache cache;
  CHECK(cache.directions(rig.fitter, state, candidates).col(0) == state.jacobian.col(0));
  addCandidate(rig.fitter, state, candidates[0], 0.02);
  CHECK(std::isinf(state.free[0].deviation));
  rig.fitter.release(state, 0);
  CHECK_THROWS_AS(cache.directions(rig.fitter, state, candidates), std::logic_error);
}

TEST_CASE("what changes at a time changes nothing before it") {
  const Rig rig({}, 100.0, 1);
  const FitState state = rig.fitter.start(syntheticVehicle(), {});
  std::vector<Candidate> changes;
  for (const Candidate& candidate : candidatesFor(state, excitationOf(rig.data, state.model)))
    if (candidate.change_point == "terrain_change.time_1") changes.push_back(candidate);
  const Eigen::MatrixXd directions = directionsOf(rig.fitter, state, changes);
  for (size_t c = 0; c < changes.size(); ++c) {
    double later = 0.0;
    for (size_t i = 0; i < rig.data.all().size(); ++i) {
      const double value = directions(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c));
      if (rig.data.all()[i].end <= changes[c].since)
        REQUIRE(value == 0.0);
      else
        later += std::abs(value);
    }
    CHECK(later > 0.0);
  }
}

TEST_CASE("directions that are simulated in any order are the same, to the bit") {
  const Rig rig({}, 60.0, 1);
  const FitState state = rig.fitter.start(syntheticVehicle(), {});
  const auto candidates = candidatesFor(state, excitationOf(rig.data, state.model));
  const Fitter backwards(rig.data, [](size_t count, const std::function<void(size_t)>& body) {
    while (count > 0) body(--count);
  });
  CHECK(directionsOf(backwards, state, candidates) == directionsOf(rig.fitter, state, candidates));
}

TEST_CASE(
    "a screening has one test for each effect, strongest first, and none for a rejected one") {
  const Rig rig({{"slip_ratio.slip", 0.1}}, 200.0, 1);
  const FitState state = rig.fitter.start(syntheticVehicle(), {});
  SearchSettings settings;
  settings.draws = 199;
  settings.rejected = {"lever_arm_x"};
  SensitivityCache cache;
  const Screening first = screen(rig.fitter, state, settings, true, cache);
  std::set<std::string> names;
  for (size_t i = 0; i < first.tests.size(); ++i) {
    CHECK(names.insert(first.tests[i].effect).second);
    CHECK(first.tests[i].uniqueness >= 0.0);
    CHECK(first.tests[i].uniqueness <= 1.0 + 1e-9);
    CHECK(first.tests[i].detectable > 0.0);
    if (i > 0) CHECK(std::abs(first.tests[i].score) <= std::abs(first.tests[i - 1].score));
    if (i > 0) CHECK(first.tests[i].p_value >= first.tests[i - 1].p_value);
  }
  CHECK(names.count("lever_arm_x") == 0);
  CHECK(names.count("slip_ratio") == 1);
  for (const Candidate& candidate : first.candidates) CHECK(candidate.effect != "lever_arm_x");
  CHECK(first.chance.size() == 199);
  CHECK(std::is_sorted(first.chance.begin(), first.chance.end()));
  CHECK(first.alpha == settings.alpha);
  CHECK_FALSE(significant(first).empty());
  const Screening later = screen(rig.fitter, state, settings, false, cache);
  CHECK(later.alpha == settings.alpha_more);
  CHECK(later.scores == first.scores);
}

TEST_CASE("of each effect beyond chance the most promising candidate counts, the best first") {
  const Screening screening = madeUp({{"a", 1.2, 5.0},
                                      {"b", 3.0, 7.0},
                                      {"a", 1.0, 9.0},
                                      {"a", 0.9, 99.0},
                                      {"c", 0.99, 50.0},
                                      {"b", 9.0, 6.0}});
  CHECK(significant(screening) == std::vector<size_t>{2, 1});
  CHECK(significant(Screening{}).empty());
}

TEST_CASE("a p value is by blocks where they convince, else by the size if that is clearer") {
  Screening screening = madeUp({{"a", 1.0, 1.0}, {"b", 1.0, 1.0}});
  for (int i = 1; i <= 99; ++i) screening.chance.push_back(0.1 * i);
  screening.alpha = 0.05;
  CHECK(pValueOf(screening, 20.0, 0.0) == Approx(0.01));
  CHECK(pValueOf(screening, 5.05, 0.0) == Approx(0.5));
  CHECK(pValueOf(screening, 5.05, 1.5) == Approx(chanceOfSize(1.5, 2)));
  screening.first = true;
  CHECK(pValueOf(screening, 5.05, 1.5) == Approx(chanceOfSize(1.5, 2, true)));
}

TEST_CASE("a size vanishes below a small share of what is typical, on either side of 0") {
  const double typical = parameterNamed(effectNamed("slip_ratio"), "slip").typical;
  CHECK(isVanishing("slip_ratio", "slip", 0.0));
  CHECK(isVanishing("slip_ratio", "slip", 1e-3 * typical));
  CHECK(isVanishing("slip_ratio", "slip", -1e-3 * typical));
  CHECK_FALSE(isVanishing("slip_ratio", "slip", 0.01 * typical));
  CHECK_FALSE(isVanishing("slip_ratio", "slip", -0.01 * typical));
}
