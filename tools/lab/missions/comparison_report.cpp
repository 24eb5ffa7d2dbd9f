// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors

#include "tools/lab/missions/comparison_report.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <ostream>

#include "common/report/text.hpp"
#include "tools/lab/missions/prediction_errors.hpp"

namespace tread::missions {
namespace {

using Json = nlohmann::ordered_json;

/// Numbers of executions on the new surface for which the text shows pooled ratios.
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

Omniscient omniscientOf(const RuleComparison& comparison) {
  Omniscient omniscient;
  for (const MissionBatch& batch : comparison.batches)
    for (const MissionResult& result : batch.results) omniscient.add(result);
  return omniscient;
}

/// Each rule in its own drives.
std::vector<Row> rowsOfWorlds(const RuleComparison& comparison, const Omniscient& omniscient) {
  std::vector<Row> rows;
  for (const MissionBatch& batch : comparison.batches)
    rows.push_back(rowOf(batch.rule, batch.results, errorAsDriven(), omniscient));
  return rows;
}

/// Errors of the oracle, which has no settling.
Row omniscientRow(const std::vector<MissionResult>& results, const Omniscient& omniscient) {
  Row row;
  row.rule = "omniscient";
  const ErrorOf known = [&](const ScoredExecution& execution, uint64_t seed) {
    return omniscient.errorOf(execution, seed);
  };
  row.errors = errorsAroundChanges(results, known);
  row.all = meanErrorOf(results, known);
  return row;
}

/// Each rule's predictions for the executions of the first rule's drives.
std::vector<Row> rowsOfExecutions(const RuleComparison& comparison, const Omniscient& omniscient) {
  std::vector<Row> rows;
  const std::vector<MissionResult>& results = comparison.batches.front().results;
  if (results.empty()) return rows;
  const std::vector<learner::Rule>& rules = results.front().shadow_rules;
  for (size_t i = 0; i < rules.size(); ++i)
    rows.push_back(rowOf(rules[i], results, errorByRule(i), omniscient));
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
      {"the 1st after it", &ErrorsAroundChanges::first},
      {"2nd, 3rd after it", &ErrorsAroundChanges::next},
      {"5..15 after it", &ErrorsAroundChanges::settled}};
  for (const auto& [when, part] : parts)
    for (const Row& row : rows) printErrors(out, row.rule, when, row.errors.*part);
  for (const Row& row : rows) printErrors(out, row.rule, "all on one surface", row.all);
}

/// Difference between the mean errors of two rules on the same executions. Missions are
/// independent, so the interval is over missions.
struct Difference {
  double position = 0.0, yaw = 0.0;            ///< [m], [rad]; negative is better
  double half_position = 0.0, half_yaw = 0.0;  ///< half the 95 % interval
};

using PartOf = std::function<MeanError(const std::vector<MissionResult>&, const ErrorOf&)>;

Difference differenceOf(const std::vector<MissionResult>& results, size_t rule, size_t against,
                        const PartOf& part) {
  struct OfMission {
    double count, position, yaw;
  };
  constexpr double kNormal95 = 1.959963984540054;
  std::vector<OfMission> missions;
  OfMission all{0.0, 0.0, 0.0};
  for (const MissionResult& result : results) {
    const MeanError mine = part({result}, errorByRule(rule));
    const MeanError other = part({result}, errorByRule(against));
    const auto n = static_cast<double>(mine.count);
    missions.push_back({n, n * (mine.position - other.position), n * (mine.yaw - other.yaw)});
    all.count += n;
    all.position += missions.back().position;
    all.yaw += missions.back().yaw;
  }
  if (all.count <= 0.0) return {};
  Difference difference{all.position / all.count, all.yaw / all.count};
  double position = 0.0, yaw = 0.0;
  for (const OfMission& one : missions) {
    position += std::pow(one.position - one.count * difference.position, 2);
    yaw += std::pow(one.yaw - one.count * difference.yaw, 2);
  }
  difference.half_position = kNormal95 * std::sqrt(position) / all.count;
  difference.half_yaw = kNormal95 * std::sqrt(yaw) / all.count;
  return difference;
}

void printDifferences(std::ostream& out, const std::vector<MissionResult>& results) {
  if (results.empty() || results.front().shadow_rules.size() < 2) return;
  const std::vector<learner::Rule>& rules = results.front().shadow_rules;
  out << "  less than " << rules.front()
      << " on these executions (negative is better), with the 95 % interval over missions:\n";
  const auto around = [](MeanError ErrorsAroundChanges::*part) -> PartOf {
    return [part](const std::vector<MissionResult>& of, const ErrorOf& error) {
      return errorsAroundChanges(of, error).*part;
    };
  };
  const std::pair<const char*, PartOf> parts[] = {
      {"1..3 after it", around(&ErrorsAroundChanges::after)},
      {"2nd, 3rd after it", around(&ErrorsAroundChanges::next)},
      {"5..15 after it", around(&ErrorsAroundChanges::settled)},
      {"all on one surface", meanErrorOf}};
  for (const auto& [when, part] : parts)
    for (size_t rule = 1; rule < rules.size(); ++rule) {
      const Difference d = differenceOf(results, rule, 0, part);
      out << formatted("  %-12s %-18s %+8.4f +-%.4f m  %+8.4f +-%.4f rad\n", rules[rule].c_str(),
                       when, d.position, d.half_position, d.yaw, d.half_yaw);
    }
}

std::string countText(double count) {
  return std::isfinite(count) ? formatted("%.0f", count) : "never";
}

std::string firstWithin(const std::vector<double>& ratios) {
  for (size_t n = 0; n < ratios.size(); ++n)
    if (ratios[n] <= Settling::kWithin) return std::to_string(n);
  return "never";
}

/// Pooled ratios after 0, 5, 10 and 20 executions; a dash if too few changes have that many.
std::string ratiosText(const std::vector<double>& ratios) {
  std::string text;
  for (const size_t n : kShownAfter)
    text += n < ratios.size() ? formatted(" %5.2f", ratios[n]) : std::string("     -");
  return text;
}

void printSettling(std::ostream& out, const Row& row, const char* which, const Settling& settling) {
  if (settling.changes == 0) return;
  out << formatted(
      "  %-12s %-10s %7d %8d  %11s %5s %5s  %11s %5s  %s  %s\n", row.rule.c_str(), which,
      settling.changes, settling.missions, countText(settling.position).c_str(),
      countText(settling.yaw).c_str(), countText(settling.both).c_str(),
      firstWithin(settling.position_ratio).c_str(), firstWithin(settling.yaw_ratio).c_str(),
      ratiosText(settling.position_ratio).c_str(), ratiosText(settling.yaw_ratio).c_str());
}

void printSettlingTable(std::ostream& out, const std::vector<Row>& rows) {
  out << formatted(
      "  executions on a new surface until the mean error of the next %zu is at most %.1f times "
      "the "
      "omniscient one's:\n  median over the changes, and all changes pooled; then the ratio of the "
      "two errors after 0, 5, 10 and 20 executions:\n",
      Settling::kWindow, Settling::kWithin);
  out << "  rule         surface    changes missions  median: pos   yaw  both  pooled: pos   yaw   "
         "  "
         "position after 0 5 10 20       yaw after 0 5 10 20\n";
  for (const Row& row : rows) printSettling(out, row, "any", row.settling);
  for (const Row& row : rows) printSettling(out, row, "first met", row.first_met);
  for (const Row& row : rows) printSettling(out, row, "met before", row.met_before);
}

void printDrives(std::ostream& out, const RuleComparison& comparison) {
  out << "  rule         missions  arrived  refused  idle  stopped  contacts  path [m]  patterns\n";
  for (const MissionBatch& batch : comparison.batches) {
    double metres = 0.0;
    int patterns = 0;
    for (const MissionResult& result : batch.results) {
      metres += result.distance;
      patterns += result.completed;
    }
    out << formatted(
        "  %-12s %8zu %8d %8d %5d %8d %9d %9.0f %9d\n", batch.rule.c_str(), batch.results.size(),
        countOf(batch, MissionOutcome::kArrived), countOf(batch, MissionOutcome::kRefused),
        countOf(batch, MissionOutcome::kIdle), countOf(batch, MissionOutcome::kStopped),
        collisionsOf(batch), metres, patterns);
  }
}

/// A rule's error, only for executions that the oracle predicts, too.
ErrorOf whereKnown(ErrorOf error, const Omniscient& omniscient) {
  return [error = std::move(error), &omniscient](
             const ScoredExecution& execution,
             uint64_t seed) -> std::optional<report::PredictionError> {
    if (!omniscient.errorOf(execution, seed)) return std::nullopt;
    return error(execution, seed);
  };
}

/// For the headline: how much of the way from `off` to the oracle each rule closes, on the same
/// executions; empty if `off` is not among the rules or the oracle knows too little.
std::string closedText(const std::vector<MissionResult>& results, const Omniscient& omniscient) {
  if (results.empty()) return "";
  const std::vector<learner::Rule>& rules = results.front().shadow_rules;
  const auto off = std::find(rules.begin(), rules.end(), "off");
  if (off == rules.end()) return "";
  const auto settled = [&](const ErrorOf& error) {
    return errorsAroundChanges(results, whereKnown(error, omniscient)).settled;
  };
  const MeanError none = settled(errorByRule(static_cast<size_t>(off - rules.begin())));
  const MeanError best = omniscientRow(results, omniscient).errors.settled;
  if (none.position <= best.position || none.yaw <= best.yaw) return "";
  std::string text;
  for (size_t i = 0; i < rules.size(); ++i) {
    if (rules[i] == "off") continue;
    const MeanError mine = settled(errorByRule(i));
    text += formatted("%s%s %.0f %% (yaw %.0f %%)", text.empty() ? "" : ", ", rules[i].c_str(),
                      100.0 * (none.position - mine.position) / (none.position - best.position),
                      100.0 * (none.yaw - mine.yaw) / (none.yaw - best.yaw));
  }
  if (text.empty()) return "";
  return "; closes of the way from off to omniscient, 5..15 executions after a change: " + text;
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
                    {"after_1", errorJson(row.errors.first)},
                    {"after_2_to_3", errorJson(row.errors.next)},
                    {"settled_5_to_15", errorJson(row.errors.settled)},
                    {"all", errorJson(row.all)},
                    {"settling", settlingJson(row.settling)},
                    {"settling_first_met", settlingJson(row.first_met)},
                    {"settling_met_before", settlingJson(row.met_before)}});
  return json;
}

