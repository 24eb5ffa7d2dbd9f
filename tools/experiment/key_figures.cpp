// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tools/experiment/text_tables.hpp"

namespace tread::experiment {
namespace {

/// Errors of a rule over those of another one, one number for each transition.
std::vector<double> ratios(const std::vector<Row>& rows, const std::string& quantity,
                           const std::string& rule, const std::string& against, int k) {
  std::vector<double> values;
  for (const Row& row : rows) {
    if (row.quantity != quantity || row.rule != rule || row.k != k) continue;
    const Row* other = find(rows, row.from, row.to, quantity, against, "", k);
    if (other != nullptr) values.push_back(row.estimate.value / other->estimate.value);
  }
  return values;
}

/// "12.3" per cent less in the median, or "-".
std::string medianReduction(const std::vector<double>& values) {
  if (values.empty()) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", 100.0 * (1.0 - median(values)));
  return text;
}

/// "+4" per cent more in the worst transition, or "-".
std::string worst(const std::vector<double>& values) {
  if (values.empty()) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%+.1f",
                100.0 * (*std::max_element(values.begin(), values.end()) - 1.0));
  return text;
}

std::string cost(const Tables& tables, const std::string& quantity, const std::string& rule) {
  std::vector<double> values;
  for (const Row& row : tables.unchanged)
    if (row.quantity == quantity && row.rule == rule) values.push_back(row.estimate.value);
  if (values.empty()) return "-";
  char text[48];
  std::snprintf(text, sizeof text, "%.3f (%.3f)", median(values),
                *std::max_element(values.begin(), values.end()));
  return text;
}

std::string rowOf(const Tables& tables, const std::string& rule) {
  const auto both = [](const auto& cell) {
    return cell(std::string(kPosition)) + " / " + cell(std::string(kOrientation));
  };
  const std::string sequence = both([&](const std::string& quantity) {
    return medianReduction(ratios(tables.errors, quantity, rule, "single", 0));
  });
  const std::string sequence_worst = both([&](const std::string& quantity) {
    return worst(ratios(tables.errors, quantity, rule, "off", 0));
  });
  const std::string all_10 = both([&](const std::string& quantity) {
    return medianReduction(ratios(tables.all_patterns, quantity, rule, "single", 10));
  });
  const std::string all_3 = both([&](const std::string& quantity) {
    return worst(ratios(tables.all_patterns, quantity, rule, "off", 3));
  });
  const std::string unchanged =
      both([&](const std::string& quantity) { return cost(tables, quantity, rule); });
  char line[200];
  std::snprintf(line, sizeof line, "%-13s %15s %17s %15s %17s  %s\n", rule.c_str(),
                sequence.c_str(), sequence_worst.c_str(), all_10.c_str(), all_3.c_str(),
                unchanged.c_str());
  return line;
}

}  // namespace

std::string textOfKeyFigures(const Tables& tables, const Setting& setting) {
  std::string text =
      "KEY FIGURES, position / orientation. Reductions [%] against single, median over "
      "transitions; worst\n"
      "transition [%] against off (+ = worse than no learning); test sequences, then errors over "
      "all patterns\n"
      "after 10 and after 3 executions; long-run error on an unchanged surface over the omniscient "
      "one,\nmedian (worst) over surfaces.\n\n";
  char head[200];
  std::snprintf(head, sizeof head, "%-13s %15s %17s %15s %17s  %s\n", "rule", "sequences",
                "worst vs off", "all after 10", "all 3, vs off", "unchanged");
  text += head;
  for (const std::string& rule : setting.rules) text += rowOf(tables, rule);
  return text;
}

}  // namespace tread::experiment
