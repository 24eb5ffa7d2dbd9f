// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/recordings/csv_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "common/config/scalars.hpp"

namespace tread::recordings {
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

/// A field as a message shows it: not too long, and printable.
std::string shown(const std::string& field) {
  std::string text = field.substr(0, 40);
  for (char& letter : text)
    if (letter < ' ' || letter > '~') letter = '?';
  return "'" + text + "'";
}

/// The next line that is neither empty nor a comment; counts all lines.
bool nextLine(std::istream& file, std::string& line, size_t& number) {
  while (std::getline(file, line)) {
    ++number;
    if (!line.empty() && line != "\r" && line.front() != '#') return true;
  }
  return false;
}

}  // namespace

CsvTable::CsvTable(const std::string& path) : path_(path) {
  std::ifstream file(path);
  read(file);
}

CsvTable::CsvTable(const std::string& text, const std::string& path) : path_(path) {
  std::istringstream file(text);
  read(file);
}

void CsvTable::read(std::istream& file) {
  size_t number = 0;
  std::string line;
  if (!file || !nextLine(file, line, number))
    throw RecordingError(path_ +
                         ": cannot be read or is empty; give a CSV file with a header line");
  for (const std::string& name : fieldsOf(line)) columns_.emplace(name, columns_.size());
  while (nextLine(file, line, number)) {
    rows_.push_back(fieldsOf(line));
    lines_.push_back(number);
    if (rows_.back().size() == columns_.size()) continue;
    throw error(rows_.size() - 1, std::to_string(rows_.back().size()) +
                                      " columns, the header has " +
                                      std::to_string(columns_.size()) + "; is the file truncated?");
  }
  if (rows_.empty())
    throw RecordingError(path_ + ":1: no rows after the header; is the file truncated?");
}

void CsvTable::require(const std::vector<std::string>& names) const {
  for (const std::string& name : names)
    if (columns_.count(name) == 0)
      throw RecordingError(path_ + ":1: no column " + name + "; needed are " + joinWords(names));
}

const std::string& CsvTable::text(size_t row, std::string_view column) const {
  const auto found = columns_.find(column);
  if (found == columns_.end())
    throw RecordingError(path_ + ":1: no column " + std::string(column) +
                         "; is this another --format?");
  return rows_[row][found->second];
}

double CsvTable::number(size_t row, std::string_view column) const {
  const std::string& field = text(row, column);
  char* end = nullptr;
  const double value = std::strtod(field.c_str(), &end);
  if (end == field.c_str() || *end != '\0' || !std::isfinite(value))
    throw error(row, "column " + std::string(column) + " is " + shown(field) +
                         "; a finite number is needed");
  return value;
}

double CsvTable::numberWithin(size_t row, std::string_view column, double min, double max) const {
  const double value = number(row, column);
  if (value < min || value > max)
    throw error(row, "column " + std::string(column) + " is " + text(row, column) +
                         "; allowed is " + std::to_string(min) + " to " + std::to_string(max));
  return value;
}

int CsvTable::integer(size_t row, std::string_view column) const {
  const double value = number(row, column);
  if (value != std::floor(value) || std::abs(value) > 1e9)
    throw error(row, "column " + std::string(column) + " is " + shown(text(row, column)) +
                         "; a whole number is needed");
  return static_cast<int>(value);
}

RecordingError CsvTable::error(size_t row, const std::string& problem) const {
  const size_t line = lines_[std::min(row, lines_.size() - 1)];
  return RecordingError(path_ + ":" + std::to_string(line) + ": " + problem);
}

}  // namespace tread::recordings
