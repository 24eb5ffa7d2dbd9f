// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/missions/stop_report.hpp"

#include <algorithm>
#include <cctype>
#include <ostream>

#include "common/report/text.hpp"

namespace tread::missions {
namespace {

bool isDigit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

}  // namespace

std::string withoutNumbers(const std::string& reason) {
  std::string kind;
  for (size_t i = 0; i < reason.size(); ++i) {
    const bool after_number = !kind.empty() && kind.back() == '#';
    const bool point = reason[i] == '.' && i + 1 < reason.size() && isDigit(reason[i + 1]);
    if (after_number && (isDigit(reason[i]) || point)) continue;
    kind += isDigit(reason[i]) ? '#' : reason[i];
  }
  std::replace(kind.begin(), kind.end(), '#', 'N');
  return kind;
}

Steadiness steadinessOf(const std::vector<MissionResult>& results) {
  Steadiness steadiness;
  for (const MissionResult& result : results) {
    const auto stops = static_cast<int>(result.stops.size());
    steadiness.driven += result.driven;
    steadiness.flips += static_cast<int>(result.flips.size());
    steadiness.stops += stops;
    if (stops > steadiness.most_stops) steadiness.most_seed = result.seed;
    steadiness.most_stops = std::max(steadiness.most_stops, stops);
    for (const Stop& stop : result.stops) {
      steadiness.stood += stop.duration;
      ++steadiness.reasons[withoutNumbers(stop.reason)];
    }
  }
  return steadiness;
}

void printSteadiness(std::ostream& out, const std::vector<MissionResult>& results) {
  const Steadiness steadiness = steadinessOf(results);
  const auto missions = static_cast<double>(std::max<size_t>(1, results.size()));
  out << formatted("flips %d: %.2f per minute driven (%.0f s)\n", steadiness.flips,
                   steadiness.flipsPerMinute(), steadiness.driven);
  out << formatted("stops %d: %.2f per mission, at most %d (seed %llu), %.0f s in all\n",
                   steadiness.stops, steadiness.stops / missions, steadiness.most_stops,
                   static_cast<unsigned long long>(steadiness.most_seed), steadiness.stood);
  std::vector<std::pair<int, std::string>> reasons;
  for (const auto& [reason, count] : steadiness.reasons) reasons.emplace_back(-count, reason);
  std::sort(reasons.begin(), reasons.end());
  for (const auto& [count, reason] : reasons) {
    out << formatted("          %4d  ", -count)
        << (reason.empty() ? "(no reason published)" : reason) << '\n';
  }
}

}  // namespace tread::missions
