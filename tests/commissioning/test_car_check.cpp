// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The short drive of a car: conclusions about throttle, steering and INS, over simulated cars and
// grounds that were not used for tuning.
#include <catch2/catch.hpp>

#include <random>

#include "modules/commissioning/core/wiring_check.hpp"
#include "modules/commissioning/core/wiring_drive.hpp"
#include "modules/simulator/simulator_files.hpp"
#include "tests/helpers.hpp"

using namespace tread;
using namespace tread::commissioning;
using tread::testing::effort;
using tread::testing::kDeg;

namespace {

/// A car with hidden properties.
struct HiddenCar {
  bool throttle_reversed = false;
  bool steering_reversed = false;
  bool steering_dead = false;
  bool mirrored = false;
  double askew = 0.0;  ///< [1] relative to the full steering
  double ins_yaw = 0.0, ins_x = 0.0, ins_y = 0.0;
  double wheelbase = 0.9;
  double steering_rate = 2.0;
  double faster = 1.0;
  std::string surface = "tarmac";
};

struct DrivenCar {
  std::vector<TimedCommand> commands;
  std::vector<TimedPose> fixes;
  std::string problem;
  double path = 0.0, farthest = 0.0, fastest = 0.0;
};

DrivenCar driveCar(const HiddenCar& hidden, WiringDriveConfig how, uint64_t seed) {
  sim::RobotSettings settings =
      sim::readSimulatedRobot(std::string(TREAD_SOURCE_DIR) + "/tests/data/robots/car");
  settings.seed = seed;
  settings.vehicle.wheelbase = hidden.wheelbase;
  settings.vehicle.steering_rate = hidden.steering_rate;
  settings.vehicle.drive.free_speed *= hidden.faster;
  settings.ins.mounting.angles.yaw = hidden.ins_yaw;
  settings.ins.mounting.p_body = {hidden.ins_x, hidden.ins_y, 0.0};
  sim::WorldDescription world;
  world.base_surface = hidden.surface;
  sim::SimulatedRobot robot(std::make_shared<const sim::World>(world), settings);
  how.car = true;
  WiringDrive chooser(how);
  DrivenCar driven;
  std::optional<Pose2> pose;
  for (int64_t t = 0; !chooser.done(); t += 10'000) {
    robot.advanceTo(t);
    for (const sim::InsMeasurement& sample : robot.takeInsSamples()) {
      pose = Pose2{sample.p_map.x(), sample.p_map.y(), hidden.mirrored ? -sample.yaw : sample.yaw};
      driven.fixes.push_back({sample.utime, *pose});
    }
    driven.farthest = std::max(driven.farthest, robot.truth().T_map_body.position().norm());
    driven.fastest = std::max(driven.fastest, robot.vehicle().velocity().v_x);
    if (t % 50'000 != 0) continue;
    const TrackCommand given = chooser.step(t, pose);
    pose.reset();
    driven.commands.push_back({t, given});
    const double steering = hidden.steering_dead ? 0.0 : given.right;
    robot.setPower({hidden.throttle_reversed ? -given.left : given.left,
                    (hidden.steering_reversed ? -steering : steering) + hidden.askew});
  }
  driven.problem = chooser.problem();
  driven.path = robot.truth().distance;
  return driven;
}

WiringExpectation carOf(const HiddenCar& hidden, bool seen) {
  WiringExpectation expected;
  expected.wheelbase = hidden.wheelbase;
  if (seen)
    expected.seen = SideMotion{hidden.steering_reversed ? Side::kRight : Side::kLeft,
                               !hidden.throttle_reversed};
  return expected;
}

std::string carWords(const WiringReport& report) {
  std::string words = report.unsure;
  for (const WiringFault& fault : report.faults) words += fault.words + "\n";
  return words;
}

/// Whether exactly the hidden faults were reported.
bool carNamed(const HiddenCar& hidden, const WiringReport& report) {
  const bool turned = std::abs(hidden.ins_yaw) > 0.1;
  return report.unsure.empty() && report.has(FaultKind::kReversed) == hidden.throttle_reversed &&
         report.has(FaultKind::kSteeringReversed) == hidden.steering_reversed &&
         report.has(FaultKind::kSteeringDead) == hidden.steering_dead &&
         report.has(FaultKind::kInsMirrored) == hidden.mirrored &&
         (report.has(FaultKind::kInsTurned) == turned || hidden.mirrored);
}

double between(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1.0p-53;
}

HiddenCar drawnCar(std::mt19937_64& random) {
  HiddenCar hidden;
  const std::vector<std::string> surfaces{"tarmac", "gravel", "grass", "cinder"};
  hidden.surface = surfaces[random() % surfaces.size()];
  hidden.wheelbase = between(random, 0.6, 1.4);
  hidden.steering_rate = between(random, 1.0, 4.0);
  hidden.faster = between(random, 0.7, 1.6);
  return hidden;
}

/// Each fault alone, two together, and none.
HiddenCar withFault(HiddenCar hidden, int kind) {
  hidden.throttle_reversed = kind == 1 || kind == 3;
  hidden.steering_reversed = kind == 2 || kind == 3;
  if (kind == 4) hidden.ins_yaw = 90.0 * kDeg;
  if (kind == 5) hidden.ins_yaw = kPi;
  hidden.steering_dead = kind == 6;
  hidden.mirrored = kind == 7;
  return hidden;
}
constexpr int kFaults = 8;

}  // namespace

TEST_CASE("a car's minute stays in its circle and names every wrong part on any ground") {
  std::mt19937_64 random(20261126);
  int named = 0, all = 0;
  for (int i = 0; i < effort(5); ++i)
    for (int kind = 0; kind < kFaults; ++kind) {
      const HiddenCar hidden = withFault(drawnCar(random), kind);
      const DrivenCar driven = driveCar(hidden, {}, random());
      CHECK(driven.problem == "");
      CHECK(driven.farthest < 5.0);
      const WiringReport report = checkWiring(driven.commands, driven.fixes, carOf(hidden, true));
      ++all;
      if (carNamed(hidden, report)) {
        ++named;
      } else {
        UNSCOPED_INFO("kind " << kind << " on " << hidden.surface << ": " << carWords(report));
      }
    }
  CHECK(named == all);
}

TEST_CASE("a car's numbers hold: speed, mounting and place of the INS, angle of its wheels") {
  std::mt19937_64 random(7);
  int speed = 0, yaw = 0, place = 0, askew = 0, all = 0;
  for (int i = 0; i < effort(12); ++i) {
    HiddenCar hidden = drawnCar(random);
    hidden.surface = "tarmac";
    hidden.ins_yaw = between(random, -0.5, 0.5);
    hidden.ins_x = between(random, -0.3, 0.6);
    hidden.ins_y = between(random, -0.3, 0.3);
    hidden.askew = i % 2 == 0 ? 0.2 : 0.0;
    const DrivenCar driven = driveCar(hidden, {}, random());
    const WiringReport report = checkWiring(driven.commands, driven.fixes, carOf(hidden, true));
    ++all;
    UNSCOPED_INFO("speed " << report.full_left.value << " of " << driven.fastest << ", yaw "
                           << report.mounting_yaw.value << " of " << hidden.ins_yaw << ", place "
                           << report.antenna_x.value << " " << report.antenna_y.value << " of "
                           << hidden.ins_x << " " << hidden.ins_y << ", straight "
                           << report.steering_straight.value << ", left "
                           << report.steering_left.value << ", right "
                           << report.steering_right.value << ", lag " << report.steering_lag.value);
    speed += std::abs(report.full_left.value / driven.fastest - 1.0) < 0.1;
    yaw += std::abs(wrapAngle(report.mounting_yaw.value - hidden.ins_yaw)) < 0.03;
    place += std::hypot(report.antenna_x.value - hidden.ins_x,
                        report.antenna_y.value - hidden.ins_y) < 0.12;
    askew += report.has(FaultKind::kSteeringAskew) == (hidden.askew != 0.0);
  }
  CHECK(speed == all);
  CHECK(yaw == all);
  CHECK(place == all);
  CHECK(askew == all);
}

TEST_CASE("before a drive a car's wrong parts are named within less than a metre of path") {
  std::mt19937_64 random(77);
  int named = 0, all = 0;
  for (int i = 0; i < effort(5); ++i)
    for (int kind = 0; kind < kFaults; ++kind) {
      const HiddenCar hidden = withFault(drawnCar(random), kind);
      const DrivenCar driven = driveCar(hidden, preDrive(true), random());
      CHECK(driven.path < 1.0);
      WiringExpectation expected = carOf(hidden, false);
      expected.brief = true;
      const WiringReport report = checkWiring(driven.commands, driven.fixes, expected);
      ++all;
      // Throttle and steering both reversed look like an INS turned by 180 deg, and on such a short
      // drive a mirrored one looks like reversed steering: both are reported.
      const bool either = (kind == 3 && report.has(FaultKind::kInsTurned)) ||
                          (kind == 7 && report.has(FaultKind::kSteeringReversed));
      if (carNamed(hidden, report) || either) {
        ++named;
      } else {
        UNSCOPED_INFO("kind " << kind << " on " << hidden.surface << ", path " << driven.path
                              << ": " << carWords(report));
      }
    }
  CHECK(named == all);
}
