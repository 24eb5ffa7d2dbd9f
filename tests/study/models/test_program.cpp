// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <filesystem>
#include <string>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/tools/lab/gap/arc_drive.hpp"
#include "tests/tools/lab/gap/gap_program.hpp"

namespace tread::gap {
namespace {

using samples::Folder;
using samples::kModels;
using samples::Run;
using samples::writeDrive;

Run run(const std::string& arguments) {
  return samples::runProgram("tread-compare-models", arguments);
}

}  // namespace

TEST_CASE("bad input to a comparison of models ends with 2 and one line") {
  const Folder folder;
  folder.write("on.yaml",
               "name: a\nkind: track_speed\ngauge: 1\neffects:\n  slip_ratio:\n    slip: 0.1\n");
  folder.write("power.yaml", "name: a\nkind: power\nfull_speed: 1\ngauge: 0.6\n");
  folder.write("no.lcmlog", "this is no log\n");
  writeDrive(folder.path("speeds.lcmlog"), 10.0);
  const std::string measured = "poses: as measured\ngyro: at fixes\n";
  const std::string warthog = "recording: a\nrobot: \"Warthog\"\nformat: steps\nbaseline: 1.08\n";
  const std::string husky = "recording: b\nrobot: \"Husky\"\nformat: steps\nbaseline: 1.08\n";
  writeDrive(folder.path("a.lcmlog"), 30.0, 0.49, warthog + measured);
  writeDrive(folder.path("b.lcmlog"), 31.0, 0.49, warthog + "poses: as logged\ngyro: all\n");
  writeDrive(folder.path("husky.lcmlog"), 32.0, 0.49, husky + measured);
  writeDrive(folder.path("wide.lcmlog"), 33.0, 0.49, "recording: c\nbaseline: 1.1652\n");
  const std::string nominal = " --model " + kModels + "warthog_nominal.yaml ";
  const auto logs = [&](const std::string& second) {
    return folder.path("a.lcmlog") + " " + folder.path(second) + " ";
  };
  const std::string out = " --out " + folder.path("out");
  const std::pair<std::string, std::string> kBad[] = {
      {"--log none.lcmlog" + out, "none.lcmlog"},
      {"--log " + folder.path("no.lcmlog") + out, "no.lcmlog"},
      {"--pool --log " + folder.path("speeds.lcmlog") + out, "at least two --log"},
      {"--log " + folder.path("speeds.lcmlog") + " " + folder.path("speeds.lcmlog") + out,
       "give each log once"},
      {"--model " + folder.path("power.yaml") + " --log " + folder.path("speeds.lcmlog") + out,
       "its commands are track speeds"},
      {"--model " + folder.path("on.yaml") + " --log " + folder.path("speeds.lcmlog") + out,
       "the effect slip_ratio is on"},
      {"--log " + logs("b.lcmlog") + out, "import both in the same way"},
      {"--pool --log " + logs("husky.lcmlog") + out, "give logs of one robot"},
      {nominal + "--log " + folder.path("wide.lcmlog") + out, "gauge: 1.08"},
      {nominal + "--log " + folder.path("a.lcmlog") + out,
       "only 30 s of measured driving, too little"}};
  for (const auto& [arguments, words] : kBad) {
    const Run bad = run(arguments);
    INFO(arguments << "\n" << bad.printed);
    CHECK(bad.status == 2);
    CHECK(bad.says(words));
    CHECK(std::count(bad.printed.begin(), bad.printed.end(), '\n') == 1);
  }
  CHECK_FALSE(std::filesystem::exists(folder.path("out")));
}

TEST_CASE(
    "a comparison for a log is a table, a file for people and one for programs, always the same") {
  const Folder folder;
  writeDrive(folder.path("drive.lcmlog"), 220.0);
  writeDrive(folder.path("short.lcmlog"), 30.0);
  const std::string comparison = "--model " + kModels + "warthog_nominal.yaml --log " +
                                 folder.path("drive.lcmlog") + " " + folder.path("short.lcmlog");
  const Run one = run(comparison + " --threads 1 --out " + folder.path("a"));
  INFO(one.printed);
  CHECK(one.status == 0);
  CHECK(one.says("Yaw error after 2 s"));
  CHECK(one.says("short.lcmlog: only 30 s of measured driving, too little to tell chance"));
  const auto json = nlohmann::json::parse(folder.text("a/comparison.json"));
  const auto& rungs = json["nested"][0]["rungs"];
  CHECK(rungs["gain_track"]["yaw_rad"]["median"] < rungs["ideal"]["yaw_rad"]["median"]);
  CHECK(rungs.contains("discovered"));
  for (const char* rival : {"all_parameters", "sparse_regression"}) {
    CHECK(rungs[rival]["yaw_rad"]["median"] < rungs["ideal"]["yaw_rad"]["median"]);
    CHECK(json["nested"][0]["folds"][0]["named"].contains(rival));
  }
  CHECK(run(comparison + " --threads 2 --out " + folder.path("b")).status == 0);
  for (const char* file : {"comparison.json", "comparison.md"})
    CHECK(folder.text(std::string("a/") + file) == folder.text(std::string("b/") + file));
}

TEST_CASE(
    "without a model the comparison begins with the track that a recording names, or above it") {
  const Folder folder;
  writeDrive(folder.path("named.lcmlog"), 202.0, 0.49, "recording: a\nbaseline: 1.08\n");
  writeDrive(folder.path("nameless.lcmlog"), 202.0);
  const Run both = run("--log " + folder.path("named.lcmlog") + " " +
                       folder.path("nameless.lcmlog") + " --out " + folder.path("out"));
  INFO(both.printed);
  CHECK(both.status == 0);
  const auto json = nlohmann::json::parse(folder.text("out/comparison.json"));
  const auto& named = json["nested"][0]["rungs"];
  const auto& nameless = json["nested"][1]["rungs"];
  CHECK(named.contains("ideal"));
  CHECK_FALSE(nameless.contains("ideal"));
  // The effective track is fitted, so its initial value does not matter.
  CHECK(nameless["gain_track"]["yaw_rad"]["rms"].get<double>() ==
        Approx(named["gain_track"]["yaw_rad"]["rms"].get<double>()).epsilon(0.05));
}

}  // namespace tread::gap
