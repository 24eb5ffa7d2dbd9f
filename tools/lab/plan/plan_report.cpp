// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/plan/plan_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/config/scalars.hpp"
#include "common/report/plot.hpp"
#include "common/report/text.hpp"
#include "common/store/store.hpp"

namespace tread::plan {
namespace {

using Json = nlohmann::ordered_json;
using planner::PathEnd;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();  // JSON writes it as null

/// Name in the JSON.
const char* nameOf(PathEnd end) {
  if (end == PathEnd::kSolved) return "solved";
  return end == PathEnd::kUnreachable ? "unreachable" : "none_in_time";
}

/// Totals over many answers.
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

/// A number of a plan; null without a plan.
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
  // Lattice costs are integers, the others need at most three decimals.
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

using Eigen::Vector2d;
using report::Box;
using report::Colour;
using report::Panel;

constexpr double kMargin = 70.0;     // [pixels] around the panel for its axes
constexpr double kLongest = 1000.0;  // [pixels] longer side of the panel
constexpr double kShortest = 300.0;  // [pixels]

/// The part of the map's frame covered by the grid.
struct Extent {
  Vector2d low{1e9, 1e9};
  Vector2d high{-1e9, -1e9};

  Vector2d size() const { return high - low; }
};

std::array<Vector2d, 4> corners(const PlanScene& scene, CellIndex from, CellIndex to,
                                double more = 0.0) {
  const double cell = scene.grid.cellSize();
  const Vector2d low(from.x * cell - more, from.y * cell - more);
  const Vector2d high(to.x * cell + more, to.y * cell + more);
  return {scene.T_map_grid * low, scene.T_map_grid * Vector2d(high.x(), low.y()),
          scene.T_map_grid * high, scene.T_map_grid * Vector2d(low.x(), high.y())};
}

Extent extentOf(const PlanScene& scene) {
  const CellIndex low = scene.grid.lower();
  Extent extent;
  for (const Vector2d& corner :
       corners(scene, low, {low.x + scene.grid.width(), low.y + scene.grid.height()})) {
    extent.low = extent.low.cwiseMin(corner);
    extent.high = extent.high.cwiseMax(corner);
  }
  return extent;
}

/// The panel's size follows the map's proportions.
Box boxFor(const Extent& extent) {
  const double scale = kLongest / extent.size().maxCoeff();
  return {kMargin, kMargin, std::max(kShortest, extent.size().x() * scale),
          std::max(kShortest, extent.size().y() * scale)};
}

/// Draws cells that are not free; equal neighbours in a row as one.
void drawCells(Panel& panel, const PlanScene& scene, double metres_per_pixel) {
  const CellIndex low = scene.grid.lower();
  for (int y = low.y; y < low.y + scene.grid.height(); ++y) {
    const int end = low.x + scene.grid.width();
    for (int x = low.x; x < end;) {
      const Cell cell = scene.grid.at({x, y});
      const int first = x;
      while (x < end && scene.grid.at({x, y}) == cell) ++x;
      if (isFree(cell)) continue;
      const double grey = cell == kUnknown ? 0.8 : 0.15;
      // Half a pixel of overlap: anti-aliasing would leave bright seams between rows.
      const auto run = corners(scene, {first, y}, {x, y + 1}, metres_per_pixel / 2.0);
      panel.polygon({run.begin(), run.end()}, {grey, grey, grey});
    }
  }
}

void drawFootprints(Panel& panel, const PlanScene& scene) {
  const Colour fill{0.90, 0.62, 0.00, 0.18};
  for (const Pose2& T_map_body : scene.stations) {
    if (scene.outline.empty()) {
      panel.disc(T_map_body.position(), scene.radius, fill);
      continue;
    }
    std::vector<Vector2d> outline;
    for (const Vector2d& corner : scene.outline) outline.push_back(T_map_body * corner);
    panel.polygon(outline, fill);
    outline.push_back(outline.front());
    panel.line(outline, {{0.70, 0.45, 0.00, 0.6}, 0.8, false, ""});
  }
}

/// A dot with its heading.
void drawPose(Panel& panel, const Pose2& T_map_body, double length, Colour colour) {
  panel.dot(T_map_body.position(), colour, 6.0);
  panel.line({T_map_body.position(), T_map_body * Vector2d(length, 0.0)}, {colour, 3.0, false, ""});
}

/// Below the map, so that it hides nothing.
void drawLegend(report::Picture& sheet, const PlanScene& scene, const Box& box) {
  double x = box.x;
  const double y = box.y + box.height + 50.0;
  const auto entry = [&](Colour colour, const std::string& tokens, double width) {
    sheet.fill({x, y - 8.0, 14.0, 8.0}, colour);
    sheet.text(x + 19.0, y, tokens, 11.0);
    x += width;
  };
  entry(report::kGreen, "start", 65.0);
  entry(report::kRed, "goal", 62.0);
  if (!scene.path.empty()) entry(report::kOrange, "plan", 60.0);
  if (!scene.tree.empty()) entry(report::kBlue, "search tree", 90.0);
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
  // A name comes from a file that may be corrupted: its bytes need not be UTF-8.
  writeText(path, json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
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

std::vector<Vector2d> rectangle(double length, double width) {
  const double x = length / 2.0;
  const double y = width / 2.0;
  return {{x, y}, {-x, y}, {-x, -y}, {x, -y}};
}

void drawPlan(const std::string& path, const PlanScene& scene) {
  const Extent extent = extentOf(scene);
  const Box box = boxFor(extent);
  const double metres_per_pixel =
      std::max(extent.size().x() / box.width, extent.size().y() / box.height);
  report::Picture sheet(static_cast<int>(box.width + 2.0 * kMargin),
                        static_cast<int>(box.height + 2.0 * kMargin), scene.title);
  sheet.text(20.0, 50.0, scene.result);
  Panel panel(sheet, box,
              {"", "x [m]", "y [m]", extent.low.x(), extent.high.x(), extent.low.y(),
               extent.high.y(), true});
  drawCells(panel, scene, metres_per_pixel);
  for (const auto& branch : scene.tree)
    panel.line(branch, {{0.00, 0.45, 0.70, 0.25}, 0.6, false, ""});
  drawFootprints(panel, scene);
  panel.line(scene.path, {report::kOrange, 2.5, false, ""});
  drawPose(panel, scene.T_map_start, 14.0 * metres_per_pixel, report::kGreen);
  drawPose(panel, scene.T_map_goal, 14.0 * metres_per_pixel, report::kRed);
  panel.finish();
  drawLegend(sheet, scene, box);
  sheet.save(path);
}

}  // namespace tread::plan
