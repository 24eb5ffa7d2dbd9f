// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/setup/trials.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/report/text.hpp"

namespace tread::setup {
namespace {

constexpr double kSilence = 1.2;       // [s] within which the watchdog must trip
constexpr double kRampStep = 0.02;     // of the full command
constexpr double kRampEvery = 0.15;    // [s]
constexpr int kDisturbances = 4;       // tolerated faults of the motor line in one drive
constexpr double kStandsSpeed = 0.05;  // [m/s] of the INS that counts as standstill

/// Motion of a side as reported by the controller: its speed if it measures one, else the current.
double toldMotion(const motor::MotorTelemetry& telemetry, int side) {
  const double speed = telemetry.measured[static_cast<size_t>(side)];
  const double current = telemetry.current[static_cast<size_t>(side)];
  return std::abs(std::isfinite(speed) ? 10.0 * speed : current);
}

TrackCommand ofSide(int side, double share) {
  return side == 0 ? TrackCommand{share, 0.0} : TrackCommand{0.0, share};
}

TrackCommand straight(const Drivers& drivers, double share) {
  return {share, drivers.isCar() ? 0.0 : share};
}

class Lift {
 public:
  Lift(Site& site, Interview& person, const Drivers& drivers)
      : person_(person), drivers_(drivers), robot_(site, drivers) {}

  LiftReport run() {
    require(robot_.begin());
    person_.confirm("wheels_up");
    if (drivers_.isCar()) {
      tryCar();
    } else {
      for (const int side : {0, 1}) {
        trySide(side);
        if (side == 0) ask();
      }
    }
    tryWatchdog();
    return report_;
  }

 private:
  void require(const std::string& problem) const {
    if (!problem.empty()) throw std::runtime_error(problem);
  }

  void hold(double seconds, const std::optional<TrackCommand>& command) {
    if (robot_.run(seconds, [&](int64_t) { return command; }).empty()) return;
    require(robot_.begin());
    require(robot_.run(seconds, [&](int64_t) { return command; }));
  }

  void trySide(int side) {
    const auto at = static_cast<size_t>(side);
    LiftedSide& lifted = report_.sides[at];
    hold(0.8, TrackCommand{});
    const double idle = toldMotion(robot_.telemetry(), side);
    const bool told = std::isfinite(idle);
    lifted.dead_power = std::nan("");
    for (double share = kRampStep; share <= kLiftedLevel; share += kRampStep) {
      hold(kRampEvery, ofSide(side, share));
      if (!told || toldMotion(robot_.telemetry(), side) < idle + 0.3) continue;
      lifted.dead_power = share - kRampStep;
      break;
    }
    hold(1.5, ofSide(side, kLiftedLevel));
    const motor::MotorTelemetry running = robot_.telemetry();
    lifted.current = running.current[static_cast<size_t>(side)];
    if (told && toldMotion(running, side) < idle + 0.3)
      report_.problems.push_back((drivers_.isCar() ? std::string("the throttle")
                                                   : std::string("the configured ") +
                                                         (side == 0 ? "left" : "right") + " side") +
                                 " draws no current and does not turn at 40 %: look at its "
                                 "motor, its fuse and its channel");
    hold(0.6, TrackCommand{});
  }

  /// A servo has no feedback, so a person must watch it.
  void tryCar() {
    trySide(0);
    report_.seen.forward = person_.choice("first_direction", {"forward", "backward"}) == "forward";
    for (const double share : {1.0, -1.0, 0.0}) hold(1.0, TrackCommand{0.0, share});
    report_.seen.side = person_.choice("first_steering", {"left", "right"}) == "left"
                            ? commissioning::Side::kLeft
                            : commissioning::Side::kRight;
  }

  void ask() {
    report_.seen.side = person_.choice("first_track", {"left", "right"}) == "left"
                            ? commissioning::Side::kLeft
                            : commissioning::Side::kRight;
    report_.seen.forward = person_.choice("first_direction", {"forward", "backward"}) == "forward";
  }

  /// Stops sending: the controller must stop by itself. Afterwards it gets zero commands anyway, so
  /// only a person can see which of the two stopped it.
  void tryWatchdog() {
    hold(1.0, straight(drivers_, kLiftedLevel));
    hold(kSilence, std::nullopt);
    require(robot_.begin());
    hold(0.5, TrackCommand{});
    if (person_.choice("watchdog_stopped", {"yes", "no"}) == "no")
      throw std::runtime_error(
          "the controller does not stop when its line falls silent: set up its "
          "watchdog, or choose a controller with a watchdog; the robot must not drive without one");
  }

