// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include <catch2/catch.hpp>

#include "common/geometry/se2.hpp"
#include "modules/motor_bridge/core/motion_monitor.hpp"

using namespace tread;
using namespace tread::motor;

namespace {

/// A tracked robot with a good INS at 50 Hz, and a monitor. Each part can be made faulty.
struct Drive {
  explicit Drive(const MotionLimits& limits = {}) : monitor(limits) {}

  MotionMonitor monitor;
  TrackCommand command;
  MotorTelemetry motors;
  /// [1] share of the commanded speed that becomes motion
  double slip_left = 0.85, slip_right = 0.85;
  double turn_slip = 0.6;
  Twist2 shove;  ///< [m/s, rad/s] additional real motion
  Pose2 offset;  ///< of the INS's pose
  Twist2 drift;  ///< of that offset, in map, per second
  double noise = 1.0;
  bool velocity = true, gyro = true;
  std::function<void(InsMotion&)> spoil = [](InsMotion&) {};

  /// Drives for a time [s]; returns the verdict, if any, and its time from now [s].
  std::pair<double, std::string> run(double seconds) {
    for (int i = 0; i < static_cast<int>(50.0 * seconds + 0.5); ++i) {
      const std::string verdict = step();
      if (!verdict.empty()) return {0.02 * (i + 1), verdict};
    }
    return {99.0, ""};
  }
  /// Drives for a time [s] and ignores verdicts.
  void settle(double seconds) {
    for (double t = 0.0; t < seconds; t += 0.02) run(0.02);
  }
  /// The same after healthy driving, which must have no verdict.
  void good(double left, double right, double seconds = 4.0) {
    command = {left, right};
    CHECK(run(seconds).second.empty());
  }

