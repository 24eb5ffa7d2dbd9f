// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "common/recordings/recorded_drive.hpp"
#include "common/report/page.hpp"
#include "common/soundness/drive_log.hpp"
#include "common/store/store.hpp"
#include "tests/helpers.hpp"
#include "tests/tools/lab/gap/small_log.hpp"
#include "tests/tools/robot/import/drive_samples.hpp"

using namespace tread;
using namespace tread::gap;
using namespace tread::samples;

namespace {

size_t posesOf(const Segment& segment) {
  size_t count = 0;
  for (const InsSample& sample : segment.ins) count += std::isfinite(sample.T_map_body.x) ? 1 : 0;
  return count;
}

Drive importedSteps(int steps, bool keep_lag, recordings::Gyro gyro) {
  const Folder folder("gap_steps");
  std::string rows = kStepsHeader;
  for (int step = 1; step <= steps; ++step) rows += stepRows(step);
  const std::string csv = folder.file("drive.csv", rows);
  recordings::Session session =
      recordings::readSession(folder.file("sessions.csv", sessions(121 * steps)), "drive");
  session.lag_kept = keep_lag;
  if (keep_lag) session.pose_lag = 0.0;
  recordings::ImportCounts counts;
  return toDrive(
      toDriveLog("drive.lcmlog", recordings::makeLog(recordings::readSteps(csv, session, gyro),
                                                     session, "steps", {}, counts)));
}

}  // namespace

TEST_CASE(
    "a drive without a gap is one segment at rest, its commands merged, its poses unwrapped") {
  SmallLog log;
  for (int i = 0; i < 20; ++i) {
    log.motor(0.05 * i, {}, motor_t::STATE_ARMED);
    log.ins(0.05 * i, {}, 0.0);
  }
  drive(log, 1.0, 21.0, {1.0, 0.0, 0.8}, {});
  const Drive result = toDrive(toDriveLog("a.lcmlog", log.sorted()));
  REQUIRE(result.segments.size() == 1);
  const Segment& segment = result.segments[0];
  REQUIRE(result.kind == CommandKind::kTrackSpeed);
  REQUIRE(segment.begin() == 0.0);
  REQUIRE(segment.end == Approx(21.0));
  REQUIRE(segment.commands.size() == 2);
  REQUIRE(segment.commands[1].time == Approx(1.0));
  REQUIRE(segment.commands[1].command[1] == Approx(1.4));
  REQUIRE_FALSE(segment.entry_speeds);
  REQUIRE(segment.command_before == TrackCommand{});
  REQUIRE(segment.ins.back().T_map_body.yaw == Approx(0.8 * 19.9));
  REQUIRE(std::isnan(segment.ins.back().roll));
  REQUIRE(result.driven() == Approx(21.0));
  REQUIRE(result.encoders.empty());
  REQUIRE(result.voltage.empty());
}

TEST_CASE("missing commands end a segment, and where the robot still moves after them poses wait") {
  SmallLog log;
  const Pose2 T_map_body = drive(log, 0.0, 10.0, {1.0, 0.0, 0.0}, {});
  drive(log, 10.5, 20.5, {1.0, 0.0, 0.0}, T_map_body);
  const Drive result = toDrive(toDriveLog("a", log.sorted()));
  REQUIRE(result.segments.size() == 2);
  REQUIRE(result.segments[0].end == Approx(10.0));
  REQUIRE(result.segments[1].begin() == Approx(10.5));
  // The speed is unknown then; after three seconds it no longer matters.
  REQUIRE(result.segments[1].ins.front().time == Approx(13.5));
}

TEST_CASE(
    "what an operator or a fault does is unknown, what the robot's own bridge holds is zero") {
  SmallLog log;
  for (int i = 0; i < 400; ++i) {
    const double time = 0.05 * i;
    log.ins(time, {0.01 * i, 0.0, 0.0}, 0.0);
    if (time < 5.0)
      log.motor(time, {0.3, 0.3}, motor_t::STATE_DISARMED, StopReason::kNotArmedYet);
    else if (time < 10.0)
      log.motor(time, {0.3, 0.3}, motor_t::STATE_DISARMED, StopReason::kOperatorDrives);
    else if (time < 15.0)
      log.motor(time, {0.3, 0.3});
    else
      log.motor(time, {}, motor_t::STATE_ESTOP);
  }
  const Drive result = toDrive(toDriveLog("a", log.sorted()));
  REQUIRE(result.segments.size() == 2);
  REQUIRE(result.segments[0].commands.size() == 1);
  REQUIRE(result.segments[0].commands[0].command == TrackCommand{});
  REQUIRE(result.segments[0].end == Approx(5.0));
  REQUIRE(result.segments[1].begin() == Approx(10.0));
  REQUIRE(result.segments[1].end == Approx(15.0));
}