constexpr size_t kShown = 5;  ///< missions with the largest ratios

double timeOf(const MissionResult& result) {
  return result.time - result.begun;
}

}  // namespace

void printComparison(std::ostream& out, const RuleComparison& comparison) {
  const Omniscient omniscient = omniscientOf(comparison);
  out << outcomesOf(comparison.batches)
      << closedText(comparison.batches.front().results, omniscient) << '\n';
  out << "the same worlds, each rule drives:\n";
  printDrives(out, comparison);
  const std::vector<Row> own = rowsOfWorlds(comparison, omniscient);
  printTable(out, own);
  printSettlingTable(out, own);
  std::vector<Row> same = rowsOfExecutions(comparison, omniscient);
  if (same.empty()) return;
  const MissionBatch& driven = comparison.batches.front();
  out << "the same executions, those of the drives with " << driven.rule
      << ", predicted by each rule:\n";
  std::vector<Row> with_best = same;
  with_best.push_back(omniscientRow(driven.results, omniscient));
  printTable(out, with_best);
  printDifferences(out, driven.results);
  printSettlingTable(out, same);
}

void writeComparison(const std::string& path, const RuleComparison& comparison) {
  const Omniscient omniscient = omniscientOf(comparison);
  const MissionBatch& driven = comparison.batches.front();
  Json json;
  json["same_worlds"] = rowsJson(rowsOfWorlds(comparison, omniscient));
  json["same_executions_driven_with"] = driven.rule;
  json["same_executions"] = rowsJson(rowsOfExecutions(comparison, omniscient));
  const Row best = omniscientRow(driven.results, omniscient);
  json["omniscient"] = {{"before", errorJson(best.errors.before)},
                        {"after_1_to_3", errorJson(best.errors.after)},
                        {"after_1", errorJson(best.errors.first)},
                        {"after_2_to_3", errorJson(best.errors.next)},
                        {"settled_5_to_15", errorJson(best.errors.settled)},
                        {"all", errorJson(best.all)}};
  json["batches"] = Json::array();
  for (const MissionBatch& batch : comparison.batches) json["batches"].push_back(batchJson(batch));
  writeJsonFile(path, json);
}

