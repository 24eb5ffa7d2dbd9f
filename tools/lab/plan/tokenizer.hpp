// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "common/config/config_reader.hpp"
#include "common/geometry/se2.hpp"

namespace tread::plan {

/// Splits a text into words, for foreign formats other than YAML.
/** A byte order mark is skipped; UTF-16 throws. Missing words, wrong numbers and values out of
 * range throw ConfigError "name:line: error". */
class Tokenizer {
 public:
  /// `name` replaces the file in messages; `comment` begins a comment up to the end of the line.
  Tokenizer(std::string text, std::string name, char comment = '\0');

  /// Whether only blanks and comments are left.
  bool atEnd();
  /// The next word without consuming it; empty at the end. It is valid as long as this object.
  std::string_view peek();
  /// `what` is expected; it is named in the error if the text ends.
  std::string_view next(const std::string& what);
  /// Consumes exactly this word.
  void expect(const std::string& word);
  int64_t integer(const std::string& what, int64_t min, int64_t max);
  double number(const std::string& what, Range range, const std::string& unit);
  /// x, y [m] and heading [rad] of `what`, limited to these magnitudes.
  Pose2 pose(const std::string& what, double farthest, double most_turn);

  /// Unread characters.
  size_t left() const { return text_.size() - at_; }
  /// All unread characters; ends the reading of words.
  std::string_view rest();
  /// Line of the last word, from 1.
  int line() const { return word_line_; }
  /// An error at the line of the last word.
  ConfigError error(const std::string& problem) const;
  /// Prefix of errors from here on, for instance "primitive 3"; empty = none.
  void inside(const std::string& part) { part_ = part; }

 private:
  void skipBlanks();

  std::string text_;
  std::string name_;
  std::string part_;
  char comment_;
  size_t at_ = 0;
  int line_ = 1;       // line of at_
  int word_line_ = 1;  // line of the last word
};

/// A file's text; throws ConfigError with one line for a folder, what cannot be read, and what is
/// larger than any file of this kind.
std::string readWhole(const std::string& path);

}  // namespace tread::plan
