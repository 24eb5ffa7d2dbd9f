// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace tread::recordings {

/// Recordings cannot be read or used: what() is one line "file:line: what is wrong; what to do".
class RecordingError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// How a table is written.
struct CsvLayout {
  char delimiter = ',';  ///< between fields; of spaces, several are one
  bool header = true;    ///< the first line names the columns
};

/// A table of separated values, read whole. Quoted fields may hold delimiters. Empty lines and
/// lines that begin with # are comments.
/** Throws RecordingError for a file that cannot be opened, has no rows, or has a row of another
 * length (truncated). A column is asked for by its name or by its number from 1; one that is
 * missing or of a name that is there twice throws RecordingError. */
class CsvTable {
 public:
  explicit CsvTable(const std::string& path, const CsvLayout& layout = {});
  /// The same of a text; `path` stands for it in messages.
  CsvTable(const std::string& text, const std::string& path);

  size_t rows() const { return rows_.size(); }
  /// Of the file, from 1; behind the last row, that of the last one.
  size_t line(size_t row) const { return lines_[std::min(row, lines_.size() - 1)]; }
  /// Throws RecordingError that lists the columns needed if one is missing.
  void require(const std::vector<std::string>& names) const;
  const std::string& text(size_t row, std::string_view column) const;
  /// A finite number; throws RecordingError otherwise.
  double number(size_t row, std::string_view column) const;
  double numberWithin(size_t row, std::string_view column, double min, double max) const;
  /// A whole number.
  int integer(size_t row, std::string_view column) const;
  /// "file:line: problem" for a row; behind the last one, for the last line.
  RecordingError error(size_t row, const std::string& problem) const;

 private:
  static constexpr size_t kTwice = static_cast<size_t>(-1);

  void read(std::istream& file, const CsvLayout& layout);
  void readHeader(const std::vector<std::string>& names);
  std::string columnNames() const;
  size_t indexOf(std::string_view column) const;

  std::string path_;
  std::map<std::string, size_t, std::less<>> columns_;  ///< kTwice for a name that is there twice
  size_t width_ = 0;
  std::vector<std::vector<std::string>> rows_;
  std::vector<size_t> lines_;  ///< of the rows, from 1
};

}  // namespace tread::recordings
