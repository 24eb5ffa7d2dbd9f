// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/recordings/csv_lines.hpp"

#include <algorithm>
#include <optional>
#include <regex>

#include "common/config/foreign_text.hpp"

namespace tread::recordings {
namespace {

/// A header is among the first lines.
constexpr size_t kMostLinesAbove = 1000;
constexpr size_t kLinesCompared = 20;
/// A longer quoted text means that the quote is never closed.
constexpr size_t kLongestQuoted = 2000;

bool isLineEnd(char letter) {
  return letter == '\n' || letter == '\r';
}

bool isBlank(char letter) {
  return letter == ' ' || letter == '\t';
}

size_t countWithoutEnd(const std::vector<std::string>& fields) {
  size_t count = fields.size();
  while (count > 0 && fields[count - 1].empty()) --count;
  return count;
}

/// The names of a header without its leading #.
CsvLine named(CsvLine line, char delimiter) {
  std::string& first = line.fields.front();
  first.erase(0, first.find_first_not_of("#% \t"));
  if (first.empty() && delimiter == ' ') line.fields.erase(line.fields.begin());
  return line;
}

std::optional<CsvLine> headerWith(std::string_view text, char delimiter,
                                  const std::vector<std::string>& names) {
  CsvLines lines(text, delimiter);
  CsvLine line;
  for (size_t count = 0; count < kMostLinesAbove && lines.next(line); ++count) {
    const CsvLine header = named(line, delimiter);
    const auto holds = [&](const std::string& name) {
      return std::count(header.fields.begin(), header.fields.end(), name) > 0;
    };
    if (std::all_of(names.begin(), names.end(), holds)) return header;
  }
  return std::nullopt;
}

/// How many of the first lines a delimiter splits into as many fields as the first one.
size_t agreement(std::string_view text, char delimiter) {
  CsvLines lines(text, delimiter);
  CsvLine line;
  std::vector<size_t> counts;
  while (counts.size() < kLinesCompared && lines.next(line))
    if (!line.comment) counts.push_back(countWithoutEnd(line.fields));
  if (counts.empty() || counts.front() < 2) return 0;
  return static_cast<size_t>(std::count(counts.begin(), counts.end(), counts.front()));
}

/// In case of a tie the first of this list.
char likelyDelimiter(std::string_view text) {
  char likely = ',';
  size_t best = 0;
  for (const char delimiter : {'\t', ';', '|', ',', ' '}) {
    const size_t lines = agreement(text, delimiter);
    if (lines > best) likely = delimiter;
    best = std::max(best, lines);
  }
  return likely;
}

/// The first line that is no comment or, before numbers, the comment with as many fields.
void findHeader(std::string_view text, CsvStart& start) {
  CsvLines lines(text, start.delimiter);
  CsvLine line;
  CsvLine above;
  bool some = lines.next(line);
  for (; some && line.comment; some = lines.next(line)) above = named(line, start.delimiter);
  if (!some) return;
  start.header = line;
  if (!holdsNumbers(line)) return;
  if (above.fields.size() == line.fields.size() && !holdsNumbers(above))
    start.header = above;
  else
    start.problem =
        "there are numbers where the names of the columns should be; without names, set header: "
        "false in the mapping";
}

}  // namespace

bool CsvLines::isDelimiter(char letter) const {
  return letter == delimiter_ || (delimiter_ == ' ' && letter == '\t');
}

bool CsvLines::next(CsvLine& line) {
  while (at_ < text_.size()) {
    line = {{}, number_, false};
    for (bool more = true; more;) more = readField(line);
    passLineEnd();
    if (countWithoutEnd(line.fields) > 0) return true;
  }
  return false;
}

void CsvLines::passLineEnd() {
  if (at_ == text_.size()) return;
  if (text_.substr(at_, 2) == "\r\n") ++at_;
  ++at_;
  ++number_;
}

void CsvLines::passBlanks() {
  while (at_ < text_.size() && isBlank(text_[at_]) &&
         (delimiter_ == ' ' || !isDelimiter(text_[at_])))
    ++at_;
}

/// False if the field is the last one of its line.
bool CsvLines::readField(CsvLine& line) {
  passBlanks();
  const bool some = at_ < text_.size();
  if (line.fields.empty()) line.comment = some && text_[at_] == '#';
  std::string& field = line.fields.emplace_back();
  if (some && text_[at_] == '"' && !line.comment) readQuoted(field);
  while (at_ < text_.size() && !isLineEnd(text_[at_]) && !isDelimiter(text_[at_]))
    field += text_[at_++];
  while (!field.empty() && isBlank(field.back())) field.pop_back();
  if (delimiter_ == ' ') passBlanks();
  if (at_ == text_.size() || isLineEnd(text_[at_])) return false;
  if (delimiter_ != ' ') ++at_;
  return true;
}

/// Up to the closing quote; an unclosed quote is an ordinary character.
void CsvLines::readQuoted(std::string& field) {
  const size_t end = std::min(text_.size(), at_ + kLongestQuoted);
  std::string read;
  size_t lines = 0;
  for (size_t at = at_ + 1; at < end; ++at) {
    if (text_[at] == '"' && (at + 1 == text_.size() || text_[at + 1] != '"')) {
      field = read;
      number_ += lines;
      at_ = at + 1;
      return;
    }
    if (text_[at] == '"') ++at;
    if (text_.substr(at, 2) == "\r\n") continue;
    if (isLineEnd(text_[at])) ++lines;
    read += isLineEnd(text_[at]) ? ' ' : text_[at];
  }
}

CsvStart findStart(std::string_view text, const CsvLayout& layout) {
  CsvStart start;
  const char given = layout.delimiter;
  for (const char delimiter : {given != '\0' ? given : '\t', '\t', ';', '|', ',', ' '}) {
    if (!layout.header || layout.columns.empty()) break;
    const auto header = headerWith(text, delimiter, layout.columns);
    if (!header) continue;
    start = {delimiter, *header, {}};
    if (given != '\0' && given != delimiter)
      start.problem = std::string("the columns are separated by '") + delimiter + "', not by '" +
                      given + "'; change the delimiter in the mapping or leave it out";
    return start;
  }
  start.delimiter = given != '\0' ? given : likelyDelimiter(text);
  if (layout.header) findHeader(text, start);
  return start;
}

bool isNumeric(std::string field) {
  std::replace(field.begin(), field.end(), ',', '.');
  return parseForeignNumber(field).has_value();
}

bool holdsNumbers(const CsvLine& line) {
  const auto good = [](const std::string& field) { return field.empty() || isNumeric(field); };
  return std::all_of(line.fields.begin(), line.fields.end(), good);
}

bool isNoMeasurement(std::string field) {
  static const std::regex kWords(
      R"([+-]?(nan|inf|infinity|1\.#(qnan|snan|ind|inf)0*)(\(.*\))?|#?n/?a!?|null|none|-)",
      std::regex::icase | std::regex::optimize);
  // A regex match is the slowest step, and a number cannot match.
  if (field.empty()) return true;
  return field.size() < 20 && !isNumeric(field) && std::regex_match(field, kWords);
}

DecimalSign decimalSign(const std::string& field) {
  const size_t sign = field.find_first_of(".,");
  if (sign == std::string::npos || !isNumeric(field)) return DecimalSign::kNone;
  if (field[sign] == '.') return DecimalSign::kPoint;
  const size_t first = field.find_first_of("0123456789");
  const size_t before = first < sign ? sign - first : 0;
  const bool thousands = before >= 1 && before <= 3 && field[first] != '0' &&
                         field.size() - sign - 1 == 3 &&
                         field.find_first_of("eE") == std::string::npos;
  return thousands ? DecimalSign::kCommaOrThousands : DecimalSign::kComma;
}

std::string numberProblem(const std::string& field, bool decimal_comma) {
  static const std::regex kThousands(
      R"([+-]?[0-9]{1,3}(([.,' ]|\xC2\xA0|\xE2\x80[\x89\xAF])[0-9]{3})+([.,][0-9]*)?)");
  const DecimalSign sign = decimalSign(field);
  if (decimal_comma && sign == DecimalSign::kPoint)
    return "; the others have a decimal comma: is the point one of thousands? Write none";
  if (sign == DecimalSign::kComma || sign == DecimalSign::kCommaOrThousands)
    return "; a decimal comma needs decimal_comma: true in the mapping (tread-import "
           "--decimal-comma), a comma of thousands must not be written";
  if (field.size() < 40 && std::regex_match(field, kThousands))
    return "; numbers must be written without separators of thousands";
  if (field.find(':') != std::string::npos)
    return "; a finite number is needed, a time of day in seconds";
  return "; a finite number is needed";
}

}  // namespace tread::recordings
