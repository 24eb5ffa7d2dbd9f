// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include "tests/tools/lab/plan/plan_samples.hpp"

using namespace tread::plan::samples;
using Catch::Contains;
using Json = nlohmann::json;

namespace {

const std::string kSource = TREAD_SOURCE_DIR;
const std::string kOffice = "--map " + kSource + "/tests/data/planning/office.yaml ";
const std::string kWithSet = "--patterns " + kSource + "/config/patterns/teodor.yaml ";
const std::string kRobot = "--footprint 1.3,0.68 ";
const std::string kTask = "--start -13.5,0.1,0 --goal 13.5,0.1,0 ";

using Run = tread::samples::CalledProgram;

/// Runs tread-plan with a command line.
Run run(const std::string& arguments) {
  return tread::samples::called("tread-plan " + arguments);
}

/// Bad input: one line on stderr, exit code 2.
void checkRefused(const std::string& arguments, const std::string& tokens) {
  CAPTURE(arguments);
  const Run result = run(arguments);
  CHECK(result.status == 2);
  CHECK_THAT(result.printed, Contains(tokens));
  CHECK_THAT(result.printed, Catch::StartsWith("tread-plan: "));
  CHECK(std::count(result.printed.begin(), result.printed.end(), '\n') == 1);
}

}  // namespace

TEST_CASE("tread-plan plans through our office, tells it and writes JSON and a picture") {
  const Folder folder;
  const Run result = run(kOffice + kWithSet + kRobot + kTask + "--deadline-ms 20000 --json " +
                         folder.path("a.json") + " --picture " + folder.path("a.png"));
  CHECK(result.status == 0);
  CHECK_THAT(result.printed, Catch::StartsWith("solved: "));
  const Json json = Json::parse(folder.text("a.json"));
  CHECK(json["solved"] == true);
  CHECK(json["length_m"].get<double>() > 26.5);
  CHECK(json["poses"][0][0].get<double>() == Approx(-13.5));
  CHECK(json["poses"][0][1].get<double>() == Approx(0.1));
  CHECK(json["patterns"].size() == json["ends"].size());
  CHECK(json["first_solution_ms"].get<double>() <= json["total_ms"].get<double>());
  CHECK(json["expansions"].get<int>() > 0);
  CHECK(json["clearance_ms"].get<double>() > 0.0);
  CHECK(json["memory_mb"].get<double>() > 1.0);
  CHECK(folder.text("a.png").substr(1, 3) == "PNG");
}

TEST_CASE("tread-plan ends with 1 for a goal that cannot be come to, and says why and how near") {
  const Folder folder;
  const Run result =
      run(kOffice + kWithSet + kRobot + "--start -13.5,0.1,0 --goal 80,0.1,0 --json " +
          folder.path("a.json") + " --picture " + folder.path("a.png"));
  CHECK(result.status == 1);
  CHECK_THAT(result.printed, Catch::StartsWith("unreachable: the goal lies outside the map"));
  const Json json = Json::parse(folder.text("a.json"));
  CHECK(json["solved"] == false);
  CHECK(json["status"] == "unreachable");
  CHECK(json["closest_approach"]["distance_m"].get<double>() > 60.0);
  CHECK(folder.text("a.png").substr(1, 3) == "PNG");
}

TEST_CASE(
    "tread-plan told to come close plans to the nearest place, and says why not to the goal") {
  const Folder folder;
  const Run result = run(kOffice + kWithSet + kRobot + "--start -13.5,0.1,0 --goal 80,0.1,0 " +
                         "--deadline-ms 20000 --come-close --json " + folder.path("a.json"));
  CHECK(result.status == 0);
  CHECK_THAT(result.printed, Contains("as close as possible: the goal lies outside the map"));
  const Json json = Json::parse(folder.text("a.json"));
  CHECK(json["solved"] == true);
  const double nearest = json["closest_approach"]["x"].get<double>();
  CHECK(json["poses"].back()[0].get<double>() == Approx(nearest).margin(0.8));
}

