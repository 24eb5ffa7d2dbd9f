// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The whole robot in virtual time with seeded faults, and checks that the rules can fail.
#include <algorithm>
#include <limits>
#include <set>
#include <vector>

#include <catch2/catch.hpp>

#include "common/messages/fence_messages.hpp"
#include "tests/bench/faults/fault_run.hpp"
#include "tests/bench/faults/invariants.hpp"
#include "tests/bench/faults/limit_rules.hpp"
#include "tests/bench/faults/return_run.hpp"
#include "tests/helpers.hpp"
#include "tests/tools/lab/missions/shipped_robot.hpp"

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

/// Violation in mission 3 under one fault; empty if none.
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

/// Seeds from `first` on with fences, manual driving, tilts and returns, in missions of 12 s.
void driveSeeds(uint64_t first, int count) {
  RunOptions options;
  options.duration = 12.0;
  for (uint64_t seed = first; seed < first + static_cast<uint64_t>(count); ++seed) {
    CAPTURE(seed);
    const FaultyRun run = runFaulty(teodor(), scheduleOf(seed, options.duration), options);
    CHECK((run.violation ? run.violation->what : "") == "");
  }
}

}  // namespace

// Three cases, which run in parallel. The usual run has 67 seeds; tools/test --all has all.
TEST_CASE("seeds from 1 on break no rule under their faults") {
  driveSeeds(1, 67);
}
TEST_CASE("seeds from 1001 on break no rule under their faults", "[study]") {
  driveSeeds(1001, 67);
}
TEST_CASE("seeds from 2001 on break no rule under their faults", "[study]") {
  driveSeeds(2001, 67);
}

TEST_CASE("seeds that once broke a rule, or touched something") {
  // Seeds that once broke a rule. Later fixes changed the draws of some: 23, 163, 178, 254, 302 and
  // 1582 belong to an earlier order of faults and now mean others.
  RunOptions every_beam;
  every_beam.beams = 541;
  for (const uint64_t seed : {20537, 40414, 23, 163, 178, 254, 302, 1582, 50154, 101483, 101880,
                              103151, 105412, 108137}) {
    CAPTURE(seed);
    const FaultyRun run = runFaulty(teodor(), bareScheduleOf(seed, 16.0), every_beam);
    CHECK((run.violation ? run.violation->what : "") == "");
  }
  // These left a fence, or ground that the INS reported as steep, through obstacles and unknown
  // cells; in the last one a MANUAL altered in transit was counted by the rule.
  for (const uint64_t seed :
       {4, 200006, 200049, 200068, 200091, 200143, 200149, 202133, 305019, 305178, 308388}) {
    CAPTURE(seed);
    FaultSchedule schedule = scheduleOf(seed, 16.0);
    schedule.scenario.lie.reset();  // those seeds had none
    const FaultyRun run = runFaulty(teodor(), schedule);
    CHECK((run.violation ? run.violation->what : "") == "");
  }
}

TEST_CASE("a range finder that lies while the robot drives is named and touches nothing") {
  for (auto kind = FaultKind::kScanFreeze; kind <= FaultKind::kScanZero;
       kind = static_cast<FaultKind>(static_cast<int>(kind) + 1))
    for (const double strength : {0.2, 0.8}) {
      std::vector<double> named;  // [s] after it moved under the lie
      for (const double moment : {7.0, 8.0, 9.0}) {
        CAPTURE(nameOf(kind), strength, moment);
        FaultSchedule schedule;
        schedule.seed = 3;
        schedule.faults = {faultOf(kind, moment, 1e6, "*", "*", strength)};
        const FaultyRun run = runFaulty(teodor(), schedule);
        CHECK((run.violation ? run.violation->what : "") == "");
        CHECK(run.collisions == 0);
        REQUIRE(run.effect.moved);
        REQUIRE(run.effect.named_after);
        named.push_back(*run.effect.named_after);
        REQUIRE(run.effect.zero_after);
        CHECK(*run.effect.zero_after < *run.effect.named_after + 0.15);
        CHECK(run.effect.reason == "disarmed by planner");
        CHECK_FALSE(run.arrived);
      }
      // The appearance of a rotated scan depends on the surroundings and on the robot's yaw rate.
      std::sort(named.begin(), named.end());
      CAPTURE(nameOf(kind), strength, named[0], named[1], named[2]);
      CHECK(named[1] < 0.6);
      CHECK(named[2] < 1.0);
    }
}

TEST_CASE("an operator lost for good: with `go_back` the robot returns to where its way began") {
  int lost = 0, back = 0;
  missions::RobotConfig robot = teodor();
  robot.simulated.laser.beams = RunOptions{}.beams;
  for (uint64_t seed = 1; seed <= 6; ++seed) {
    const ReturnRun run = runReturn(robot, seed);
    CAPTURE(seed, run.away, run.missed_start, run.state);
    CHECK(run.collisions == 0);
    CHECK_FALSE(run.moved_at_end);
    if (!run.lost) continue;
    ++lost;
    back += run.returned_after > 0.0 ? 1 : 0;
  }
  CHECK(lost >= 3);
  CHECK(back >= lost - 1);
}

