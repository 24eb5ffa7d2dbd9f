// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "common/config/config_reader.hpp"
#include "common/geometry/se2.hpp"

namespace tread::plan {

/// The words of a text one after the other, for the formats of others that are no YAML.
/** A byte order mark is passed over; UTF-16 throws. What is missing, no number or out of its range
 * throws ConfigError with "name:line: what". */
class Tokenizer {
 public:
  /// `name` stands for the file in messages; from `comment` on to the end of its line nothing
  /// counts.
  Tokenizer(std::string text, std::string name, char comment = '\0');

  /// Whether nothing but blanks and comments is left.
  bool atEnd();
  /// The next word without taking it; empty at the end. It lives as long as this does.
  std::string_view peek();
  /// `what` it should be is told where the text ends before it.
  std::string_view next(const std::string& what);
  /// Takes exactly this word.
  void expect(const std::string& word);
  int64_t integer(const std::string& what, int64_t min, int64_t max);
  double number(const std::string& what, Range range, const std::string& unit);
  /// x, y [m] and heading [rad] of `what`, no greater than these.
  Pose2 pose(const std::string& what, double farthest, double most_turn);

  /// Characters that were not taken yet.
  size_t left() const { return text_.size() - at_; }
  /// All of them; no word can be taken after that.
  std::string_view rest();
  /// Of the word that was taken last, from 1.
  int line() const { return word_line_; }
  /// An error at the line of the word that was taken last.
  ConfigError error(const std::string& problem) const;
  /// Words that errors begin with from here on, for instance "primitive 3"; empty = none.
  void inside(const std::string& part) { part_ = part; }

 private:
  void skipBlanks();

  std::string text_;
  std::string name_;
  std::string part_;
  char comment_;
  size_t at_ = 0;
  int line_ = 1;       // of at_
  int word_line_ = 1;  // of the word that was taken last
};

/// A file's text; throws ConfigError with one line for a folder, what cannot be read, and what is
/// larger than any file of this kind.
std::string readWhole(const std::string& path);

}  // namespace tread::plan
