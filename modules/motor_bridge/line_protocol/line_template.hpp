// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tread::motor {

/// Numbers in a line by name.
using LineValues = std::map<std::string, double>;

/// One line of a protocol with named numbers in it, for writing and reading.
/** Text is literal, {{ and }} are braces. A number is {NAME} or {NAME:FORM}; FORM is
 *
 *      [+][0WIDTH]d    decimal integer; + always writes a sign, 0WIDTH pads with zeros
 *      [+][0WIDTH].Nf  decimals with N digits after the point, N = 0..9
 *      [+][0WIDTH]x    hexadecimal (X: capitals), unsigned; with + two's complement of WIDTH
 *      digits
 *
 * The default FORM is d. WIDTH is 1..9 digits, for + with x 1..8. Reading is the inverse of
 * writing, except that leading zeros and signs are optional; hexadecimals of a WIDTH need exactly
 * that many digits. {_} reads any text up to the next literal; it cannot be written. */
class LineTemplate {
 public:
  LineTemplate() = default;
  /// Throws std::invalid_argument with the error.
  explicit LineTemplate(const std::string& text);

  /// The line with these values; each is clamped to the range of its form. Missing values are 0.
  std::string format(const LineValues& values) const;
  /// The values of a line; nullopt if it is a different line.
  std::optional<LineValues> match(std::string_view line) const;

  const std::string& text() const { return text_; }
  /// Names of its numbers, without "_".
  std::vector<std::string> names() const;
  bool has(const std::string& name) const;
  /// Whether a negative value of this name can be written.
  bool takesNegative(const std::string& name) const;
  /// Whether it can be written: it contains no {_}.
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
