// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "common/recordings/csv_table.hpp"
#include "common/recordings/recorded_drive.hpp"
#include "common/soundness/drive_log.hpp"
#include "tests/tools/robot/import/drive_samples.hpp"

using namespace tread;
using namespace tread::recordings;
using namespace tread::samples;

namespace {

struct Imported {
  std::vector<LogEvent> events;
  std::vector<ins_t> ins;
  std::vector<motor_t> motor;
  std::vector<execution_record_t> executions;  ///< the last record of each
  ImportCounts counts;
};

Imported imported(const RecordedDrive& recording, const Session& session,
                  const std::string& format) {
  Imported result;
  result.events = makeLog(recording, session, format, {}, result.counts);
  result.ins = messagesOn(kIns, result.events);
  result.motor = messagesOn(kMotor, result.events);
  for (const execution_t& message : messagesOn(kExecution, result.events)) {
    REQUIRE(message.records.size() <= 8);
    const execution_record_t& last = message.records.back();
    if (last.outcome != execution_record_t::OUTCOME_RUNNING) result.executions.push_back(last);
  }
  return result;
}

Imported importedSteps() {
  const Folder folder("import_steps");
  const std::string csv = folder.file("drive.csv", kStepsHeader + stepRows(3) + stepRows(4));
  const Session session = readSession(folder.file("sessions.csv", sessions(242)), "drive");
  return imported(readSteps(csv, session), session, "steps");
}

/// The exception for a steps file with this content.
std::string complaint(const std::string& content, int rows = 242) {
  const Folder folder("import_bad");
  try {
    const Session session = readSession(folder.file("sessions.csv", sessions(rows)), "drive");
    readSteps(folder.file("drive.csv", content), session);
  } catch (const RecordingError& error) {
    const std::string text = error.what();
    return text.substr(text.find("drive.csv"));
  }
  return "";
}

}  // namespace

TEST_CASE("steps: a fix is an INS message only where it is new, at the time it was measured") {
  const Imported log = importedSteps();
  REQUIRE(log.ins.size() == 2 * 61);
  // The robot was at x = t; the pose came 0.2 s late. Log time of the step's start from MOTOR.
  const int64_t onset = log.motor.front().utime;
  for (size_t i = 0; i < 61; ++i) {
    REQUIRE(log.ins[i].utime == onset + static_cast<int64_t>(i) * 100'000 - 200'000);
    REQUIRE(log.ins[i].position[0] == Approx(0.1 * static_cast<double>(i)));
  }
  // The gyro is not delayed: at the pose's time its value is that time (the sample writes t as the
  // rate).
  REQUIRE(log.ins[20].rate[2] == Approx(1.8));
  REQUIRE(std::isnan(log.ins[20].velocity[0]));
  REQUIRE((log.ins[20].ins_status & ins_t::STATUS_NO_ATTITUDE) != 0);
}

TEST_CASE("all readings of the gyro lie beside the fixes, which stay as they are") {
  const Folder folder("import_gyro");
  const std::string csv = folder.file("drive.csv", kStepsHeader + stepRows(3) + stepRows(4));
  Session session = readSession(folder.file("sessions.csv", sessions(242)), "drive");
  session.pose_lag = 0.23;
  const Imported few = imported(readSteps(csv, session), session, "steps");
  const Imported all = imported(readSteps(csv, session, Gyro::kAll), session, "steps");
  REQUIRE(few.ins.size() == 122);
  REQUIRE(all.ins.size() == 122 + 242);
  constexpr int32_t kNoPose = ins_t::STATUS_NO_POSITION | ins_t::STATUS_NO_HEADING;
  size_t fix = 0;
  for (const ins_t& ins : all.ins) {
    if ((ins.ins_status & kNoPose) != 0) {
      REQUIRE((ins.ins_status & kNoPose) == kNoPose);
      REQUIRE(std::isnan(ins.position[0]));
      REQUIRE(std::isfinite(ins.rate[2]));
      continue;
    }
    REQUIRE(ins.utime == few.ins[fix].utime);
    REQUIRE(ins.ins_status == few.ins[fix].ins_status);
    REQUIRE(ins.position[0] == few.ins[fix].position[0]);
    REQUIRE(std::isnan(ins.rate[2]));
    ++fix;
  }
  REQUIRE(fix == 122);
}