TEST_CASE("motor currents are read where both tracks' are known") {
  SmallLog log;
  for (int i = 0; i < 100; ++i) {
    log.current_left = i < 50 ? 3.5F : static_cast<float>(kNaN);
    log.current_right = -1.5F;
    log.motor(0.05 * i, {1.0, 1.0});
    log.ins(0.05 * i, {0.05 * i, 0.0, 0.0}, 0.0);
  }
  const Drive result = toDrive(toDriveLog("a", log.sorted()));
  REQUIRE(result.currents.size() == 50);
  REQUIRE(result.currents[49].time == Approx(2.45));
  REQUIRE(result.currents[49].left == 3.5);
  REQUIRE(result.currents[49].right == -1.5);
}

TEST_CASE("a jump or a silence of the INS begins a segment whose commands begin before its poses") {
  SmallLog log;
  for (int i = 0; i < 600; ++i) {
    const double time = 0.05 * i;
    log.motor(time, {1.0, 1.0});
    const bool silent = time > 18.01 && time < 19.99;
    const Pose2 pose{time + (i >= 200 ? 50.0 : 0.0), 0.0, 0.0};
    if (!silent) log.ins(time, pose, 0.0, i == 200 ? ins_t::STATUS_JUMP : 0);
  }
  const Drive result = toDrive(toDriveLog("a", log.sorted()));
  REQUIRE(result.segments.size() == 3);
  REQUIRE(result.segments[0].ins.back().time == Approx(9.95));
  REQUIRE(result.segments[1].begin() == Approx(7.0));
  REQUIRE(result.segments[1].ins.front().time == Approx(10.0));
  REQUIRE(result.segments[1].command_before[0] == 1.0);
  REQUIRE(result.segments[2].begin() == Approx(17.0));
  REQUIRE(result.segments[2].ins.front().time == Approx(20.0));
  for (const Execution& execution : result.executions) {
    const Segment& segment = result.segments[execution.segment];
    REQUIRE(execution.begin >= segment.ins.front().time - 0.05);
    REQUIRE(execution.end <= segment.end + 0.05);
  }
}

TEST_CASE(
    "a held pose is no pose, but its gyro counts, and a robot told to stand may repeat its pose") {
  SmallLog log;
  for (int i = 0; i < 200; ++i) {
    const double time = 0.05 * i;
    const bool drives = time >= 4.99;
    log.motor(time, drives ? TrackCommand{1.0, 1.0} : TrackCommand{});
    log.ins(time, {drives ? 0.05 * (i / 4) : 0.0, 0.0, 0.0}, 0.1);
  }
  const Drive result = toDrive(toDriveLog("a", log.sorted()));
  REQUIRE(result.segments.size() == 1);
  const auto& ins = result.segments[0].ins;
  REQUIRE(ins.size() == 200);
  size_t standing = 0;
  size_t driving = 0;
  for (const InsSample& sample : ins) {
    REQUIRE(sample.omega == Approx(0.1));
    if (std::isfinite(sample.T_map_body.x)) ++(sample.time < 4.97 ? standing : driving);
  }
  REQUIRE(standing >= 80);
  REQUIRE(driving == 25);
}

TEST_CASE("whole turns between two late poses are those of the gyro") {
  SmallLog log;
  double yaw = 0.0;
  for (int i = 0; i < 400; ++i) {
    const double time = 0.05 * i;
    const double omega = 4.0;
    log.motor(time, {-2.0, 2.0});
    if (i % 24 == 0)
      log.ins(time, {0.1 * i, 0.0, yaw}, omega);
    else
      log.ins(time, {kNaN, kNaN, kNaN}, omega,
              ins_t::STATUS_NO_POSITION | ins_t::STATUS_NO_HEADING);
    yaw += 0.05 * omega;
  }
  const Drive result = toDrive(toDriveLog("a", log.sorted()));
  REQUIRE(result.segments.size() == 1);
  const auto& last = result.segments[0].ins[384];
  REQUIRE(last.T_map_body.yaw == Approx(4.0 * 0.05 * 384));
}

