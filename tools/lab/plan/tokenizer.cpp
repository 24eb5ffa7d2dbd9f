// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/plan/tokenizer.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "common/config/foreign_text.hpp"
#include "common/config/scalars.hpp"

namespace tread::plan {
namespace {

bool isBlank(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\v' || c == '\f';
}

/// A word for a message: one short line, whatever bytes it contains.
std::string quoted(std::string_view word) {
  constexpr size_t kLongest = 40;
  return formatText(std::string(word.substr(0, kLongest))) + (word.size() > kLongest ? "..." : "");
}

}  // namespace

Tokenizer::Tokenizer(std::string text, std::string name, char comment)
    : text_(std::move(text)), name_(std::move(name)), comment_(comment) {
  if (const std::string problem = takeByteOrderMark(text_); !problem.empty())
    throw ConfigError(name_ + ": " + problem);
}

void Tokenizer::skipBlanks() {
  while (at_ < text_.size()) {
    if (comment_ != '\0' && text_[at_] == comment_) {
      at_ = std::min(text_.find('\n', at_), text_.size());
      continue;
    }
    if (!isBlank(text_[at_])) return;
    if (text_[at_] == '\n') ++line_;
    ++at_;
  }
}

bool Tokenizer::atEnd() {
  skipBlanks();
  return at_ == text_.size();
}

std::string_view Tokenizer::peek() {
  skipBlanks();
  size_t end = at_;
  while (end < text_.size() && !isBlank(text_[end]) && (comment_ == '\0' || text_[end] != comment_))
    ++end;
  return std::string_view(text_).substr(at_, end - at_);
}

std::string_view Tokenizer::next(const std::string& what) {
  const std::string_view word = peek();
  if (word.empty()) throw error("the file ends where " + what + " should be");
  word_line_ = line_;
  at_ += word.size();
  return word;
}

void Tokenizer::expect(const std::string& word) {
  const std::string_view found = next(word);
  if (found != word) throw error(quoted(found) + " stands where " + word + " should be");
}

int64_t Tokenizer::integer(const std::string& what, int64_t min, int64_t max) {
  const std::string_view word = next(what);
  const bool whole = word.find_first_not_of("+-0123456789") == std::string_view::npos;
  const auto value = whole ? parseForeignNumber(word) : std::nullopt;
  if (!value || *value < static_cast<double>(min) || *value > static_cast<double>(max))
    throw error(what + " is " + quoted(word) + "; a whole number " + std::to_string(min) + ".." +
                std::to_string(max) + " is needed");
  return static_cast<int64_t>(*value);
}

double Tokenizer::number(const std::string& what, Range range, const std::string& unit) {
  const std::string_view word = next(what);
  const auto value = parseForeignNumber(word);
  if (!value || !(*value >= range.min && *value <= range.max))
    throw error(what + " is " + quoted(word) + "; a number " + formatNumber(range.min) + ".." +
                formatNumber(range.max) + " " + unit + " is needed");
  return *value;
}

Pose2 Tokenizer::pose(const std::string& what, double farthest, double most_turn) {
  const double x = number(what + "'s x", {-farthest, farthest}, "m");
  const double y = number(what + "'s y", {-farthest, farthest}, "m");
  return {x, y, number(what + "'s heading", {-most_turn, most_turn}, "rad")};
}

std::string_view Tokenizer::rest() {
  const std::string_view all = std::string_view(text_).substr(at_);
  at_ = text_.size();
  return all;
}

ConfigError Tokenizer::error(const std::string& problem) const {
  return ConfigError(name_ + ":" + std::to_string(word_line_) + ": " +
                     (part_.empty() ? "" : part_ + ": ") + problem);
}

std::string readWhole(const std::string& path) {
  constexpr std::streamsize kLargest = 256 << 20;  // enough for text maps of 8000 x 8000 cells
  std::error_code none;
  if (std::filesystem::is_directory(path, none))
    throw ConfigError(path + ": is a folder, not a file");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw ConfigError(path + ": cannot be read (" + std::strerror(errno) + "); check the path");
  std::string text;
  std::string piece(1 << 20, '\0');
  do {
    file.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    text.append(piece, 0, static_cast<size_t>(file.gcount()));
    if (static_cast<std::streamsize>(text.size()) > kLargest)
      throw ConfigError(path + ": is larger than 256 MB, too large for a map or pattern set");
  } while (file);
  return text;
}

}  // namespace tread::plan
