// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <random>

#include "core_rig.hpp"
#include "modules/identification/core/evidence.hpp"
#include "modules/identification/core/identified_model.hpp"

using namespace tread;
using namespace tread::gap;
using samples::encodersOf;
using samples::Rig;
using samples::Values;

namespace {

/// Evidence of wheels that follow the tracks of `tracks`, for the effects hidden in a drive, in
/// order.
std::vector<std::optional<MeasuredEvidence>> wheelsOf(const Values& hidden, const Values& tracks,
                                                      double late = 0.0) {
  Rig rig(hidden, 400.0, 3);
  rig.drives.front().encoders = encodersOf(samples::vehicleWith(tracks), rig.drives.front(), late);
  std::vector<std::string> names;
  for (const auto& [path, value] : hidden) names.push_back(effectOf(path));
  const auto said = evidenceBy(EvidenceSource::kWheels, rig.fitter, rig.fitted(hidden), names);
  std::vector<std::optional<MeasuredEvidence>> shown;
  for (const std::string& name : names) {
    const auto one = said.find(name);
    shown.push_back(one == said.end() ? std::nullopt : std::optional(one->second));
  }
  return shown;
}

std::optional<MeasuredEvidence> wheelOf(const Values& hidden, const Values& tracks,
                                        double late = 0.0) {
  return wheelsOf(hidden, tracks, late).front();
}

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
std::optional<MeasuredEvidence> currentOf(const Values& hidden, const Draw& draw,
                                          Change change = nullptr) {
  Rig rig(hidden, 400.0, 3);
  Drive& drive = rig.drives.front();
  drive.currents = currentsOf(hidden, drive, draw);
  if (change != nullptr)
    for (size_t i = 0; i < drive.currents.size(); ++i)
      change(drive.currents[i], drive.segments.front().commands[i].command.tracks());
  std::vector<std::string> names;
  for (const auto& [path, value] : hidden) names.push_back(effectOf(path));
  const auto said = evidenceBy(EvidenceSource::kCurrents, rig.fitter, rig.fitted(hidden), names);
  const auto first = said.find(names.front());
  return first == said.end() ? std::nullopt : std::optional(first->second);
}

const Values kDrag{{"quadratic_drag.drag", 0.3}};
const Draw kLoad{200.0, 0.0};

constexpr double kVoltageDrive = 400.0;  // [s]
const Values kSag{{"battery_sag.per_hour", 1.8}};

/// Evidence on the hidden effect from a voltage of 25 V that falls linearly by a share.
std::optional<MeasuredEvidence> voltageOf(const Values& hidden, double falls) {
  Rig rig(hidden, kVoltageDrive, 3);
  for (double time = 0.0; time < kVoltageDrive; time += 0.05)
    rig.drives.front().voltage.push_back({time, 25.0 * (1.0 - falls * time / kVoltageDrive)});
  const auto said = evidenceBy(EvidenceSource::kVoltage, rig.fitter, rig.fitted(hidden),
                               {effectOf(hidden[0].first)});
  return said.empty() ? std::nullopt : std::optional(said.begin()->second);
}

}  // namespace

TEST_CASE("of an effect in the drive the wheel speeds show all, whatever the wheels' scale") {
  const Values limit{{"speed_saturation.inverse_limit", 1.4}};
  const auto wheels = wheelOf(limit, limit);
  REQUIRE(wheels);
  CHECK(wheels->value == Approx(1.0).margin(0.1));
  CHECK(wheels->low < wheels->value);
  CHECK(wheels->high > wheels->value);
  CHECK(wheels->confirms());
  CHECK_FALSE(wheels->refutes());
}

TEST_CASE("of an effect under the wheels they show nothing") {
  const auto wheels = wheelOf({{"yaw_inertia.lag", 0.8}}, {});
  REQUIRE(wheels);
  CHECK(wheels->value == Approx(0.0).margin(0.1));
  CHECK(wheels->refutes());
  CHECK_FALSE(wheels->confirms());
}

