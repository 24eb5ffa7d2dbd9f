// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <algorithm>
#include <iterator>

#include "tests/common/recordings/synthetic_drives.hpp"
#include "tests/helpers.hpp"
#include "tests/tools/called_program.hpp"

using namespace tread;

namespace {

using tread::samples::called;
using tread::samples::CalledProgram;
using tread::samples::linearGround;
using tread::samples::writeDrives;
using tread::testing::contentOf;
using DriveFolder = tread::samples::Folder;

std::string drivesIn(const DriveFolder& folder) {
  return writeDrives(folder, {{"one", "Rover", "hard", linearGround(0.95, 0.50, -0.05)},
                              {"two", "Rover", "soft", linearGround(0.85, 0.43, -0.10)}});
}

}  // namespace

TEST_CASE(
    "from-recordings writes recordings, averaged sets and a log that the learner learns from") {
  const DriveFolder folder("from_recordings");
  const std::string drives = drivesIn(folder);
  const std::string recorded = folder.file("recorded");
  const std::string log = folder.file("soft.log");
  const std::string arguments = "tread-patterns from-recordings " + drives + " --robot rov -o " +
                                recorded + " --log " + log +
                                " --from hard --to soft --executions 16 --seed 3";
  const CalledProgram made = called(arguments);
  INFO(made.printed);
  REQUIRE(made.status == 0);
  CHECK(made.printed.find("hard: 48 steady windows used") != std::string::npos);
  const recordings::PatternRecordings read = recordings::readRecordings(recorded);
  REQUIRE(read.surfaces.size() == 2);
  CHECK(read.surfaces[1].surface == "soft");
  CHECK(read.patterns.patterns().size() == 8);
  const CalledProgram replay = called("tread-replay learner " + log + " --patterns " + recorded +
                                      "/hard.yaml --rule single");
  INFO(replay.printed);
  CHECK(replay.status == 0);
  CHECK(replay.printed.find("soft: 32 executions in, 32 measured, 0 refused") != std::string::npos);
  const std::string again = folder.file("again");
  REQUIRE(called(arguments.substr(0, arguments.find(" -o ")) + " -o " + again + " --log " + again +
                 ".log --from hard --to soft --executions 16 --seed 3")
              .status == 0);
  CHECK(contentOf(log) == contentOf(again + ".log"));
  CHECK(contentOf(recorded + "/soft.csv") == contentOf(again + "/soft.csv"));
}

TEST_CASE("from-recordings says in one line what is wrong") {
  const DriveFolder folder("from_recordings_bad");
  const std::string drives = drivesIn(folder);
  const std::string make =
      "tread-patterns from-recordings " + drives + " -o " + folder.file("recorded");
  const auto complaint = [](const std::string& arguments) {
    const CalledProgram outcome = called(arguments);
    INFO(outcome.printed);
    CHECK(outcome.status == 2);
    CHECK(std::count(outcome.printed.begin(), outcome.printed.end(), '\n') == 1);
    return outcome.printed;
  };
  CHECK(complaint(make + " --robot horse") ==
        "tread-patterns: no robot is called 'horse'; there are 'Rover'\n");
  CHECK(complaint(make + " --log " + folder.file("a.log") + " --from hard --to ice") ==
        "tread-patterns: --to 'ice': name one of the surfaces hard, soft\n");
  CHECK(complaint(make + " --recipe /no/such/recipe.yaml").find("/no/such/recipe.yaml") !=
        std::string::npos);
  CHECK(complaint("tread-patterns from-recordings /no/such/drives -o " + folder.file("recorded"))
            .find("/no/such/drives/sessions.csv: cannot be read") != std::string::npos);
  // A usage error has code 2.
  CHECK(called(make + " --log " + folder.file("a.log")).status == 2);
}

TEST_CASE("from-recordings does not mix its surfaces with other recordings") {
  const DriveFolder folder("from_recordings_mixed");
  const std::string drives = drivesIn(folder);
  std::filesystem::create_directories(folder.file("recorded"));
  folder.file("recorded/ice.csv", "pattern,execution,sample,x_m,y_m,yaw_rad\n");
  const CalledProgram outcome =
      called("tread-patterns from-recordings --force " + drives + " -o " + folder.file("recorded"));
  CHECK(outcome.status == 2);
  CHECK(outcome.printed.find("ice.csv: a surface of other recordings") != std::string::npos);
}
