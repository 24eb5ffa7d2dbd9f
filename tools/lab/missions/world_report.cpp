// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/missions/world_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <ostream>

#include "common/report/text.hpp"
#include "modules/learner/core/rules/make_rule.hpp"
#include "tools/lab/missions/given_worlds.hpp"

namespace tread::missions {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kSameMetric = 0.01;
constexpr std::array<double, 3> kQuantiles = {.5, .9, .99};
constexpr double kNormal95 = 1.959963984540054;

constexpr const char* kOmniscient = "omniscient";
const std::pair<std::string, TrueShare> kShares[] = {
    {"+true_means", TrueShare::kMeans}, {"+true_covariances", TrueShare::kCovariances}};

/// JSON has neither infinity nor NaN.
Json orNull(double number) {
  return std::isfinite(number) ? Json(number) : Json(nullptr);
}

Json worldJson(const MissionResult& result) {
  return {{"world", result.world},
          {"success", result.outcome == MissionOutcome::kArrived},
          {"contact", result.outcome == MissionOutcome::kContact},
          {"timeout", result.outcome == MissionOutcome::kStopped},
          {"time_s", result.clock},
          {"metric", navigationMetric(result)},
          {"metres", result.distance},
          {"least_clearance_m", orNull(result.least_clearance)},
          {"promised_contacts", result.plans.touches}};
}

Json summaryJson(const MissionBatch& batch) {
  const TimedSummary summary = timedSummaryOf(batch.results);
  return {{"worlds", batch.results.size()},
          {"success", summary.success},
          {"contact", summary.contact},
          {"timeout", summary.timeout},
          {"metric", summary.metric},
          {"time_s", orNull(summary.time)},
          {"metres", orNull(summary.metres)},
          {"clearance_m", orNull(summary.clearance)},
          {"least_clearance_m", orNull(summary.least_clearance)},
          {"stops", summary.stops},
          {"stood_s", summary.stood},
          {"next_sigma_m", orNull(summary.next_sigma)},
          {"end_sigma_m", orNull(summary.end_sigma)},
          {"promised_contacts", summary.touches},
          {"expansions",
           {{"50", summary.expansions[0]},
            {"90", summary.expansions[1]},
            {"99", summary.expansions[2]}}}};
}

Json timedJson(const MissionBatch& batch) {
  Json json;
  json["rule"] = batch.rule;
  json["set"] = batch.overrides;
  json["summary"] = summaryJson(batch);
  json["worlds"] = Json::array();
  for (const MissionResult& result : batch.results) json["worlds"].push_back(worldJson(result));
  json["missions"] = batchJson(batch);
  return json;
}

double meanErrorCm(const std::vector<MissionResult>& results) {
  const MeanError error = meanErrorOf(results, errorAsDriven());
  return error.count > 0 ? 100.0 * error.position : std::nan("");
}

std::string metricsText(const std::vector<MissionBatch>& batches) {
  std::string text;
  for (const MissionBatch& batch : batches)
    text += (text.empty() ? "; metric " : ", ") + batch.rule +
            formatted(" %.3f", timedSummaryOf(batch.results).metric);
  return text;
}

}  // namespace

std::optional<PatternSource> patternSourceOf(const std::string& word) {
  const auto isRule = [](const std::string& rule) {
    const std::vector<std::string> rules = learner::ruleNames();
    return std::find(rules.begin(), rules.end(), rule) != rules.end();
  };
  if (word == kOmniscient) return PatternSource{word, "", TrueShare::kAll};
  if (isRule(word)) return PatternSource{word, word, std::nullopt};
  for (const auto& [ending, share] : kShares) {
    if (word.size() <= ending.size()) continue;
    const std::string rule = word.substr(0, word.size() - ending.size());
    if (rule + ending == word && isRule(rule)) return PatternSource{word, rule, share};
  }
  return std::nullopt;
}

std::string timedLineOf(const MissionResult& result) {
  return formatted("world %-8s %-8s %5.1f s  %5.1f m  metric %.3f  clearance %.3f m  stops %zu%s%s",
                   result.world.c_str(), nameOf(result.outcome), result.clock, result.distance,
                   navigationMetric(result), result.least_clearance, result.stops.size(),
                   result.reason.empty() ? "" : "  ", result.reason.c_str());
}