TEST_CASE("a lag that the wheels have, too, is in the drive, also where encoders are late") {
  const Values lag{{"actuator_lag.lag", 0.6}};
  for (const double late : {0.0, 0.125}) {
    const auto wheels = wheelOf(lag, lag, late);
    REQUIRE(wheels);
    CHECK(wheels->value > 0.9);
    CHECK(wheels->value < 1.4);
    CHECK(wheels->confirms());
  }
}

TEST_CASE("a lag in the drive beside one under the wheels: together they are in neither") {
  const Values drive{{"actuator_lag.lag", 0.4}};
  const auto both = wheelsOf({{"actuator_lag.lag", 0.4}, {"yaw_inertia.lag", 0.6}}, drive);
  for (const auto& wheels : both) {
    if (!wheels) continue;  // too vague to decide
    CHECK(wheels->of_lags);
    CHECK(wheels->value > 0.1);
    CHECK(wheels->value < 0.9);
  }
}

TEST_CASE("an effect in the drive beside one under the wheels: each is told for itself") {
  const Values limit{{"speed_saturation.inverse_limit", 1.4}};
  const auto wheels =
      wheelsOf({{"speed_saturation.inverse_limit", 1.4}, {"yaw_inertia.lag", 0.8}}, limit);
  REQUIRE(wheels[0]);
  REQUIRE(wheels[1]);
  CHECK(wheels[0]->value == Approx(1.0).margin(0.15));
  CHECK(wheels[0]->confirms());
  CHECK(wheels[1]->value == Approx(0.0).margin(0.15));
  CHECK(wheels[1]->refutes());
  CHECK_FALSE(wheels[1]->of_lags);
}

TEST_CASE(
    "wheel speeds say nothing of scales, of motion to the side, of the INS, and without any") {
  CHECK_FALSE(wheelOf({{"slip_ratio.slip", 0.2}}, {}));
  CHECK_FALSE(wheelOf({{"centrifugal_drift.time", 0.2}}, {}));
  CHECK_FALSE(wheelOf({{"ins_latency.latency", 0.3}}, {}));
  const Rig rig({{"yaw_inertia.lag", 0.8}}, 300.0, 3);
  CHECK(evidenceBy(EvidenceSource::kWheels, rig.fitter, rig.fitted({{"yaw_inertia.lag", 0.8}}),
                   {"yaw_inertia"})
            .empty());
}

TEST_CASE("a delay that the wheels have is no latency of the INS any more") {
  const Values delay{{"command_delay.delay", 0.4}};
  Rig rig(delay, 400.0, 3);
  const auto found = [&] {
    FoundTerms result;
    result.state = rig.fitted(delay);
    result.effects = {"command_delay"};
    return identifiedModel(rig.fitter, syntheticVehicle(), {}, result).effects.front();
  };
  CHECK(found().group == std::vector<std::string>{"ins_latency"});
  rig.drives.front().encoders = encodersOf(samples::vehicleWith(delay), rig.drives.front());
  REQUIRE(found().evidence.size() == 1);
  CHECK(found().evidence.front().confirms());
  CHECK(found().group.empty());
}

TEST_CASE("encoders that are late themselves do not make a short latency of the INS a delay") {
  const Values delay{{"command_delay.delay", 0.12}};
  Rig rig(delay, 400.0, 3);
  // The tracks have no delay; the encoders are late by as much.
  rig.drives.front().encoders = encodersOf(samples::vehicleWith({}), rig.drives.front(), 0.12);
  FoundTerms result;
  result.state = rig.fitted(delay);
  result.effects = {"command_delay"};
  const FoundEffect effect =
      identifiedModel(rig.fitter, syntheticVehicle(), {}, result).effects.front();
  CHECK(effect.group == std::vector<std::string>{"ins_latency"});
}

TEST_CASE("of two effects that resemble each other wheels say one thing, or nothing") {
  // A drive turns to one side by an asymmetry that the wheels show completely, and by a pull.
  const Values both{{"track_asymmetry.share", 0.05}, {"yaw_pull.pull", 0.05}};
  for (const auto& said : wheelsOf(both, {{"track_asymmetry.share", 0.05}})) CHECK_FALSE(said);
  // If the wheels show everything there is no contradiction.
  const auto alone = wheelOf({{"track_asymmetry.share", 0.05}}, {{"track_asymmetry.share", 0.05}});
  REQUIRE(alone);
  CHECK(alone->confirms());
}

