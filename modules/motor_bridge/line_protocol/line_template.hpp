// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tread::motor {

/// Numbers in a line by their names.
using LineValues = std::map<std::string, double>;

/// One line of a protocol with named numbers in it, to write and to read.
/** Text stands for itself, {{ and }} for braces. A number is {NAME} or {NAME:FORM}; FORM is
 *
 *      [+][0WIDTH]d    decimal integer; + writes a sign always, 0WIDTH fills up with zeros
 *      [+][0WIDTH].Nf  decimals with N digits behind the point, N = 0..9
 *      [+][0WIDTH]x    hexadecimal (X: capitals), unsigned; with + two's complement of WIDTH digits
 *
 * Without FORM it is d. WIDTH is 1..9 digits, for + with x 1..8. A line is read as it is written,
 * except that leading zeros and signs may be there or not; hexadecimals of a WIDTH take exactly
 * so many digits. {_} reads any text up to what follows it; it cannot be written. */
class LineTemplate {
 public:
  LineTemplate() = default;
  /// Throws std::invalid_argument with what is wrong.
  explicit LineTemplate(const std::string& text);

  /// The line with these values; each is clamped to what its form can hold. What is missing is 0.
  std::string format(const LineValues& values) const;
  /// The values of a line; nothing if it is another line.
  std::optional<LineValues> match(std::string_view line) const;

  const std::string& text() const { return text_; }
  /// Names of its numbers, without "_".
  std::vector<std::string> names() const;
  bool has(const std::string& name) const;
  /// Whether a negative value of this name can be written.
  bool takesNegative(const std::string& name) const;
  /// Whether it can be written: there is no {_}.
  bool isWritable() const;

 private:
  /// Literal text, then a number unless its name is empty.
  struct Piece {
    std::string literal;
    std::string name;
    char form = 'd';
    bool sign = false;
    int width = 0;
    int digits = 0;
  };
  static Piece fieldOf(const std::string& field);
  static std::string written(const Piece& piece, double value);
  static std::optional<double> readFrom(const Piece& piece, std::string_view& rest);

  std::string text_;
  std::vector<Piece> pieces_;
};

}  // namespace tread::motor
