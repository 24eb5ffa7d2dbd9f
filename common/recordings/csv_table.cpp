// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/recordings/csv_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "common/config/foreign_text.hpp"
#include "common/config/scalars.hpp"
#include "common/recordings/csv_lines.hpp"

namespace tread::recordings {
namespace {

constexpr size_t kMostLinesOfUnits = 2;

/// A field as a message shows it: not too long, and printable.
std::string shown(const std::string& field) {
  std::string text = field.substr(0, 40);
  for (char& letter : text)
    if (letter < ' ' || letter > '~') letter = '?';
  return "'" + text + "'";
}

std::string textOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (file) text << file.rdbuf();
  return text.str();
}

/// The line "sep=;" at the beginning gives spreadsheets the delimiter.
void takeSeparatorLine(std::string& text, CsvLayout& layout) {
  if (text.compare(0, 4, "sep=") != 0 || text.size() < 5) return;
  if (layout.delimiter == '\0') layout.delimiter = text[4];
  text[0] = '#';
}

/// Value of the last digit of 1.76414E+12: 1e7; 0 for numbers in another format.
double lastDigitOf(const std::string& field) {
  const size_t e = field.find_first_of("eE");
  if (e == std::string::npos) return 0.0;
  const size_t sign = field.find_first_of(".,");
  const size_t decimals = sign < e ? e - sign - 1 : 0;
  const size_t from = field.find_first_not_of('+', e + 1);
  int exponent = 0;
  if (from == std::string::npos ||
      std::from_chars(&field[from], field.data() + field.size(), exponent).ec != std::errc())
    return 0.0;
  return std::pow(10.0, static_cast<double>(exponent) - static_cast<double>(decimals));
}

}  // namespace

CsvTable::CsvTable(const std::string& path, const CsvLayout& layout)
    : CsvTable(textOf(path), path, layout) {}

CsvTable::CsvTable(std::string text, const std::string& path, const CsvLayout& layout)
    : path_(path) {
  read(std::move(text), layout);
}

void CsvTable::readHeader(const std::vector<std::string>& names) {
  for (size_t i = 0; i < names.size(); ++i) {
    const auto [place, added] = columns_.emplace(names[i], i);
    if (!added) place->second = kTwice;
    if (!names[i].empty()) width_ = i + 1;
  }
}

void CsvTable::read(std::string text, CsvLayout layout) {
  if (const std::string problem = takeByteOrderMark(text); !problem.empty())
    throw RecordingError(path_ + ": " + problem);
  if (const auto zero = std::find(text.begin(), text.end(), '\0'); zero != text.end())
    throw RecordingError(
        path_ + ":" + std::to_string(1 + std::count(text.begin(), zero, '\n')) +
        ": contains NUL bytes, as after a power failure; remove them (tr -d '\\000')");
  takeSeparatorLine(text, layout);
  const CsvStart start = findStart(text, layout);
  delimiter_ = start.delimiter;
  decimal_comma_ = layout.decimal_comma;
  header_ = start.header;
  if (!start.problem.empty()) throw headerError(start.problem);
  readHeader(header_.fields);
  CsvLines lines(text, delimiter_);
  CsvLine line;
  while (lines.next(line)) {
    if (line.comment || line.number == header_.number) continue;
    if (!rows_.empty() && header_.number > 0 && line.fields == header_.fields)
      throw RecordingError(path_ + ":" + std::to_string(line.number) +
                           ": the header comes again: are these two drives, joined? Part them "
                           "here");
    if (line.number > header_.number) {
      if (!takeUnits(line, layout.columns)) addRow(line);
    } else if (line.fields.size() >= width_ && holdsNumbers(line)) {
      throw headerError("a header below rows of numbers; were two files joined? Part them here");
    }
  }
  if (rows_.empty() && header_.number == 0)
    throw RecordingError(path_ + ": cannot be read or is empty; give a CSV file" +
                         (layout.header ? " with a header line" : ""));
  if (rows_.empty()) throw headerError("no rows after the header; is the file truncated?");
  findDecimalSign();
}

