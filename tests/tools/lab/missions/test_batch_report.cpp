// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Counts, tables and JSON of invented missions with known numbers.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <sstream>

#include <nlohmann/json.hpp>

#include "tests/tools/called_program.hpp"
#include "tools/lab/missions/comparison_report.hpp"
#include "tools/lab/missions/prediction_errors.hpp"

using namespace tread;
using namespace tread::missions;
using namespace tread::samples;
using Json = nlohmann::json;

namespace {

MissionResult mission(uint64_t seed, MissionOutcome outcome, const std::string& reason = "") {
  MissionResult result;
  result.seed = seed;
  result.outcome = outcome;
  result.reason = reason;
  result.time = 50.0;
  result.begun = 2.0;
  result.driven = 40.0;
  result.distance = 36.0;
  result.straight_line = 30.0;
  return result;
}

MissionBatch invented() {
  MissionBatch batch;
  batch.seed = 1;
  batch.rule = "bank";
  batch.overrides = {"planner.margins.growth=0"};
  batch.virtual_time = 300.0;
  batch.wall_time = 30.0;
  batch.cpu_time = 60.0;
  batch.results = {mission(1, MissionOutcome::kArrived),
                   mission(2, MissionOutcome::kArrived),
                   mission(3, MissionOutcome::kArrived),
                   mission(4, MissionOutcome::kRefused, "unreachable: a wall"),
                   mission(5, MissionOutcome::kRefused, "unreachable: a wall"),
                   mission(6, MissionOutcome::kStopped, "time ran out")};
  batch.results[1].contacts = {{10.0, "left", {}, 0.02}, {20.0, "", {}, 0.01}};
  batch.results[1].line_blocked = true;
  batch.results[2].flips = {{5.0, "left", "right"}};
  batch.results[2].stops = {{6.0, 0.5, "too near"}, {7.0, 1.5, ""}};
  return batch;
}

std::string summaryOf(const MissionBatch& batch) {
  std::ostringstream text;
  printSummary(text, batch);
  return text.str();
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// An execution of 1 s with this end error.
ScoredExecution scored(double time, const std::string& surface, double error) {
  ScoredExecution execution;
  execution.time = time;
  execution.pattern = "ahead";
  execution.surface = surface;
  execution.measured = true;
  execution.path_length = 2.0;
  execution.error_position = error;
  execution.error_yaw = -error;
  return execution;
}

/// Errors of 1 m that fall to `later` after `needed` executions on grass; the oracle's error is
/// known.
struct HandMade {
  std::vector<MissionResult> results;
  Omniscient omniscient;
};

HandMade handMade(int on_grass, int needed, double later = 0.1) {
  HandMade made;
  for (uint64_t seed = 1; seed <= 12; ++seed) {
    MissionResult result = mission(seed, MissionOutcome::kArrived);
    result.crossings = {{0.5, "tarmac", "grass"}};
    for (int i = 0; i < on_grass; ++i) {
      ScoredExecution execution = scored(1.0 + i, "grass", i < needed ? 1.0 : later);
      // Ends alternate by 0.1 m and 0.1 rad around their mean, which is the oracle's error.
      const double off = i % 2 == 0 ? 0.1 : -0.1;
      execution.measured_end = {1.0 + off, 0.0, off};
      result.executions.push_back(execution);
    }
    made.omniscient.add(result);
    made.results.push_back(result);
  }
  return made;
}

}  // namespace

TEST_CASE("counts of a batch add up to its missions, in text and in JSON") {
  const MissionBatch batch = invented();
  const std::string text = summaryOf(batch);
  INFO(text);
  CHECK(text.find("6 missions: 3 arrived, contacts 2\noutcome   missions  [%]\n") == 0);
  CHECK(contains(text, "arrived      3   50.0 %\n"));
  CHECK(contains(text, "refused      2   33.3 %\n             2  unreachable: a wall\n"));
  CHECK(contains(text, "idle         0    0.0 %\n"));
  CHECK(contains(text, "stopped      1   16.7 %\n             1  time ran out\n"));
  CHECK(contains(text, "collisions 2; straight line blocked in 1 of 6 missions\n"));
  CHECK(contains(text, "flips 1: 0.25 per minute driven (240 s)\n"));
  CHECK(contains(text, "stops 2: 0.33 per mission, at most 2 (seed 3), 2 s in all\n"));
  CHECK(contains(text, "1  (no reason published)\n"));
  CHECK(contains(text, "disarmed 0: 0.00 per hour driven\n"));
  CHECK(contains(text, "300 s of virtual time in 30 s: 5.0 times real time per core\n"));
  const Json json = batchJson(batch);
  CHECK(json["missions"] == 6);
  CHECK(json["arrived"].get<int>() + json["refused"].get<int>() + json["idle"].get<int>() +
            json["stopped"].get<int>() ==
        6);
  CHECK(json["collisions"] == 2);
  CHECK(json["stop_reasons"][""] == 1);
  CHECK(json["set"] == Json::array({"planner.margins.growth=0"}));
  REQUIRE(json["runs"].size() == 6);
  int collisions = 0;
  for (const Json& run : json["runs"]) collisions += run["collisions"].get<int>();
  CHECK(collisions == 2);
  CHECK(json["runs"][1]["contacts"][0]["pattern"] == "left");
  CHECK(json["runs"][1]["contacts"][1]["penetration_m"] == 0.01);
  CHECK(json["runs"][2]["flips"][0]["to"] == "right");
  CHECK(json["runs"][3]["result"] == "refused");
  CHECK(json["runs"][3]["reason"] == "unreachable: a wall");
  CHECK(json["runs"][0]["detour"].get<double>() == Approx(1.2));
}

TEST_CASE("a batch without missions has shares of nothing, and no number that is none") {
  const std::string text = summaryOf({});
  INFO(text);
  CHECK(contains(text, "arrived      0    0.0 %"));
  CHECK(contains(text, "flips 0: 0.00 per minute driven"));
  CHECK_FALSE(contains(text, "nan"));
  CHECK_FALSE(contains(text, "inf"));
  CHECK(batchJson({})["stops_per_mission"] == 0.0);
}

TEST_CASE("a mission's line tells outcome, counts and reason") {
  MissionResult result = mission(7, MissionOutcome::kStopped, "time ran out");
  result.completed = 12;
  result.surface_changes = 3;
  result.crossings = {{9.0, "grass", "tarmac"}};
  CHECK(lineOf(result) ==
        "seed 7      stopped   50.0 s   36.0 m  detour 1.20  patterns  12  crossings 1 of 3  "
        "collisions 0  stops 0  flips 0  time ran out");
  CHECK(mission(1, MissionOutcome::kArrived).detour() == Approx(1.2));
  CHECK(MissionResult{}.detour() == 0.0);
}

TEST_CASE("a crossing without executions about it has dashes in text and null in JSON") {
  MissionBatch batch;
  batch.results = {mission(1, MissionOutcome::kArrived)};
  batch.results[0].crossings = {{9.0, "grass", "tarmac"}};
  CHECK(contains(crossingsOf(batch.results[0]), "before / after / settled: - / - / -\n"));
  const Json crossing = batchJson(batch)["runs"][0]["crossings"][0];
  for (const char* key : {"before_m", "before_rad", "after_m", "after_rad", "settled_m"}) {
    INFO(key);
    CHECK(crossing.at(key).is_null());
  }
}

TEST_CASE("errors after changes are pooled by pair of surfaces, each execution once") {
  MissionResult one = mission(1, MissionOutcome::kArrived);
  one.crossings = {{3.5, "grass", "tarmac"}, {6.5, "tarmac", "grass"}};
  one.executions = {scored(1, "grass", 0.1),  scored(2, "grass", 0.1), scored(3, "grass", 0.1),
                    scored(4, "tarmac", 0.5), scored(5, "", 9.0),      scored(6, "tarmac", 0.3),
                    scored(7, "grass", 0.2)};
  one.executions[1].measured = false;
  const auto errors = errorsAfterChange({one, one}, 1, 3);
  REQUIRE(errors.size() == 3);
  CHECK(errors[0].from == "grass");
  CHECK(errors[0].to == "tarmac");
  CHECK(errors[0].count == 4);
  CHECK(errors[0].position == Approx(0.4));
  CHECK(errors[0].yaw == Approx(0.4));
  CHECK(errors[0].position_per_m == Approx(0.2));
  CHECK(errors[1].from == "start");
  CHECK(errors[1].count == 4);
  CHECK(errors[2].to == "grass");
  CHECK(errors[2].count == 2);
  // The row of all changes excludes the start.
  MissionBatch batch;
  batch.results = {one};
  CHECK(contains(summaryOf(batch), "  all changes            3        0.3333     0.3333\n"));
}

TEST_CASE("a segment is what lies between two changes, measured and on one surface") {
  MissionResult result = mission(1, MissionOutcome::kArrived);
  result.crossings = {{2.5, "grass", "tarmac"}};
  result.executions = {scored(1, "grass", 0.1), scored(2, "", 0.1), scored(2.5, "grass", 0.1),
                       scored(3, "tarmac", 0.1)};
  CHECK(segmentOf(result, 0).size() == 2);
  CHECK(segmentOf(result, 1).size() == 1);
  CHECK(segmentOf(result, 1)[0]->time == 3.0);
}

TEST_CASE("a rule settles where five executions together are within a fifth of the best") {
  // 1 m once and 0.1 m four times is 1.4 m, above 0.6 m: all five must be good.
  const HandMade late = handMade(20, 4);
  CHECK(settlingOf(late.results, errorAsDriven(), late.omniscient).both == 4.0);
  const HandMade within = handMade(20, 4, 0.119);
  CHECK(settlingOf(within.results, errorAsDriven(), within.omniscient).both == 4.0);
  const HandMade beyond = handMade(20, 4, 0.121);
  CHECK(std::isinf(settlingOf(beyond.results, errorAsDriven(), beyond.omniscient).both));
}

TEST_CASE("changes with fewer than five executions behind them are left out of settling") {
  const HandMade four = handMade(4, 0);
  const Settling none = settlingOf(four.results, errorAsDriven(), four.omniscient);
  CHECK(none.changes == 0);
  CHECK(none.missions == 0);
  CHECK(std::isinf(none.position));
  CHECK(none.position_ratio.empty());
  const HandMade five = handMade(5, 0);
  const Settling all = settlingOf(five.results, errorAsDriven(), five.omniscient);
  CHECK(all.changes == 12);
  CHECK(all.both == 0.0);
  CHECK(all.position_ratio.size() == 1);
}

TEST_CASE("the pooled ratio is shown as far as ten changes have so many executions") {
  HandMade made = handMade(12, 0);
  for (size_t i = 0; i < 3; ++i) made.results[i].executions.resize(6);
  Settling settling = settlingOf(made.results, errorAsDriven(), made.omniscient);
  // Windows after 0 and 1 executions exist in all twelve, later ones in nine: too few.
  CHECK(settling.position_ratio.size() == 2);
  made.results.resize(9);
  settling = settlingOf(made.results, errorAsDriven(), made.omniscient);
  CHECK(settling.changes == 9);
  CHECK(settling.position_ratio.empty());
  CHECK(settling.both == 0.0);
}

TEST_CASE("a comparison of rules counts each rule's missions and those of all together") {
  RuleComparison comparison;
  for (const char* rule : {"bank", "off"}) {
    MissionBatch batch = invented();
    batch.rule = rule;
    comparison.batches.push_back(batch);
  }
  comparison.batches[1].results.pop_back();
  std::ostringstream text;
  printComparison(text, comparison);
  INFO(text.str());
  CHECK(text.str().find("6 missions each: arrived bank 3, off 3; contacts bank 2, off 2\n") == 0);
  CHECK(contains(text.str(),
                 "  bank                6        3        2     0        1         2       216"));
  CHECK(contains(text.str(),
                 "  off                 5        3        2     0        0         2       180"));
  const OwnFolder folder;
  writeComparison(folder.path("rules.json"), comparison);
  const Json json = Json::parse(folder.text("rules.json"));
  REQUIRE(json["batches"].size() == 2);
  CHECK(json["batches"][1]["rule"] == "off");
  CHECK(json["batches"][1]["missions"] == 5);
  CHECK(json["same_executions_driven_with"] == "bank");
  CHECK(json["same_worlds"][0]["settling"]["median_both"].is_null());
  CHECK(json["same_worlds"][0]["all"]["count"] == 0);
}

TEST_CASE("drives stand side by side in one picture, each under what came of it") {
  const MissionBatch batch = invented();
  CHECK(resultOf(batch, 2) == "bank arrived after 50 s, 0 stops, 2 contacts");
  CHECK(resultOf(batch, 3) == "bank arrived after 50 s, 2 stops");
  std::vector<report::DriveScene> scenes(2);
  for (report::DriveScene& scene : scenes) {
    scene.T_map_goal = {20.0, 0.0, 0.0};
    scene.track = {{0.0, {}}, {10.0, {10.0, 1.0, 0.0}}};
    scene.errors = {{2.0, 0.1, -0.2}, {4.0, 0.05, 0.1}};
    scene.stops = {{5.0, 0.5}};
    scene.duration = 10.0;
  }
  const OwnFolder folder;
  report::drawSideBySide(folder.path("both.png"), "both", scenes);
  CHECK(isPng(folder.text("both.png")));
  CHECK_THROWS_WITH(report::drawSideBySide("/nowhere/both.png", "both", scenes),
                    Catch::Contains("/nowhere/both.png"));
}

TEST_CASE("missions that only one of the two solves have no ratio of times") {
  OmniscientComparison comparison;
  comparison.learning.results = {mission(1, MissionOutcome::kArrived),
                                 mission(2, MissionOutcome::kStopped, "time ran out")};
  comparison.omniscient.results = {mission(1, MissionOutcome::kRefused, "blocked: a wall"),
                                   mission(2, MissionOutcome::kArrived)};
  CHECK(timeRatios(comparison).empty());
  std::ostringstream text;
  printOmniscient(text, comparison);
  CHECK(contains(text.str(), "1 omniscient, both in 0\n"));
  CHECK_FALSE(contains(text.str(), "nan"));
  const OwnFolder folder;
  writeOmniscient(folder.path("o.json"), comparison);
  const Json json = Json::parse(folder.text("o.json"));
  CHECK(json["both_arrived"] == 0);
  CHECK(json["time_ratio"]["median"].is_null());
  CHECK(json["missions"].empty());
}

TEST_CASE("the smallest of as many ratios as a share asks for, by the nearest rank") {
  std::vector<TimeRatio> sorted;
  for (int i = 1; i <= 10; ++i) sorted.push_back({static_cast<uint64_t>(i), 1.0 * i, 1.0});
  CHECK(quantileOf(sorted, 0.0) == 1.0);
  CHECK(quantileOf(sorted, 0.5) == 5.0);
  CHECK(quantileOf(sorted, 0.91) == 10.0);
  CHECK(quantileOf(sorted, 2.0) == 10.0);
}

TEST_CASE("tread-missions refuses bad input in one line with status 2, before it drives") {
  const OwnFolder folder;
  const std::string faults = folder.write("faults.yaml", "messages:\n  - channel: INSS\n");
  const std::vector<std::pair<std::string, std::string>> refused{
      {"--missions 0", "--missions"},
      {"--missions many", "--missions"},
      {"--threads 65", "--threads"},
      {"--length 10", "--length"},
      {"--rule magic", "magic"},
      {"--rule off --rules off,multi_model", "--rule"},
      {"--rules off,multi_model --compare-omniscient", "--compare-omniscient"},
      {"--world swamp", "dragging_track"},
      {"--world dying_battery --compare-omniscient", "changes on its way"},
      {"--mision 3", "--missions"},
      {"--robot /no/robot", "/no/robot"},
      {"--faults /no/faults.yaml", "/no/faults.yaml"},
      {"--faults " + faults, faults + ":2"},
      {"--set planner.margins.grwth=0", "grwth"},
      {"--set nothing", "PROCESS.KEY=VALUE"},
      {"--json /nowhere/report.json", "/nowhere/report.json"},
      {"--log /nowhere/drive.lcmlog", "/nowhere/drive.lcmlog"},
      {"--simulator /no/simulator.yaml --goal 1 2", "/no/simulator.yaml"},
      {"--simulator /no/simulator.yaml", "--goal"},
      {"--goal 1 2", "--simulator"},
      {"--seed 4 --missions 2 --show 6", "--show"}};
  for (const auto& [arguments, words] : refused) {
    const CalledProgram run = called("tread-missions " + arguments);
    INFO(arguments << ": " << run.printed);
    CHECK(run.status == 2);
    CHECK(run.isOneLine());
    CHECK(run.says(words));
  }
  const CalledProgram same =
      called("tread-missions --json " + folder.path("a") + " --log " + folder.path("a"));
  CHECK(same.status == 2);
  CHECK(same.isOneLine());
  CHECK_FALSE(std::filesystem::exists(folder.path("a")));
}

TEST_CASE("the mission of a simulator's file is reported from its log as one of real processes") {
  const OwnFolder folder;
  const std::string config = TREAD_SOURCE_DIR "/config";
  const std::string outputs =
      " --log " + folder.path("drive.lcmlog") + " --truth " + folder.path("truth.csv");
  const CalledProgram mission = called("tread-missions --simulator " + config +
                                       "/simulators/demo.yaml --goal -9.8 -2.8" + outputs);
  INFO(mission.printed);
  REQUIRE(mission.status == 0);
  const CalledProgram report = called("tread-report " + folder.path("drive.lcmlog") + " --truth " +
                                      folder.path("truth.csv") + " --world " + config +
                                      "/worlds/demo.yaml --picture " + folder.path("drive.png"));
  INFO(report.printed);
  CHECK(report.status == 0);
  CHECK(report.says("arrived after "));
  CHECK(report.says("contacts 0"));
  CHECK(isPng(folder.text("drive.png")));
}
