// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "common/pattern/pattern_file.hpp"
#include "common/recordings/average.hpp"
#include "modules/pattern_recorder/recorder_node.hpp"
#include "tools/lab/missions/robot_system.hpp"

using namespace tread;
using namespace tread::pattern_recorder;

namespace {

const std::string kConfigFolder = std::string(TREAD_SOURCE_DIR) + "/config/";

PatternSet shipped(const std::vector<std::string>& names) {
  PatternSetContent content = readPatternFile(kConfigFolder + "patterns/teodor.yaml").content();
  std::vector<MotionPattern> chosen;
  for (const MotionPattern& pattern : content.patterns)
    if (std::find(names.begin(), names.end(), pattern.name) != names.end())
      chosen.push_back(pattern);
  content.patterns = chosen;
  std::vector<MotionClass> used;
  for (const MotionClass& motion : content.classes)
    for (const MotionPattern& pattern : chosen)
      if (pattern.entry_class == motion.name) {
        used.push_back(motion);
        break;
      }
  content.classes = used;
  std::string why;
  return PatternSet::make(content, why).value();
}

PatternSet fewPatterns() {
  return shipped(
      {"straight", "hard_left", "hard_right", "start", "stop", "turn_left_90", "turn_right_90"});
}

/// The simulated robot on flat grass; the recorder replaces the planner.
class RecordedDrive {
 public:
  RecordedDrive(const PatternSet& set, const RecordingConfig& how, const FaultPlan& faults = {})
      : system_(missions::readRobot(kConfigFolder + "robots/teodor"), meadow(), {}, 7, "off",
                faults),
        motor_(system_.bus().outside(), kMotor),
        program_(system_.bus().outside(), kProgram) {
    for (const char* name : {"planner", "learner", "mapping", "lidar_driver"})
      system_.bus().kill(name);
    RecordingConfig by_test = how;
    by_test.operator_name = "test";
    system_.bus().addNode("recorder", [&, set, by_test](Bus& bus) {
      return std::make_unique<RecorderNode>(
          set, by_test, bus, [this](const std::string& line) { said.push_back(line); });
    });
  }

  static sim::WorldDescription meadow() {
    sim::WorldDescription world;
    world.name = "meadow";
    world.bounds = {{-40.0, -40.0}, {40.0, 40.0}};
    return world;
  }

  RecorderNode& recorder() { return dynamic_cast<RecorderNode&>(*bus().node("recorder")); }
  VirtualBus& bus() { return system_.bus(); }
  missions::RobotSystem& system() { return system_; }
  Pose2 truth() const { return system_.robot().truth().T_map_body; }
  double farthest() const { return farthest_; }
  const motor_t& motor() const { return motor_.message(); }
  const program_t& program() const { return program_.message(); }