 private:
  double gauss(double sigma) { return noise * sigma * normal_(random_); }
  std::string step() {
    constexpr double kInterval = 0.02;
    utime_ += 20'000;
    monitor.command(command, utime_ - 15'000);
    monitor.receive(motors);
    const double share = 1.0 - std::exp(-kInterval / 0.2);
    left_ += share * (1.1 * slip_left * command.left - left_);
    right_ += share * (1.1 * slip_right * command.right - right_);
    const Twist2 v{0.5 * (left_ + right_) + shove.v_x, shove.v_y,
                   turn_slip * (right_ - left_) / 0.6 + shove.omega};
    truth_ = truth_ * Pose2{v.v_x * kInterval, v.v_y * kInterval, v.omega * kInterval};
    offset.x += drift.v_x * kInterval;
    offset.y += drift.v_y * kInterval;
    offset.yaw += drift.omega * kInterval;
    monitor.receive(measured(v));
    return monitor.fault(utime_).words;
  }
  InsMotion measured(const Twist2& v) {
    InsMotion ins;
    ins.utime = utime_;
    ins.x = truth_.x + offset.x + gauss(0.003);
    ins.y = truth_.y + offset.y + gauss(0.003);
    ins.yaw = wrapAngle(truth_.yaw + offset.yaw + gauss(0.001));
    ins.position_std = 0.02;
    if (velocity) {
      ins.v_forward = v.v_x + gauss(0.01);
      ins.v_left = v.v_y + gauss(0.01);
    }
    if (gyro) ins.yaw_rate = v.omega + gauss(0.002);
    spoil(ins);
    return ins;
  }

  std::mt19937_64 random_{7};
  std::normal_distribution<double> normal_;
  int64_t utime_ = 10'000'000;
  double left_ = 0.0, right_ = 0.0;
  Pose2 truth_;
};

/// Checks that it was reported in time, in one short line with this beginning.
void checkTold(const std::pair<double, std::string>& told, const std::string& begin,
               double limit = 1.5) {
  INFO(told.first << " s: " << told.second);
  CHECK(told.first <= limit);
  CHECK(told.second.find(begin) == 0);
  CHECK(told.second.size() <= 120);
  CHECK(told.second.find('\n') == std::string::npos);
}

}  // namespace

TEST_CASE("motion: every way of driving well is explained") {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> power(-1.0, 1.0);
  for (const double slip : {0.6, 0.85, 1.05}) {
    Drive drive;
    drive.slip_left = drive.slip_right = slip;
    for (int i = 0; i < 200; ++i)
      drive.good(power(random), power(random), 0.2 + 2.0 * std::abs(power(random)));
    drive.good(0.0, 0.0, 5.0);
  }
}

TEST_CASE(
    "motion: a pose that repeats itself is told, with the INS's rates alive, at 0 or unknown") {
  for (const int rates : {0, 1, 2}) {
    Drive drive;
    drive.good(0.8, 0.7);
    std::optional<InsMotion> held;
    drive.spoil = [&](InsMotion& ins) {
      if (!held) held = ins;
      InsMotion repeated = *held;
      repeated.utime = ins.utime;
      repeated.v_forward = rates == 0 ? ins.v_forward : rates == 1 ? 0.0 : InsMotion::kUnknown;
      repeated.v_left = rates == 0 ? ins.v_left : rates == 1 ? 0.0 : InsMotion::kUnknown;
      repeated.yaw_rate = rates == 0 ? ins.yaw_rate : rates == 1 ? 0.0 : InsMotion::kUnknown;
      ins = repeated;
    };
    checkTold(drive.run(3.0), "pose frozen", 1.0);
  }
}

TEST_CASE("motion: a position that stands while heading and noise live is told") {
  Drive drive;
  drive.velocity = false;
  drive.good(0.8, 0.8);
  drive.spoil = [n = 0](InsMotion& ins) mutable { ins.x = ins.y = 0.001 * (++n % 7); };
  checkTold(drive.run(3.0), "pose jumps");
  checkTold(drive.run(3.0), "pose jumps");
}

TEST_CASE("motion: a jump of 3 m and a heading off by 20 deg are told at once") {
  for (const bool rates : {true, false}) {
    Drive drive;
    drive.velocity = drive.gyro = rates;
    drive.good(0.8, 0.8);
    drive.offset.x = 3.0;
    checkTold(drive.run(1.0), "pose jumps 3.0", 0.041);
    drive.settle(3.0);
    drive.good(0.8, 0.8);
    drive.offset.yaw = 0.35;
    checkTold(drive.run(1.0), "heading jumps 20 deg", 0.041);
  }
}

TEST_CASE("motion: a heading that was off by 20 deg from the start is told after 1.5 m") {
  Drive drive;
  drive.velocity = false;
  drive.good(0.0, 0.0, 2.0);
  drive.offset.yaw = 0.35;
  drive.settle(4.0);
  drive.command = {1.0, 1.0};
  const auto told = drive.run(6.0);
  INFO(told.first << " " << told.second);
  CHECK(told.first < 4.5);
  CHECK(told.second.find("sideways") != std::string::npos);
}

TEST_CASE("motion: a heading that drifts away from its gyro is told") {
  Drive drive;
  drive.good(0.8, 0.8);
  drive.drift.omega = 0.2;
  checkTold(drive.run(3.0), "heading and gyro differ");
}

TEST_CASE("motion: a turn before the gyro is there is not held against it") {
  Drive drive;
  drive.good(0.0, 0.0, 2.0);
  double missing = 0.5;  // [s] of a turn
  drive.spoil = [&missing](InsMotion& ins) {
    if (missing <= 0.0 || std::abs(ins.yaw_rate) < 0.3) return;
    missing -= 0.02;
    ins.yaw_rate = std::numeric_limits<double>::quiet_NaN();
  };
  drive.command = {-0.8, 0.8};
  const auto told = drive.run(6.0);
  INFO(told.first << " " << told.second);
  CHECK(missing <= 0.0);
  CHECK(told.second.empty());
}

TEST_CASE("motion: a position that drifts away from its velocity is told") {
  Drive drive;
  drive.good(0.8, 0.8);
  drive.drift.v_y = 0.4;
  checkTold(drive.run(3.0), "position and INS velocity differ");
}

TEST_CASE("motion: turns and travel of the wrong sign are told") {
  Drive turning;
  turning.good(0.2, 1.0);
  turning.turn_slip = -0.6;
  checkTold(turning.run(3.0), "turns");
  Drive backwards;
  backwards.good(0.8, 0.8);
  std::optional<double> begin;
  backwards.spoil = [&begin](InsMotion& ins) {
    if (!begin) begin = ins.x;
    ins.x = 2.0 * *begin - ins.x;
    ins.v_forward *= -1.0;
  };
  checkTold(backwards.run(3.0), "travels");
}

TEST_CASE("motion: spinning and blocked tracks are told apart by what the motors say") {
  Drive bare;
  bare.good(0.8, 0.8);
  bare.slip_left = bare.slip_right = 0.0;
  checkTold(bare.run(3.0), "stuck or pose frozen");

  Drive spinning;
  spinning.motors.measured[0] = spinning.motors.measured[1] = 0.8;
  spinning.good(0.8, 0.8);
  spinning.slip_left = spinning.slip_right = 0.0;
  checkTold(spinning.run(3.0), "tracks spin or pose frozen");

  Drive blocked;
  blocked.motors.measured[0] = blocked.motors.measured[1] = 0.8;
  blocked.good(0.8, 0.8);
  blocked.motors.measured[0] = blocked.motors.measured[1] = 0.0;
  checkTold(blocked.run(3.0), "both tracks blocked", 0.8);

  Drive bellied;
  bellied.motors.current[0] = 41.0;
  bellied.motors.current[1] = 38.0;
  bellied.good(0.0, 0.0);
  bellied.slip_left = bellied.slip_right = 0.0;
  bellied.command = {0.8, 0.8};
  const auto told = bellied.run(3.0);
  checkTold(told, "stuck or pose frozen");
  CHECK(told.second.find("41, 38 A") != std::string::npos);
}

TEST_CASE("motion: a dead track is told by the turn towards it, or by its own speed") {
  for (const double way : {1.0, -1.0}) {
    Drive drive;
    drive.good(0.9 * way, 0.9 * way);
    drive.slip_left = 0.0;
    const auto told = drive.run(3.0);
    checkTold(told, "turns", 1.1);
    CHECK(told.second.find("left track dead") != std::string::npos);
  }
  Drive known;
  known.motors.measured[0] = known.motors.measured[1] = 0.9;
  known.good(0.9, 0.9);
  known.motors.measured[1] = 0.0;
  checkTold(known.run(3.0), "right track dead", 0.8);
}

TEST_CASE("motion: after some driving, dead, blocked and mirrored tracks are told within 1.5 s") {
  // 0.4 of the power is 0.44 m/s, including turns on the spot.
  const TrackCommand kCommands[] = {{0.4, 0.4}, {0.9, 0.9}, {-0.5, -0.4}, {0.5, 0.9}, {-0.6, 0.6}};
  for (const TrackCommand& command : kCommands) {
    CAPTURE(command.left, command.right);
    const auto driven = [&command] {
      Drive drive;
      for (int i = 0; i < 6; ++i) {
        drive.good(0.8, 0.5, 2.0);
        drive.good(-0.5, 0.5, 2.0);
      }
      drive.good(command.left, command.right);
      return drive;
    };
    Drive left = driven();
    left.slip_left = 0.0;
    checkTold(left.run(3.0), "left track dead");
    Drive right = driven();
    right.slip_right = 0.0;
    checkTold(right.run(3.0), "right track dead");
    Drive blocked = driven();
    blocked.slip_left = blocked.slip_right = 0.0;
    checkTold(blocked.run(3.0), "stuck or pose frozen");
    Drive mirrored = driven();
    mirrored.turn_slip *= -1.0;
    if (std::abs(command.left - command.right) > 0.3) checkTold(mirrored.run(3.0), "turns");
  }
}

TEST_CASE("motion: another ground is no fault, however sudden and slippery") {
  const TrackCommand kCommands[] = {{0.4, 0.4}, {0.9, 0.9}, {0.3, 0.9}, {0.5, 0.9}, {-0.6, 0.6}};
  struct Ground {
    double slip, turn_slip;
  };
  const Ground kGrounds[] = {{0.95, 0.7}, {0.8, 0.5}, {0.65, 0.4}, {0.55, 0.3}};
  for (const TrackCommand& command : kCommands) {
    for (const Ground& from : kGrounds) {
      for (const Ground& to : kGrounds) {
        CAPTURE(command.left, command.right, from.slip, to.slip);
        Drive drive;
        drive.slip_left = drive.slip_right = from.slip;
        drive.turn_slip = from.turn_slip;
        for (int i = 0; i < 4; ++i) {
          drive.good(0.8, 0.5, 2.0);
          drive.good(-0.5, 0.5, 2.0);
        }
        drive.good(command.left, command.right);
        drive.slip_left = drive.slip_right = to.slip;
        drive.turn_slip = to.turn_slip;
        drive.good(command.left, command.right, 20.0);
      }
    }
  }
}

TEST_CASE("motion: sliding and rolling without a command are told, standing is not") {
  Drive drive;
  drive.good(0.8, 0.8);
  drive.good(0.0, 0.0, 20.0);
  drive.shove.v_x = 0.3;
  checkTold(drive.run(3.0), "moves");
  Drive sideways;
  sideways.good(0.0, 0.0, 4.0);
  sideways.shove.v_y = 0.3;
  checkTold(sideways.run(3.0), "moves");
}

TEST_CASE("motion: a verdict stands for as long as its cause, and ends after it") {
  Drive drive;
  drive.good(0.0, 0.0, 4.0);
  drive.shove.v_x = 0.3;
  REQUIRE(drive.run(3.0).first < 1.5);
  for (int i = 0; i < 200; ++i) CHECK(drive.run(0.02).first < 0.03);
  drive.shove.v_x = 0.0;
  double longest = 0.0;
  for (double t = 0.0; t < 6.0; t += 0.02)
    if (drive.run(0.02).first < 0.03) longest = t;
  CHECK(longest < 3.5);
}

TEST_CASE("motion: what is not known is not judged") {
  Drive drive;
  drive.spoil = [](InsMotion& ins) { ins.x = InsMotion::kUnknown; };
  drive.good(1.0, 1.0, 10.0);
  Drive coarse;
  coarse.good(0.0, 0.0, 2.0);
  coarse.velocity = coarse.gyro = false;
  coarse.spoil = [](InsMotion& ins) {
    ins.position_std = 2.5;
    ins.x += 0.25 * std::sin(1e-6 * static_cast<double>(ins.utime));
  };
  coarse.run(0.1);
  coarse.good(0.0, 0.0, 60.0);
}

TEST_CASE("motion: a fix that becomes better may move by the error that it had") {
  Drive drive;
  drive.velocity = false;
  drive.good(0.0, 0.0, 2.0);
  double std = 0.4;
  drive.spoil = [&std](InsMotion& ins) { ins.position_std = std; };
  drive.good(0.8, 0.8);
  std = 0.02;
  drive.offset.y = 0.4;
  drive.good(0.8, 0.8);
}

TEST_CASE("motion: a broken message among good ones is passed over, a second one is told") {
  Drive drive;
  drive.good(0.8, 0.8);
  int broken = 1;
  drive.spoil = [&broken](InsMotion& ins) {
    if (broken > 0) ins.x += 40.0 * broken--;
  };
  drive.good(0.8, 0.8);
  drive.spoil = [n = 0](InsMotion& ins) mutable {
    if (++n == 10) ins.yaw += 2.0;
    if (n == 20) ins.v_forward = 1e30;
  };
  drive.good(0.8, 0.8);
  drive.spoil = [n = 0](InsMotion& ins) mutable {
    if (++n % 4 == 0) ins.y += 5.0;
  };
  checkTold(drive.run(3.0), "pose jumps", 0.5);
}

namespace {

/// Smallest drift of a kind that is reported within a time [s], in steps of 10 %.
double smallestTold(double within, const std::function<void(Drive&, double)>& spoil) {
  for (double size = 0.01; size < 5.0; size *= 1.1) {
    Drive drive;
    drive.command = {0.9, 0.9};
    drive.run(5.0);
    spoil(drive, size);
    if (drive.run(within).first <= within) return size;
  }
  return 5.0;
}

}  // namespace

TEST_CASE(
    "motion: the smallest drifts that are told at 0.84 m/s, by rates of the INS and without") {
  const auto ahead = [](Drive& drive, double size) { drive.drift.v_x = size; };
  const auto aside = [](Drive& drive, double size) { drive.drift.v_y = size; };
  const auto turn = [](Drive& drive, double size) { drive.drift.omega = size; };
  const auto blind = [](const auto& spoil) {
    return [spoil](Drive& drive, double size) {
      drive.velocity = drive.gyro = false;
      drive.run(3.0);
      spoil(drive, size);
    };
  };
  for (const double within : {1.5, 4.0}) {
    const double known[] = {smallestTold(within, ahead), smallestTold(within, aside),
                            smallestTold(within, turn)};
    const double unknown[] = {smallestTold(within, blind(ahead)),
                              smallestTold(within, blind(aside)),
                              smallestTold(within, blind(turn))};
    CAPTURE(within, known[0], known[1], known[2], unknown[0], unknown[1], unknown[2]);
    CHECK(known[0] < 0.35);
    CHECK(known[1] < 0.35);
    CHECK(known[2] < 0.25);
    CHECK(unknown[0] < 1.0);
    CHECK(unknown[1] < 0.5);
    CHECK(unknown[2] < 0.8);
  }
}
