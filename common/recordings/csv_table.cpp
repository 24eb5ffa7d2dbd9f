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

std::string trimmed(const std::string& field) {
  const size_t begin = field.find_first_not_of(" \t");
  if (begin == std::string::npos) return {};
  return field.substr(begin, field.find_last_not_of(" \t") + 1 - begin);
}

/// Fields of one line; quotes, and spaces around, are removed.
std::vector<std::string> fieldsOf(const std::string& line, char delimiter) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (const char letter : line) {
    if (letter == '"') {
      quoted = !quoted;
    } else if (letter == delimiter && !quoted) {
      if (delimiter != ' ' || !fields.back().empty()) fields.emplace_back();
    } else if (letter != '\r') {
      fields.back() += letter;
    }
  }
  if (delimiter == ' ' && fields.size() > 1 && fields.back().empty()) fields.pop_back();
  for (std::string& field : fields) field = trimmed(field);
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

CsvTable::CsvTable(const std::string& path, const CsvLayout& layout) : path_(path) {
  std::ifstream file(path);
  read(file, layout);
}

CsvTable::CsvTable(const std::string& text, const std::string& path) : path_(path) {
  std::istringstream file(text);
  read(file, {});
}

void CsvTable::readHeader(const std::vector<std::string>& names) {
  for (size_t i = 0; i < names.size(); ++i) {
    const auto [place, added] = columns_.emplace(names[i], i);
    if (!added) place->second = kTwice;
  }
}

void CsvTable::read(std::istream& file, const CsvLayout& layout) {
  size_t number = 0;
  std::string line;
  if (!file || !nextLine(file, line, number))
    throw RecordingError(path_ + ": cannot be read or is empty; give a CSV file" +
                         (layout.header ? " with a header line" : ""));
  constexpr const char* kByteOrderMark = "\xEF\xBB\xBF";
  if (line.compare(0, 3, kByteOrderMark) == 0) line.erase(0, 3);
  std::vector<std::string> fields = fieldsOf(line, layout.delimiter);
  width_ = fields.size();
  if (layout.header) readHeader(fields);
  for (bool more = !layout.header || nextLine(file, line, number); more;
       more = nextLine(file, line, number)) {
    rows_.push_back(fieldsOf(line, layout.delimiter));
    lines_.push_back(number);
    if (rows_.back().size() == width_) continue;
    throw error(rows_.size() - 1, std::to_string(rows_.back().size()) + " columns, the " +
                                      (layout.header ? "header" : "first line") + " has " +
                                      std::to_string(width_) + "; is the file truncated?");
  }
  if (rows_.empty())
    throw RecordingError(path_ + ":1: no rows after the header; is the file truncated?");
}

void CsvTable::require(const std::vector<std::string>& names) const {
  for (const std::string& name : names)
    if (columns_.count(name) == 0)
      throw RecordingError(path_ + ":1: no column " + name + "; needed are " + joinWords(names));
}

std::string CsvTable::columnNames() const {
  if (columns_.empty()) return std::to_string(width_);
  std::vector<std::string> names;
  for (const auto& [name, index] : columns_) names.push_back(name);
  return joinWords(names);
}

size_t CsvTable::indexOf(std::string_view column) const {
  const auto found = columns_.find(column);
  if (found != columns_.end() && found->second != kTwice) return found->second;
  const std::string name(column);
  if (found != columns_.end())
    throw RecordingError(path_ + ":1: column " + name + " is there twice; give its number");
  const auto number = parseInteger(name);
  if (number && *number >= 1 && *number <= static_cast<int64_t>(width_))
    return static_cast<size_t>(*number) - 1;
  throw RecordingError(path_ + ":1: no column " + name + "; there are " + columnNames());
}

const std::string& CsvTable::text(size_t row, std::string_view column) const {
  return rows_[row][indexOf(column)];
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
  return RecordingError(path_ + ":" + std::to_string(line(row)) + ": " + problem);
}

}  // namespace tread::recordings
