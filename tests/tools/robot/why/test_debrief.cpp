// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include "common/drive/drive_log.hpp"
#include "common/messages/blank.hpp"
#include "tests/helpers.hpp"
#include "tests/tools/called_program.hpp"
#include "tools/robot/why/debrief.hpp"

using namespace tread;
using namespace tread::why;
using tread::samples::called;
using tread::samples::CalledProgram;
using tread::samples::OwnFolder;

namespace {

/// A drive of 20 s along x to a goal 10 m ahead; `stop` [s]: motor_bridge disarms then for 1 s.
struct InventedDrive {
  double stop = -1.0;
  Reason reason = {StopReason::kInsStale, "INS is stale: nothing new within 100 ms"};
  double ins_silent_from = 100.0, ins_silent_to = 100.0;
  std::string driver_says;
  std::string margin = "0.2";
  double error = 0.04;
  double error_late = 0.04;  ///< from 10 s on
  int refused = 0;           ///< of the twenty patterns
  std::string gap;           ///< report of tread-gap watch after 5 s; empty = none
  bool gap_gone = false;     ///< withdrawn after 6 s

  void write(const std::string& path) const {
    DriveLogBuilder log;
    for (int i = 0; i < 200; ++i) step(log, 0.1 * i);
    if (!gap.empty()) log.addMark(at(5.0), "gap", gap);
    if (gap_gone)
      log.addMark(at(6.0), "no gap", "since 5 s the left drive gives as the model says");
    LogWriter writer(path);
    for (const LogEvent& event : log.sorted())
      writer.write(event.utime, event.channel, event.bytes.data(), event.bytes.size());
    writer.flush();
  }

 private:
  static int64_t at(double time) { return 1'000'000 + std::llround(1e6 * time); }

  void step(DriveLogBuilder& log, double time) const {
    const bool stopped = time >= stop && time < stop + 1.0;
    for (const double part : {0.0, 0.05})
      if (time + part < ins_silent_from || time + part >= ins_silent_to) pose(log, time + part);
    auto motor = blank<motor_t>();
    motor.utime = at(time);
    motor.bridge_state = stopped ? motor_t::STATE_DISARMED : motor_t::STATE_DRIVING;
    const Reason why = stopped ? reason : Reason(StopReason::kPlaying);
    motor.state_code = static_cast<int16_t>(why.code);
    motor.state_reason = why.words;
    log.add(kMotor, motor);
    auto plan = blank<plan_t>();
    plan.utime = at(time);
    plan.plan_status = stopped       ? plan_t::PLAN_STOPPED
                       : time > 18.0 ? plan_t::PLAN_ARRIVED
                                     : plan_t::PLAN_DRIVING;
    if (stopped) {
      plan.reason_code = static_cast<int16_t>(reason.code);
      plan.reason = "motor_bridge: " + reason.words;
    }
    log.add(kPlan, plan);
    if (std::fmod(time + 1e-9, 1.0) < 0.05) everySecond(log, time);
  }

  void pose(DriveLogBuilder& log, double time) const {
    auto ins = blank<ins_t>();
    ins.utime = at(time);
    ins.position[0] = 0.5 * time;
    ins.position[1] = ins.position[2] = 0.0;
    DriveLogBuilder::setAttitude(ins, 0.0);
    ins.ins_status = ins_t::STATUS_GOOD;
    log.add(kIns, ins);
  }

  void everySecond(DriveLogBuilder& log, double time) const {
    auto health = blank<health_t>();
    health.utime = at(time + 0.03);
    health.process = "ins_driver";
    health.boot_id = 1;
    const bool ill = !driver_says.empty() && time > ins_silent_from && time < ins_silent_to + 1.0;
    health.health_state = ill ? health_t::HEALTH_FAILED : health_t::HEALTH_OK;
    health.health_reason = ill ? driver_says : "";
    log.add(kHealth, health);
    log.addConfig(at(time), "planner", 1, "margins:\n  growth: " + margin + "\n  plan: 0.1\n");
    auto goal = blank<goal_t>();
    goal.utime = at(time);
    goal.goal_id = 5;
    goal.goal_pose[0] = 10.0;
    goal.goal_pose[1] = goal.goal_pose[2] = 0.0;
    log.add(kGoal, goal);
    auto learning = blank<learning_t>();
    learning.utime = at(time);
    learning.learned_pattern_name = "straight";
    learning.accepted = time >= refused;
    learning.gate_reason = learning.accepted ? "" : "entered in another motion";
    learning.error_position = time < 10.0 ? error : error_late;
    learning.error_yaw = 0.01;
    log.add(kLearning, learning);
  }
};

Debrief debriefOf(const InventedDrive& drive) {
  const OwnFolder folder;
  drive.write(folder.path("drive.lcmlog"));
  return debrief(readTimeline({folder.path("drive.lcmlog")}, kInsStep));
}

InventedDrive withoutIns() {
  InventedDrive drive;
  drive.stop = 8.0;
  drive.ins_silent_from = 7.9;
  drive.ins_silent_to = 10.0;
  drive.driver_says = "/dev/ttyUSB0: no more bytes for 1.1 s";
  return drive;
}

}  // namespace

TEST_CASE("a drive in which nothing went wrong has no finding") {
  const Debrief drive = debriefOf({});
  CHECK(drive.findings.empty());
  CHECK(drive.worst() == nullptr);
  CHECK(drive.figures.goals == 1);
  CHECK(drive.figures.reached == 1);
  CHECK(drive.figures.stops == 0);
  CHECK(drive.figures.measured == 20);
  CHECK(drive.figures.distance == Approx(9.9).margin(0.2));
  CHECK(drive.figures.error_position == Approx(0.04));
  CHECK_THAT(textOf(drive, -1.0), Catch::Contains("why: nothing went wrong"));
}

