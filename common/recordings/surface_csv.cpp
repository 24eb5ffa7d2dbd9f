// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/recordings/surface_csv.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <system_error>

#include "common/config/scalars.hpp"

namespace tread::recordings {
namespace {

constexpr size_t kColumns = 6;
constexpr std::array<const char*, kColumns> kNames = {"pattern", "execution", "sample",
                                                      "x_m",     "y_m",       "yaw_rad"};

std::string quoted(std::string_view field) {
  std::string text(field.substr(0, 40));
  for (char& letter : text)
    if (letter < ' ' || letter > '~') letter = '?';
  return "'" + text + "'";
}

/// Reads a surface line by line; each line is looked at once and nothing of it is copied.
class SurfaceReader {
 public:
  SurfaceReader(std::string_view text, const std::string& path, const PatternSet& patterns)
      : rest_(text), path_(path), patterns_(patterns) {
    result_.executions.resize(patterns.patterns().size());
    last_number_.resize(patterns.patterns().size(), 0);
  }

  SurfaceRecordings read() {
    readHeader();
    std::string_view line;
    while (nextLine(line)) readRow(line);
    requireWhole();
    for (size_t p = 0; p < result_.executions.size(); ++p)
      if (result_.executions[p].empty())
        throw error("pattern " + quoted(patterns_.patterns()[p].name) +
                    " of patterns.yaml has no execution here; record it or take it out there");
    return std::move(result_);
  }

 private:
  RecordingError error(const std::string& problem) const {
    return RecordingError(path_ + ":" + std::to_string(line_) + ": " + problem);
  }

  /// The next line that is neither empty nor a comment.
  bool nextLine(std::string_view& line) {
    while (!rest_.empty()) {
      const size_t end = rest_.find('\n');
      line = rest_.substr(0, end);
      rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
      ++line_;
      if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
      if (!line.empty() && line.front() != '#') return true;
    }
    return false;
  }

  void readHeader() {
    std::string_view line;
    if (!nextLine(line)) {
      line_ = 1;
      throw error(std::string("empty; the first line is ") + kSurfaceHeader);
    }
    if (line != kSurfaceHeader)
      throw error("header " + quoted(line) + "; it must be " + kSurfaceHeader);
  }

  void split(std::string_view line) {
    for (size_t column = 0; column < kColumns; ++column) {
      const size_t end = line.find(',');
      if ((end == std::string_view::npos) != (column + 1 == kColumns))
        throw error("this row has " + std::string(column + 1 == kColumns ? "more" : "fewer") +
                    " than 6 columns; is the file truncated?");
      fields_[column] = line.substr(0, end);
      if (end != std::string_view::npos) line.remove_prefix(end + 1);
    }
  }

  template <typename Number>
  Number number(size_t column, const char* wanted) const {
    const std::string_view field = fields_[column];
    Number value{};
    const auto [end, failure] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (failure != std::errc() || end != field.data() + field.size())
      throw error(std::string(kNames[column]) + " is " + quoted(field) + "; " + wanted);
    return value;
  }

  double coordinate(size_t column) const {
    constexpr const char* kWanted = "a finite number is needed; take this execution out";
    const auto value = number<double>(column, kWanted);
    if (!std::isfinite(value))
      throw error(std::string(kNames[column]) + " is " + quoted(fields_[column]) + "; " + kWanted);
    return value;
  }

  void readRow(std::string_view line) {
    split(line);
    const auto execution = number<int>(1, "a whole number from 1 is needed");
    const auto sample = number<int>(2, "a whole number from 1 is needed");
    if (open_ && fields_[0] == patterns_.patterns()[pattern_].name && execution == number_)
      requireNext(sample);
    else
      begin(execution, sample);
    Execution& poses = result_.executions[pattern_].back();
    poses.push_back({coordinate(3), coordinate(4), coordinate(5)});
  }

