// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "common/recordings/csv_lines.hpp"

namespace tread::recordings {

/// Recordings cannot be read or used: what() is one line "file:line: what is wrong; what to do".
class RecordingError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A table of separated values, read whole, as written by spreadsheets and third-party programs.
/** Lines end with LF, CR LF or CR; quoted fields may contain delimiters and line ends. Empty rows,
 * lines that begin with # and empty fields after the last column are ignored. Throws
 * RecordingError for a file that cannot be opened, is no UTF-8 text, has no rows, or has a row of
 * another length. A column is addressed by its name or by its number from 1; a missing column or
 * an ambiguous name throws RecordingError. */
class CsvTable {
 public:
  explicit CsvTable(const std::string& path, const CsvLayout& layout = {});
  /// The same of a text; `path` stands for it in messages.
  CsvTable(std::string text, const std::string& path, const CsvLayout& layout = {});

  size_t rows() const { return rows_.size(); }
  /// Line in the file, from 1; for a row beyond the end, that of the last row.
  size_t line(size_t row) const { return lines_[std::min(row, lines_.size() - 1)]; }
  /// Throws RecordingError that lists the columns needed if one is missing.
  void require(const std::vector<std::string>& names) const;
  const std::string& text(size_t row, std::string_view column) const;
  /// Whether a field means "not measured": empty, nan, inf, n/a and similar.
  bool missing(size_t row, std::string_view column) const;
  /// A finite number; throws RecordingError otherwise.
  double number(size_t row, std::string_view column) const;
  double numberWithin(size_t row, std::string_view column, double min, double max) const;
  /// A whole number.
  int integer(size_t row, std::string_view column) const;
  /// Resolution of a column: the largest value of a last digit in it; 0 unless all numbers are
  /// written like 1.76414E+12.
  double lastDigit(std::string_view column) const;
  /// The lines below the header that were skipped as units, in words.
  std::vector<std::string> units() const;
  /// The unit of a column, "deg" also for [deg] or a degree sign; may be empty.
  std::string unit(std::string_view column) const;
  /// "file:line: problem" for a row; beyond the end, for the last line.
  RecordingError error(size_t row, const std::string& problem) const;
  /// The same for the line of the header.
  RecordingError headerError(const std::string& problem) const;

 private:
  static constexpr size_t kTwice = static_cast<size_t>(-1);

  void read(std::string text, CsvLayout layout);
  void readHeader(const std::vector<std::string>& names);
  void addRow(CsvLine& line);
  bool takeUnits(const CsvLine& line, const std::vector<std::string>& names);
  void findDecimalSign();
  std::optional<double> parsed(const std::string& field) const;
  std::string columnNames() const;
  size_t indexOf(std::string_view column) const;

  std::string path_;
  char delimiter_ = ',';
  bool decimal_comma_ = false;
  CsvLine header_;
  std::map<std::string, size_t, std::less<>> columns_;  ///< kTwice for a duplicate name
  size_t width_ = 0;
  std::vector<std::vector<std::string>> units_;
  std::vector<std::vector<std::string>> rows_;
  std::vector<size_t> lines_;  ///< of the rows, from 1
};

}  // namespace tread::recordings
