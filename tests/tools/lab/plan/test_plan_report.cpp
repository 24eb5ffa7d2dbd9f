// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>

#include "tests/tools/lab/plan/plan_samples.hpp"
#include "tools/lab/plan/plan_report.hpp"

using namespace tread;
using namespace tread::plan;
using namespace tread::plan::samples;
using Catch::Contains;
using Json = nlohmann::ordered_json;

namespace {

PlanAnswer solvedAnswer() {
  PlanAnswer answer;
  answer.end = planner::PathEnd::kSolved;
  answer.cost = 2.5;
  answer.time = 2.25;
  answer.length = 1.5;
  answer.patterns = {"ahead", "left"};
  answer.poses = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.5, 0.25, 0.5}};
  answer.ends = {1, 2};
  answer.expansions = 1200;
  answer.first_solution_ms = 1.25;
  answer.total_ms = 5.0;
  answer.clearance_ms = 1.5;
  answer.heuristic_ms = 0.5;
  answer.memory_mb = 3.0;
  return answer;
}

PlanAnswer unreachableAnswer() {
  PlanAnswer answer;
  answer.end = planner::PathEnd::kUnreachable;
  answer.reason = "the goal is walled in";
  answer.closest = ClosestApproach{{2.0, 3.0}, 0.75};
  answer.total_ms = 1.0;
  return answer;
}

}  // namespace

TEST_CASE("the answer to a query has all its keys, and null for what there is not") {
  const Json solved = answerJson(solvedAnswer());
  CHECK(solved["solved"] == true);
  CHECK(solved["status"] == "solved");
  CHECK(solved["reason"] == "");
  CHECK(solved["cost"] == 2.5);
  CHECK(solved["time_s"] == 2.25);
  CHECK(solved["length_m"] == 1.5);
  CHECK(solved["patterns"] == Json({"ahead", "left"}));
  CHECK(solved["poses"] == Json::parse("[[0.0,0.0,0.0],[1.0,0.0,0.0],[1.5,0.25,0.5]]"));
  CHECK(solved["ends"] == Json({1, 2}));
  CHECK(solved["expansions"] == 1200);
  CHECK(solved["first_solution_ms"] == 1.25);
  CHECK(solved["total_ms"] == 5.0);
  CHECK(solved["closest_approach"].is_null());
  const Json none = answerJson(unreachableAnswer());
  CHECK(none["solved"] == false);
  CHECK(none["status"] == "unreachable");
  CHECK(none["reason"] == "the goal is walled in");
  CHECK(none["cost"].is_null());
  CHECK(none["first_solution_ms"].is_null());
  CHECK(none["poses"] == Json::array());
  CHECK(none["closest_approach"] == Json::parse(R"({"x":2.0,"y":3.0,"distance_m":0.75})"));
  CHECK(none.size() == solved.size());
}

TEST_CASE("many answers are counted, with quantiles of nearest rank") {
  std::vector<PlanAnswer> answers(100, solvedAnswer());
  for (size_t i = 0; i < answers.size(); ++i) {
    answers[i].first_solution_ms = static_cast<double>(100 - i);
    answers[i].length = i < 50 ? 1.0 : 2.0;
  }
  answers.push_back(unreachableAnswer());
  answers.push_back(PlanAnswer{});
  const Json json = answersJson(std::vector<PlanQuery>(answers.size()), answers, 4.5);
  CHECK(json["queries"] == 102);
  CHECK(json["solved"] == 100);
  CHECK(json["unreachable"] == 1);
  CHECK(json["none_in_time"] == 1);
  CHECK(json["preparation_ms"] == 4.5);
  CHECK(json["first_ms"] == Json::parse(R"({"p50":50.0,"p95":95.0,"p99":99.0,"max":100.0})"));
  CHECK(json["total_ms"]["max"] == 5.0);
  CHECK(json["length_m"]["mean"] == 1.5);
  // 100 x 1200 expansions in 100 x 3 ms of search plus 1 ms for the unreachable one.
  CHECK(json["expansions_per_s"].get<double>() == Approx(120000 / 0.301));
  REQUIRE(json["answers"].size() == 102);
  CHECK(json["answers"][100]["status"] == "unreachable");
  CHECK(json["answers"][100]["length_m"].is_null());
}