TEST_CASE("a faulty mission replays to the same step") {
  missions::RobotConfig loose = teodor();
  loose.motor_bridge.bridge.operators.lease_us = 60'000'000;
  FaultSchedule schedule = bareScheduleOf(7, 16.0);
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
  CHECK(plan(before, 3'100'000).empty());  // it cannot have received it yet
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

TEST_CASE("the rules see a robot that knows nothing of its fences") {
  FaultSchedule schedule;
  schedule.seed = 3;
  schedule.scenario.own_fences = {{"pond", true, {{2, -4}, {5, -4}, {5, 4}, {2, 4}}}};
  RunOptions options;
  CHECK_FALSE(runFaulty(teodor(), schedule, options).violation);
  options.keeps_fences = false;
  const FaultyRun run = runFaulty(teodor(), schedule, options);
  REQUIRE(run.violation);
  CHECK(run.violation->what.find("over the fence pond") != std::string::npos);
}

TEST_CASE("the rules see a bridge that does not look at the tilt that it is told") {
  missions::RobotConfig loose = teodor();
  const Fault tilt = faultOf(FaultKind::kTilt, 7.0, 10.0, "*", "*", 0.6);
  CHECK(brokenBy(loose, tilt).empty());
  loose.motor_bridge.bridge.tilt.reset();
  loose.planner.max_slope.reset();
  CHECK(brokenBy(loose, tilt).find("tilted beyond the limit") != std::string::npos);
}

namespace {

/// Violation while a person drives from 6 to 11 s.
FaultyRun byHand(const missions::RobotConfig& robot, int64_t silent_from, double released) {
  FaultSchedule schedule;
  schedule.seed = 3;
  schedule.scenario.hand =
      HandStretch{6'000'000, 11'000'000, silent_from, silent_from + 2'000'000, released, 0.7};
  const FaultyRun run = runFaulty(robot, schedule);
  REQUIRE(run.by_hand);
  return run;
}

}  // namespace

TEST_CASE("the rules see a bridge that does not look at the lease of a hand") {
  missions::RobotConfig loose = teodor();
  CHECK_FALSE(byHand(loose, 8'000'000, 2.0).violation);
  CHECK_FALSE(byHand(loose, 20'000'000, 0.4).violation);
  loose.motor_bridge.bridge.manual.lease_us = 60'000'000;
  const FaultyRun run = byHand(loose, 8'000'000, 2.0);
  REQUIRE(run.violation);
  CHECK(run.violation->what.find("the hand holds no button, is silent") != std::string::npos);
}

TEST_CASE("no pad, keyboard or page moves a robot that never tells a rest") {
  RunOptions options;
  options.duration = 12.0;
  std::set<HandLie::Kind> lied;
  for (uint64_t seed = 1; seed <= 30; ++seed) {
    const FaultSchedule schedule = lyingScheduleOf(seed, options.duration);
    CAPTURE(seed, describe(schedule.scenario));
    const FaultyRun run = runFaulty(teodor(), schedule, options);
    CHECK((run.violation ? run.violation->what : "") == "");
    if (run.lied && schedule.onlyLies()) lied.insert(schedule.scenario.lie->kind);
  }
  CHECK(lied.size() == 3);
}

TEST_CASE("the rules see a return that is none, and one that a stop has not ended") {
  FaultSchedule schedule;
  schedule.seed = 3;
  schedule.scenario.go_back = true;
  schedule.faults = {faultOf(FaultKind::kOperatorLost, 8.0, 16.0)};
  missions::RobotConfig loose = teodor();
  const FaultyRun returns = runFaulty(loose, schedule);
  CHECK_FALSE(returns.violation);
  CHECK(returns.returned);
  // A planner that ignores the loss drives on to its goal.
  loose.planner.operators.lease_us = 60'000'000;
  const FaultyRun goes_on = runFaulty(loose, schedule);
  REQUIRE(goes_on.violation);
  CHECK(goes_on.violation->what.find("no return") != std::string::npos);
  // An ARM without an operator, after a stop on the way back, has no effect.
  schedule.faults.push_back(faultOf(FaultKind::kEstop, 12.5, 12.6));
  schedule.faults.push_back(faultOf(FaultKind::kForge, 13.0, 14.5, "ARM"));
  CHECK_FALSE(runFaulty(teodor(), schedule).violation);
}

namespace {

/// A bridge that has received everything needed for driving, repeated every 10 ms, except for
/// `left_out`.
struct ToldBridge {
  MotorRule rule{MotorLimits{}};
  int64_t now = 1'000'000;
  double roll = 0.0;  ///< [rad]

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
    ins.orientation[0] = std::cos(roll / 2.0);
    ins.orientation[1] = std::sin(roll / 2.0);
    if (left_out != "INS") tell(kIns, ins);
  }
  /// Milliseconds of power until the rule reports a violation; -1 if not within 3 s.
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

TEST_CASE("the motors' rule: a hand moves while it holds and sees, and no longer") {
  const auto drive = [](bool hold, bool give_back, float begins = 0.0F) {
    ToldBridge told;
    told.arm();
    REQUIRE(told.drive("") == -1);
    manual_t manual{};
    manual.hold = 1;
    manual.seen_utime = told.now;
    for (manual.seq = 1; manual.seq <= 2; ++manual.seq) {
      manual.hand_left = manual.seq == 2 ? 1.0F : begins;
      told.tell(kManual, manual);
    }
    manual.hold = hold;
    manual.give_back = give_back;
    told.tell(kManual, manual);
    return told.drive("motion");
  };
  // The program's lease of 200 ms is that of the last one with motion.
  CHECK(drive(true, false) == 470);
  CHECK(drive(false, false) == 460);
  // A stick that was not measured at rest must not move the robot.
  CHECK(drive(true, false, 1.0F) == 460);
  CHECK(drive(true, false, std::numeric_limits<float>::quiet_NaN()) == 460);
  ToldBridge told;
  told.arm();
  REQUIRE(told.drive("") == -1);
  // Without program and INS it may continue, and needs no new ARM.
  manual_t manual{};
  manual.hold = 1;
  for (int i = 0; i < 200; ++i, told.now += 10'000) {
    manual.hand_left = i < 2 ? 0.0F : 0.5F;
    ++manual.seq;
    manual.seen_utime = told.now;
    told.tell(kManual, manual);
    told.tellAllBut("INS");
    REQUIRE(told.rule.check(told.now, {0.5, 0.5}).empty());
  }
  ++manual.seq;
  manual.hold = 0;
  told.tell(kManual, manual);
  const int64_t released = told.drive("INS");
  CHECK(released >= 250);
  CHECK(released <= 270);
}

TEST_CASE("the motors' rule: beyond the tilt limit zero within 250 ms, and until an ARM") {
  MotorLimits limits;
  limits.tilt = 0.5;
  const auto tilted = [&](double roll) {
    ToldBridge told{MotorRule(limits)};
    told.arm();
    REQUIRE(told.drive("") == -1);
    told.roll = roll;
    const int64_t objects = told.drive("");
    told.roll = 0.0;
    told.rule.check(told.now, {0.0, 0.0});
    if (objects >= 0) CHECK(told.drive("") >= 0);  // not armed
    told.arm();
    CHECK(told.drive("") == -1);
    return objects;
  };
  CHECK(tilted(0.45) == -1);
  const int64_t objects = tilted(0.55);
  CHECK(objects > 230);
  CHECK(objects <= 270);
}

TEST_CASE("the rule of fences holds only where the bridge could keep them") {
  const FootprintSize outline{0.6, 0.6, 0.3};
  const Fence pond{"pond", true, {{2, -2}, {4, -2}, {4, 2}, {2, 2}}};
  const auto crosses = [&](const std::function<void(FenceRule&, int64_t)>& tell, bool own) {
    FenceRule rule(own ? std::vector<Fence>{pond} : std::vector<Fence>{}, outline);
    std::string wrong;
    for (int64_t now = 1'000'000; now < 4'000'000 && wrong.empty(); now += 5'000) {
      if (tell) tell(rule, now);
      wrong = rule.check(now, {static_cast<double>(now) * 1e-6 - 1.0, 0.0, 0.0}, 1.0);
    }
    return !wrong.empty();
  };
  CHECK(crosses(nullptr, true));
  CHECK_FALSE(crosses(nullptr, false));
  CHECK_FALSE(crosses([](FenceRule& rule, int64_t now) { rule.blind(now); }, true));
  const auto hand = [&](const std::string& by, int64_t at) {
    return [&pond, by, at](FenceRule& rule, int64_t now) {
      if (now != at) return;
      const fence_t message = toMessage(FenceRequest{by, false, pond});
      std::vector<uint8_t> bytes(static_cast<size_t>(message.getEncodedSize()));
      message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
      rule.receive({now, "FENCE", bytes});
    };
  };
  CHECK(crosses(hand("mission operator", 1'100'000), false));
  CHECK_FALSE(crosses(hand("mission operator", 2'200'000), false));  // too near to stop
  CHECK_FALSE(crosses(hand("stranger", 1'100'000), false));
}

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
    if (left_out != "motion") CHECK(told.drive("") >= 0);  // not armed
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
