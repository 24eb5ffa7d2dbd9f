// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Timed missions in worlds from a file: reading, metric, comparison.
#include <catch2/catch.hpp>

#include <cmath>
#include <cstdlib>
#include <sstream>

#include <nlohmann/json.hpp>

#include "common/config/config_reader.hpp"
#include "tests/tools/called_program.hpp"
#include "tools/lab/missions/given_worlds.hpp"
#include "tools/lab/missions/world_report.hpp"

using namespace tread;
using namespace tread::missions;
using namespace tread::samples;
using Json = nlohmann::json;

namespace {

const std::string kSource = TREAD_SOURCE_DIR;
const std::string kWorlds = kSource + "/tests/data/given_worlds/";

std::vector<std::string> namesOf(const std::vector<MissionWorld>& worlds) {
  std::vector<std::string> names;
  for (const MissionWorld& world : worlds) names.push_back(world.description.name);
  return names;
}

std::string refusalOf(const OwnFolder& folder, const std::string& lines) {
  try {
    readGivenWorlds(folder.write("w.txt", lines));
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

MissionResult timedRun(MissionOutcome outcome, double clock, double path = 10.0) {
  MissionResult result;
  result.world = "w";
  result.outcome = outcome;
  result.clock = clock;
  result.timed = TimedRun{1.0, 100.0, path};
  result.least_clearance = 0.1;
  return result;
}

}  // namespace

TEST_CASE(
    "lines of discs are worlds on the benchmark's course, with the paths of the table beside") {
  const std::vector<MissionWorld> worlds = readGivenWorlds(kWorlds + "worlds.txt");
  CHECK(namesOf(worlds) == std::vector<std::string>{"open", "gap", "slalom"});
  const MissionWorld& gap = worlds[1];
  CHECK(gap.seed == 1);
  CHECK(gap.T_map_start.x == -2.25);
  CHECK(gap.T_map_start.yaw == Approx(kPi / 2));
  CHECK(gap.straight_line == Approx(10.0));
  REQUIRE(gap.timed);
  CHECK(gap.timed->path == 10.5);
  CHECK(gap.timed->tolerance == 1.0);
  CHECK(gap.timed->limit == 100.0);
  CHECK(gap.description.base_surface == "tarmac");
  CHECK(gap.description.obstacles.front().radius == 0.075);
  CHECK_FALSE(sim::worldFault(gap.description));
  CHECK(gap.description.bounds.contains({-2.25, 13.0}));
}

TEST_CASE("packed worlds are the same worlds, and some can be chosen by name") {
  const OwnFolder folder;
  const std::string packed = folder.path("worlds.txt.gz");
  REQUIRE(std::system(("gzip -c " + kWorlds + "worlds.txt > " + packed).c_str()) == 0);
  const std::vector<MissionWorld> worlds = readGivenWorlds(packed, {"slalom", "open"});
  CHECK(namesOf(worlds) == std::vector<std::string>{"slalom", "open"});
  CHECK(worlds[0].seed == 2);
  CHECK(worlds[0].timed->path == Approx(10.0));  // no table: the straight line
  CHECK_THROWS_WITH(readGivenWorlds(packed, {"7"}),
                    Catch::Contains("--only 7") && Catch::Contains("open to slalom"));
}

TEST_CASE("a list of worlds has starts, goals, limits and grounds of its own") {
  const std::vector<MissionWorld> worlds = readGivenWorlds(kWorlds + "two.yaml");
  CHECK(namesOf(worlds) == std::vector<std::string>{"open", "gap", "slalom", "two grounds"});
  CHECK(worlds[0].timed->tolerance == 0.8);
  CHECK(worlds[0].timed->limit == 40.0);
  CHECK(worlds[0].timed->path == 10.0);
  CHECK(worlds[3].timed->limit == 30.0);
  CHECK(worlds[3].timed->path == 9.2);
  CHECK(worlds[3].T_map_goal.x == 9.0);
  CHECK(worlds[3].description.base_surface == "grass");
  CHECK(worlds[3].description.regions.size() == 1);
}

TEST_CASE("one ground for all of them replaces theirs, and its friction can be said") {
  const auto surfaceIn = [](const MissionWorld& world) {
    return sim::World(world.description).surface(world.T_map_goal.position());
  };
  const auto on_gravel = readGivenWorlds(kWorlds + "two.yaml", {"two grounds"}, {"gravel", {}});
  CHECK(surfaceIn(on_gravel[0]).name == "gravel");
  const auto slippery = readGivenWorlds(kWorlds + "two.yaml", {"two grounds"}, {"", 0.3});
  CHECK(surfaceIn(slippery[0]).friction == 0.3);
  CHECK(surfaceIn(slippery[0]).shear_displacement ==
        sim::builtInSurface("ice")->shear_displacement);
  CHECK(surfaceOf({"mud", {}}).friction == 0.40);
  CHECK_THROWS_WITH(surfaceOf({"lava", {}}),
                    Catch::Contains("--surface lava") && Catch::Contains("gravel"));
}

TEST_CASE("lines that are no discs are refused with file and line") {
  const OwnFolder folder;
  const std::string good = "1 0 5 0.1  # a post\n";
  CHECK(refusalOf(folder, "# nothing\n\n" + good) == "accepted");
  for (const char* bad :
       {"1 0 5", "1 0 5 0", "1 0 x 0.1", "1 0 5 0.1 7", "1 nan 5 0.1", "1 0 5e9 1"}) {
    CAPTURE(bad);
    const std::string refusal = refusalOf(folder, good + bad + "\n");
    CHECK(refusal.find("w.txt:2: is not \"world x y radius\"") != std::string::npos);
  }
  CHECK(refusalOf(folder, "# nothing\n").find("contains no world") != std::string::npos);
  CHECK_THROWS_WITH(readGivenWorlds("/nowhere/w.txt"), Catch::Contains("/nowhere/w.txt: cannot"));
}

TEST_CASE("the metric is half at best, falls with the time, and is none without success") {
  CHECK(navigationMetric(timedRun(MissionOutcome::kArrived, 4.0)) == 0.5);
  CHECK(navigationMetric(timedRun(MissionOutcome::kArrived, 10.0)) == Approx(0.5));
  CHECK(navigationMetric(timedRun(MissionOutcome::kArrived, 20.0)) == Approx(0.25));
  CHECK(navigationMetric(timedRun(MissionOutcome::kArrived, 90.0)) == Approx(0.125));
  CHECK(navigationMetric(timedRun(MissionOutcome::kContact, 4.0)) == 0.0);
  CHECK(navigationMetric(timedRun(MissionOutcome::kStopped, 100.1)) == 0.0);
}

TEST_CASE("rules, the truth, and a part of each are told apart by their names") {
  CHECK(patternSourceOf("collective")->rule == "collective");
  CHECK_FALSE(patternSourceOf("collective")->truth);
  CHECK(patternSourceOf("omniscient")->truth == TrueShare::kAll);
  CHECK(patternSourceOf("multi_model+true_means")->truth == TrueShare::kMeans);
  CHECK(patternSourceOf("multi_model+true_means")->rule == "multi_model");
  CHECK(patternSourceOf("off+true_covariances")->truth == TrueShare::kCovariances);
  for (const char* word : {"", "fastest", "off+", "+true_means", "omniscient+true_means"})
    CHECK_FALSE(patternSourceOf(word));
}

TEST_CASE("two batches are compared world by world, with an interval") {
  MissionBatch slow, fast;
  slow.rule = "off";
  fast.rule = "learned";
  for (int i = 0; i < 4; ++i) {
    slow.results.push_back(timedRun(MissionOutcome::kArrived, 20.0));
    fast.results.push_back(timedRun(MissionOutcome::kArrived, i < 3 ? 10.0 : 20.0));
  }
  slow.results.push_back(timedRun(MissionOutcome::kContact, 3.0));
  fast.results.push_back(timedRun(MissionOutcome::kStopped, 100.0));
  const TimedSummary summary = timedSummaryOf(slow.results);
  CHECK(summary.success == Approx(0.8));
  CHECK(summary.contact == Approx(0.2));
  CHECK(summary.timeout == 0.0);
  CHECK(summary.metric == Approx(0.2));
  CHECK(summary.time == Approx(20.0));
  const PairedMetric paired = pairedMetric(fast.results, slow.results);
  CHECK(paired.mean == Approx(0.15));
  CHECK(paired.better == 3);
  CHECK(paired.worse == 0);
  // Standard error of .25 .25 .25 0 0.
  CHECK(paired.high - paired.mean == Approx(1.96 * 0.1369306 / std::sqrt(5.0)).epsilon(1e-3));
  std::ostringstream text;
  printWorlds(text, {slow, fast});
  CHECK(text.str().find("learned                      +0.1500") != std::string::npos);
  CHECK(text.str().find("3 better, 0 worse") != std::string::npos);
}

TEST_CASE("given worlds are driven from the command line, each with its result in the JSON") {
  const OwnFolder folder;
  const std::string json = folder.path("r.json");
  const CalledProgram run =
      called("tread-missions --worlds " + kWorlds + "worlds.txt --only gap,open --robot " +
             kSource + "/tests/data/robots/jackal --rule off --json " + json);
  INFO(run.printed);
  REQUIRE(run.status == 0);
  const Json report = Json::parse(folder.text("r.json"));
  REQUIRE(report["worlds"].size() == 2);
  CHECK(report["worlds"][0]["world"] == "gap");
  CHECK(report["worlds"][0]["success"] == true);
  CHECK(report["worlds"][0]["contact"] == false);
  CHECK(report["worlds"][0]["metres"].get<double>() > 9.0);
  CHECK(report["worlds"][0]["least_clearance_m"].get<double>() > 0.03);
  CHECK(report["worlds"][1]["metric"].get<double>() > 0.3);
  CHECK(report["summary"]["success"] == 1.0);
  CHECK(report["summary"]["contact"] == 0.0);
}

TEST_CASE("what only given worlds have is refused elsewhere, in one line") {
  for (const char* arguments :
       {"--rule omniscient", "--rules off,multi_model+true_means", "--surface ice", "--only 1",
        "--worlds /nowhere.txt", "--rule fastest"}) {
    CAPTURE(arguments);
    const CalledProgram run = called(std::string("tread-missions ") + arguments);
    CHECK(run.status == 2);
    CHECK(run.isOneLine());
  }
}
