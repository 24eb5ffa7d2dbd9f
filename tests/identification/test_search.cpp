// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>

#include <catch2/catch.hpp>

#include "core_rig.hpp"

using namespace tread;
using namespace tread::gap;
using samples::Rig;
using samples::Values;

namespace {

using Names = std::vector<std::string>;

/// Result of a complete search on a drive with this ground roughness.
FoundTerms found(const Values& hidden, double seconds, uint64_t seed, double ground) {
  SyntheticNoise noise;
  noise.ground = ground;
  const Rig rig(hidden, seconds, seed, noise);
  SearchMemory memory;
  return search(rig.fitter, syntheticVehicle(), {}, memory, samples::kSilent);
}

/// The estimated delay, of the command or of the poses; 0 = none.
double delayOf(const FoundTerms& result) {
  for (const std::string& name : result.effects) {
    const Effect& effect = effectNamed(name);
    if (effect.search.late_by == LateBy::kCommand || effect.search.late_by == LateBy::kPoses)
      return *findParameter(result.state.model, primaryPath(effect));
  }
  return 0.0;
}

}  // namespace

// On this ground a step at the best time fits slightly better than the true slope, by less than a
// standard error.
TEST_CASE("a slow change that a step at some moment fits as well is told as what always acts") {
  const FoundTerms result = found({{"battery_sag.per_hour", 0.35}}, 400.0, 6, 0.05);
  CHECK(result.effects == Names{"battery_sag"});
  CHECK(*findParameter(result.state.model, "battery_sag.per_hour") == Approx(0.35).margin(0.1));
  const auto& beside = result.evidence.at("battery_sag").runner_ups;
  const auto step = std::find_if(beside.begin(), beside.end(), [](const RunnerUp& runner_up) {
    return runner_up.effect == "payload_change";
  });
  REQUIRE(step != beside.end());
  CHECK(step->behind < 0.0);
}

TEST_CASE("a step that is there stays one, though what always acts explains a part of it") {
  const FoundTerms result =
      found({{"payload_change.yaw", 0.2}, {"payload_change.time", 130.0}}, 400.0, 3, 0.04);
  CHECK(result.effects == Names{"payload_change"});
  CHECK(*findParameter(result.state.model, "payload_change.yaw") == Approx(0.2).margin(0.03));
  CHECK(*findParameter(result.state.model, "payload_change.time") == Approx(130.0).margin(10.0));
}

// With a lag of the drive, which is found first and too long, the delay is not significant.
TEST_CASE("a delay is found beside the lags of yaw rate and speed, and these get their sizes") {
  const FoundTerms result =
      found({{"yaw_inertia.lag", 1.0}, {"body_inertia.lag", 0.6}, {"command_delay.delay", 0.03}},
            300.0, 1, 0.03);
  CHECK(delayOf(result) == Approx(0.03).margin(0.01));
  CHECK(*findParameter(result.state.model, "yaw_inertia.lag") == Approx(1.0).margin(0.015));
  CHECK(*findParameter(result.state.model, "body_inertia.lag") == Approx(0.6).margin(0.015));
}

TEST_CASE("lags without a delay get none") {
  const FoundTerms result =
      found({{"yaw_inertia.lag", 1.0}, {"body_inertia.lag", 0.6}}, 300.0, 1, 0.03);
  CHECK(result.effects == Names{"yaw_inertia", "body_inertia"});
}

TEST_CASE("a loss on one track is one effect of that track, and an asymmetry of both stays one") {
  for (const auto& [path, value] : Values{{"left_track_loss.loss", 0.1},
                                          {"right_track_loss.loss", 0.06},
                                          {"track_asymmetry.share", 0.05}}) {
    INFO(path);
    const FoundTerms result = found({{path, value}}, 400.0, 7, 0.03);
    CHECK(result.effects == Names{effectOfPath(path)});
    CHECK(*findParameter(result.state.model, path) == Approx(value).margin(0.01));
  }
}