  Interview& person_;
  Drivers drivers_;
  DirectRobot robot_;
  LiftReport report_;
};

/// [s] until the INS shows standstill after commands cease.
double coastAfterSilence(DirectRobot& robot, const TrackCommand& command) {
  robot.run(1.0, [&](int64_t) { return command; });
  const int64_t last = robot.commands().back().utime;
  std::optional<double> stopped;
  const auto standing = [&] {
    const auto& fixes = robot.fixes();
    if (fixes.size() < 12) return false;
    const TimedPose& now = fixes.back();
    const TimedPose& then = fixes[fixes.size() - 11];
    const double time = 1e-6 * static_cast<double>(now.utime - then.utime);
    const bool stands =
        then.utime > last && distanceBetween(then.T_map_body, now.T_map_body) < kStandsSpeed * time;
    if (stands) stopped = 1e-6 * static_cast<double>(then.utime - last);
    return stands;
  };
  robot.run(
      kSilence + 1.0, [](int64_t) { return std::nullopt; }, standing);
  robot.begin();
  robot.run(0.3, [](int64_t) { return TrackCommand{}; });
  return stopped.value_or(kSilence + 1.0);
}

}  // namespace

LiftReport tryWheelsUp(Site& site, Interview& person, const Drivers& drivers) {
  return Lift(site, person, drivers).run();
}

GroundReport tryWheelsDown(Site& site, const Drivers& drivers,
                           const commissioning::WiringDriveConfig& how,
                           const commissioning::WiringExpectation& expected, bool watchdog) {
  GroundReport report;
  DirectRobot robot(site, drivers);
  report.problem = robot.begin();
  if (!report.problem.empty()) return report;
  robot.run(0.5, [](int64_t) { return TrackCommand{}; });
  commissioning::WiringDriveConfig config = how;
  config.car = drivers.isCar();
  commissioning::WiringDrive drive(config);
  std::string fault;
  // A short fault of the line does not end the drive.
  for (int i = 0; i < kDisturbances && (i == 0 || robot.begin().empty()); ++i) {
    fault = robot.run(
        2.0 * how.seconds + 10.0, [&](int64_t now) { return drive.step(now, robot.takePose()); },
        [&] { return drive.done(); });
    if (fault.empty()) break;
  }
  robot.run(0.5, [](int64_t) { return TrackCommand{}; });
  report.problem = fault.empty() ? drive.problem() : fault;
  report.commands = robot.commands();
  report.fixes = robot.fixes();
  commissioning::WiringExpectation told = expected;
  told.wheelbase = drivers.wheelbase;
  report.wiring = commissioning::checkWiring(report.commands, report.fixes, told);
  if (watchdog && report.problem.empty() && !report.wiring.has(commissioning::FaultKind::kNoMotion))
    report.watchdog = coastAfterSilence(robot, straight(drivers, 0.5));
  return report;
}

namespace {

/// Shifts the servo's ends so that zero steering is straight ahead and both sides are equal.
void centreServo(const commissioning::WiringReport& wiring, RobotFindings& findings) {
  if (findings.controller.kind != "vesc") return;
  const double reach = 0.5 * (wiring.steering_left.value - wiring.steering_right.value);
  const double askew = wiring.steering_straight.value;
  const double even = reach - std::abs(askew);
  const double middle = 0.5 * (findings.servo_left + findings.servo_right);
  const double half = 0.5 * (findings.servo_left - findings.servo_right);
  const double turned = findings.robot.drive.invert_right ? -1.0 : 1.0;
  const auto position = [&](double angle) {
    return std::clamp(middle + turned * half * (angle - askew) / reach, 0.0, 1.0);
  };
  findings.servo_left = position(turned * even);
  findings.servo_right = position(-turned * even);
  findings.controller.section = carSection(findings);
}

void applyToCar(const commissioning::WiringReport& wiring, RobotFindings& findings) {
  DriveDescription& drive = findings.robot.drive;
  if (!wiring.moves[0].forward) drive.invert_left = !drive.invert_left;
  if (!wiring.moves[1].forward) drive.invert_right = !drive.invert_right;
  if (wiring.has(commissioning::FaultKind::kSteeringAskew)) centreServo(wiring, findings);
}

void applyToSides(const commissioning::WiringReport& wiring, DriveDescription& drive) {
  const DriveDescription before = drive;
  for (const int i : {0, 1}) {
    const commissioning::SideMotion& moves = wiring.moves[static_cast<size_t>(i)];
    const bool inverted = (i == 0 ? before.invert_left : before.invert_right) != !moves.forward;
    (moves.side == commissioning::Side::kLeft ? drive.invert_left : drive.invert_right) = inverted;
  }
  if (wiring.moves[0].side == commissioning::Side::kRight)
    drive.left_channel = 3 - before.left_channel;
}

}  // namespace

void applyWiring(const commissioning::WiringReport& wiring, RobotFindings& findings) {
  if (findings.robot.drive.isCar()) {
    applyToCar(wiring, findings);
  } else {
    applyToSides(wiring, findings.robot.drive);
  }
  double& yaw = findings.robot.ins.angles.yaw;
  if (wiring.has(commissioning::FaultKind::kInsTurned))
    yaw = wrapAngle(yaw + wiring.mounting_yaw.value);
}

}  // namespace tread::setup
