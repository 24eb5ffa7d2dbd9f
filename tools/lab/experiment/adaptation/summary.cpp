// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/experiment/adaptation/summary.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "common/geometry/degrees.hpp"
#include "common/statistics/statistics.hpp"
#include "tools/lab/experiment/trials.hpp"

namespace tread::adaptation {
namespace {

constexpr int kResamples = 2000;
constexpr double kNoDifference = 1e-6;  // [1] rounding error of ratios

/// Values of one quantity, one per session.
struct Columns {
  std::vector<double> errors, ratios, judged;  ///< judged: ratios of the judged rule
  std::vector<std::string> sessions;
};

Standing standingOf(const Columns& columns, uint64_t seed) {
  Standing standing;
  if (columns.errors.empty()) return standing;
  standing.error = meanOf(columns.errors);
  standing.ratio = intervalOf(columns.ratios, seed);
  const auto worst = std::max_element(columns.ratios.begin(), columns.ratios.end());
  standing.worst = *worst;
  standing.worst_session = columns.sessions[static_cast<size_t>(worst - columns.ratios.begin())];
  const size_t n = columns.judged.size();
  if (n != columns.ratios.size() || n < 2) return standing;
  std::vector<double> differences;
  for (size_t i = 0; i < n; ++i) differences.push_back(columns.judged[i] - columns.ratios[i]);
  standing.difference = meanOf(differences);
  double squares = 0.0;
  for (const double d : differences) squares += std::pow(d - standing.difference, 2);
  const auto count = static_cast<double>(n);
  standing.standard_error = std::sqrt(squares / (count * (count - 1.0)));
  const double margin = standing.standard_error + kNoDifference;
  standing.judged = standing.difference < -margin  ? Verdict::kBetter
                    : standing.difference > margin ? Verdict::kWorse
                                                   : Verdict::kLevel;
  return standing;
}

}  // namespace

const char* nameOf(Verdict verdict) {
  switch (verdict) {
    case Verdict::kBetter:
      return "better";
    case Verdict::kLevel:
      return "level";
    case Verdict::kWorse:
      return "worse";
    case Verdict::kUnknown:
      break;
  }
  return "-";
}

ConfidenceInterval intervalOf(const std::vector<double>& values, uint64_t seed) {
  ConfidenceInterval interval = kNoInterval;
  if (values.empty()) return interval;
  interval.value = meanOf(values);
  if (values.size() < 2) return interval;
  std::mt19937_64 random(seed);
  std::vector<double> means;
  for (int i = 0; i < kResamples; ++i) {
    double sum = 0.0;
    for (size_t j = 0; j < values.size(); ++j)
      sum += values[experiment::drawIndex(random, values.size())];
    means.push_back(sum / static_cast<double>(values.size()));
  }
  std::sort(means.begin(), means.end());
  interval.low = means[static_cast<size_t>(0.025 * kResamples)];
  interval.high = means[static_cast<size_t>(0.975 * kResamples)];
  return interval;
}

std::vector<SummaryLine> summaryOf(const AdaptationErrors& errors,
                                   const std::vector<std::string>& rules, uint64_t seed) {
  const auto placeOf = [&](const char* name) {
    return static_cast<size_t>(std::find(rules.begin(), rules.end(), name) - rules.begin());
  };
  const size_t off = placeOf(kOff), judged = placeOf(kJudged);
  std::vector<std::string> vehicles;
  for (const SessionErrors& session : errors.sessions)
    if (std::find(vehicles.begin(), vehicles.end(), session.vehicle) == vehicles.end())
      vehicles.push_back(session.vehicle);
  std::vector<SummaryLine> lines;
  const auto add = [&](HeldOut kind, const std::string& vehicle, size_t h, size_t rule, size_t k) {
    Columns position, yaw;
    for (const SessionErrors& session : errors.sessions) {
      if (session.kind != kind || session.vehicle != vehicle) continue;
      const Cell& cell = session.cells[rule][k][h];
      const Cell& none = session.cells[off][k][h];
      if (cell.starts < kLeastStarts) continue;
      position.sessions.push_back(session.session);
      position.errors.push_back(cell.position);
      position.ratios.push_back(cell.position / none.position);
      yaw.errors.push_back(toDegrees(cell.yaw));
      yaw.ratios.push_back(cell.yaw / none.yaw);
      if (judged == rules.size() || rule == judged) continue;
      position.judged.push_back(session.cells[judged][k][h].position / none.position);
      yaw.judged.push_back(session.cells[judged][k][h].yaw / none.yaw);
    }
    yaw.sessions = position.sessions;
    lines.push_back({kind, vehicle, rules[rule], kExecutions[k], kHorizons[h],
                     position.errors.size(), standingOf(position, seed), standingOf(yaw, seed)});
  };
  for (const HeldOut kind : kAllLeftOut)
    for (const std::string& vehicle : vehicles) {
      const bool tested =
          std::any_of(errors.sessions.begin(), errors.sessions.end(),
                      [&](const auto& s) { return s.kind == kind && s.vehicle == vehicle; });
      for (size_t h = 0; h < kHorizons.size() && tested; ++h)
        for (size_t rule = 0; rule < rules.size(); ++rule)
          for (size_t k = 0; k < kExecutions.size(); ++k) add(kind, vehicle, h, rule, k);
    }
  return lines;
}

}  // namespace tread::adaptation