TEST_CASE("quantiles are values that were measured") {
  CHECK(nearestRank({3.0, 1.0, 2.0}, 0.5) == 2.0);
  CHECK(nearestRank({3.0, 1.0, 2.0}, 0.99) == 3.0);
  CHECK(nearestRank({7.0}, 0.0) == 7.0);
  CHECK(std::isnan(nearestRank({}, 0.5)));
}

TEST_CASE("a report of nothing solved has null where there is no number") {
  const Json json = answersJson({{}}, {PlanAnswer{}}, 1.0);
  const Json written = Json::parse(json.dump());
  CHECK(written["first_ms"]["p50"].is_null());
  CHECK(written["length_m"]["mean"].is_null());
  CHECK(written["expansions_per_s"].is_null());
  CHECK_THAT(answersText({PlanAnswer{}}, 1.0), Contains("first plan after: none"));
}

TEST_CASE("a report is written whole, whatever bytes a name has, or refused in one line") {
  const Folder folder;
  PlanAnswer answer = solvedAnswer();
  answer.patterns = {
      "\xff"
      "bad"};
  writeJson(folder.path("a.json"), answerJson(answer));
  CHECK(Json::parse(folder.text("a.json"))["cost"] == 2.5);
  CHECK_THROWS_WITH(writeJson("/nowhere/a.json", answerJson(answer)),
                    Contains("/nowhere/a.json: cannot be written"));
}

TEST_CASE("people read how a query ended, how good the plan is and what it took") {
  const std::string solved = answerText(solvedAnswer());
  CHECK_THAT(solved, Contains("solved: 2 patterns, 2.2 s, 1.50 m, cost 2.5\n"));
  CHECK_THAT(solved, Contains("first plan after 1.25 ms, ended after 5.00 ms"));
  CHECK_THAT(solved, Contains("1200 expansions"));
  const std::string none = answerText(unreachableAnswer());
  CHECK_THAT(none, Contains("unreachable: the goal is walled in\n"));
  CHECK_THAT(none, Contains("closest approach: 0.75 m from the goal, at 2.00 3.00\n"));
  PlanAnswer partial = solvedAnswer();
  partial.end = planner::PathEnd::kNoneInTime;
  partial.reason = "the deadline came first";
  partial.first_solution_ms.reset();
  CHECK_THAT(answerText(partial),
             Contains("none in time: the deadline came first\nbest so far: 2"));
  partial.all_seen = true;
  partial.reason = "nothing more to see";
  CHECK_THAT(answerText(partial), Contains("none found: nothing more to see\n"));
  CHECK_THAT(answersText({solvedAnswer(), unreachableAnswer()}, 1.0),
             Contains("2 queries: 1 solved, 1 unreachable, 0 none in time\n"));
}

TEST_CASE("a plan's picture is a PNG in the shape of its map, or one clear line") {
  const Folder folder;
  PlanScene scene;
  scene.grid = Grid(0.1, {0, 0}, 200, 100);
  for (int x = 0; x < 150; ++x) scene.grid.set({x, 40}, kFree);
  scene.grid.set({10, 40}, kObstacle);
  scene.T_map_grid = {-3.0, 1.0, 0.0};
  scene.tree = {{{0.0, 1.0}, {1.0, 2.0}}};
  scene.path = {{0.0, 1.0}, {2.0, 3.0}};
  scene.stations = {{0.0, 1.0, 0.3}};
  scene.outline = rectangle(0.8, 0.6);
  scene.T_map_goal = {2.0, 3.0, 0.0};
  drawPlan(folder.path("a.png"), scene);
  const std::string bytes = folder.text("a.png");
  REQUIRE(bytes.size() > 1000);
  CHECK(bytes.substr(1, 3) == "PNG");
  const auto number = [&bytes](size_t at) {
    return static_cast<unsigned char>(bytes[at]) * 256 + static_cast<unsigned char>(bytes[at + 1]);
  };
  CHECK(number(18) == 1000 + 140);
  CHECK(number(22) == 500 + 140);
  scene.outline.clear();
  scene.radius = 0.3;
  scene.grid = Grid(0.1, {0, 0}, 1, 1);
  drawPlan(folder.path("b.png"), scene);
  CHECK(folder.text("b.png").size() > 1000);
  CHECK_THROWS_WITH(drawPlan("/nowhere/a.png", scene),
                    Contains("/nowhere/a.png: cannot be written"));
}
