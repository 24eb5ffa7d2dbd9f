// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cstdio>
#include <filesystem>

#include "common/config/command_line.hpp"
#include "tools/plan/plan_report.hpp"
#include "tools/plan/task_planner.hpp"

namespace {

using namespace tread;
using namespace tread::plan;

/// What all queries share counts for the only one.
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
  return answer.status == PlanStatus::kSolved ? 0 : 1;
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
      "Plans with motion patterns on a map. Ends with 0 if there is a plan, or after many queries; "
      "1 if the goal is unreachable or none was found in time; 2 for bad input.",
      "tread-plan"};
  describe(app, options);
  if (const auto code = parseCommandLine(app, argc, argv)) return *code;
  const PlanTask task = loadTask(options);
  return task.many ? planMany(task, options) : planOne(task, options);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "tread-plan: %s\n", problem.what());
    return 2;
  }
}