void CsvTable::addRow(CsvLine& line) {
  std::vector<std::string>& fields = line.fields;
  const bool named = header_.number > 0;
  if (!named && rows_.empty()) width_ = fields.size();
  const size_t most = std::max(width_, header_.fields.size());
  while (fields.size() > most && fields.back().empty()) fields.pop_back();
  const size_t count = fields.size();
  rows_.push_back(std::move(fields));
  lines_.push_back(line.number);
  if (count >= width_ && count <= most) return;
  const std::string them = std::to_string(count) + " columns, the " +
                           (named ? "header" : "first line") + " has " + std::to_string(width_);
  if (count < width_) throw error(rows_.size() - 1, them + "; is the file truncated?");
  if (delimiter_ == ',' && count == 2 * width_)
    throw error(rows_.size() - 1, them +
                                      ": decimal commas between commas? Export it with ; or "
                                      "tabs between the columns");
  throw error(rows_.size() - 1, them + "; is a name missing, or does a text hold the separator '" +
                                    delimiter_ + "' without quotes around it?");
}

/// Below the header, before the first row: words in the columns that should have numbers.
bool CsvTable::takeUnits(const CsvLine& line, const std::vector<std::string>& names) {
  if (!rows_.empty() || units_.size() == kMostLinesOfUnits) return false;
  bool words = false;
  for (const std::string& name : names) {
    const auto column = columns_.find(name);
    if (column == columns_.end() || column->second >= line.fields.size()) continue;
    const std::string& field = line.fields[column->second];
    if (field.empty() || field == "1" || field == "-") continue;  // a number has no unit
    if (isNumeric(field) || isNoMeasurement(field)) return false;
    words = true;
  }
  if (words) units_.push_back(line.fields);
  return words;
}

std::vector<std::string> CsvTable::units() const {
  std::vector<std::string> lines;
  for (const auto& fields : units_) lines.push_back(joinWords(fields));
  return lines;
}

std::string CsvTable::unit(std::string_view column) const {
  const size_t index = indexOf(column);
  if (units_.empty() || index >= units_.back().size()) return {};
  std::string unit = units_.back()[index];
  for (const char bracket : {'[', ']', '(', ')'})
    unit.erase(std::remove(unit.begin(), unit.end(), bracket), unit.end());
  if (unit == "\xC2\xB0") return "deg";
  return unit == "%" ? "percent" : unit;
}

/// A comma is decimal where it cannot separate thousands, and no number has a point.
void CsvTable::findDecimalSign() {
  const auto any = [&](char letter, DecimalSign sign) {
    for (const auto& row : rows_)
      for (const std::string& field : row)
        if (field.find(letter) != std::string::npos && decimalSign(field) == sign) return true;
    return false;
  };
  if (any(',', DecimalSign::kComma) && !any('.', DecimalSign::kPoint)) decimal_comma_ = true;
}

void CsvTable::require(const std::vector<std::string>& names) const {
  for (const std::string& name : names)
    if (columns_.count(name) == 0)
      throw headerError("no column " + name + "; needed are " + joinWords(names));
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
    throw headerError("column " + name + " is there twice; give its number");
  const auto number = parseInteger(name);
  if (number && *number >= 1 && *number <= static_cast<int64_t>(width_))
    return static_cast<size_t>(*number) - 1;
  throw headerError("no column " + name + "; there are " + columnNames());
}

const std::string& CsvTable::text(size_t row, std::string_view column) const {
  return rows_[row][indexOf(column)];
}

bool CsvTable::missing(size_t row, std::string_view column) const {
  return isNoMeasurement(text(row, column));
}

std::optional<double> CsvTable::parsed(const std::string& field) const {
  if (!decimal_comma_) return parseForeignNumber(field);
  if (field.find('.') != std::string::npos) return std::nullopt;
  std::string with_point = field;
  std::replace(with_point.begin(), with_point.end(), ',', '.');
  return parseForeignNumber(with_point);
}

double CsvTable::number(size_t row, std::string_view column) const {
  const std::string& field = text(row, column);
  if (const auto value = parsed(field)) return *value;
  throw error(row, "column " + std::string(column) + " is " + shown(field) +
                       numberProblem(field, decimal_comma_));
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

double CsvTable::lastDigit(std::string_view column) const {
  double least = std::numeric_limits<double>::infinity();
  for (size_t row = 0; row < rows(); ++row)
    if (!missing(row, column)) least = std::min(least, lastDigitOf(text(row, column)));
  return std::isfinite(least) ? least : 0.0;
}

RecordingError CsvTable::error(size_t row, const std::string& problem) const {
  return RecordingError(path_ + ":" + std::to_string(line(row)) + ": " + problem);
}

RecordingError CsvTable::headerError(const std::string& problem) const {
  return RecordingError(path_ + ":" + std::to_string(std::max<size_t>(1, header_.number)) + ": " +
                        problem);
}

}  // namespace tread::recordings
