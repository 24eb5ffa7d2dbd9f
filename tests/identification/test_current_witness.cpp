// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <random>

#include "core_rig.hpp"
#include "modules/identification/core/current_witness.hpp"
#include "modules/identification/core/discovery.hpp"
#include "modules/identification/core/witness.hpp"

using namespace tread;
using namespace tread::gap;
using samples::Rig;
using samples::Values;

namespace {

/// Components of a vehicle's motor currents.
struct Draw {
  /// [A s/m] for speed lost by the hidden effect; 0 = the effect is in the drive
  double load = 0.0;
  double friction = 0.0;  ///< [A] of dry friction in the gears
};

/// Currents at 20 Hz, positive forwards, of a vehicle with these effects.
/** `unloaded`: those of them that cause no load. */
std::vector<CurrentSample> currentsOf(const Values& hidden, const Drive& drive, const Draw& draw,
                                      const Values& unloaded = {}) {
  constexpr double kRolling = 10.0;  // [A s/m]
  constexpr double kScrub = 60.0;    // [A s/m] of half the difference of the tracks
  constexpr double kInertia = 5.0;   // [A s2/m]
  std::mt19937_64 random(5);
  std::normal_distribution<double> gauss(0.0, 0.5);
  const ModelDocument with = samples::vehicleWith(hidden);
  VehicleKernel vehicle(with.vehicle, EntryState{});
  VehicleKernel sound(samples::vehicleWith(unloaded).vehicle, EntryState{});
  const double arm = with.vehicle.gauge / 2.0;
  std::vector<CurrentSample> currents;
  Twist2 before;
  for (const CommandSample& command : drive.segments.front().commands) {
    const Twist2 moves = vehicle.twist();
    const Twist2 would = sound.twist();
    const TrackCommand tracks = vehicle.trackSpeeds();
    const auto track = [&](double side) {
      const double turn = side * arm * moves.omega;
      const double speed = moves.v_x + turn;
      const double change = (speed - before.v_x - side * arm * before.omega) / 0.05;
      const double lost = would.v_x - moves.v_x + side * arm * (would.omega - moves.omega);
      return kRolling * speed + kScrub * turn + kInertia * change + draw.load * lost +
             draw.friction * std::tanh(50.0 * (side < 0.0 ? tracks.left : tracks.right)) +
             gauss(random);
    };
    const double left = track(-1.0);
    currents.push_back({command.time, left, track(1.0)});
    before = moves;
    DriveContext context;
    context.session_time = command.time;
    vehicle.step(command.command.tracks(), 0.05, context);
    sound.step(command.command.tracks(), 0.05, context);
  }
  return currents;
}

using Change = void (*)(CurrentSample&, const TrackCommand&);

/// Evidence on the first hidden effect from modified currents.
std::optional<CurrentWitness> currentWitnessOf(const Values& hidden, const Draw& draw,
                                               Change change = nullptr) {
  Rig rig(hidden, 400.0, 3);
  Drive& drive = rig.drives.front();
  drive.currents = currentsOf(hidden, drive, draw);
  if (change != nullptr)
    for (size_t i = 0; i < drive.currents.size(); ++i)
      change(drive.currents[i], drive.segments.front().commands[i].command.tracks());
  std::vector<std::string> names;
  for (const auto& [path, value] : hidden) names.push_back(effectOf(path));
  const auto said = currentWitnesses(rig.fitter, rig.fitted(hidden), names);
  const auto first = said.find(names.front());
  return first == said.end() ? std::nullopt : std::optional(first->second);
}

const Values kDrag{{"quadratic_drag.drag", 0.3}};
const Draw kLoad{200.0, 0.0};

}  // namespace

TEST_CASE("with a load the motor currents rise, more than in proportion") {
  const Values loads[] = {kDrag, {{"turn_speed_loss.loss", 0.3}}, {{"yaw_pull.pull", 0.2}}};
  for (const Values& hidden : loads) {
    CAPTURE(hidden.front().first);
    const auto currents = currentWitnessOf(hidden, kLoad);
    REQUIRE(currents);
    CHECK(currents->rise > 2.0);
    CHECK(currents->low < currents->rise);
    CHECK(currents->high > currents->rise);
    CHECK(currents->saysLoad());
    CHECK_FALSE(currents->saysNoLoad());
  }
}

TEST_CASE("where the drive gives less they are what they are at the speed that is left") {
  const Values losses[] = {{{"speed_saturation.inverse_limit", 1.4}},
                           {{"battery_sag.per_hour", 2.0}},
                           {{"thermal_derating.loss", 0.3}}};
  for (const Values& hidden : losses) {
    for (const double friction : {0.0, 6.0}) {
      CAPTURE(hidden.front().first, friction);
      const auto currents = currentWitnessOf(hidden, {0.0, friction});
      REQUIRE(currents);
      CHECK(currents->rise == Approx(0.0).margin(0.4));
      CHECK(currents->saysNoLoad());
      CHECK_FALSE(currents->saysLoad());
    }
  }
}