TimedSummary timedSummaryOf(const std::vector<MissionResult>& results) {
  TimedSummary summary;
  std::vector<double> clearances;
  int arrived = 0;
  PlanFigures plans;
  const double share = 1.0 / static_cast<double>(std::max<size_t>(1, results.size()));
  for (const MissionResult& result : results) {
    const bool success = result.outcome == MissionOutcome::kArrived;
    if (success) summary.success += share;
    if (result.outcome == MissionOutcome::kContact) summary.contact += share;
    if (result.outcome == MissionOutcome::kStopped) summary.timeout += share;
    summary.metric += share * navigationMetric(result);
    summary.time += success ? result.clock : 0.0;
    summary.metres += success ? result.distance : 0.0;
    arrived += success ? 1 : 0;
    clearances.push_back(result.least_clearance);
    summary.stops += share * static_cast<double>(result.stops.size());
    for (const Stop& stop : result.stops) summary.stood += share * stop.duration;
    plans.count += result.plans.count;
    plans.next += result.plans.next;
    plans.end += result.plans.end;
    plans.expansions.insert(plans.expansions.end(), result.plans.expansions.begin(),
                            result.plans.expansions.end());
    summary.touches += share * result.plans.touches;
  }
  std::sort(plans.expansions.begin(), plans.expansions.end());
  for (size_t i = 0; i < summary.expansions.size() && !plans.expansions.empty(); ++i)
    summary.expansions[i] = plans.expansions[static_cast<size_t>(
        kQuantiles[i] * static_cast<double>(plans.expansions.size() - 1))];
  std::sort(clearances.begin(), clearances.end());
  const double none = std::numeric_limits<double>::quiet_NaN();
  summary.time = arrived > 0 ? summary.time / arrived : none;
  summary.metres = arrived > 0 ? summary.metres / arrived : none;
  summary.next_sigma = plans.count > 0 ? plans.next / plans.count : none;
  summary.end_sigma = plans.count > 0 ? plans.end / plans.count : none;
  summary.least_clearance = clearances.empty() ? none : clearances.front();
  summary.clearance = clearances.empty() ? none : clearances[clearances.size() / 2];
  return summary;
}

PairedMetric pairedMetric(const std::vector<MissionResult>& mine,
                          const std::vector<MissionResult>& other) {
  PairedMetric paired;
  const size_t count = std::min(mine.size(), other.size());
  double squares = 0.0;
  for (size_t i = 0; i < count; ++i) {
    const double difference = navigationMetric(mine[i]) - navigationMetric(other[i]);
    paired.mean += difference;
    squares += difference * difference;
    paired.better += difference > kSameMetric ? 1 : 0;
    paired.worse += difference < -kSameMetric ? 1 : 0;
  }
  const auto n = static_cast<double>(std::max<size_t>(1, count));
  paired.mean /= n;
  const double variance = std::max(0.0, squares / n - paired.mean * paired.mean);
  const double half = kNormal95 * std::sqrt(variance / std::max(1.0, n - 1.0));
  paired.low = paired.mean - half;
  paired.high = paired.mean + half;
  return paired;
}

void printWorlds(std::ostream& out, const std::vector<MissionBatch>& batches) {
  out << '\n' << outcomesOf(batches, "world") << metricsText(batches) << '\n';
  out << "success, contact, timeout: shares; stops and stood: per run; sigmas: next pattern, "
         "plan\n";
  out << formatted("%-28s %6s %8s %8s %8s %7s %8s %8s %13s %9s %6s %9s %10s %13s\n", "rule",
                   "worlds", "success", "contact", "timeout", "metric", "time [s]", "path [m]",
                   "clearance [m]", "least [m]", "stops", "stood [s]", "error [cm]", "sigmas [cm]");
  for (const MissionBatch& batch : batches) {
    const TimedSummary s = timedSummaryOf(batch.results);
    out << formatted(
        "%-28s %6zu %8.3f %8.3f %8.3f %7.4f %8.1f %8.1f %13.3f %9.3f %6.1f %9.1f %10.1f %6.1f "
        "%6.1f\n",
        batch.rule.c_str(), batch.results.size(), s.success, s.contact, s.timeout, s.metric, s.time,
        s.metres, s.clearance, s.least_clearance, s.stops, s.stood, meanErrorCm(batch.results),
        100.0 * s.next_sigma, 100.0 * s.end_sigma);
  }
  if (batches.size() < 2) return;
  out << "metric minus that of " << batches.front().rule
      << " in the same worlds, with the 95 % interval over them:\n";
  for (size_t i = 1; i < batches.size(); ++i) {
    const PairedMetric d = pairedMetric(batches[i].results, batches.front().results);
    out << formatted("%-28s %+.4f [%+.4f, %+.4f], %d better, %d worse\n", batches[i].rule.c_str(),
                     d.mean, d.low, d.high, d.better, d.worse);
  }
}

void writeWorlds(const std::string& path, const std::vector<MissionBatch>& batches) {
  if (batches.size() == 1) return writeJsonFile(path, timedJson(batches.front()));
  Json json;
  json["batches"] = Json::array();
  for (const MissionBatch& batch : batches) json["batches"].push_back(timedJson(batch));
  json["metric_less_the_first"] = Json::array();
  for (size_t i = 1; i < batches.size(); ++i) {
    const PairedMetric d = pairedMetric(batches[i].results, batches.front().results);
    json["metric_less_the_first"].push_back({{"rule", batches[i].rule},
                                             {"mean", d.mean},
                                             {"low", d.low},
                                             {"high", d.high},
                                             {"better", d.better},
                                             {"worse", d.worse}});
  }
  writeJsonFile(path, json);
}

}  // namespace tread::missions
