// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/experiment/key_figures.hpp"

#include <algorithm>
#include <cmath>

#include "common/report/text.hpp"
#include "common/statistics/statistics.hpp"

namespace tread::experiment {
namespace {

/// Ratio of the errors of two rules, one number per transition.
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

double largest(const std::vector<double>& values) {
  return values.empty() ? kNoFigure : *std::max_element(values.begin(), values.end());
}

double medianCost(const std::vector<Row>& rows, const std::string& quantity,
                  const std::string& rule, int k) {
  std::vector<double> costs;
  for (const Row& row : rows)
    if (row.quantity == quantity && row.rule == rule && row.k == k)
      costs.push_back(row.estimate.value);
  return medianOf(costs);
}

double worst(const std::vector<Row>& rows, const std::string& quantity, const std::string& rule,
             int k) {
  return 100.0 * (largest(ratios(rows, quantity, rule, "off", k)) - 1.0);
}

double reduced(const std::vector<Row>& rows, const std::string& quantity, const std::string& rule,
               int k) {
  return 100.0 * (1.0 - medianOf(ratios(rows, quantity, rule, "single", k)));
}

/// One column of the key figures: its function of a table's rows after k executions.
struct Figure {
  const char* title;
  const char* format;
  /// Computed at once over all sets of recordings, for cells that are means over them.
  bool of_means;
  std::vector<Row> Tables::*rows;
  double (*of_rows)(const std::vector<Row>& rows, const std::string& quantity,
                    const std::string& rule, int k);
  int k;

  double value(const Tables& tables, const std::string& quantity, const std::string& rule) const {
    return of_rows(tables.*rows, quantity, rule, k);
  }
};

const Figure kFigures[] = {
    {"sequences", "%.1f", false, &Tables::errors, reduced, 0},
    {"worst to off", "%+.1f", false, &Tables::errors, worst, 0},
    {"of means", "%+.1f", true, &Tables::errors, worst, 0},
    {"all after 10", "%.1f", false, &Tables::all_patterns, reduced, 10},
    {"all 3 to off", "%+.1f", false, &Tables::all_patterns, worst, 3},
    {"of means", "%+.1f", true, &Tables::all_patterns, worst, 3},
    {"unchanged", "%.3f", false, &Tables::unchanged, medianCost, 0},
    {"by sequences", "%.3f", false, &Tables::unchanged_sequences, medianCost, 0},
};

std::string shown(const char* format, double value) {
  return std::isfinite(value) ? formatted(format, value) : "-";
}

/// Mean and standard deviation over the sets of recordings.
std::string cellOf(const Figure& figure, const std::vector<Tables>& sets,
                   const std::string& quantity, const std::string& rule) {
  const auto n = static_cast<double>(sets.size());
  double mean = 0.0, squares = 0.0;
  std::vector<double> values;
  for (const Tables& set : sets) values.push_back(figure.value(set, quantity, rule));
  for (const double value : values) mean += value / n;
  for (const double value : values) squares += (value - mean) * (value - mean);
  const std::string text = shown(figure.format, mean);
  if (sets.size() < 2 || !std::isfinite(mean)) return text;
  const bool ratio = std::string(figure.format) == "%.3f";
  return text + " +-" + shown(ratio ? "%.3f" : "%.1f", std::sqrt(squares / (n - 1.0)));
}

std::string padded(const std::string& text, size_t width) {
  return text.size() < width ? std::string(width - text.size(), ' ') + text : text;
}

}  // namespace

std::string textOfKeyFigures(const Tables& tables, const Setting& setting,
                             const std::vector<Tables>& sets) {
  constexpr size_t kName = 23, kWidth = 15;
  std::string text =
      "KEY FIGURES. Reductions [%] relative to single: median over transitions, test sequences, "
      "and "
      "over all patterns\nafter 10 executions. Relative to off [%]: the worst transition, + = "
      "worse "
      "than no learning, test sequences, and over\nall patterns after 3 executions. Unchanged: "
      "error in the long run relative to the omniscient one, median over surfaces,\nrandom "
      "patterns, and "
      "test sequences.";
  if (sets.size() > 1)
    text += " Means and deviations over " + std::to_string(sets.size()) +
            " sets of recordings; of means: the worst\nof the means over the sets.";
  text += "\n";
  for (const char* quantity : kQuantities) {
    text += "\n" + std::string(quantity) +
            std::string(kName - std::min(kName, std::string(quantity).size()), ' ');
    for (const Figure& figure : kFigures)
      if (sets.size() > 1 || !figure.of_means) text += padded(figure.title, kWidth);
    text += "\n";
    for (const std::string& rule : setting.rules) {
      text += rule + std::string(kName - std::min(kName, rule.size()), ' ');
      for (const Figure& figure : kFigures)
        if (!figure.of_means)
          text += padded(cellOf(figure, sets, quantity, rule), kWidth);
        else if (sets.size() > 1)
          text += padded(shown(figure.format, figure.value(tables, quantity, rule)), kWidth);
      text += "\n";
    }
  }
  return text;
}

}  // namespace tread::experiment