TEST_CASE("a silent INS is told apart from messages that get lost, with its evidence") {
  const Debrief silent = debriefOf(withoutIns());
  REQUIRE(silent.worst() != nullptr);
  CHECK(silent.worst()->cause == "ins_device");
  CHECK(silent.worst()->time == Approx(8.0).margin(0.02));
  CHECK_THAT(textOf(silent, -1.0), Catch::Contains("no more bytes for 1.1 s"));
  InventedDrive lossy;
  lossy.stop = 8.0;
  const Debrief lost = debriefOf(lossy);
  REQUIRE(lost.worst() != nullptr);
  CHECK(lost.worst()->cause == "lost_INS");
  CHECK(lost.figures.stops == 1);
}

TEST_CASE("what tread-gap watch found before a stop for its motion is evidence of it") {
  InventedDrive drive;
  drive.stop = 8.0;
  drive.reason = {StopReason::kTrackDead,
                  "left track dead: 0.02 m/s where its commands explain 0.6 m/s"};
  drive.gap = "since 4 s the left drive gives 30 % less than the model says (28 to 32 %): motor";
  const Debrief found = debriefOf(drive);
  REQUIRE(found.worst() != nullptr);
  CHECK(found.worst()->cause == "drive");
  CHECK_THAT(textOf(found, -1.0), Catch::Contains("gap_watch: " + drive.gap));
  drive.gap_gone = true;
  CHECK_THAT(textOf(debriefOf(drive), -1.0), !Catch::Contains("gap_watch"));
}

TEST_CASE("patterns that end further off than before are told with the patterns") {
  InventedDrive drive;
  drive.error_late = 0.2;
  const Debrief found = debriefOf(drive);
  REQUIRE(found.worst() != nullptr);
  CHECK(found.worst()->cause == "prediction");
  CHECK(found.worst()->evidence.size() == 4);
  CHECK(found.worst()->time == Approx(10.0).margin(2.1));
}

TEST_CASE("measurements that the learner refused are told by their reason, where they are many") {
  InventedDrive drive;
  drive.refused = 2;
  CHECK(debriefOf(drive).findings.empty());
  drive.refused = 8;
  const Debrief found = debriefOf(drive);
  REQUIRE(found.findings.size() == 1);
  CHECK(found.findings[0].sentence ==
        "the learner rejected 8 of 20 patterns: 8 for entered in another motion");
  CHECK(found.findings[0].evidence.size() == 1);
}

TEST_CASE("another drive is compared: figures, causes and keys of the configuration") {
  InventedDrive better;
  better.margin = "0.3";
  const Debrief before = debriefOf(withoutIns()), now = debriefOf(better);
  const auto keys = configDifferences(before, now);
  REQUIRE(keys.size() == 1);
  CHECK(keys[0].what == "planner.margins.growth");
  CHECK(keys[0].before == "0.2");
  CHECK(keys[0].now == "0.3");
  const std::string text = textOfDifferences(before, now);
  CHECK_THAT(text, Catch::Contains("unplanned stops: 1 -> 0"));
  CHECK_THAT(text, Catch::Contains("cause ins_device: 1 times -> -"));
  CHECK_THAT(textOfDifferences(now, now), Catch::Contains("configuration: the same"));
}

TEST_CASE("tread-why prints, writes a page and JSON, and looks at one moment") {
  const OwnFolder folder;
  withoutIns().write(folder.path("drive.lcmlog"));
  const CalledProgram why = called("tread-why " + folder.path("drive.lcmlog") + " --html " +
                                   folder.path("why.html") + " --json " + folder.path("why.json"));
  CAPTURE(why.printed);
  REQUIRE(why.status == 0);
  CHECK(why.says("why: 8.0 s: the INS gave no usable pose"));
  CHECK_THAT(folder.text("why.html"), Catch::Contains("the INS gave no usable pose"));
  const auto json = nlohmann::json::parse(folder.text("why.json"));
  CHECK(json["findings"][json["worst"].get<size_t>()]["cause"] == "ins_device");
  CHECK_FALSE(json["findings"][0]["evidence"].empty());
  CHECK(called("tread-why " + folder.path("drive.lcmlog") + " --at 8").says("stop: the INS"));
  CHECK(called("tread-why " + folder.path("drive.lcmlog") + " --at 16")
            .says("no findings within 5 s of 16.0 s"));
  CHECK(called("tread-why " + folder.path("drive.lcmlog") + " --against " +
               folder.path("drive.lcmlog"))
            .says("configuration: the same"));
}

TEST_CASE("a log that is truncated is debriefed as far as it goes, and one of others is refused") {
  const OwnFolder folder;
  withoutIns().write(folder.path("drive.lcmlog"));
  const std::string bytes = folder.text("drive.lcmlog");
  folder.write("cut.lcmlog", bytes.substr(0, bytes.size() - 10));
  const CalledProgram cut = called("tread-why " + folder.path("cut.lcmlog"));
  CHECK(cut.status == 0);
  CHECK(cut.says("cut.lcmlog: "));
  folder.write("other.lcmlog", "no log at all");
  const CalledProgram other = called("tread-why " + folder.path("other.lcmlog"));
  CHECK(other.status == 2);
  CHECK(other.isOneLine());
}
