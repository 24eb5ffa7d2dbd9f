// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tread::recordings {

/// The format of a table.
struct CsvLayout {
  char delimiter = '\0';  ///< between fields; a run of spaces counts as one; 0: detect
  bool header = true;     ///< a line names the columns
  /// Numbers are 0,5; if false, only where they cannot be read otherwise
  bool decimal_comma = false;
  /// Names in the header. If given, the header may be anywhere and behind a #, and a row of units
  /// may follow it; otherwise the header is the first line that is no comment.
  std::vector<std::string> columns;
};

/// A line of a table, cut into its fields.
struct CsvLine {
  std::vector<std::string> fields;  ///< without quotes and surrounding blanks
  size_t number = 0;                ///< of the file, from 1
  bool comment = false;             ///< begins with #
};

/// The lines of a table in order; empty ones are left out.
class CsvLines {
 public:
  CsvLines(std::string_view text, char delimiter) : text_(text), delimiter_(delimiter) {}
  /// False at the end.
  bool next(CsvLine& line);

 private:
  bool isDelimiter(char letter) const;
  bool readField(CsvLine& line);
  void readQuoted(std::string& field);
  void passBlanks();
  void passLineEnd();

  std::string_view text_;
  char delimiter_;
  size_t at_ = 0;
  size_t number_ = 1;
};

/// How a table begins.
struct CsvStart {
  char delimiter = ',';
  CsvLine header;       ///< line 0 if there is none
  std::string problem;  ///< empty if the table is readable
};

CsvStart findStart(std::string_view text, const CsvLayout& layout);

/// Whether a field is a number, with a decimal point or comma.
bool isNumeric(std::string field);

/// Whether each field is a number or empty.
bool holdsNumbers(const CsvLine& line);

/// Whether a field means "not measured": empty, nan, inf, n/a and similar.
bool isNoMeasurement(std::string field);

/// Decimal sign that a field suggests.
enum class DecimalSign { kNone, kPoint, kComma, kCommaOrThousands };
DecimalSign decimalSign(const std::string& field);

/// Why a field is not a number, and what to do, for messages.
std::string numberProblem(const std::string& field, bool decimal_comma);

}  // namespace tread::recordings