TEST_CASE(
    "executions of two seconds are kept, long ones are cut, others leave pieces of the drive") {
  SmallLog log;
  drive(log, 0.0, 30.0, {1.0, 0.0, 0.1}, {});
  SECTION("two seconds") {
    for (int n = 0; n < 12; ++n) log.execution(n + 1, 2.2 * n + 0.5, 2.2 * n + 2.5);
    log.execution(99, 28.0, 29.5, execution_record_t::OUTCOME_ABORTED);
    const Drive result = toDrive(toDriveLog("a", log.sorted()));
    REQUIRE(result.executions.size() == 12);
    REQUIRE(result.executions[1].begin == Approx(2.7));
    REQUIRE(result.executions[1].end == Approx(4.7));
  }
  SECTION("five seconds") {
    for (int n = 0; n < 5; ++n) log.execution(n + 1, 5.0 * n + 0.5, 5.0 * n + 5.5);
    const Drive result = toDrive(toDriveLog("a", log.sorted()));
    REQUIRE(result.executions.size() == 10);
    REQUIRE(result.executions[1].begin == Approx(2.5));
  }
  SECTION("one second, or none") {
    for (int n = 0; n < 20; ++n) log.execution(n + 1, 1.0 * n, 1.0 * n + 1.0);
    const Drive result = toDrive(toDriveLog("a", log.sorted()));
    REQUIRE(result.executions.size() == 15);
    REQUIRE(result.executions[14].end == Approx(30.0));
  }
}

TEST_CASE(
    "an imported recording: a segment a step, with the gyro of all rows and the poses as logged") {
  const Drive fixes = importedSteps(2, false, recordings::Gyro::kAtFixes);
  REQUIRE(fixes.segments.size() == 2);
  // The first two of 61 fixes precede the first command.
  REQUIRE(posesOf(fixes.segments[0]) == 59);
  const Drive all = importedSteps(2, true, recordings::Gyro::kAll);
  REQUIRE(all.segments.size() == 2);
  const Segment& step = all.segments[1];
  REQUIRE(posesOf(step) == 61);
  REQUIRE(step.ins.size() == 121);
  REQUIRE(step.end - step.begin() == Approx(6.05));
  for (size_t i = 0; i < step.ins.size(); ++i) {
    REQUIRE(step.ins[i].time - step.begin() == Approx(0.05 * static_cast<double>(i)).margin(1e-9));
    REQUIRE(step.ins[i].omega == Approx(0.05 * static_cast<double>(i)).margin(1e-6));
    if (i % 2 == 0) REQUIRE(step.ins[i].T_map_body.x == Approx(0.05 * static_cast<double>(i)));
  }
  REQUIRE(all.executions.size() == 4);
  REQUIRE(all.executions[0].begin - all.segments[0].begin() == Approx(1.2));
}

TEST_CASE(
    "an imported step begins with its encoders, after the step before it if it went on at once") {
  const Drive all = importedSteps(2, true, recordings::Gyro::kAll);
  // 1.9 and 3.9 rad/s at 0.5 m, commanded 2 and 4 rad/s.
  REQUIRE(all.segments[0].entry_speeds->tracks().left == Approx(0.95));
  REQUIRE(all.segments[0].command_before[0] == Approx(0.95));
  REQUIRE(all.segments[1].entry_speeds->tracks().right == Approx(1.95));
  REQUIRE(all.segments[1].command_before[1] == Approx(2.0));
}

TEST_CASE("all readings of the gyro: fixes stay what they were, and no reading is said twice") {
  const Drive lag_removed = importedSteps(1, false, recordings::Gyro::kAll);
  const auto& ins = lag_removed.segments.at(0).ins;
  size_t rates = 0;
  for (const InsSample& sample : ins) rates += std::isfinite(sample.omega) ? 1 : 0;
  REQUIRE(rates == 121);
  REQUIRE(posesOf(lag_removed.segments[0]) == 59);
}

TEST_CASE(
    "a log that cannot be read is one clear line, of a truncated one the whole events count") {
  const Folder folder("gap_bad");
  REQUIRE_THROWS_WITH(readDrive(folder.file("none.lcmlog")), Catch::Contains("cannot be read"));
  REQUIRE_THROWS_WITH(readDrive(folder.file("text.lcmlog", "no log at all")),
                      Catch::Contains("is this an LCM log"));
  SmallLog log;
  drive(log, 0.0, 10.0, {1.0, 0.0, 0.1}, {});
  const std::string path = folder.file("cut.lcmlog");
  {
    LogWriter writer(path);
    for (const LogEvent& event : log.sorted())
      writer.write(event.utime, event.channel, event.bytes.data(), event.bytes.size());
  }
  for (const LogNote& note : readDrive(path).notes) REQUIRE_FALSE(note.isFatal());
  REQUIRE(readDrive(path).name == "cut.lcmlog");
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 30);
  const Drive cut = readDrive(path);
  for (const LogNote& note : cut.notes) REQUIRE_FALSE(note.isFatal());
  REQUIRE_THAT(cut.notes.at(0).what, Catch::Contains("ends in the middle of an event; its 299 "
                                                     "whole events, 10 s, are used"));
  REQUIRE(cut.lost == cut.notes[0].what);
  REQUIRE(cut.segments.size() == 1);
}

