// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <array>
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

double largest(const std::vector<double>& values) {
  return values.empty() ? median(values) : *std::max_element(values.begin(), values.end());
}

/// What is told of a rule; position and orientation of each in turn.
struct Figures {
  std::array<double, 2> sequences;        ///< [%] median reduction against single
  std::array<double, 2> sequences_worst;  ///< [%] more than off in the worst transition
  std::array<double, 2> all_after_10;     ///< the same over all patterns
  std::array<double, 2> all_after_3_worst;
  std::array<double, 2> unchanged;  ///< [1] of the omniscient error, median over surfaces
  std::array<double, 2> unchanged_worst;
};

Figures figuresOf(const Tables& tables, const std::string& rule) {
  Figures figures{};
  for (size_t i = 0; i < 2; ++i) {
    const std::string quantity = i == 0 ? kPosition : kOrientation;
    const auto less = [&](const std::vector<Row>& rows, int k) {
      return 100.0 * (1.0 - median(ratios(rows, quantity, rule, "single", k)));
    };
    const auto more = [&](const std::vector<Row>& rows, int k) {
      return 100.0 * (largest(ratios(rows, quantity, rule, "off", k)) - 1.0);
    };
    figures.sequences[i] = less(tables.errors, 0);
    figures.sequences_worst[i] = more(tables.errors, 0);
    figures.all_after_10[i] = less(tables.all_patterns, 10);
    figures.all_after_3_worst[i] = more(tables.all_patterns, 3);
    std::vector<double> costs;
    for (const Row& row : tables.unchanged)
      if (row.quantity == quantity && row.rule == rule) costs.push_back(row.estimate.value);
    figures.unchanged[i] = median(costs);
    figures.unchanged_worst[i] = largest(costs);
  }
  return figures;
}

/// Deviation of each figure from book to book.
Figures spreadOf(const std::vector<Tables>& books, const std::string& rule) {
  std::vector<Figures> all;
  for (const Tables& book : books) all.push_back(figuresOf(book, rule));
  const auto deviation = [&](std::array<double, 2> Figures::*figure, size_t i) {
    double mean = 0.0, squares = 0.0;
    for (const Figures& one : all) mean += (one.*figure)[i] / static_cast<double>(all.size());
    for (const Figures& one : all) squares += std::pow((one.*figure)[i] - mean, 2);
    return std::sqrt(squares / static_cast<double>(all.size() - 1));
  };
  Figures spread{};
  for (const auto figure :
       {&Figures::sequences, &Figures::sequences_worst, &Figures::all_after_10,
        &Figures::all_after_3_worst, &Figures::unchanged, &Figures::unchanged_worst})
    for (size_t i = 0; i < 2; ++i) (spread.*figure)[i] = deviation(figure, i);
  return spread;
}

std::string formatted(const char* format, double value) {
  if (!std::isfinite(value)) return "-";
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string rowOf(const std::string& name, const Figures& figures, bool with_sign) {
  const char* more = with_sign ? "%+.1f" : "%.1f";
  const auto pair = [](const std::array<double, 2>& both, const char* format) {
    return formatted(format, both[0]) + " / " + formatted(format, both[1]);
  };
  char line[200];
  std::snprintf(
      line, sizeof line, "%-13s %15s %15s %15s %15s %16s %16s\n", name.c_str(),
      pair(figures.sequences, "%.1f").c_str(), pair(figures.sequences_worst, more).c_str(),
      pair(figures.all_after_10, "%.1f").c_str(), pair(figures.all_after_3_worst, more).c_str(),
      pair(figures.unchanged, "%.3f").c_str(), pair(figures.unchanged_worst, "%.3f").c_str());
  return line;
}

}  // namespace

std::string textOfKeyFigures(const Tables& tables, const Setting& setting,
                             const std::vector<Tables>& books) {
  std::string text =
      "KEY FIGURES, position / orientation. Reductions [%] against single: median over "
      "transitions. "
      "Against\noff [%]: the worst transition, + = worse than no learning. Test sequences; errors "
      "over all patterns after\n10 and after 3 executions; error in the long run on an unchanged "
      "surface over the omniscient one.\n\n";
  char head[200];
  std::snprintf(head, sizeof head, "%-13s %15s %15s %15s %15s %16s %16s\n", "rule", "sequences",
                "worst to off", "all after 10", "all 3 to off", "unchanged", "worst surface");
  text += head;
  for (const std::string& rule : setting.rules) text += rowOf(rule, figuresOf(tables, rule), true);
  if (books.size() < 2) return text;
  text += "deviation from book to book\n";
  for (const std::string& rule : setting.rules) text += rowOf(rule, spreadOf(books, rule), false);
  return text;
}

}  // namespace tread::experiment
