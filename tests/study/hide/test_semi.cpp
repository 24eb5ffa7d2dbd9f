// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>

#include <Eigen/Geometry>

#include "common/geometry/se2.hpp"
#include "tests/study/hide/blind_bench.hpp"
#include "tests/study/hide/event_edit.hpp"
#include "tests/study/hide/semi.hpp"

using namespace tread;
using namespace tread::blind;

namespace {

/// A synthetic log instead of a recording, before and after.
struct Pair {
  std::vector<LogEvent> before = makeCase(bench::shortPlan({})).events;
  std::vector<LogEvent> after = before;
  SemiTruth truth;

  explicit Pair(const std::string& effect, int size = 2) {
    truth = hideInLog(effect, size, 3, after);
  }
  std::vector<ins_t> insBefore() const { return messagesOf(before, kIns); }
  std::vector<ins_t> insAfter() const { return messagesOf(after, kIns); }
  std::vector<motor_t> motorBefore() const { return messagesOf(before, kMotor); }
  std::vector<motor_t> motorAfter() const { return messagesOf(after, kMotor); }
  double value() const { return truth.parameters.front().value; }
};

Eigen::Quaterniond attitudeOf(const ins_t& ins) {
  return {ins.orientation[0], ins.orientation[1], ins.orientation[2], ins.orientation[3]};
}

double yawOf(const ins_t& ins) {
  const Eigen::Matrix3d R = attitudeOf(ins).toRotationMatrix();
  return std::atan2(R(1, 0), R(0, 0));
}

}  // namespace

TEST_CASE("misalignment turns every heading by the angle and leaves the rest") {
  const Pair pair("heading_misalignment");
  const auto a = pair.insBefore(), b = pair.insAfter();
  REQUIRE(a.size() == b.size());
  CHECK(std::abs(pair.value()) == Approx(6.0 * kPi / 180.0));
  for (size_t i = 0; i < a.size(); i += 7) {
    CHECK(wrapAngle(yawOf(b[i]) - yawOf(a[i])) == Approx(-pair.value()).margin(1e-12));
    CHECK(b[i].position[0] == a[i].position[0]);
    CHECK(b[i].rate[2] == a[i].rate[2]);
  }
}

TEST_CASE("late poses keep what they say and get later stamps, and the gyro stays in time") {
  const Pair pair("ins_latency");
  CHECK(pair.value() == 0.3);
  std::map<int64_t, ins_t> after;
  for (const ins_t& ins : pair.insAfter()) {
    CHECK(after.count(ins.utime) == 0);
    after[ins.utime] = ins;
  }
  for (const ins_t& ins : pair.insBefore()) {
    REQUIRE(after.count(ins.utime + 300'000) == 1);
    const ins_t& late = after[ins.utime + 300'000];
    CHECK(late.position[0] == ins.position[0]);
    CHECK(late.orientation[3] == ins.orientation[3]);
    REQUIRE(after.count(ins.utime) == 1);
    CHECK(after[ins.utime].rate[2] == ins.rate[2]);
  }
}

TEST_CASE("a delay of all channels shifts whole INS messages") {
  const Pair pair("command_delay", 1);
  const auto a = pair.insBefore(), b = pair.insAfter();
  REQUIRE(a.size() == b.size());
  for (size_t i = 0; i < a.size(); i += 11) {
    CHECK(b[i].utime == a[i].utime + 250'000);
    CHECK(b[i].rate[2] == a[i].rate[2]);
  }
  for (size_t i = 1; i < pair.after.size(); ++i)
    CHECK(pair.after[i].utime >= pair.after[i - 1].utime);
}

TEST_CASE("scale, lever arms and gyro bias are what they say") {
  const Pair scale("position_scale"), x("lever_arm_x"), y("lever_arm_y"), gyro("gyro_bias");
  const auto before = scale.insBefore();
  const auto scaled = scale.insAfter(), moved_x = x.insAfter(), moved_y = y.insAfter(),
             biased = gyro.insAfter();
  for (size_t i = 0; i < before.size(); i += 13) {
    CHECK(scaled[i].position[0] == Approx((1.0 + scale.value()) * before[i].position[0]));
    const Eigen::Vector3d p(before[i].position), px(moved_x[i].position), py(moved_y[i].position);
    const Eigen::Vector3d arm_x = attitudeOf(before[i]).conjugate() * (px - p);
    const Eigen::Vector3d arm_y = attitudeOf(before[i]).conjugate() * (py - p);
    CHECK((arm_x - Eigen::Vector3d(-x.value(), 0.0, 0.0)).norm() < 1e-9);
    CHECK((arm_y - Eigen::Vector3d(0.0, -y.value(), 0.0)).norm() < 1e-9);
    CHECK(biased[i].rate[2] - before[i].rate[2] == Approx(gyro.value()));
  }
}

TEST_CASE("commands are those that a vehicle with the effect would have needed") {
  const Pair asymmetry("track_asymmetry"), dead("motor_deadband"), sag("battery_sag");
  const auto before = asymmetry.motorBefore();
  const auto uneven = asymmetry.motorAfter(), wide = dead.motorAfter(), strong = sag.motorAfter();
  for (size_t i = 0; i < before.size(); ++i) {
    const double left = static_cast<double>(before[i].command[0]);
    const double right = static_cast<double>(before[i].command[1]);
    CHECK(static_cast<double>(uneven[i].command[0]) * (1.0 + asymmetry.value()) ==
          Approx(left).margin(1e-6));
    CHECK(static_cast<double>(uneven[i].command[1]) * (1.0 - asymmetry.value()) ==
          Approx(right).margin(1e-6));
    const double u = static_cast<double>(wide[i].command[0]);
    const double heard = std::copysign(std::max(0.0, std::abs(u) - dead.value()), u);
    CHECK(heard == Approx(left).margin(1e-6));
  }
  const double last = static_cast<double>(before[before.size() * 4 / 5].command[0]);
  const double share = 0.8;
  CHECK(static_cast<double>(strong[before.size() * 4 / 5].command[0]) ==
        Approx(last / (1.0 - sag.value() * share)).margin(1e-3));
}

TEST_CASE("from a moment on the vehicle yaws less than before") {
  const Pair pair("payload_change");
  CHECK(pair.value() == -0.4);
  const double when = pair.truth.parameters.back().value;
  const auto a = pair.motorBefore(), b = pair.motorAfter();
  for (size_t i = 0; i < a.size(); ++i) {
    const double half_a = static_cast<double>(a[i].command[1] - a[i].command[0]);
    const double half_b = static_cast<double>(b[i].command[1] - b[i].command[0]);
    const double share = static_cast<double>(a[i].utime - a.front().utime) /
                         static_cast<double>(a.back().utime - a.front().utime);
    const double gain = share < when ? 1.0 : 1.0 / 0.6;
    CHECK(half_b == Approx(gain * half_a).margin(1e-5));
    CHECK(static_cast<double>(b[i].command[1] + b[i].command[0]) ==
          Approx(static_cast<double>(a[i].command[1] + a[i].command[0])).margin(1e-5));
  }
}

TEST_CASE("what cannot be hidden in a recording is refused in words") {
  std::vector<LogEvent> events = makeCase(bench::shortPlan({})).events;
  CHECK_THROWS_WITH(hideInLog("track_backlash", 1, 1, events),
                    "effect 'track_backlash' cannot be hidden in a recording");
  CHECK_THROWS_WITH(hideInLog("gyro_bias", 3, 1, events), Catch::Contains("1 or 2"));
}
