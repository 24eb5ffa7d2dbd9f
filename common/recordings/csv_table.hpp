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

/// A table of separated values, read whole, as spreadsheets and other people's programs write it.
/** Lines end with LF, CR LF or CR; quoted fields may hold delimiters and line ends. Empty rows and
 * lines that begin with # are left out, empty fields behind the last column, too. Throws
 * RecordingError for a file that cannot be opened, is no UTF-8 text, has no rows, or has a row of
 * another length. A column is asked for by its name or by its number from 1; one that is missing
 * or of a name that is there twice throws RecordingError. */
class CsvTable {
 public:
  explicit CsvTable(const std::string& path, const CsvLayout& layout = {});
  /// The same of a text; `path` stands for it in messages.
  CsvTable(std::string text, const std::string& path, const CsvLayout& layout = {});

  size_t rows() const { return rows_.size(); }
  /// Of the file, from 1; behind the last row, that of the last one.
  size_t line(size_t row) const { return lines_[std::min(row, lines_.size() - 1)]; }
  /// Throws RecordingError that lists the columns needed if one is missing.
  void require(const std::vector<std::string>& names) const;
  const std::string& text(size_t row, std::string_view column) const;
  /// Whether a field holds no measurement: empty, nan, inf, n/a and what else programs write.
  bool missing(size_t row, std::string_view column) const;
  /// A finite number; throws RecordingError otherwise.
  double number(size_t row, std::string_view column) const;
  double numberWithin(size_t row, std::string_view column, double min, double max) const;
  /// A whole number.
  int integer(size_t row, std::string_view column) const;
  /// What the last digit of a column's numbers is worth, in the row where it is worth least; 0
  /// where not all of them are written as 1.76414E+12.
  double lastDigit(std::string_view column) const;
  /// The lines below the header that were left out as its units, in words.
  std::vector<std::string> units() const;
  /// That of a column, as "deg" also where [deg] or a sign of degrees stands there; or empty.
  std::string unit(std::string_view column) const;
  /// "file:line: problem" for a row; behind the last one, for the last line.
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
  std::map<std::string, size_t, std::less<>> columns_;  ///< kTwice for a name that is there twice
  size_t width_ = 0;
  std::vector<std::vector<std::string>> units_;
  std::vector<std::vector<std::string>> rows_;
  std::vector<size_t> lines_;  ///< of the rows, from 1
};

}  // namespace tread::recordings
