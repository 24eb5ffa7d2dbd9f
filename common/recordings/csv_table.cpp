// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/recordings/csv_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>

namespace tread::importer {
namespace {

/// Fields of one line; quotes are removed.
std::vector<std::string> fieldsOf(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (const char letter : line) {
    if (letter == '"') {
      quoted = !quoted;
    } else if (letter == ',' && !quoted) {
      fields.emplace_back();
    } else if (letter != '\r') {
      fields.back() += letter;
    }
  }
  return fields;
}

}  // namespace

CsvTable::CsvTable(const std::string& path) : path_(path) {
  std::ifstream file(path);
  std::string line;
  if (!file || !std::getline(file, line))
    throw ImportError(path + ": cannot be read or is empty; give a CSV file with a header line");
  header_ = fieldsOf(line);
  while (std::getline(file, line)) {
    rows_.push_back(fieldsOf(line));
    if (rows_.back().size() == header_.size()) continue;
    throw error(rows_.size() - 1, std::to_string(rows_.back().size()) +
                                      " columns, the header has " + std::to_string(header_.size()) +
                                      "; is the file truncated?");
  }
  if (rows_.empty())
    throw ImportError(path + ":1: no rows after the header; is the file truncated?");
}

size_t CsvTable::column(const std::string& name) const {
  const auto found = std::find(header_.begin(), header_.end(), name);
  if (found == header_.end())
    throw ImportError(path_ + ":1: no column " + name + "; is this another --format?");
  return static_cast<size_t>(found - header_.begin());
}

double CsvTable::number(size_t row, size_t column) const {
  const std::string& field = rows_[row][column];
  char* end = nullptr;
  const double value = std::strtod(field.c_str(), &end);
  if (end == field.c_str() || *end != '\0' || !std::isfinite(value))
    throw error(row,
                "column " + header_[column] + " is '" + field + "'; a finite number is needed");
  return value;
}

int CsvTable::integer(size_t row, size_t column) const {
  const double value = number(row, column);
  if (value != std::floor(value) || std::abs(value) > 1e9)
    throw error(row, "column " + header_[column] + " is '" + rows_[row][column] +
                         "'; a whole number is needed");
  return static_cast<int>(value);
}

ImportError CsvTable::error(size_t row, const std::string& problem) const {
  return ImportError(path_ + ":" + std::to_string(row + 2) + ": " + problem);
}

}  // namespace tread::importer