TEST_CASE("a drive says of which robot it was imported, and how") {
  const Drive fixes = importedSteps(2, false, recordings::Gyro::kAtFixes);
  REQUIRE(fixes.imported);
  CHECK(fixes.imported->robot == "Some robot, 100 kg");
  CHECK(fixes.imported->baseline == 1.0);
  CHECK(fixes.imported->options == "--format steps, poses as measured, gyro at fixes");
  const Drive all = importedSteps(2, true, recordings::Gyro::kAll);
  CHECK(all.imported->options == "--format steps, poses as logged, gyro all");
  CHECK_NOTHROW(requireSameImport(fixes, fixes));
  CHECK_THROWS_WITH(requireSameImport(fixes, all),
                    "drive.lcmlog: imported with --format steps, poses as logged, gyro all, but "
                    "drive.lcmlog with --format steps, poses as measured, gyro at fixes; import "
                    "both in the same way");
  CHECK_NOTHROW(requireSameGauge(fixes, 1.015));
  CHECK_THROWS_WITH(requireSameGauge(fixes, 1.08),
                    "drive.lcmlog: its commands were made for tracks 1 m apart, the model says "
                    "gauge: 1.08; give a model of this robot");
  Drive other = fixes;
  other.imported->robot = "Husky";
  CHECK_THROWS_WITH(requireSameRobot(fixes, other),
                    "drive.lcmlog: of the robot Husky, but drive.lcmlog of the robot Some robot, "
                    "100 kg; give logs of one robot");
  SmallLog own;
  drive(own, 0.0, 10.0, {1.0, 0.0, 0.1}, {});
  const Drive live = toDrive(toDriveLog("live.lcmlog", own.sorted()));
  CHECK_FALSE(live.imported);
  CHECK_NOTHROW(requireSameImport(live, fixes));
  CHECK_NOTHROW(requireSameGauge(live, 3.0));
}

TEST_CASE("the hash of a log is its SHA-256") {
  const Folder folder("gap_hash");
  REQUIRE(sha256(readText(folder.file("abc", "abc"))) ==
          "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST_CASE(
    "real recordings become drives with a segment for every step, and nothing in them is fatal") {
  const std::string folder = tread::testing::recorded("drive/");
  if (folder.empty()) {
    WARN("skipped: the recorded drives are not here (TREAD_RECORDINGS)");
    return;
  }
  struct Expected {
    const char* session;
    size_t segments;     // steps of the recording
    size_t most_broken;  // steps in a wrong frame
  };
  for (const Expected& expected : {Expected{"warthog_unlabelled_2023", 119, 0},
                                   {"warthog_gravel_20240806", 99, 5},
                                   {"warthog_sand_20240925a", 99, 5},
                                   {"husky_tile_2022", 199, 0}}) {
    const std::string name = expected.session;
    recordings::Session session = recordings::readSession(folder + "sessions.csv", name);
    session.pose_lag = 0.0;
    recordings::ImportCounts counts;
    const auto recording =
        recordings::readSteps(folder + "steps/" + name + ".csv", session, recordings::Gyro::kAll);
    const Drive result =
        toDrive(toDriveLog(name, recordings::makeLog(recording, session, "steps", {}, counts)));
    INFO(name);
    for (const LogNote& note : result.notes) {
      INFO(note.what);
      REQUIRE_FALSE(note.isFatal());
    }
    REQUIRE(result.segments.size() <= expected.segments);
    REQUIRE(result.segments.size() + expected.most_broken >= expected.segments);
    REQUIRE(result.executions.size() == 2 * result.segments.size());
    REQUIRE(result.encoders.size() == recording.drive.size());
    for (const Segment& segment : result.segments) {
      REQUIRE(segment.entry_speeds);
      REQUIRE(segment.end - segment.begin() > 5.0);
      // A gyro value in every row; usually a fifth to a half of them have a new pose.
      REQUIRE(segment.ins.size() > 100);
      REQUIRE(posesOf(segment) * 20 > segment.ins.size());
    }
  }
}
