// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace tread::importer {

/// A file cannot be imported: what() is one line "file:line: what is wrong; what to do".
class ImportError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A table of comma-separated values with a header line, read whole. Quoted fields may hold commas.
/** Throws ImportError for a file that cannot be opened, has no rows, or has a row of another length
 * (truncated). */
class CsvTable {
 public:
  explicit CsvTable(const std::string& path);

  size_t rows() const { return rows_.size(); }
  /// Position of a column; throws ImportError if it is missing.
  size_t column(const std::string& name) const;
  const std::string& text(size_t row, size_t column) const { return rows_[row][column]; }
  /// A finite number; throws ImportError otherwise.
  double number(size_t row, size_t column) const;
  /// A whole number.
  int integer(size_t row, size_t column) const;
  /// "file:line: problem" for a row.
  ImportError error(size_t row, const std::string& problem) const;

 private:
  std::string path_;
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace tread::importer
