// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/missions/omniscient_report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>

#include "common/report/text.hpp"
#include "tools/missions/campaign_json.hpp"

namespace tread::missions {
namespace {

constexpr size_t kShown = 5;  ///< missions with the largest ratios

double timeOf(const MissionResult& result) {
  return result.time - result.begun;
}

}  // namespace

std::vector<TimeRatio> timeRatios(const OmniscientComparison& comparison) {
  std::vector<TimeRatio> ratios;
  for (size_t i = 0; i < comparison.learning.results.size(); ++i) {
    const MissionResult& learning = comparison.learning.results[i];
    const MissionResult& omniscient = comparison.omniscient.results[i];
    const bool both =
        learning.outcome == Outcome::kArrived && omniscient.outcome == Outcome::kArrived;
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
                   countOf(comparison.learning, Outcome::kArrived),
                   comparison.learning.rule.c_str(),
                   countOf(comparison.omniscient, Outcome::kArrived), ratios.size());
  if (ratios.empty()) return;
  out << formatted(
      "time to the goal over the omniscient robot's: median %.3f, p90 %.3f, worst %.3f\n",
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
  nlohmann::ordered_json json;
  json["both_arrived"] = ratios.size();
  json["time_ratio"] = {{"median", quantileOf(ratios, 0.5)},
                        {"p90", quantileOf(ratios, 0.9)},
                        {"worst", quantileOf(ratios, 1.0)}};
  json["missions"] = nlohmann::ordered_json::array();
  for (const TimeRatio& at : ratios)
    json["missions"].push_back({{"seed", at.seed},
                                {"learning_s", at.learning},
                                {"omniscient_s", at.omniscient},
                                {"ratio", at.ratio()}});
  json["learning"] = campaignJson(comparison.learning);
  json["omniscient"] = campaignJson(comparison.omniscient);
  writeJsonFile(path, json);
}

}  // namespace tread::missions