TEST_CASE("a slower track that draws more drags, one that draws no more gives less") {
  const Values asymmetry{{"track_asymmetry.share", 0.08}};
  const auto drags = currentWitnessOf(asymmetry, kLoad);
  REQUIRE(drags);
  CHECK(drags->saysLoad());
  const auto weak = currentWitnessOf(asymmetry, {});
  REQUIRE(weak);
  CHECK(weak->saysNoLoad());
}

TEST_CASE("dry friction of gears is no load of an effect that looks like it") {
  const auto currents = currentWitnessOf({{"motor_deadband.speed", 0.15}}, {0.0, 6.0});
  CHECK((!currents || !currents->saysLoad()));
}

TEST_CASE("a load beside a weak drive: each is told for itself") {
  const Values both{{"quadratic_drag.drag", 0.3}, {"battery_sag.per_hour", 2.0}};
  Rig rig(both, 400.0, 3);
  Drive& drive = rig.drives.front();
  drive.currents = currentsOf(both, drive, kLoad, {both[1]});
  const auto said =
      currentWitnesses(rig.fitter, rig.fitted(both), {"quadratic_drag", "battery_sag"});
  REQUIRE(said.size() == 2);
  CHECK(said.at("quadratic_drag").saysLoad());
  CHECK(said.at("battery_sag").saysNoLoad());
}

TEST_CASE("it does not matter which way a controller counts currents") {
  const Change changes[] = {[](CurrentSample& current, const TrackCommand&) {
                              current.left = -current.left;
                              current.right = -current.right;
                            },
                            [](CurrentSample& current, const TrackCommand& command) {
                              current.left *= command.left < 0.0 ? -1.0 : 1.0;
                              current.right *= command.right < 0.0 ? -1.0 : 1.0;
                            }};
  for (const Change change : changes) {
    const auto load = currentWitnessOf(kDrag, kLoad, change);
    REQUIRE(load);
    CHECK(load->saysLoad());
    const auto weak = currentWitnessOf({{"battery_sag.per_hour", 2.0}}, {}, change);
    REQUIRE(weak);
    CHECK(weak->saysNoLoad());
  }
}

TEST_CASE("without currents, with NaN, stuck ones or ones of another machine nothing is said") {
  CHECK_FALSE(currentWitnessOf(kDrag, kLoad, [](CurrentSample& current, const TrackCommand&) {
    current.left = current.right = kNotMeasured;
  }));
  CHECK_FALSE(currentWitnessOf(kDrag, kLoad, [](CurrentSample& current, const TrackCommand&) {
    current.left = current.right = 0.0;
  }));
  CHECK_FALSE(currentWitnessOf(kDrag, kLoad, [](CurrentSample& current, const TrackCommand&) {
    current.left = current.right = 3.0;
  }));
  CHECK_FALSE(currentWitnessOf(kDrag, kLoad, [](CurrentSample& current, const TrackCommand&) {
    current.left = 20.0 * std::sin(7.0 * current.time);
    current.right = 20.0 * std::sin(11.0 * current.time);
  }));
  const Rig rig(kDrag, 300.0, 3);
  CHECK(currentWitnesses(rig.fitter, rig.fitted(kDrag), {"quadratic_drag"}).empty());
}

TEST_CASE("a NaN now and then costs that moment alone") {
  const auto currents =
      currentWitnessOf(kDrag, kLoad, [](CurrentSample& current, const TrackCommand&) {
        if (std::fmod(current.time, 5.0) < 0.3) current.left = kNotMeasured;
      });
  REQUIRE(currents);
  CHECK(currents->saysLoad());
}

TEST_CASE("currents say nothing of scales, of lags, of motion to the side, and of the INS") {
  const Values silent[] = {{{"slip_ratio.slip", 0.2}},
                           {{"yaw_inertia.lag", 0.8}},
                           {{"lag_asymmetry.slowing", 0.3}},
                           {{"centrifugal_drift.time", 0.2}},
                           {{"ins_latency.latency", 0.3}}};
  for (const Values& hidden : silent) {
    CAPTURE(hidden.front().first);
    CHECK_FALSE(currentWitnessOf(hidden, {}));
  }
}

TEST_CASE("what the currents say stands with the effect that was found") {
  Rig rig(kDrag, 400.0, 3);
  rig.drives.front().currents = currentsOf(kDrag, rig.drives.front(), kLoad);
  FoundTerms result;
  result.state = rig.fitted(kDrag);
  result.effects = {"quadratic_drag"};
  const FoundEffect effect =
      identifiedModel(rig.fitter, syntheticVehicle(), {}, result).effects.front();
  REQUIRE(effect.currents);
  CHECK(effect.currents->saysLoad());
  CHECK_FALSE(effect.wheels);
}