std::vector<TimeRatio> timeRatios(const OmniscientComparison& comparison) {
  std::vector<TimeRatio> ratios;
  for (size_t i = 0; i < comparison.learning.results.size(); ++i) {
    const MissionResult& learning = comparison.learning.results[i];
    const MissionResult& omniscient = comparison.omniscient.results[i];
    const bool both = learning.outcome == MissionOutcome::kArrived &&
                      omniscient.outcome == MissionOutcome::kArrived;
    if (both) ratios.push_back({learning.seed, timeOf(learning), timeOf(omniscient)});
  }
  std::sort(ratios.begin(), ratios.end(),
            [](const TimeRatio& a, const TimeRatio& b) { return a.ratio() < b.ratio(); });
  return ratios;
}

double quantileOf(const std::vector<TimeRatio>& sorted, double share) {
  if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto rank = static_cast<size_t>(std::ceil(share * static_cast<double>(sorted.size())));
  return sorted[std::min(sorted.size(), std::max<size_t>(1, rank)) - 1].ratio();
}

void printOmniscient(std::ostream& out, const OmniscientComparison& comparison) {
  const std::vector<TimeRatio> ratios = timeRatios(comparison);
  out << formatted("arrived: %d learning with rule %s, %d omniscient, both in %zu\n",
                   countOf(comparison.learning, MissionOutcome::kArrived),
                   comparison.learning.rule.c_str(),
                   countOf(comparison.omniscient, MissionOutcome::kArrived), ratios.size());
  if (ratios.empty()) return;
  out << formatted("time to the goal, learning / omniscient: median %.3f, p90 %.3f, worst %.3f\n",
                   quantileOf(ratios, 0.5), quantileOf(ratios, 0.9), ratios.back().ratio());
  for (size_t i = 0; i < std::min(kShown, ratios.size()); ++i) {
    const TimeRatio& at = ratios[ratios.size() - 1 - i];
    out << formatted("  seed %-6llu %.2f  (%.1f s, %.1f s)\n",
                     static_cast<unsigned long long>(at.seed), at.ratio(), at.learning,
                     at.omniscient);
  }
}

void writeOmniscient(const std::string& path, const OmniscientComparison& comparison) {
  const std::vector<TimeRatio> ratios = timeRatios(comparison);
  Json json;
  json["both_arrived"] = ratios.size();
  json["time_ratio"] = {{"median", quantileOf(ratios, 0.5)},
                        {"p90", quantileOf(ratios, 0.9)},
                        {"worst", quantileOf(ratios, 1.0)}};
  json["missions"] = Json::array();
  for (const TimeRatio& at : ratios)
    json["missions"].push_back({{"seed", at.seed},
                                {"learning_s", at.learning},
                                {"omniscient_s", at.omniscient},
                                {"ratio", at.ratio()}});
  json["learning"] = batchJson(comparison.learning);
  json["omniscient"] = batchJson(comparison.omniscient);
  writeJsonFile(path, json);
}

}  // namespace tread::missions