  /// Runs until the recorder ends or the time is over; arms once per second if requested.
  void run(double seconds, bool arming = true) {
    const int64_t end = bus().now() + static_cast<int64_t>(seconds * 1e6);
    while (bus().now() < end && recorder().state() == RecorderNode::State::kRunning) {
      if (arming) arm();
      bus().runUntil(bus().now() + 200'000);
      farthest_ = std::max(farthest_, std::hypot(truth().x, truth().y));
    }
  }

  void arm() {
    arm_t message{};
    message.utime = bus().now();
    message.seq = seq_++;
    message.armed = true;
    message.armed_by = "test";
    bus().outside().publish(kArm, message);
  }

  void estop(bool engaged) {
    estop_t message{};
    message.utime = bus().now();
    message.seq = seq_++;
    message.engaged = engaged;
    message.estop_by = "test";
    bus().outside().publish(kEstop, message);
  }

  bool saying(const std::string& words) const {
    for (const std::string& line : said)
      if (line.find(words) != std::string::npos) return true;
    return false;
  }

  std::vector<std::string> said;

 private:
  missions::RobotSystem system_;
  Latest<motor_t> motor_;
  Latest<program_t> program_;
  double farthest_ = 0.0;
  int64_t seq_ = 0;
};

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

}  // namespace

TEST_CASE("Each pattern is driven often enough within the room, and measured as it went") {
  RecordingConfig how;
  how.executions = 5;
  how.room = 4.0;
  const PatternSet set = fewPatterns();
  RecordedDrive drive(set, how);
  drive.run(300.0);
  INFO(joined(drive.said));
  REQUIRE(drive.recorder().state() == RecorderNode::State::kDone);
  CHECK(drive.farthest() < 4.0);
  CHECK(drive.motor().bridge_state == motor_t::STATE_ARMED);
  std::vector<recordings::AverageNote> notes;
  const PatternSet averaged =
      recordings::averageSet(set, {"grass", drive.recorder().recorded()}, {}, notes);
  // The robot turns more on grass than on the set's tarmac, but no recording differs much.
  for (const MotionPattern& pattern : averaged.patterns()) {
    INFO(pattern.name);
    const Pose2& end = pattern.end();
    const Pose2& shipped_end = set.findByName(pattern.name)->end();
    CHECK(std::hypot(end.x - shipped_end.x, end.y - shipped_end.y) < 0.25);
    CHECK(std::abs(end.yaw) > 0.95 * std::abs(shipped_end.yaw));
    CHECK(std::abs(end.yaw - shipped_end.yaw) < 0.45);
  }
}

TEST_CASE("All shipped patterns are recorded in one go") {
  RecordingConfig how;
  how.executions = 1;
  how.room = 5.0;
  RecordedDrive drive(readPatternFile(kConfigFolder + "patterns/teodor.yaml"), how);
  drive.run(200.0);
  INFO(joined(drive.said));
  CHECK(drive.recorder().state() == RecorderNode::State::kDone);
  CHECK(drive.farthest() < 5.0);
}

TEST_CASE("The same drive twice gives the same recordings, bit for bit") {
  RecordingConfig how;
  how.executions = 1;
  RecordedDrive first(fewPatterns(), how);
  RecordedDrive second(fewPatterns(), how);
  first.run(100.0);
  second.run(100.0);
  CHECK(first.said == second.said);
  const auto& a = first.recorder().recorded();
  const auto& b = second.recorder().recorded();
  REQUIRE(first.recorder().state() == RecorderNode::State::kDone);
  for (size_t p = 0; p < a.size(); ++p) {
    CHECK(a[p][0].back().x == b[p][0].back().x);
    CHECK(a[p][0].back().yaw == b[p][0].back().yaw);
  }
}

TEST_CASE("Without a permission nothing is driven") {
  RecordedDrive drive(fewPatterns(), {});
  drive.run(10.0, false);
  CHECK(drive.recorder().reason() == "not armed: tread-arm allows it to drive");
  CHECK(drive.farthest() < 0.02);
  CHECK(drive.program().running.execution_id == 0);
}

TEST_CASE("Where the set cannot turn back, it stands before the room ends and asks for help") {
  RecordingConfig how;
  how.room = 4.0;
  RecordedDrive drive(shipped({"start", "straight", "stop"}), how);
  drive.run(60.0);
  INFO(joined(drive.said));
  CHECK(drive.recorder().state() == RecorderNode::State::kRunning);
  CHECK(drive.saying("no pattern fits into the room from here"));
  CHECK(drive.farthest() < 4.0);
  CHECK(drive.motor().execution_id == 0);
}

TEST_CASE("Beyond the room it stops at once, and arming there does not help") {
  RecordingConfig how;
  how.room = 1.5;
  // A set that predicts a third of the motion, so that the end pose is unpredictable.
  PatternSetContent content = shipped({"start", "straight", "stop"}).content();
  for (MotionPattern& pattern : content.patterns)
    for (Pose2& pose : pattern.trajectory) pose.x *= 0.3;
  std::string why;
  RecordedDrive drive(PatternSet::make(content, why).value(), how);
  drive.run(30.0);
  INFO(joined(drive.said));
  CHECK(drive.recorder().reason().find("from where it began (") != std::string::npos);
  CHECK(drive.recorder().reason().find("drive it back, then arm it again") != std::string::npos);
  CHECK(drive.farthest() < 2.0);
  CHECK(drive.motor().execution_id == 0);
}

TEST_CASE("An INS that is lost stops the drive, and the execution is refused and driven again") {
  RecordingConfig how;
  how.executions = 2;
  RecordedDrive drive(fewPatterns(), how);
  while (drive.motor().bridge_state != motor_t::STATE_DRIVING && drive.bus().now() < 30'000'000)
    drive.run(0.2);
  drive.system().connect("ins", false);
  drive.run(3.0);
  CHECK(drive.motor().execution_id == 0);
  CHECK(drive.recorder().reason() == "INS is silent");
  drive.system().connect("ins", true);
  drive.run(200.0);
  INFO(joined(drive.said));
  CHECK(drive.saying("refused, it will be repeated: aborted: "));
  CHECK(drive.recorder().state() == RecorderNode::State::kDone);
}

TEST_CASE("An emergency stop stops it, and it goes on only when armed again") {
  RecordingConfig how;
  how.executions = 2;
  RecordedDrive drive(fewPatterns(), how);
  while (drive.motor().bridge_state != motor_t::STATE_DRIVING && drive.bus().now() < 30'000'000)
    drive.run(0.2);
  drive.estop(true);
  drive.run(2.0);
  CHECK(drive.motor().bridge_state == motor_t::STATE_ESTOP);
  drive.estop(false);
  drive.run(3.0, false);
  CHECK(drive.recorder().reason() == "not armed: tread-arm allows it to drive");
  drive.run(200.0);
  INFO(joined(drive.said));
  CHECK(drive.recorder().state() == RecorderNode::State::kDone);
}

TEST_CASE("Its end empties the program, and the robot stands within half a second") {
  RecordedDrive drive(fewPatterns(), {});
  while (drive.motor().bridge_state != motor_t::STATE_DRIVING && drive.bus().now() < 30'000'000)
    drive.run(0.2);
  drive.run(1.0);
  drive.recorder().shutdown(drive.bus().now());
  drive.bus().runUntil(drive.bus().now() + 1'000);
  drive.bus().kill("recorder");
  drive.bus().runUntil(drive.bus().now() + 100'000);
  CHECK(drive.program().running.execution_id == 0);
  CHECK(drive.motor().command[0] == 0.0F);
  CHECK(drive.motor().command[1] == 0.0F);
  drive.bus().runUntil(drive.bus().now() + 500'000);
  const Pose2 before = drive.truth();
  drive.bus().runUntil(drive.bus().now() + 500'000);
  CHECK(std::hypot(drive.truth().x - before.x, drive.truth().y - before.y) < 0.01);
}

TEST_CASE("Beside another planner it says nothing and gives up") {
  RecordedDrive drive(fewPatterns(), {});
  drive.bus().runUntil(drive.bus().now() + 10'000);  // runs are identified by their start
  drive.bus().restart("planner");
  drive.run(10.0);
  CHECK(drive.recorder().state() == RecorderNode::State::kFailed);
  CHECK(drive.recorder().reason().find("another planner publishes PROGRAM") == 0);
  CHECK(drive.recorder().recorded()[0].empty());
}

TEST_CASE("A pattern that is refused again and again ends it with the reason") {
  RecordingConfig how;
  how.give_up_after = 3;
  how.limits.max_speed = 0.2;  // below the speed of all driving executions
  RecordedDrive drive(fewPatterns(), how);
  drive.run(120.0);
  INFO(joined(drive.said));
  CHECK(drive.recorder().state() == RecorderNode::State::kFailed);
  CHECK(drive.recorder().reason().find("was refused 3 times in a row, the last time: measured") !=
        std::string::npos);
  drive.bus().runUntil(drive.bus().now() + 300'000);
  CHECK(drive.motor().execution_id == 0);
}

TEST_CASE("Lost, late and doubled messages cost repetitions, not recordings") {
  RecordingConfig how;
  how.executions = 2;
  FaultPlan faults;
  MessageFault fault;
  fault.receiver = "*";
  fault.channel = "*";
  fault.drop = 0.02;
  fault.duplicate = 0.02;
  faults.messages.push_back(fault);
  RecordedDrive drive(fewPatterns(), how, faults);
  drive.run(300.0);
  INFO(joined(drive.said));
  CHECK(drive.recorder().state() == RecorderNode::State::kDone);
}
