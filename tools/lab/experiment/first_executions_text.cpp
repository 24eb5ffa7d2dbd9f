// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/experiment/first_executions_text.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "common/report/text.hpp"
#include "tools/lab/experiment/first_executions.hpp"
#include "tools/lab/experiment/tables.hpp"

namespace tread::experiment {
namespace {

constexpr size_t kName = 24;

std::string named(const std::string& name) {
  return name + std::string(kName - std::min(kName, name.size()), ' ');
}

std::string cell(const char* format, double value) {
  return formatted("%8s", std::isfinite(value) ? formatted(format, value).c_str() : "-");
}

/// Rows of a quantity after k executions, on changed or unchanged ground.
std::vector<const Row*> rowsOf(const std::vector<Row>& rows, bool changed, const char* quantity,
                               const std::string& method, size_t k) {
  std::vector<const Row*> found;
  for (const Row& row : rows)
    if ((row.from != row.to) == changed && row.quantity == quantity && row.rule == method &&
        row.k == static_cast<int>(k))
      found.push_back(&row);
  return found;
}

double meanOf(const std::vector<const Row*>& rows) {
  if (rows.empty()) return Estimate{}.value;
  double sum = 0.0;
  for (const Row* row : rows) sum += row->estimate.value;
  return sum / static_cast<double>(rows.size());
}

/// Errors of all methods after k executions on new ground.
struct AfterChange {
  const Tables& tables;
  const char* quantity;
  size_t k;

  std::vector<const Row*> of(const std::string& method) const {
    return rowsOf(tables.first_executions, true, quantity, method, k);
  }
  double over(const std::string& method, const char* other) const {
    return meanOf(of(method)) / meanOf(of(other));
  }
  double worst(const std::string& method) const {
    const auto own = of(method), off = of("off");
    double largest = Estimate{}.value;
    for (size_t i = 0; i < std::min(own.size(), off.size()); ++i)
      largest = std::fmax(largest, own[i]->estimate.value / off[i]->estimate.value);
    return largest;
  }
};

/// A table with a row per method and `columns` numbers.
std::string block(
    const std::string& title, const std::vector<std::string>& columns,
    const std::vector<std::string>& methods,
    const std::function<std::string(const std::string& method, size_t column)>& cellOf) {
  std::string text = "\n" + named(title);
  for (const std::string& column : columns) text += formatted("%8s", column.c_str());
  for (const std::string& method : methods) {
    text += "\n" + named(method);
    for (size_t column = 0; column < columns.size(); ++column) text += cellOf(method, column);
  }
  return text + "\n";
}

std::string textOfRegions(const Tables& tables, const Setting& setting) {
  std::vector<std::string> methods, columns;
  for (const std::string& method : setting.rules)
    if (!rowsOf(tables.regions, true, kRegion, method, 1).empty()) methods.push_back(method);
  if (methods.empty()) return "";
  for (size_t j = 1; j <= FirstExecutions::kCount; ++j) columns.push_back(std::to_string(j));
  std::string text =
      "\n90 % REGIONS: share of measured ends inside [%], before execution 1, 2, ...; mean over "
      "transitions.\n";
  for (const bool changed : {true, false})
    text += block(changed ? "new ground" : "unchanged ground", columns, methods,
                  [&](const std::string& method, size_t j) {
                    return cell("%.0f", 100.0 * meanOf(rowsOf(tables.regions, changed, kRegion,
                                                              method, j + 1)));
                  });
  return text;
}

std::vector<std::string> testedColumns() {
  std::vector<std::string> columns;
  for (const size_t k : FirstExecutions::kTested) columns.push_back("k=" + std::to_string(k));
  return columns;
}

std::string textOfErrorsAfter(const Tables& tables, const Setting& setting, const char* quantity) {
  const auto table = [&](const char* title, const char* format, auto value) {
    return block(title, testedColumns(), setting.rules,
                 [&](const std::string& method, size_t column) {
                   const AfterChange errors{tables, quantity, FirstExecutions::kTested[column]};
                   return cell(format, value(errors, method));
                 });
  };
  using Method = const std::string&;
  return "\n" + std::string(quantity) + "\n" +
         table("error", "%.3f",
               [](const AfterChange& errors, Method method) { return meanOf(errors.of(method)); }) +
         table(
             "over off", "%.3f",
             [](const AfterChange& errors, Method method) { return errors.over(method, "off"); }) +
         table("over omniscient", "%.3f",
               [](const AfterChange& errors, Method method) {
                 return errors.over(method, kOmniscient);
               }) +
         table("worst over off", "%.3f",
               [](const AfterChange& errors, Method method) { return errors.worst(method); });
}

/// Mean over surfaces and half its 99 % interval; surfaces are independent.
std::string price(const std::vector<Row>& rows, const char* quantity, const std::string& method) {
  double squares = 0.0;
  const auto found = rowsOf(rows, false, quantity, method, 0);
  for (const Row* row : found)
    squares += std::pow((row->estimate.high - row->estimate.low) / 2.0, 2);
  const double half = std::sqrt(squares) / static_cast<double>(found.size());
  return cell("%.3f", meanOf(found)) + cell("+-%.3f", half);
}

std::string textOfPrice(const Tables& tables, const Setting& setting) {
  std::string text =
      "\nUNCHANGED GROUND: error relative to the omniscient one, mean over surfaces; random "
      "patterns, all "
      "of them after k\nexecutions, and in the long run with its 99 % interval (paired).\n";
  for (const char* quantity : kQuantities) {
    std::vector<std::string> columns = testedColumns();
    columns.insert(columns.end(), {"long", ""});
    text += block(quantity, columns, setting.rules, [&](const std::string& method, size_t column) {
      if (column > FirstExecutions::kTested.size()) return std::string();
      if (column == FirstExecutions::kTested.size())
        return price(tables.unchanged, quantity, method);
      const int k = static_cast<int>(FirstExecutions::kTested[column]);
      double sum = 0.0, surfaces = 0.0;
      for (const std::string& surface : setting.surfaces) {
        const auto error = [&](const std::string& of) {
          const Row* row = find(tables.first_executions, surface, surface, quantity, of, "", k);
          return row == nullptr ? Estimate{}.value : row->estimate.value;
        };
        sum += error(method) / error(kOmniscient);
        surfaces += 1.0;
      }
      return cell("%.3f", sum / surfaces);
    });
  }
  return text;
}

}  // namespace

std::string textOfFirstExecutions(const Tables& tables, const Setting& setting) {
  std::string text =
      "FIRST EXECUTIONS of random patterns. Errors over all patterns after k of them, mean over "
      "transitions, and\nthis mean relative to no learning and to the correct set; "
      "worst over off: the transition with the\nlargest error relative to no learning.\n";
  for (const char* quantity : kQuantities) text += textOfErrorsAfter(tables, setting, quantity);
  return text + textOfPrice(tables, setting) + textOfRegions(tables, setting);
}

}  // namespace tread::experiment