TEST_CASE("with a load the motor currents rise, more than in proportion") {
  const Values loads[] = {kDrag, {{"turn_speed_loss.loss", 0.3}}, {{"yaw_pull.pull", 0.2}}};
  for (const Values& hidden : loads) {
    CAPTURE(hidden.front().first);
    const auto currents = currentOf(hidden, kLoad);
    REQUIRE(currents);
    CHECK(currents->value > 2.0);
    CHECK(currents->low < currents->value);
    CHECK(currents->high > currents->value);
    CHECK(currents->confirms());
    CHECK_FALSE(currents->refutes());
  }
}

TEST_CASE("where the drive gives less they are what they are at the speed that is left") {
  const Values losses[] = {{{"speed_saturation.inverse_limit", 1.4}},
                           {{"battery_sag.per_hour", 2.0}},
                           {{"thermal_derating.loss", 0.3}}};
  for (const Values& hidden : losses) {
    for (const double friction : {0.0, 6.0}) {
      CAPTURE(hidden.front().first, friction);
      const auto currents = currentOf(hidden, {0.0, friction});
      REQUIRE(currents);
      CHECK(currents->value == Approx(0.0).margin(0.4));
      CHECK(currents->refutes());
      CHECK_FALSE(currents->confirms());
    }
  }
}

TEST_CASE("a slower track that draws more drags, one that draws no more gives less") {
  const Values asymmetry{{"track_asymmetry.share", 0.08}};
  const auto drags = currentOf(asymmetry, kLoad);
  REQUIRE(drags);
  CHECK(drags->confirms());
  const auto weak = currentOf(asymmetry, {});
  REQUIRE(weak);
  CHECK(weak->refutes());
}

TEST_CASE("dry friction of gears is no load of an effect that looks like it") {
  const auto currents = currentOf({{"motor_deadband.speed", 0.15}}, {0.0, 6.0});
  CHECK((!currents || !currents->confirms()));
}

TEST_CASE("a load beside a weak drive: each is told for itself") {
  const Values both{{"quadratic_drag.drag", 0.3}, {"battery_sag.per_hour", 2.0}};
  Rig rig(both, 400.0, 3);
  Drive& drive = rig.drives.front();
  drive.currents = currentsOf(both, drive, kLoad, {both[1]});
  const auto said = evidenceBy(EvidenceSource::kCurrents, rig.fitter, rig.fitted(both),
                               {"quadratic_drag", "battery_sag"});
  REQUIRE(said.size() == 2);
  CHECK(said.at("quadratic_drag").confirms());
  CHECK(said.at("battery_sag").refutes());
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
    const auto load = currentOf(kDrag, kLoad, change);
    REQUIRE(load);
    CHECK(load->confirms());
    const auto weak = currentOf({{"battery_sag.per_hour", 2.0}}, {}, change);
    REQUIRE(weak);
    CHECK(weak->refutes());
  }
}

TEST_CASE("without currents, with NaN, stuck ones or ones of another machine nothing is said") {
  CHECK_FALSE(currentOf(kDrag, kLoad, [](CurrentSample& current, const TrackCommand&) {
    current.left = current.right = kNotMeasured;
  }));
  CHECK_FALSE(currentOf(kDrag, kLoad, [](CurrentSample& current, const TrackCommand&) {
    current.left = current.right = 0.0;
  }));
  CHECK_FALSE(currentOf(kDrag, kLoad, [](CurrentSample& current, const TrackCommand&) {
    current.left = current.right = 3.0;
  }));
  CHECK_FALSE(currentOf(kDrag, kLoad, [](CurrentSample& current, const TrackCommand&) {
    current.left = 20.0 * std::sin(7.0 * current.time);
    current.right = 20.0 * std::sin(11.0 * current.time);
  }));
  const Rig rig(kDrag, 300.0, 3);
  CHECK(evidenceBy(EvidenceSource::kCurrents, rig.fitter, rig.fitted(kDrag), {"quadratic_drag"})
            .empty());
}

