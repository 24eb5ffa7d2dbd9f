// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tread::recordings {

/// How a table is written.
struct CsvLayout {
  char delimiter = '\0';       ///< between fields; of spaces, several are one; 0: as is found
  bool header = true;          ///< a line names the columns
  bool decimal_comma = false;  ///< numbers are 0,5; else only where nothing else can be meant
  /// Names that the header has. With them it may stand anywhere and behind a #, and a row of units
  /// may follow it; without them it is the first line that is no comment.
  std::vector<std::string> columns;
};

/// A line of a table, cut into its fields.
struct CsvLine {
  std::vector<std::string> fields;  ///< without quotes and blanks around
  size_t number = 0;                ///< of the file, from 1
  bool comment = false;             ///< begins with #
};

/// The lines of a table, one after the other; empty ones are left out.
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
  std::string problem;  ///< empty if the table can be read
};

CsvStart findStart(std::string_view text, const CsvLayout& layout);

/// Whether a field holds a number, be its decimal sign a point or a comma.
bool isNumeric(std::string field);

/// Whether all fields hold numbers or nothing.
bool holdsNumbers(const CsvLine& line);

/// Whether a field says that nothing was measured: empty, nan, inf, n/a and what else programs
/// write.
bool isNoMeasurement(std::string field);

/// What a field says of the decimal sign.
enum class DecimalSign { kNone, kPoint, kComma, kCommaOrThousands };
DecimalSign decimalSign(const std::string& field);

/// Why a field is no number, and what to do, for messages.
std::string numberProblem(const std::string& field, bool decimal_comma);

}  // namespace tread::recordings
