// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <algorithm>

#include "tests/tools/called_program.hpp"
#include "tests/tools/robot/import/drive_samples.hpp"

using namespace tread::samples;

namespace {

size_t lines(const std::string& text) {
  return static_cast<size_t>(std::count(text.begin(), text.end(), '\n'));
}

const std::string kModelFile =
    std::string(TREAD_SOURCE_DIR) + "/config/models/warthog_nominal.yaml";

}  // namespace

TEST_CASE("from a recording to a report on the command line") {
  const Folder folder("command_line");
  const std::string csv = folder.file("drive.csv", kStepsHeader + stepRows(1) + stepRows(2));
  const std::string log = folder.file("drive.log");
  const std::string report = folder.file("report.txt");
  const CalledProgram import =
      called("tread-import --format steps --sessions " +
             folder.file("sessions.csv", sessions(242)) + " " + csv + " -o " + log);
  INFO(import.printed);
  REQUIRE(import.status == 0);
  // The used data, and the response of speed and turn to the commands.
  REQUIRE(lines(import.printed) == 3);
  const CalledProgram replay = called("tread-replay learner " + log + " --model " + kModelFile +
                                      " --rule collective --report " + report);
  INFO(replay.printed);
  REQUIRE(replay.status == 0);
  REQUIRE(replay.printed.find("drive: 4 executions in, 4 measured, 0 refused") !=
          std::string::npos);
  REQUIRE(std::filesystem::file_size(report) == replay.printed.size());
}

TEST_CASE("a log with left and right commands, of an older version, teaches the same sets today") {
  // For the content and its recording see tests/common/log/test_older_types.cpp.
  const CalledProgram replay = called("tread-replay learner " + std::string(TREAD_SOURCE_DIR) +
                                      "/tests/data/logs/two_tracks.lcmlog");
  INFO(replay.printed);
  REQUIRE(replay.status == 0);
  REQUIRE(replay.printed.find("PATTERN_SET: 4 versions equal, 0 different, 0 only in the log") !=
          std::string::npos);
  REQUIRE(replay.printed.find("LEARNING: 3 executions equal, 0 different") != std::string::npos);
}

TEST_CASE("a truncated recording is one line, and no log is left behind") {
  const Folder folder("command_line_bad");
  const std::string csv = folder.file("drive.csv", kStepsHeader + stepRows(1));
  const std::string log = folder.file("drive.log");
  const CalledProgram import =
      called("tread-import --format steps --sessions " +
             folder.file("sessions.csv", sessions(242)) + " " + csv + " -o " + log);
  REQUIRE(import.status == 2);
  REQUIRE(lines(import.printed) == 1);
  REQUIRE(import.printed.find("drive.csv:122: ") != std::string::npos);
  REQUIRE_FALSE(std::filesystem::exists(log));
}

TEST_CASE("a log that does not fit on the disk is one line, not a success") {
  const Folder folder("command_line_full");
  const std::string csv = folder.file("drive.csv", kStepsHeader + stepRows(1) + stepRows(2));
  const CalledProgram import =
      called("tread-import --format steps --sessions " +
             folder.file("sessions.csv", sessions(242)) + " " + csv + " -o /dev/full");
  REQUIRE(import.status == 1);
  REQUIRE(lines(import.printed) == 1);
  REQUIRE(import.printed.find("/dev/full: cannot be written") != std::string::npos);
}

TEST_CASE("executions of a length that is no whole number of commands are refused") {
  const Folder folder("command_line_length");
  const std::string csv = folder.file("drive.csv", kStepsHeader + stepRows(1) + stepRows(2));
  const CalledProgram import = called("tread-import --format steps --length 0.12 --sessions " +
                                      folder.file("sessions.csv", sessions(242)) + " " + csv +
                                      " -o " + folder.file("x.log"));
  REQUIRE(import.status == 2);
  REQUIRE(lines(import.printed) == 1);
  REQUIRE(import.printed.find("--length") != std::string::npos);
}

TEST_CASE("bad arguments of tread-replay are one clear line each") {
  const CalledProgram missing = called("tread-replay learner /nowhere.log --model " + kModelFile);
  REQUIRE(missing.status == 2);
  REQUIRE(lines(missing.printed) == 1);
  REQUIRE(missing.printed.find("/nowhere.log") != std::string::npos);
  REQUIRE(called("tread-replay learner /nowhere.log").status == 2);
  REQUIRE(called("tread-replay learner x --rule best --model " + kModelFile).status == 2);
  REQUIRE(called("tread-replay").status == 2);
  REQUIRE(called("tread-replay --no-such-option").status == 2);
  REQUIRE(called("tread-import --no-such-option").status == 2);
}
