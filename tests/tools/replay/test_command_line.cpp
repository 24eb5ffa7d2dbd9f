// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>

#include "tests/tools/import/drive_samples.hpp"

using namespace tread::samples;

namespace {

struct Outcome {
  int code = -1;
  std::string said;  ///< on both outputs
};

Outcome call(const std::string& arguments) {
  Outcome outcome;
  FILE* pipe = popen((std::string(TREAD_BIN_DIR) + "/" + arguments + " 2>&1").c_str(), "r");
  REQUIRE(pipe != nullptr);
  std::array<char, 512> piece;
  while (std::fgets(piece.data(), piece.size(), pipe)) outcome.said += piece.data();
  const int status = pclose(pipe);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

size_t lines(const std::string& text) {
  return static_cast<size_t>(std::count(text.begin(), text.end(), '\n'));
}

const std::string kModel = std::string(TREAD_SOURCE_DIR) + "/config/models/warthog_nominal.yaml";

}  // namespace

TEST_CASE("from a recording to a report on the command line") {
  const Folder folder("command_line");
  const std::string csv = folder.file("drive.csv", kStepsHeader + stepRows(1) + stepRows(2));
  const std::string log = folder.file("drive.log");
  const std::string report = folder.file("report.txt");
  const Outcome import =
      call("tread-import --format steps --sessions " + folder.file("sessions.csv", sessions(242)) +
           " " + csv + " -o " + log);
  INFO(import.said);
  REQUIRE(import.code == 0);
  REQUIRE(lines(import.said) == 1);
  const Outcome replay = call("tread-replay learner " + log + " --model " + kModel +
                              " --rule collective --report " + report);
  INFO(replay.said);
  REQUIRE(replay.code == 0);
  REQUIRE(replay.said.find("drive: 4 executions in, 4 measured, 0 refused") != std::string::npos);
  REQUIRE(std::filesystem::file_size(report) == replay.said.size());
}

TEST_CASE("a truncated recording is one line, and no log is left behind") {
  const Folder folder("command_line_bad");
  const std::string csv = folder.file("drive.csv", kStepsHeader + stepRows(1));
  const std::string log = folder.file("drive.log");
  const Outcome import =
      call("tread-import --format steps --sessions " + folder.file("sessions.csv", sessions(242)) +
           " " + csv + " -o " + log);
  REQUIRE(import.code == 2);
  REQUIRE(lines(import.said) == 1);
  REQUIRE(import.said.find("drive.csv:122: ") != std::string::npos);
  REQUIRE_FALSE(std::filesystem::exists(log));
}

TEST_CASE("a log that does not fit on the disk is one line, not a success") {
  const Folder folder("command_line_full");
  const std::string csv = folder.file("drive.csv", kStepsHeader + stepRows(1) + stepRows(2));
  const Outcome import =
      call("tread-import --format steps --sessions " + folder.file("sessions.csv", sessions(242)) +
           " " + csv + " -o /dev/full");
  REQUIRE(import.code == 2);
  REQUIRE(lines(import.said) == 1);
  REQUIRE(import.said.find("/dev/full: cannot be written") != std::string::npos);
}

TEST_CASE("executions of a length that is no whole number of commands are refused") {
  const Folder folder("command_line_length");
  const std::string csv = folder.file("drive.csv", kStepsHeader + stepRows(1) + stepRows(2));
  const Outcome import =
      call("tread-import --format steps --length 0.12 --sessions " +
           folder.file("sessions.csv", sessions(242)) + " " + csv + " -o " + folder.file("x.log"));
  REQUIRE(import.code == 2);
  REQUIRE(lines(import.said) == 1);
  REQUIRE(import.said.find("--length") != std::string::npos);
}

TEST_CASE("bad arguments of tread-replay are one clear line each") {
  const Outcome missing = call("tread-replay learner /nowhere.log --model " + kModel);
  REQUIRE(missing.code == 1);
  REQUIRE(lines(missing.said) == 1);
  REQUIRE(missing.said.find("/nowhere.log") != std::string::npos);
  REQUIRE(call("tread-replay learner /nowhere.log").code == 1);
  REQUIRE(call("tread-replay learner x --rule best --model " + kModel).code == 2);
  REQUIRE(call("tread-replay").code == 2);
  REQUIRE(call("tread-replay --no-such-option").code == 2);
  REQUIRE(call("tread-import --no-such-option").code == 2);
}
