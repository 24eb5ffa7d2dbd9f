// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The whole robot in virtual time under seeded faults, and that the rules can fail.
#include <catch2/catch.hpp>

#include "tests/bench/faults/fault_run.hpp"
#include "tests/bench/faults/invariants.hpp"
#include "tests/bench/faults/return_run.hpp"
#include "tests/helpers.hpp"
#include "tests/tools/missions/shipped_robot.hpp"

using namespace tread;
using namespace tread::faults;
using missions::teodor;

namespace {

Fault faultOf(FaultKind kind, double from, double until, const std::string& channel = "*",
              const std::string& node = "*", double strength = 1.0) {
  return {
      kind,    static_cast<int64_t>(from * 1e6), static_cast<int64_t>(until * 1e6), channel, node,
      strength};
}

/// What broke in mission 3 under one fault; empty if nothing did.
std::string brokenBy(const missions::RobotConfig& robot, const Fault& fault, bool keyed = true) {
  FaultSchedule schedule;
  schedule.seed = 3;
  schedule.keyed = keyed;
  schedule.faults = {fault};
  const FaultyRun run = runFaulty(robot, schedule);
  REQUIRE(run.drove);
  REQUIRE(run.paths_judged > 5);
  return run.violation ? run.violation->what : "";
}

}  // namespace

TEST_CASE("under seeded faults no rule is broken: the first seventy seeds") {
  for (uint64_t seed = 1; seed <= static_cast<uint64_t>(tread::testing::effort(70)); ++seed) {
    CAPTURE(seed);
    const FaultyRun run = runFaulty(teodor(), scheduleOf(seed, 16.0));
    CHECK((run.violation ? run.violation->what : "") == "");
  }
}

TEST_CASE("an operator lost for good: with `go_back` the robot returns to where its way began") {
  int lost = 0, back = 0;
  for (uint64_t seed = 1; seed <= 6; ++seed) {
    const ReturnRun run = runReturn(teodor(), seed);
    CAPTURE(seed, run.away, run.missed_start, run.state);
    CHECK(run.collisions == 0);
    CHECK_FALSE(run.moved_at_end);
    if (!run.lost) continue;
    ++lost;
    back += run.returned_after > 0.0 ? 1 : 0;
  }
  CHECK(lost >= 4);
  CHECK(back >= lost - 1);
}

TEST_CASE("a faulty mission replays to the same step") {
  missions::RobotConfig loose = teodor();
  loose.motor_bridge.bridge.operators.lease_us = 60'000'000;
  FaultSchedule schedule = scheduleOf(7, 16.0);
  schedule.faults.push_back(faultOf(FaultKind::kOperatorLost, 7.0, 14.0));
  const FaultyRun first = runFaulty(loose, schedule), second = runFaulty(loose, schedule);
  REQUIRE(first.violation);
  REQUIRE(second.violation);
  CHECK(first.violation->utime == second.violation->utime);
  CHECK(first.violation->what == second.violation->what);
}

TEST_CASE("the rules see a bridge that does not look at the operator's lease") {
  missions::RobotConfig loose = teodor();
  const Fault lost = faultOf(FaultKind::kOperatorLost, 7.0, 12.0);
  CHECK(brokenBy(loose, lost).empty());
  loose.motor_bridge.bridge.operators.lease_us = 60'000'000;
  loose.planner.operators.lease_us = 60'000'000;
  CHECK(brokenBy(loose, lost).find("no operator within the lease") != std::string::npos);
}

TEST_CASE("the rules see a bridge that does not look at the program's lease") {
  missions::RobotConfig loose = teodor();
  const Fault dead = faultOf(FaultKind::kKill, 7.0, 12.0, "*", "planner");
  CHECK(brokenBy(loose, dead).empty());
  loose.motor_bridge.bridge.gate.lease_us = 60'000'000;
  loose.planner.lease = 60'000'000;
  CHECK(brokenBy(loose, dead).find("no PROGRAM") != std::string::npos);
}

TEST_CASE("the rules see a bridge that does not look at the INS") {
  missions::RobotConfig loose = teodor();
  const Fault silent = faultOf(FaultKind::kDrop, 7.0, 12.0, "INS", "motor_bridge");
  CHECK(brokenBy(loose, silent).empty());
  loose.motor_bridge.bridge.ins.period_us = 20'000'000;
  CHECK(brokenBy(loose, silent).find("no INS") != std::string::npos);
}

