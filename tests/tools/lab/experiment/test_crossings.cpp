// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Changes of ground inside a run, with the command-line program.
#include <sstream>

#include <catch2/catch.hpp>

#include "tests/tools/called_program.hpp"
#include "tests/tools/lab/experiment/crossing_runs.hpp"

namespace {

using tread::samples::called;
using tread::samples::CalledProgram;
using tread::samples::OwnFolder;
using tread::samples::seamMapping;
using tread::samples::writeRuns;

CalledProgram run(const std::string& arguments) {
  return called("tread-experiment crossings " + arguments);
}

/// Numbers of the row of crossings.csv with this beginning.
std::vector<double> rowOf(const std::string& csv, const std::string& begins) {
  const size_t at = csv.find("\n" + begins + ",");
  REQUIRE(at != std::string::npos);
  std::istringstream line(
      csv.substr(at + begins.size() + 2, csv.find('\n', at + 1) - at - begins.size() - 2));
  std::vector<double> numbers;
  for (std::string cell; std::getline(line, cell, ',');) numbers.push_back(std::stod(cell));
  return numbers;
}

}  // namespace

TEST_CASE("a change inside a run is noticed, and the next pieces are predicted behind it") {
  const OwnFolder folder;
  writeRuns(folder.path("drive.csv"), 12, 0.5);
  const CalledProgram result =
      run("--rules off,single,multi_model --set "
          "ground.position_noise=0.001 --mapping " +
          seamMapping() + " " + folder.path("drive.csv") + " --out " + folder.path("out"));
  INFO(result.printed);
  REQUIRE(result.status == 0);
  CHECK(result.says("12 runs, 12 changes of ground; after 12 of them the motion differs"));
  const std::string csv = folder.text("out/crossings.csv");
  const auto errorOf = [&](const std::string& rule, const std::string& phase) {
    return rowOf(csv, rule + "," + phase)[2];
  };
  // Without learning all later pieces behind the border are off by half of the path.
  CHECK(errorOf("off", "later") == Approx(1.0).epsilon(0.1));
  CHECK(errorOf("multi_model", "later") < 0.15);
  CHECK(errorOf("multi_model", "second") < errorOf("single", "second"));
  CHECK(errorOf("multi_model", "third") < errorOf("single", "third"));
  // runs, runs with a false alarm, changes, detected within .5, .8 and 1.6 s
  const std::vector<double> noticed = rowOf(folder.text("out/noticed.csv"), "multi_model");
  CHECK(noticed[0] == 12.0);
  CHECK(noticed[1] <= 1.0);
  CHECK(noticed[3] == 12.0);
  CHECK(noticed[5] >= 10.0);
  CHECK(noticed[6] == 12.0);
}

TEST_CASE("runs on one ground have no change, and hardly a false alarm") {
  const OwnFolder folder;
  writeRuns(folder.path("drive.csv"), 20, 1.0);
  const CalledProgram result = run("--rules multi_model --mapping " + seamMapping() + " " +
                                   folder.path("drive.csv") + " --out " + folder.path("out"));
  INFO(result.printed);
  REQUIRE(result.status == 0);
  CHECK(result.says("after 0 of them the motion differs"));
  const std::vector<double> noticed = rowOf(folder.text("out/noticed.csv"), "multi_model");
  CHECK(noticed[0] == 20.0);
  CHECK(noticed[1] <= 1.0);
}

TEST_CASE("crossings refuses what it cannot do in one line") {
  const OwnFolder folder;
  writeRuns(folder.path("drive.csv"), 2, 0.5);
  const auto refuses = [&](const std::string& arguments, const std::string& words) {
    const CalledProgram result = run(arguments);
    INFO(arguments << "\n" << result.printed);
    CHECK(result.status == 2);
    CHECK(result.printed.rfind("tread-experiment: ", 0) == 0);
    CHECK(result.says(words));
  };
  const std::string drive = " --mapping " + seamMapping() + " " + folder.path("drive.csv");
  refuses("--rules oracle" + drive, "unknown rule 'oracle'");
  refuses("--cut 10" + drive, "no run is left");
  refuses("--set ground.nothing=1" + drive, "nothing");
  refuses("--mapping " + seamMapping() + " " + folder.path("none.csv"), "none.csv");
}