TEST_CASE("without pose lag fixes and gyro are one message at the time at which they were logged") {
  const Folder folder("import_keep_lag");
  const std::string csv = folder.file("drive.csv", kStepsHeader + stepRows(3));
  Session session = readSession(folder.file("sessions.csv", sessions(121)), "drive");
  session.pose_lag = 0.0;
  const Imported log = imported(readSteps(csv, session, Gyro::kAll), session, "steps");
  REQUIRE(log.ins.size() == 121);
  for (size_t i = 0; i < 121; ++i) {
    REQUIRE(log.ins[i].utime == log.motor[i].utime);
    REQUIRE(log.ins[i].rate[2] == Approx(0.05 * static_cast<double>(i)));
    REQUIRE(std::isfinite(log.ins[i].position[0]) == (i % 2 == 0));
  }
}

TEST_CASE("steps: steps are never chained, a silence and a jump lie between them") {
  const Imported log = importedSteps();
  REQUIRE((log.ins[0].ins_status & ins_t::STATUS_JUMP) != 0);
  REQUIRE((log.ins[60].ins_status & ins_t::STATUS_JUMP) == 0);
  REQUIRE((log.ins[61].ins_status & ins_t::STATUS_JUMP) != 0);
  REQUIRE((log.ins[61].ins_status & ins_t::STATUS_GAP) != 0);
  REQUIRE(log.ins[61].utime - log.ins[60].utime >= 2'000'000);
}

TEST_CASE("steps: commands and track speeds are metres per second at the rim") {
  const Imported log = importedSteps();
  REQUIRE(log.motor.size() == 242);
  REQUIRE(log.motor[0].command[0] == 1.0F);
  REQUIRE(log.motor[0].command[1] == 2.0F);
  REQUIRE(log.motor[0].measured[0] == Approx(0.95));
  REQUIRE(log.motor[0].channel_kind[0] == 2);
  REQUIRE(std::isnan(log.motor[0].battery_voltage));
}

TEST_CASE(
    "steps: two executions per command at the stated offset, with ids that follow from the file") {
  const Imported log = importedSteps();
  REQUIRE(log.executions.size() == 4);
  const int64_t onset = log.motor.front().utime;
  const int64_t expected_ids[4] = {11, 12, 21, 22};
  const int expected_patterns[4] = {3, 3, 4, 4};
  for (size_t i = 0; i < 4; ++i) {
    REQUIRE(log.executions[i].record_execution_id == expected_ids[i]);
    REQUIRE(log.executions[i].record_pattern_id == expected_patterns[i]);
    REQUIRE(log.executions[i].outcome == execution_record_t::OUTCOME_COMPLETED);
    REQUIRE(log.executions[i].commands_total == 40);
    REQUIRE(log.executions[i].commands_played == 40);
    REQUIRE(log.executions[i].ended - log.executions[i].started == 2'000'000);
  }
  REQUIRE(log.executions[0].started == onset + 1'200'000);
  REQUIRE(log.executions[1].started == onset + 3'200'000);
  // MOTOR names the execution and counts its commands from 0 to 39.
  REQUIRE(log.motor[23].execution_id == 0);
  REQUIRE(log.motor[24].execution_id == 11);
  REQUIRE(log.motor[24].command_index == 0);
  REQUIRE(log.motor[63].command_index == 39);
  REQUIRE(log.motor[64].execution_id == 12);
  REQUIRE(log.motor[64].command_index == 0);
}

TEST_CASE("the log says on which ground it was driven, and is the same every time") {
  const Imported log = importedSteps();
  const auto marks = messagesOn(kMark, log.events);
  REQUIRE(marks.at(0).mark_kind == "surface");
  REQUIRE(marks.at(0).mark_value == "gravel");
  REQUIRE(marks.at(1).mark_value ==
          "recording drive of a Some robot, 100 kg, tracks 1 m apart; --format steps, poses as "
          "measured, gyro at fixes");
  const Imported again = importedSteps();
  REQUIRE(again.events.size() == log.events.size());
  for (size_t i = 0; i < log.events.size(); ++i) {
    REQUIRE(again.events[i].utime == log.events[i].utime);
    REQUIRE(again.events[i].bytes == log.events[i].bytes);
    if (i > 0) REQUIRE(log.events[i].utime >= log.events[i - 1].utime);
  }
}