TEST_CASE("tread-plan takes start, goal and pace from an SBPL environment") {
  const Folder folder;
  std::string environment = kEnvironment;
  environment.replace(environment.find("0.25 0.25 0"), 11, "0.25 0.75 0");
  environment.replace(environment.find("1.75 1.25 -1.5"), 14, "1.25 1.25 1.5 ");
  const std::string arguments = "--map " + folder.write("a.cfg", environment) + " --patterns " +
                                folder.write("a.mprim", kPrimitives) + " --mprim-exact --json " +
                                folder.path("a.json");
  // One cell ahead takes 0.625 s. The quarter circle costs three times its turn of 6 s, times 129
  // because of a cell of cost 128.
  const Run result = run(arguments);
  CHECK(result.status == 0);
  CHECK_THAT(result.printed, Contains("cost 2322625"));
  CHECK(Json::parse(folder.text("a.json"))["patterns"] == Json({"0", "1"}));
  const Run faster = run(arguments + " --force --turn-time 0.1 --speed 0.5");
  CHECK_THAT(faster.printed, Contains("2 patterns"));
  CHECK(Json::parse(folder.text("a.json"))["cost"].get<double>() < 2322625.0);
}

TEST_CASE("tread-plan drives nav2's lattice and says where a map's unknown is free") {
  const Folder folder;
  folder.write(
      "a.pgm", "P2 8 4 255" + [] {
        std::string pixels;
        for (int i = 0; i < 32; ++i) pixels += i % 8 == 7 ? " 205" : " 254";
        return pixels;
      }());
  const std::string map = folder.write(
      "a.yaml",
      "image: a.pgm\nresolution: 0.5\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: .65\n"
      "free_thresh: .25\n");
  const Run result =
      run("--map " + map + " --patterns " + folder.write("a.json", kLattice) +
          " --radius 0 --start 0.75,0.75,0 --goal 2.75,1.25,1.57 --tolerance 0.3,0.3");
  CHECK(result.status == 0);
  CHECK_THAT(result.printed, Contains("solved: "));
  CHECK_THAT(result.printed, Contains("tread-plan: " + map +
                                      ": 4 cells of grey 205, which map_saver writes for unknown "
                                      "cells, are free by free_thresh 0.25"));
  CHECK_THAT(run(kOffice + "--patterns " + folder.write("b.yaml", kLattice) + " " + kRobot + kTask)
                 .printed,
             Contains("these are nav2's lattice primitives"));
}

TEST_CASE("tread-plan answers many queries and writes what they have in common") {
  const Folder folder;
  const std::string shared = kOffice + kWithSet + kRobot + "--deadline-ms 300 --json ";
  const Run drawn = run(shared + folder.path("a.json") + " --random 12 --seed 5 --apart 4 " +
                        "--write-queries " + folder.path("q.txt"));
  CHECK(drawn.status == 0);
  CHECK_THAT(drawn.printed, Catch::StartsWith("12 queries: "));
  const Json json = Json::parse(folder.text("a.json"));
  CHECK(json["queries"] == 12);
  CHECK(json["solved"].get<int>() + json["unreachable"].get<int>() +
            json["none_in_time"].get<int>() ==
        12);
  CHECK(json["solved"].get<int>() >= 9);
  CHECK(json["first_ms"]["p50"].get<double>() <= json["first_ms"]["max"].get<double>());
  CHECK(json["expansions_per_s"].get<double>() > 0.0);
  CHECK(json["length_m"]["mean"].get<double>() > 4.0);
  const Run again = run(shared + folder.path("b.json") + " --queries " + folder.path("q.txt"));
  CHECK(again.status == 0);
  const Json same = Json::parse(folder.text("b.json"));
  for (size_t i = 0; i < 12; ++i) CHECK(same["answers"][i]["start"] == json["answers"][i]["start"]);
}

