// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/missions/comparison_report.hpp"

#include <cmath>
#include <ostream>

#include "common/report/text.hpp"
#include "tools/missions/campaign_json.hpp"
#include "tools/missions/settling.hpp"

namespace tread::missions {
namespace {

using Json = nlohmann::ordered_json;

/// Executions on the new surface after which the text shows the pooled ratios.
constexpr size_t kShownAfter[] = {0, 5, 10, 20};

/// One rule on some executions.
struct Row {
  std::string rule;
  ErrorsAroundChanges errors;
  MeanError all;
  Settling settling, first_met, met_before;
};

Row rowOf(const std::string& rule, const std::vector<MissionResult>& results, const ErrorOf& error,
          const Omniscient& omniscient) {
  return {rule,
          errorsAroundChanges(results, error),
          meanErrorOf(results, error),
          settlingOf(results, error, omniscient),
          settlingOf(results, error, omniscient, Met::kFirst),
          settlingOf(results, error, omniscient, Met::kBefore)};
}

Omniscient omniscientOf(const Comparison& comparison) {
  Omniscient omniscient;
  for (const Campaign& campaign : comparison.campaigns)
    for (const MissionResult& result : campaign.results) omniscient.add(result);
  return omniscient;
}

/// Each rule in its own drives.
std::vector<Row> rowsOfWorlds(const Comparison& comparison, const Omniscient& omniscient) {
  std::vector<Row> rows;
  for (const Campaign& campaign : comparison.campaigns)
    rows.push_back(rowOf(campaign.rule, campaign.results, errorAsDriven(), omniscient));
  return rows;
}

/// Errors of the set that nobody has; its settling is left empty.
Row omniscientRow(const std::vector<MissionResult>& results, const Omniscient& omniscient) {
  Row row;
  row.rule = "omniscient";
  // An execution does not know its world's seed, so the missions are taken one by one.
  std::map<const ScoredExecution*, shadow::EndError> errors;
  for (const MissionResult& result : results)
    for (const ScoredExecution& execution : result.executions)
      if (const auto error = omniscient.errorOf(execution, result.seed))
        errors.emplace(&execution, *error);
  const ErrorOf known = [&](const ScoredExecution& execution) -> std::optional<shadow::EndError> {
    const auto found = errors.find(&execution);
    if (!execution.measured || found == errors.end()) return std::nullopt;
    return found->second;
  };
  row.errors = errorsAroundChanges(results, known);
  row.all = meanErrorOf(results, known);
  return row;
}

/// Each rule on the executions of the first rule's drives.
std::vector<Row> rowsOfExecutions(const Comparison& comparison, const Omniscient& omniscient) {
  std::vector<Row> rows;
  const std::vector<MissionResult>& results = comparison.campaigns.front().results;
  if (results.empty()) return rows;
  const std::vector<learner::Rule>& rules = results.front().shadow_rules;
  for (size_t i = 0; i < rules.size(); ++i)
    rows.push_back(rowOf(learner::ruleName(rules[i]), results, errorByRule(i), omniscient));
  return rows;
}

void printErrors(std::ostream& out, const std::string& rule, const char* when,
                 const MeanError& error) {
  if (error.count == 0) return;
  out << formatted("  %-12s %-18s %6d  %12.4f  %9.4f  %14.4f  %13.4f\n", rule.c_str(), when,
                   error.count, error.position, error.yaw, error.position_per_m, error.yaw_per_rad);
}

void printTable(std::ostream& out, const std::vector<Row>& rows) {
  out << "  rule         executions          count  position [m]  yaw [rad]  position [m/m]  "
         "yaw [rad/rad]\n";
  const std::pair<const char*, MeanError ErrorsAroundChanges::*> parts[] = {
      {"before a change", &ErrorsAroundChanges::before},
      {"1..3 after it", &ErrorsAroundChanges::after},
      {"5..15 after it", &ErrorsAroundChanges::settled}};
  for (const auto& [when, part] : parts)
    for (const Row& row : rows) printErrors(out, row.rule, when, row.errors.*part);
  for (const Row& row : rows) printErrors(out, row.rule, "all on one surface", row.all);
}

std::string countText(double count) {
  return std::isfinite(count) ? formatted("%.0f", count) : "never";
}

std::string firstWithin(const std::vector<double>& ratios) {
  for (size_t n = 0; n < ratios.size(); ++n)
    if (ratios[n] <= Settling::kWithin) return std::to_string(n);
  return "never";
}

/// Pooled ratios after some numbers of executions, a dash where too few changes have so many.
std::string ratiosText(const std::vector<double>& ratios) {
  std::string text;
  for (const size_t n : kShownAfter)
    text += n < ratios.size() ? formatted(" %5.2f", ratios[n]) : std::string("     -");
  return text;
}

void printSettling(std::ostream& out, const Row& row, const char* which, const Settling& settling) {
  if (settling.changes == 0) return;
  out << formatted(
      "  %-12s %-10s %7d %8d  %11s %5s %5s  %9s %5s  %s  %s\n", row.rule.c_str(), which,
      settling.changes, settling.missions, countText(settling.position).c_str(),
      countText(settling.yaw).c_str(), countText(settling.both).c_str(),
      firstWithin(settling.position_ratio).c_str(), firstWithin(settling.yaw_ratio).c_str(),
      ratiosText(settling.position_ratio).c_str(), ratiosText(settling.yaw_ratio).c_str());
}

void printSettlingTable(std::ostream& out, const std::vector<Row>& rows) {
  out << formatted(
      "  executions on a new surface until the mean error of the next %zu is within %.1f of the "
      "omniscient one's,\n  as the median of changes and of all changes pooled, and that error "
      "over the omniscient one's after 0, 5, 10, 20:\n",
      Settling::kWindow, Settling::kWithin);
  out << "  rule         surface    changes missions    median: m   rad  both  pooled: m   rad     "
         "position after 0 5 10 20       yaw after 0 5 10 20\n";
  for (const Row& row : rows) printSettling(out, row, "any", row.settling);
  for (const Row& row : rows) printSettling(out, row, "first met", row.first_met);
  for (const Row& row : rows) printSettling(out, row, "met before", row.met_before);
}

void printDrives(std::ostream& out, const Comparison& comparison) {
  out << "  rule         missions  arrived  refused  idle  stopped  contacts  metres  patterns\n";
  for (const Campaign& campaign : comparison.campaigns) {
    double metres = 0.0;
    int patterns = 0;
    for (const MissionResult& result : campaign.results) {
      metres += result.distance;
      patterns += result.completed;
    }
    out << formatted("  %-12s %8zu %8d %8d %5d %8d %9d %7.0f %9d\n", campaign.rule.c_str(),
                     campaign.results.size(), countOf(campaign, Outcome::kArrived),
                     countOf(campaign, Outcome::kRefused), countOf(campaign, Outcome::kIdle),
                     countOf(campaign, Outcome::kStopped), collisionsOf(campaign), metres,
                     patterns);
  }
}

Json errorJson(const MeanError& error) {
  return {{"count", error.count},
          {"position_m", error.position},
          {"yaw_rad", error.yaw},
          {"position_per_m", error.position_per_m},
          {"yaw_per_rad", error.yaw_per_rad}};
}

/// JSON has no infinity: null = never.
Json numberJson(double number) {
  return std::isfinite(number) ? Json(number) : Json(nullptr);
}

Json settlingJson(const Settling& settling) {
  return {{"missions", settling.missions},
          {"changes", settling.changes},
          {"median_position", numberJson(settling.position)},
          {"median_yaw", numberJson(settling.yaw)},
          {"median_both", numberJson(settling.both)},
          {"position_ratio", settling.position_ratio},
          {"yaw_ratio", settling.yaw_ratio}};
}

Json rowsJson(const std::vector<Row>& rows) {
  Json json = Json::array();
  for (const Row& row : rows)
    json.push_back({{"rule", row.rule},
                    {"before", errorJson(row.errors.before)},
                    {"after_1_to_3", errorJson(row.errors.after)},
                    {"settled_5_to_15", errorJson(row.errors.settled)},
                    {"all", errorJson(row.all)},
                    {"settling", settlingJson(row.settling)},
                    {"settling_first_met", settlingJson(row.first_met)},
                    {"settling_met_before", settlingJson(row.met_before)}});
  return json;
}

}  // namespace

void printComparison(std::ostream& out, const Comparison& comparison) {
  const Omniscient omniscient = omniscientOf(comparison);
  out << "the same worlds, each rule drives:\n";
  printDrives(out, comparison);
  const std::vector<Row> own = rowsOfWorlds(comparison, omniscient);
  printTable(out, own);
  printSettlingTable(out, own);
  std::vector<Row> same = rowsOfExecutions(comparison, omniscient);
  if (same.empty()) return;
  const Campaign& driven = comparison.campaigns.front();
  out << "the same executions, those of the drives with " << driven.rule
      << ", predicted by each rule:\n";
  std::vector<Row> with_best = same;
  with_best.push_back(omniscientRow(driven.results, omniscient));
  printTable(out, with_best);
  printSettlingTable(out, same);
}

void writeComparison(const std::string& path, const Comparison& comparison) {
  const Omniscient omniscient = omniscientOf(comparison);
  const Campaign& driven = comparison.campaigns.front();
  Json json;
  json["same_worlds"] = rowsJson(rowsOfWorlds(comparison, omniscient));
  json["same_executions_driven_with"] = driven.rule;
  json["same_executions"] = rowsJson(rowsOfExecutions(comparison, omniscient));
  const Row best = omniscientRow(driven.results, omniscient);
  json["omniscient"] = {{"before", errorJson(best.errors.before)},
                        {"after_1_to_3", errorJson(best.errors.after)},
                        {"settled_5_to_15", errorJson(best.errors.settled)},
                        {"all", errorJson(best.all)}};
  json["campaigns"] = Json::array();
  for (const Campaign& campaign : comparison.campaigns)
    json["campaigns"].push_back(campaignJson(campaign));
  writeJsonFile(path, json);
}

}  // namespace tread::missions