TEST_CASE("steps: rows that are missing within a step leave no execution over them") {
  const Folder folder("import_hole");
  std::string rows, kept;
  rows = stepRows(3);
  int row = 0;
  for (size_t at = 0; at < rows.size(); ++row) {
    const size_t end = rows.find('\n', at) + 1;
    if (row < 50 || row >= 90) kept += rows.substr(at, end - at);  // 2.5 to 4.5 s
    at = end;
  }
  const std::string csv = folder.file("drive.csv", kStepsHeader + kept + stepRows(4));
  const Session session = readSession(folder.file("sessions.csv", sessions(202)), "drive");
  const Imported log = imported(readSteps(csv, session), session, "steps");
  REQUIRE(log.motor.size() == 202);
  REQUIRE(log.counts.holes.size() == 1);
  REQUIRE(log.counts.holes[0].end - log.counts.holes[0].begin == Approx(2.0));
  REQUIRE(log.executions.size() == 3);
  REQUIRE(log.executions[0].outcome == execution_record_t::OUTCOME_ABORTED);
  REQUIRE(log.executions[0].outcome_reason == "commands are missing");
  REQUIRE(log.executions[0].commands_played == 26);
  REQUIRE(log.counts.completed == 2);
}

TEST_CASE("aligned: poses as they are, but none inside a long ICP gap") {
  const Folder folder("import_aligned");
  const std::string csv = folder.file("drive.csv", kAlignedHeader + alignedRows(1));
  const Session session = readSession(folder.file("sessions.csv", sessions(1)), "drive");
  const Imported log = imported(readAligned(csv, session), session, "aligned");
  REQUIRE(log.ins.size() == 111 - 9);
  REQUIRE(log.ins[0].utime == log.motor[0].utime);
  int64_t longest = 0;
  for (size_t i = 1; i < log.ins.size(); ++i)
    longest = std::max(longest, log.ins[i].utime - log.ins[i - 1].utime);
  REQUIRE(longest == 500'000);
  REQUIRE(log.executions.size() == 2);
}

TEST_CASE("continuous: the operator's part, the battery and the commands of body speeds") {
  const Folder folder("import_continuous");
  const std::string csv = folder.file("drive.csv", kContinuousHeader + continuousRows());
  const Session session = readSession(folder.file("sessions.csv", sessions(1)), "drive");
  const Imported log = imported(readContinuous(csv, session), session, "continuous");
  REQUIRE(log.motor.size() == 260);
  REQUIRE(log.motor[0].bridge_state == motor_t::STATE_DISARMED);
  REQUIRE(log.motor[50].bridge_state == motor_t::STATE_DRIVING);
  REQUIRE(std::isnan(log.motor[59].battery_voltage));
  REQUIRE(log.motor[60].battery_voltage == 48.5F);
  REQUIRE(log.motor[60].current[1] == 5.0F);
  // v = 1 m/s, w = 0.5 rad/s over a baseline of 1 m.
  REQUIRE(log.motor[200].command[0] == 0.75F);
  REQUIRE(log.motor[200].command[1] == 1.25F);
  REQUIRE(log.ins[0].device_utc == Approx((1.7e9 + 0.05 - 0.2) * 1e6));
  REQUIRE((log.ins[0].ins_status & ins_t::STATUS_NO_ATTITUDE) == 0);
}

TEST_CASE("continuous: a command that the operator cut short leaves its execution aborted") {
  const Folder folder("import_operator");
  const std::string csv = folder.file("drive.csv", kContinuousHeader + continuousRows());
  const Session session = readSession(folder.file("sessions.csv", sessions(1)), "drive");
  const Imported log = imported(readContinuous(csv, session), session, "continuous");
  REQUIRE(log.executions.size() == 4);
  REQUIRE(log.executions[0].outcome == execution_record_t::OUTCOME_COMPLETED);
  REQUIRE(log.executions[1].outcome == execution_record_t::OUTCOME_ABORTED);
  REQUIRE(log.executions[1].outcome_reason == "the operator took over");
  REQUIRE(log.executions[1].commands_played == 16);
  REQUIRE(log.executions[2].record_pattern_id == 2);
  REQUIRE(log.counts.completed == 3);
  REQUIRE(log.counts.aborted == 1);
}

TEST_CASE("a bad file is one line with file and line") {
  const std::string good = stepRows(3) + stepRows(4);
  REQUIRE(complaint(kStepsHeader + good) == "");
  REQUIRE(complaint(kStepsHeader + good.substr(0, good.size() - 20)) ==
          "drive.csv:243: 11 columns, the header has 16; is the file truncated?");
  REQUIRE(complaint(kStepsHeader + stepRows(3)) ==
          "drive.csv:122: the file ends after 121 rows, sessions.csv says 242; is the file "
          "truncated?");
  std::string nan = kStepsHeader + good;
  nan.replace(nan.find("0.1000,0.0"), 6, "nan");
  REQUIRE(complaint(nan) == "drive.csv:4: column x_m is 'nan'; a finite number is needed");
  std::string far = kStepsHeader + good;
  far.replace(far.find("0.1000,0.0"), 6, "1e10");
  REQUIRE(complaint(far) ==
          "drive.csv:4: column x_m is 1e10; allowed is -100000.000000 to 100000.000000");
  std::string missing = kStepsHeader + good;
  missing.replace(missing.find("pose_new"), 8, "pose_old");
  REQUIRE(complaint(missing).find("drive.csv:1: no column pose_new; there are ") == 0);
  REQUIRE(complaint(kStepsHeader) ==
          "drive.csv:1: no rows after the header; is the file truncated?");
  std::string swapped = kStepsHeader + good;
  swapped.replace(swapped.find("3,0,0.100"), 9, "3,0,0.010");
  REQUIRE(complaint(swapped) ==
          "drive.csv:4: t_s does not grow within the step; are the rows in order?");
}

TEST_CASE("the program ends with 2 and one line on bad input, as the gap workflow does") {
  const Folder folder("import_program");
  const std::string said = folder.file("said.txt");
  const std::string command = std::string(TREAD_BIN_DIR) + "/tread-import --format steps " +
                              "--sessions " + folder.file("none.csv") + " " +
                              folder.file("drive.csv") + " -o " + folder.file("drive.lcmlog") +
                              " 2> " + said;
  REQUIRE(WEXITSTATUS(std::system(command.c_str())) == 2);
  std::ifstream file(said);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  REQUIRE(text.find("tread-import: ") == 0);
  REQUIRE(std::count(text.begin(), text.end(), '\n') == 1);
}

TEST_CASE("what is lost is told, and more than a hundredth of it is exit status 1") {
  const Folder folder("import_loss");
  const std::string said = folder.file("said.txt");
  const std::string mapping =
      folder.file("map.yaml",
                  "tables: [{time: {column: t}, columns: {left_command: {column: l}, "
                  "right_command: {column: r}}}]\n");
  const auto exitOf = [&](int twice, const std::string& more) {
    std::string csv = "t,l,r\n";
    for (int i = 0; i < 500; ++i)
      csv += line("%.2f,%.3f,0.5\n", 0.05 * (i < twice ? 0 : i), 0.001 * i);
    const std::string command = std::string(TREAD_BIN_DIR) + "/tread-import --format csv " + more +
                                " --mapping " + mapping + " " + folder.file("drive.csv", csv) +
                                " -o " + folder.file("drive.lcmlog") + " > " + said + " 2>&1";
    std::filesystem::remove(folder.file("drive.lcmlog"));
    const int code = WEXITSTATUS(std::system(command.c_str()));
    REQUIRE(std::filesystem::exists(folder.file("drive.lcmlog")));
    return code;
  };
  const auto words = [&] {
    std::ifstream file(said);
    return std::string{std::istreambuf_iterator<char>(file), {}};
  };
  CHECK(exitOf(5, "") == 0);
  CHECK_THAT(words(), Catch::Contains("lost: 4 of 500 rows of "));
  CHECK(exitOf(50, "") == 1);
  CHECK_THAT(words(), Catch::Contains("lost: 49 of 500 rows of ") &&
                          Catch::Contains("more than 1 % was lost") &&
                          Catch::Contains("gaps in the commands: 1, 2.5 s in all"));
  CHECK(exitOf(50, "--allow-loss") == 0);
}

TEST_CASE("packed recordings are read, and those of other packers are named") {
  const Folder folder("import_packed");
  const std::string said = folder.file("said.txt");
  const std::string mapping =
      folder.file("map.yaml",
                  "tables: [{time: {column: t}, columns: {left_command: {column: l}, "
                  "right_command: {column: r}}}]\n");
  std::string csv = "t,l,r\n";
  for (int i = 0; i < 100; ++i) csv += line("%.2f,0.5,0.5\n", 0.05 * i);
  const std::string path = folder.file("drive.csv", csv);
  const auto exitOf = [&](const std::string& pack, const std::string& name) {
    const std::string command = pack + " " + path + " && " + TREAD_BIN_DIR +
                                "/tread-import --force --format csv --mapping " + mapping + " " +
                                name + " -o " + folder.file("drive.lcmlog") + " > " + said +
                                " 2>&1";
    return WEXITSTATUS(std::system(command.c_str()));
  };
  const auto words = [&] {
    std::ifstream file(said);
    return std::string{std::istreambuf_iterator<char>(file), {}};
  };
  CHECK(exitOf("gzip -kf", path + ".gz") == 0);
  CHECK_THAT(words(), Catch::Contains(" 100 MOTOR"));
  // The last unpacked line is truncated, too: that is not the table's fault.
  const auto whole = std::filesystem::file_size(path + ".gz");
  std::filesystem::resize_file(path + ".gz", whole * 2 / 3);
  CHECK(exitOf("true", path + ".gz") != 0);
  CHECK_THAT(words(), Catch::Contains(path + ".gz: the gzip data is damaged or cut off"));
  if (std::system("command -v xz > /dev/null") != 0) return;
  CHECK(exitOf("xz -kf", path + ".xz") == 2);
  CHECK_THAT(words(), Catch::Contains("is packed by xz; unpack it first: xz -dk " + path + ".xz"));
}

TEST_CASE("a session that is not known is refused, and so is a file that is not there") {
  const Folder folder("import_session");
  const std::string path = folder.file("sessions.csv", sessions(1));
  REQUIRE_THROWS_WITH(readSession(path, "other"), Catch::Contains("no session other"));
  REQUIRE_THROWS_WITH(readSession(folder.file("none.csv"), "drive"),
                      Catch::Contains("cannot be read"));
}

TEST_CASE("real recordings become logs in all their formats") {
  const char* recordings = std::getenv("TREAD_RECORDINGS");
  const std::string drive = std::string(recordings ? recordings : "") + "/drive/";
  if (!std::filesystem::exists(drive + "sessions.csv")) {
    WARN("skipped: no recordings in " + drive);
    return;
  }
  const Session grass = readSession(drive + "sessions.csv", "warthog_grass_20240920a");
  const Imported steps =
      imported(readSteps(drive + "steps/warthog_grass_20240920a.csv", grass), grass, "steps");
  REQUIRE(steps.executions.size() == 198);
  REQUIRE(steps.counts.aborted == 0);
  const Session raw = readSession(drive + "sessions.csv", "warthog_grass_20240729c");
  const std::string name = "/warthog_grass_20240729c.csv";
  const Imported aligned = imported(readAligned(drive + "aligned" + name, raw), raw, "aligned");
  const Imported whole =
      imported(readContinuous(drive + "continuous" + name, raw), raw, "continuous");
  REQUIRE(aligned.executions.size() == 40);
  REQUIRE(whole.executions.size() == 40);
  REQUIRE(whole.motor.back().battery_voltage == Approx(48.25).margin(0.5));
  for (const Imported* log : {&steps, &aligned, &whole})
    for (const gap::LogNote& note : gap::toDrive(toDriveLog("drive", log->events)).notes)
      CHECK_FALSE((note.isOfCommands() && note.isFatal()));
}