TEST_CASE("the rules see a pattern through an obstacle, and through what was never seen") {
  PathRule rule(teodor().planner.map.footprint);
  const PatternSet& set = teodor().learner.shipped;
  const MotionPattern& pattern = set.patterns().front();
  const auto receive = [&](const auto& channel, const auto& message, int64_t now) {
    std::vector<uint8_t> bytes(static_cast<size_t>(message.getEncodedSize()));
    message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    rule.receive({now, channel.name, bytes});
  };
  for (const pattern_set_part_t& part : toMessages(set)) receive(kPatternSet, part, 1);
  map_tile_t tile{};
  tile.tile_cells = 200;
  tile.cell_size = 0.1;
  tile.num_cells = 200 * 200;
  tile.cells.assign(40'000, 0);
  const auto tell = [&](Cell cell, int64_t now) {
    tile.utime = now;
    tile.cells[100 * 200 + 100] = cell;
    receive(kMap, tile, now);
  };
  int64_t id = 0;
  const auto plan = [&](double x, int64_t now) {
    const Pose2 T_map_end = Pose2{x, 10.0, 0.0} * pattern.end();
    plan_t message{};
    message.set_version = set.version();
    message.num_patterns = 1;
    message.execution_id = {++id};
    message.pattern_id = {pattern.id};
    message.pose = {{T_map_end.x, T_map_end.y, T_map_end.yaw}};
    return rule.check(now, message);
  };
  const double before = 10.0 - 0.7 - pattern.end().x;  // its end overlaps the cell, its start not
  tell(kFree, 1'000'000);
  CHECK(plan(before, 2'000'000).empty());
  tell(kObstacle, 3'000'000);
  CHECK(plan(before, 3'100'000).empty());  // it cannot know yet
  CHECK(plan(before, 3'300'000).find("1 obstacle cells") != std::string::npos);
  CHECK(plan(5.0, 3'300'000).empty());
  CHECK(plan(19.5 - pattern.end().x, 3'300'000).find("unknown ones") != std::string::npos);
  CHECK(rule.judged() == 5);
}

TEST_CASE("the rules see what a node hides of its refusals, and a version that goes back") {
  FaultSchedule schedule;
  schedule.seed = 3;
  schedule.keyed = true;
  schedule.faults = {faultOf(FaultKind::kForge, 4.0, 8.0, "PROGRAM")};
  CHECK_FALSE(runFaulty(teodor(), schedule).violation);
  CountRule counts(true);
  const std::vector<uint8_t> unsealed(30, 0);
  counts.sent("PROGRAM", unsealed);
  health_t health{};
  health.process = "planner";
  counts.receive("planner", "PROGRAM", unsealed);
  CHECK(counts.check(health).empty());
  CHECK_FALSE(counts.check(health).empty());
}

namespace {

/// A bridge that was told everything it needs to drive, again every 10 ms, but for what is left
/// out.
struct ToldBridge {
  MotorRule rule{MotorLimits{}};
  int64_t now = 1'000'000;

  template <class Message>
  void tell(const Channel<Message>& channel, Message message) {
    std::vector<uint8_t> bytes(static_cast<size_t>(message.getEncodedSize()));
    message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    rule.receive({now, channel.name, bytes});
  }
  void tellAllBut(const std::string& left_out) {
    operator_t notice{};
    notice.allowed = operator_t::ALLOW_DRIVING;
    notice.seen_utime = now;
    if (left_out != "OPERATOR") tell(kOperator, notice);
    program_t program{};
    program.utime = now;
    program.lease = 200'000;
    program.running.execution_id = left_out == "motion" ? 0 : 1;
    if (left_out != "PROGRAM") tell(kProgram, program);
    ins_t ins{};
    ins.utime = now;
    ins.orientation[0] = 1.0;
    if (left_out != "INS") tell(kIns, ins);
  }
  /// Milliseconds of power until the rule objects; -1 if it does not within 3 s.
  int64_t drive(const std::string& left_out) {
    const int64_t start = now;
    for (; now < start + 3'000'000; now += 10'000) {
      tellAllBut(left_out);
      if (!rule.check(now, {1.0, 1.0}).empty()) return (now - start) / 1000;
    }
    return -1;
  }
  void arm() {
    tellAllBut("");
    rule.check(now, {0.0, 0.0});
    now += 10'000;
    arm_t message{};
    message.armed = 1;
    tell(kArm, message);
  }
};

}  // namespace

TEST_CASE("the motors' rule objects 250 ms after each cause, and wants arming again") {
  ToldBridge bridge;
  CHECK(bridge.drive("") == 260);  // never armed
  bridge.arm();
  CHECK(bridge.drive("") == -1);
  const std::map<std::string, int64_t> limits{
      {"OPERATOR", 1250}, {"PROGRAM", 450}, {"INS", 350}, {"motion", 450}};
  for (const auto& [left_out, limit] : limits) {
    CAPTURE(left_out);
    ToldBridge told;
    told.arm();
    REQUIRE(told.drive("") == -1);
    const int64_t objects = told.drive(left_out);
    CHECK(objects > limit - 20);
    CHECK(objects <= limit + 20);
    told.rule.check(told.now, {0.0, 0.0});
    told.tellAllBut("");
    if (left_out != "motion") CHECK(told.drive("") >= 0);  // nobody has armed it
    told.arm();
    CHECK(told.drive("") == -1);
  }
  estop_t stop{};
  stop.engaged = 1;
  bridge.tell(kEstop, stop);
  CHECK(bridge.drive("") == 260);
  stop.engaged = 0;
  bridge.tell(kEstop, stop);
  CHECK(bridge.drive("") >= 0);
  bridge.arm();
  CHECK(bridge.drive("") == -1);
  bridge.tell(kArm, arm_t{});
  CHECK(bridge.drive("") == 260);
  bridge.arm();
  CHECK(bridge.drive("") == -1);
  bridge.rule.end(bridge.now);
  CHECK(bridge.drive("") == 290);
}