  void requireNext(int sample) const {
    const size_t have = result_.executions[pattern_].back().size();
    const size_t wanted = patterns_.patterns()[pattern_].commands.size();
    if (have == wanted)
      throw error("sample " + std::to_string(sample) + " of " + place() + ", which has " +
                  std::to_string(wanted) + " commands; each command has one pose");
    if (sample != static_cast<int>(have) + 1)
      throw error("sample " + std::to_string(sample) + " of " + place() + " follows sample " +
                  std::to_string(have) + "; samples count up by 1");
  }

  void begin(int execution, int sample) {
    requireWhole();
    findPattern();
    int& last = last_number_[pattern_];
    number_ = execution;
    if (execution <= last)
      throw error("execution " + std::to_string(execution) + " of pattern " + quoted(fields_[0]) +
                  (last == 0 ? "" : " after execution " + std::to_string(last)) +
                  "; executions of a pattern have rising numbers from 1 and stand together");
    if (sample != 1)
      throw error(place() + " begins with sample " + std::to_string(sample) +
                  "; samples count from 1");
    last = execution;
    open_ = true;
    Execution poses;
    poses.reserve(patterns_.patterns()[pattern_].commands.size());
    result_.executions[pattern_].push_back(std::move(poses));
  }

  /// Whether the execution that was read has all of its samples.
  void requireWhole() const {
    if (!open_) return;
    const size_t have = result_.executions[pattern_].back().size();
    const size_t wanted = patterns_.patterns()[pattern_].commands.size();
    if (have != wanted)
      throw error(place() + " ends before this line with " + std::to_string(have) + " of " +
                  std::to_string(wanted) + " samples; take it out, or is the file truncated?");
  }

  void findPattern() {
    // Mostly the same pattern again, or the one after it.
    const std::vector<MotionPattern>& all = patterns_.patterns();
    std::vector<std::string> names;
    for (size_t i = 0; i < all.size(); ++i) {
      const size_t p = (pattern_ + i) % all.size();
      if (fields_[0] != all[p].name) continue;
      pattern_ = p;
      return;
    }
    for (const MotionPattern& pattern : all) names.push_back(pattern.name);
    throw error("pattern " + quoted(fields_[0]) + " is not in patterns.yaml; known are " +
                joinWords(names));
  }

  std::string place() const {
    return "execution " + std::to_string(number_) + " of pattern " +
           quoted(patterns_.patterns()[pattern_].name);
  }

  std::string_view rest_;
  const std::string& path_;
  const PatternSet& patterns_;
  SurfaceRecordings result_;
  std::array<std::string_view, kColumns> fields_;
  std::vector<int> last_number_;  // of the executions read, by pattern
  size_t line_ = 0;
  bool open_ = false;  // an execution has been begun
  size_t pattern_ = 0;
  int number_ = 0;
};

template <typename Number>
void append(std::string& text, Number value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  text.append(digits.data(), static_cast<size_t>(end - digits.data()));
}

void appendExecution(std::string& text, const std::string& pattern, size_t number,
                     const Execution& poses) {
  for (size_t i = 0; i < poses.size(); ++i) {
    text += pattern + ',';
    append(text, number);
    text += ',';
    append(text, i + 1);
    for (const double value : {poses[i].x, poses[i].y, poses[i].yaw}) {
      text += ',';
      append(text, value);
    }
    text += '\n';
  }
}

}  // namespace

SurfaceRecordings parseSurface(const std::string& text, const std::string& path,
                               const std::string& surface, const PatternSet& patterns) {
  SurfaceRecordings recordings = SurfaceReader(text, path, patterns).read();
  recordings.surface = surface;
  return recordings;
}

std::string formatSurface(const SurfaceRecordings& recordings, const PatternSet& patterns) {
  std::string text = std::string(kSurfaceHeader) + '\n';
  for (size_t p = 0; p < patterns.patterns().size(); ++p)
    for (size_t e = 0; e < recordings.executions[p].size(); ++e)
      appendExecution(text, patterns.patterns()[p].name, e + 1, recordings.executions[p][e]);
  return text;
}

}  // namespace tread::recordings
