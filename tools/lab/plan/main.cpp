// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cstdio>
#include <filesystem>

#include "common/config/command_line.hpp"
#include "common/config/outputs.hpp"
#include "tools/lab/plan/plan_report.hpp"
#include "tools/lab/plan/task_planner.hpp"

namespace {

using namespace tread;
using namespace tread::plan;

void describeQuery(CLI::App& app, Outputs& outputs, PlanOptions& options) {
  app.add_option("--start", options.start,
                 "x,y,yaw [m, m, rad] in the map's frame; default: that of the .cfg");
  app.add_option("--goal", options.goal, "x,y,yaw like --start");
  app.add_option("--tolerance", options.tolerance,
                 "METRES,RADIANS around the goal in which a plan may end")
      ->capture_default_str();
  app.add_flag("--come-close", options.come_close,
               "plan to the nearest reachable place if the goal is unreachable");
  app.add_option("--queries", options.queries,
                 "file of queries, one line x y yaw x y yaw (start, goal) each");
  app.add_option("--random", options.random, "number of random queries with free start and goal")
      ->check(CLI::Range(int64_t{1}, int64_t{1'000'000}));
  app.add_option("--seed", options.seed, "seed of the random queries")->capture_default_str();
  app.add_option("--apart", options.apart, "least distance of their start and goal [m]")
      ->check(CLI::Range(0.0, 1e5))
      ->capture_default_str();
  outputs.file("--write-queries", options.write_queries, "file to write the random queries to");
}

void describeRobot(CLI::App& app, PlanOptions& options) {
  app.add_option("--footprint", options.footprint,
                 "LENGTH,WIDTH of the robot [m], with its origin in the middle");
  app.add_option("--radius", options.radius, "radius of a round robot [m]; 0 = a point")
      ->check(CLI::Range(0.0, 100.0));
  app.add_option("--speed", options.speed,
                 "speed of .mprim patterns [m/s]; default: that of the .cfg, else 1")
      ->check(CLI::Range(1e-3, 100.0));
  app.add_option(
         "--turn-time", options.turn_time,
         "time of .mprim patterns to turn by 45 degrees [s]; default: that of the .cfg, else 2")
      ->check(CLI::Range(1e-3, 1e4));
}

/// Adds all options to a program.
void describe(CLI::App& app, PlanOptions& options) {
  app.add_option("--map", options.map,
                 "nav2 or ROS map (.yaml with .pgm) or SBPL environment (.cfg)")
      ->required();
  app.add_option("--patterns", options.patterns,
                 "pattern file (.yaml), or primitives of SBPL (.mprim) or nav2 (.json), of which "
                 "only those with "
                 "start angle 0")
      ->required();
  app.add_flag(
      "--mprim-exact", options.exact,
      "use all .mprim primitives, each from its own start angle, with SBPL's integer costs");
  describeRobot(app, options);
  Outputs outputs(app);
  describeQuery(app, outputs, options);
  app.add_option("--deadline-ms", options.deadline_ms,
                 "planning time after which the best plan so far is the answer [ms]; default 1000, "
                 "with --mprim-exact none")
      ->check(CLI::Range(1.0, 1e9));
  outputs.file("--json", options.json, "file to write the answer to");
  outputs.file("--picture", options.picture, "PNG of map, search tree and plan");
}

/// Preparation counts for the single query.
int planOne(const PlanTask& task, const PlanOptions& options) {
  TaskPlanner planner(task);
  const PlanQuery& query = task.queries.front();
  PlanAnswer answer = planner.answer(query, planner.preparationMs());
  addPreparation(answer, planner.preparationMs());
  std::fputs(answerText(answer).c_str(), stdout);
  if (!options.json.empty()) writeJson(options.json, answerJson(answer));
  if (!options.picture.empty()) {
    PlanScene scene = planner.scene(query, answer);
    scene.title = std::filesystem::path(options.map).filename().string();
    scene.result = headline(answer);
    drawPlan(options.picture, scene);
  }
  return answer.end == planner::PathEnd::kSolved ? 0 : 1;
}

int planMany(const PlanTask& task, const PlanOptions& options) {
  TaskPlanner planner(task);
  std::vector<PlanAnswer> answers;
  for (const PlanQuery& query : task.queries) answers.push_back(planner.answer(query));
  std::fputs(answersText(answers, planner.preparationMs()).c_str(), stdout);
  if (!options.json.empty())
    writeJson(options.json, answersJson(task.queries, answers, planner.preparationMs()));
  return 0;
}

int run(int argc, char** argv) {
  PlanOptions options;
  CLI::App app{
      "Plans with motion patterns on a map. Exit status: 0 if there is a plan, or after many "
      "queries; "
      "1 if the goal is unreachable or none was found in time; 2 for bad input.",
      "tread-plan"};
  describe(app, options);
  if (const auto code = parseCommandLine(app, argc, argv)) return *code;
  const PlanTask task = loadTask(options);
  if (!task.map.note.empty())
    std::fprintf(stderr, "tread-plan: %s: %s\n", options.map.c_str(), task.map.note.c_str());
  return task.many ? planMany(task, options) : planOne(task, options);
}

}  // namespace

int main(int argc, char** argv) {
  return tread::runProgram("tread-plan", [&] { return run(argc, argv); });
}