TEST_CASE("a NaN now and then costs that moment alone") {
  const auto currents = currentOf(kDrag, kLoad, [](CurrentSample& current, const TrackCommand&) {
    if (std::fmod(current.time, 5.0) < 0.3) current.left = kNotMeasured;
  });
  REQUIRE(currents);
  CHECK(currents->confirms());
}

TEST_CASE("currents say nothing of scales, of lags, of motion to the side, and of the INS") {
  const Values silent[] = {{{"slip_ratio.slip", 0.2}},
                           {{"yaw_inertia.lag", 0.8}},
                           {{"lag_asymmetry.slowing", 0.3}},
                           {{"centrifugal_drift.time", 0.2}},
                           {{"ins_latency.latency", 0.3}}};
  for (const Values& hidden : silent) {
    CAPTURE(hidden.front().first);
    CHECK_FALSE(currentOf(hidden, {}));
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
  REQUIRE(effect.evidence.size() == 1);
  CHECK(effect.evidenceBy(EvidenceSource::kCurrents)->confirms());
}

TEST_CASE("a voltage that falls as much as the motion says that it is the battery") {
  const auto voltage = voltageOf(kSag, 0.2);  // 1.8 per hour are 20 % in 400 s
  REQUIRE(voltage);
  CHECK(voltage->value == Approx(1.0).margin(0.25));
  CHECK(voltage->low < voltage->value);
  CHECK(voltage->high > voltage->value);
  CHECK(voltage->confirms());
  CHECK_FALSE(voltage->refutes());
}

TEST_CASE("a voltage that stays says that it is something else") {
  const auto voltage = voltageOf(kSag, 0.001);
  REQUIRE(voltage);
  CHECK(voltage->value == Approx(0.0).margin(0.05));
  CHECK(voltage->refutes());
  CHECK_FALSE(voltage->confirms());
}

TEST_CASE("other ground from a time on is not the battery, whose voltage falls all along") {
  const auto voltage =
      voltageOf({{"terrain_change.slip_1", 0.2}, {"terrain_change.time_1", 200.0}}, 0.02);
  REQUIRE(voltage);
  CHECK(voltage->refutes());
}

TEST_CASE("the voltage says nothing of what does not change with time, and of the INS") {
  CHECK_FALSE(voltageOf({{"rolling_resistance.speed", 0.1}}, 0.2));
  CHECK_FALSE(voltageOf({{"slip_ratio.slip", 0.2}}, 0.2));
  CHECK_FALSE(voltageOf({{"ins_latency.latency", 0.3}}, 0.2));
}

TEST_CASE("without a voltage, with NaN or with one that is stuck nothing is said") {
  Rig rig(kSag, kVoltageDrive, 3);
  const FitState state = rig.fitted(kSag);
  CHECK(evidenceBy(EvidenceSource::kVoltage, rig.fitter, state, {"battery_sag"}).empty());
  for (const double stuck : {kNotMeasured, 0.0, 25.0}) {
    rig.drives.front().voltage.clear();
    for (double time = 0.0; time < kVoltageDrive; time += 0.05)
      rig.drives.front().voltage.push_back({time, stuck});
    CHECK(evidenceBy(EvidenceSource::kVoltage, rig.fitter, state, {"battery_sag"}).empty());
  }
}

TEST_CASE("what the voltage says stands with the effect that was found") {
  Rig rig(kSag, kVoltageDrive, 3);
  for (double time = 0.0; time < kVoltageDrive; time += 0.05)
    rig.drives.front().voltage.push_back({time, time < 200.0 ? 25.0 : 24.9});
  FoundTerms result;
  result.state = rig.fitted(kSag);
  result.effects = {"battery_sag"};
  const FoundEffect effect =
      identifiedModel(rig.fitter, syntheticVehicle(), {}, result).effects.front();
  REQUIRE(effect.evidence.size() == 1);
  CHECK(effect.evidenceBy(EvidenceSource::kVoltage)->refutes());
}
