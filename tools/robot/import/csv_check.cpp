// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/import/csv_check.hpp"

#include <algorithm>
#include <cmath>

#include "common/config/scalars.hpp"

namespace tread::import {
namespace {

using recordings::CsvTable;

void requireUnit(const CsvTable& table, const std::string& column,
                 const std::vector<std::string>& others) {
  const std::string unit = table.unit(column);
  if (std::find(others.begin(), others.end(), unit) != others.end())
    throw table.headerError("column " + column + " is in " + unit +
                            " in the row below the header, but not in the mapping; correct the "
                            "unit of the column there");
}

[[noreturn]] void throwRounded(const CsvTable& table, const std::string& column, double to,
                               const std::string& unit) {
  throw table.error(0, "column " + column + " is " + table.text(0, column) +
                           ": in all rows a spreadsheet or program has rounded it, to " +
                           formatNumber(to) + " " + unit +
                           "; export it as numbers with all their digits");
}

void requireFineTimes(const CsvTable& table, const CsvSource& source) {
  const double digit = source.time_unit * table.lastDigit(source.time);
  const size_t last = table.rows() - 1;
  if (digit == 0.0 || last == 0) return;
  const double span = table.number(last, source.time) - table.number(0, source.time);
  if (digit > source.time_unit * span / static_cast<double>(last))
    throwRounded(table, source.time, digit, "s");
}

}  // namespace

void checkTable(const CsvTable& table, const CsvSource& source) {
  if (!source.time.empty()) {
    requireUnit(table, source.time, source.other_time_units);
    requireFineTimes(table, source);
  }
  for (const auto& [quantity, column] : source.columns) {
    requireUnit(table, column.column, column.other_units);
    if (quantity != "x" && quantity != "y") continue;
    const double digit = std::abs(column.factor) * table.lastDigit(column.column);
    if (digit > 1.0) throwRounded(table, column.column, digit, "m");
  }
}

}  // namespace tread::import
