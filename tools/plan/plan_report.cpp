// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/plan/plan_report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/config/scalars.hpp"
#include "common/recordings/text_file.hpp"
#include "common/report/text.hpp"

namespace tread::plan {
namespace {

using Json = nlohmann::ordered_json;
using planner::PathEnd;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();  // JSON writes it as null

/// As JSON has it.
const char* nameOf(PathEnd end) {
  if (end == PathEnd::kSolved) return "solved";
  return end == PathEnd::kUnreachable ? "unreachable" : "none_in_time";
}

/// What many answers have in common.
struct Totals {
  size_t solved = 0;
  size_t unreachable = 0;
  size_t none_in_time = 0;
  std::vector<double> first_ms;
  std::vector<double> total_ms;
  double mean_length = kNone;  // [m]
  double expansions_per_s = kNone;
};

Totals totalsOf(const std::vector<PlanAnswer>& answers) {
  Totals totals;
  double length = 0.0;
  double expansions = 0.0;
  double search_ms = 0.0;
  for (const PlanAnswer& answer : answers) {
    const bool solved = answer.end == PathEnd::kSolved;
    totals.solved += solved ? 1 : 0;
    totals.unreachable += answer.end == PathEnd::kUnreachable ? 1 : 0;
    totals.none_in_time += answer.end == PathEnd::kNoneInTime ? 1 : 0;
    if (solved && answer.first_solution_ms) totals.first_ms.push_back(*answer.first_solution_ms);
    totals.total_ms.push_back(answer.total_ms);
    length += solved ? answer.length : 0.0;
    expansions += static_cast<double>(answer.expansions);
    search_ms += answer.total_ms - answer.clearance_ms - answer.heuristic_ms;
  }
  if (totals.solved > 0) totals.mean_length = length / static_cast<double>(totals.solved);
  if (search_ms > 0.0) totals.expansions_per_s = expansions / (search_ms * 1e-3);
  return totals;
}

Json poseJson(const Pose2& pose) {
  return {pose.x, pose.y, pose.yaw};
}

Json closestJson(const PlanAnswer& answer) {
  if (!answer.closest) return nullptr;
  return {{"x", answer.closest->p_map.x()},
          {"y", answer.closest->p_map.y()},
          {"distance_m", answer.closest->distance}};
}

Json firstJson(const PlanAnswer& answer) {
  return answer.first_solution_ms ? Json(*answer.first_solution_ms) : Json(nullptr);
}

Json spreadJson(const std::vector<double>& values) {
  return {{"p50", nearestRank(values, 0.50)},
          {"p95", nearestRank(values, 0.95)},
          {"p99", nearestRank(values, 0.99)},
          {"max", nearestRank(values, 1.0)}};
}

/// A number of a plan, or null where there is no plan.
Json ofPlan(const PlanAnswer& answer, double value) {
  return answer.poses.empty() ? Json(nullptr) : Json(value);
}

std::string spreadText(const std::string& what, const std::vector<double>& values) {
  if (values.empty()) return what + ": none\n";
  const auto at = [&values](double share) { return fixed(nearestRank(values, share), 2); };
  return what + ": p50 " + at(0.50) + ", p95 " + at(0.95) + ", p99 " + at(0.99) + ", max " +
         at(1.0) + " ms\n";
}

std::string planText(const PlanAnswer& answer) {
  // Costs of a lattice are whole numbers, others need no more than three decimals.
  return std::to_string(answer.patterns.size()) + " patterns, " + fixed(answer.time, 1) + " s, " +
         fixed(answer.length, 2) + " m, cost " +
         formatNumber(std::round(answer.cost * 1000.0) / 1000.0);
}

std::string failureText(const PlanAnswer& answer) {
  std::string text;
  if (answer.closest)
    text += "closest approach: " + fixed(answer.closest->distance, 2) + " m from the goal, at " +
            fixed(answer.closest->p_map.x(), 2) + " " + fixed(answer.closest->p_map.y(), 2) + "\n";
  if (!answer.poses.empty()) text += "best so far: " + planText(answer) + "\n";
  return text;
}

std::string effortText(const PlanAnswer& answer) {
  const std::string first =
      answer.first_solution_ms
          ? "first plan after " + fixed(*answer.first_solution_ms, 2) + " ms, ended after "
          : "ended after ";
  return first + fixed(answer.total_ms, 2) + " ms (clearance " + fixed(answer.clearance_ms, 2) +
         ", heuristics " + fixed(answer.heuristic_ms, 2) + "), " +
         std::to_string(answer.expansions) + " expansions, " + fixed(answer.memory_mb, 1) + " MB\n";
}

}  // namespace

double nearestRank(std::vector<double> values, double share) {
  if (values.empty()) return kNone;
  std::sort(values.begin(), values.end());
  const double rank = std::ceil(share * static_cast<double>(values.size()));
  return values[static_cast<size_t>(std::max(rank, 1.0)) - 1];
}

void addPreparation(PlanAnswer& answer, double preparation_ms) {
  answer.clearance_ms += preparation_ms;
  answer.total_ms += preparation_ms;
  if (answer.first_solution_ms) *answer.first_solution_ms += preparation_ms;
}

Json answerJson(const PlanAnswer& answer) {
  Json json;
  json["solved"] = answer.end == PathEnd::kSolved;
  json["status"] = nameOf(answer.end);
  json["reason"] = answer.reason;
  json["cost"] = ofPlan(answer, answer.cost);
  json["time_s"] = ofPlan(answer, answer.time);
  json["length_m"] = ofPlan(answer, answer.length);
  json["patterns"] = answer.patterns;
  json["poses"] = Json::array();
  for (const Pose2& pose : answer.poses) json["poses"].push_back(poseJson(pose));
  json["ends"] = answer.ends;
  json["closest_approach"] = closestJson(answer);
  json["expansions"] = answer.expansions;
  json["first_solution_ms"] = firstJson(answer);
  json["total_ms"] = answer.total_ms;
  json["clearance_ms"] = answer.clearance_ms;
  json["heuristic_ms"] = answer.heuristic_ms;
  json["memory_mb"] = answer.memory_mb;
  return json;
}

Json answersJson(const std::vector<PlanQuery>& queries, const std::vector<PlanAnswer>& answers,
                 double preparation_ms) {
  const Totals totals = totalsOf(answers);
  Json json;
  json["queries"] = answers.size();
  json["solved"] = totals.solved;
  json["unreachable"] = totals.unreachable;
  json["none_in_time"] = totals.none_in_time;
  json["first_ms"] = spreadJson(totals.first_ms);
  json["total_ms"] = spreadJson(totals.total_ms);
  json["preparation_ms"] = preparation_ms;
  json["length_m"] = {{"mean", totals.mean_length}};
  json["expansions_per_s"] = totals.expansions_per_s;
  json["answers"] = Json::array();
  for (size_t i = 0; i < answers.size(); ++i) {
    const PlanAnswer& answer = answers[i];
    json["answers"].push_back({{"start", poseJson(queries[i].T_map_start)},
                               {"goal", poseJson(queries[i].T_map_goal)},
                               {"status", nameOf(answer.end)},
                               {"reason", answer.reason},
                               {"cost", ofPlan(answer, answer.cost)},
                               {"time_s", ofPlan(answer, answer.time)},
                               {"length_m", ofPlan(answer, answer.length)},
                               {"expansions", answer.expansions},
                               {"first_solution_ms", firstJson(answer)},
                               {"total_ms", answer.total_ms}});
  }
  return json;
}

void writeJson(const std::string& path, const Json& json) {
  // A name comes from a file, which may have been broken: its bytes need not be UTF-8.
  recordings::writeText(path, json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

std::string headline(const PlanAnswer& answer) {
  if (answer.end == PathEnd::kSolved)
    return "solved: " + planText(answer) + (answer.reason.empty() ? "" : "; " + answer.reason);
  const bool never = answer.end == PathEnd::kUnreachable;
  const char* const none = answer.all_seen ? "none found: " : "none in time: ";
  return (never ? "unreachable: " : none) + answer.reason;
}

std::string answerText(const PlanAnswer& answer) {
  const bool solved = answer.end == PathEnd::kSolved;
  return headline(answer) + "\n" + (solved ? "" : failureText(answer)) + effortText(answer);
}

std::string answersText(const std::vector<PlanAnswer>& answers, double preparation_ms) {
  const Totals totals = totalsOf(answers);
  std::string text = std::to_string(answers.size()) + " queries: " + std::to_string(totals.solved) +
                     " solved, " + std::to_string(totals.unreachable) + " unreachable, " +
                     std::to_string(totals.none_in_time) + " none in time\n";
  text += "map and patterns prepared in " + fixed(preparation_ms, 2) + " ms\n";
  text += spreadText("first plan after", totals.first_ms);
  text += spreadText("ended after", totals.total_ms);
  if (std::isfinite(totals.mean_length))
    text += "mean length " + fixed(totals.mean_length, 2) + " m\n";
  if (std::isfinite(totals.expansions_per_s))
    text += fixed(totals.expansions_per_s, 0) + " expansions per second of search\n";
  return text;
}

}  // namespace tread::plan