TEST_CASE("tread-plan refuses bad input in one line that says what to do") {
  const Folder folder;
  const std::string cfg = "--map " + folder.write("a.cfg", kEnvironment) + " ";
  const std::string mprim = "--patterns " + folder.write("a.mprim", kPrimitives) + " ";
  checkRefused(kWithSet, "--map is required");
  checkRefused(kOffice + kWithSet + "--footprnt 1,1", "did you mean --footprint?");
  checkRefused("--map nowhere.yaml " + kWithSet, "nowhere.yaml: cannot be read");
  checkRefused("--map " + kSource + "/README.md " + kWithSet, "a map is the .yaml of a nav2 map");
  checkRefused(cfg + "--patterns nowhere.yaml", "nowhere.yaml: cannot be read");
  checkRefused(kOffice + kWithSet + kTask, "give --footprint LENGTH,WIDTH or --radius");
  checkRefused(kOffice + kWithSet + kTask + "--footprint 1", "--footprint is \"1\"; LENGTH,WIDTH");
  checkRefused(kOffice + kWithSet + kTask + "--footprint 1,nan", "LENGTH,WIDTH [m] is needed");
  checkRefused(kOffice + kWithSet + kTask + kRobot + "--radius 1", "exclude each other");
  checkRefused(kOffice + kWithSet + kRobot, "give --start and --goal, --queries or --random");
  checkRefused(kOffice + kWithSet + kRobot + "--start 1,2 --goal 1,2,3",
               "--start is \"1,2\"; x,y,yaw");
  checkRefused(kOffice + kWithSet + kRobot + kTask + "--tolerance 0.1,0",
               "METRES,RADIANS is needed");
  checkRefused(kOffice + kWithSet + kRobot + kTask + "--random 3", "exclude each other");
  checkRefused(kOffice + kWithSet + kRobot + kTask + "--write-queries q", "needs --random");
  checkRefused(kOffice + kWithSet + kRobot + "--random 3 --picture a.png", "shows one plan");
  checkRefused(kOffice + kWithSet + "--radius 9.9 --random 1", "only 0 of 1 random queries found");
  checkRefused(cfg + kWithSet + "--mprim-exact", "needs --patterns with a .mprim");
  checkRefused(cfg + mprim + "--mprim-exact --radius 1", "plans for a point");
  checkRefused(kOffice + mprim + kTask + "--mprim-exact --radius 0", "needs --map with an SBPL");
  checkRefused(cfg + mprim + "--json " + folder.path("a.cfg"), "this is the input");
  for (const char* const name : {"office.yaml", "office.pgm"})
    std::filesystem::copy_file(kSource + "/tests/data/planning/" + name, folder.path(name));
  const std::string own = "--map " + folder.path("office.yaml") + " " + kWithSet + kRobot + kTask;
  checkRefused(own + "--force --picture " + folder.path("office.pgm"), "this is the input");
  checkRefused(own + "--json " + folder.path("a") + " --picture " + folder.path("./a"),
               "two results cannot be written to one file");
  checkRefused(own + "--json never.json --picture ./never.json",
               "two results cannot be written to one file");
  checkRefused(own + "--json /nowhere/a.json", "/nowhere/a.json: cannot be written");
  const Run unwritten = run(cfg + mprim + "--json /nowhere/a.json");
  CHECK(unwritten.status == 2);
  CHECK_THAT(unwritten.printed, Contains("tread-plan: /nowhere/a.json: cannot be written"));
}

TEST_CASE("recorded scenarios cost exactly what is published and the traps are told at once") {
  if (recorded("sbpl/env1.cfg").empty()) {
    WARN("skipped: the planning scenarios are not here (TREAD_RECORDINGS)");
    return;
  }
  const auto exact = [](const std::string& map, const std::string& set) {
    return run("--map " + recorded("sbpl/" + map + ".cfg") + " --patterns " +
               recorded("sbpl/" + set + ".mprim") + " --mprim-exact");
  };
  CHECK_THAT(exact("env1", "pr2").printed, Contains("cost 8348\n"));
  CHECK_THAT(exact("env1", "all_file").printed, Contains("cost 527\n"));
  CHECK_THAT(exact("env1", "mprim_unic_sideback").printed, Contains("cost 575\n"));
  for (const auto& trap :
       {exact("env1", "unicycle_noturninplace"), exact("env2", "pr2_unicycle_10cm")}) {
    CHECK(trap.status == 1);
    CHECK_THAT(trap.printed, Catch::StartsWith("unreachable: "));
  }
}
