// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <iterator>
#include <string>

namespace tread::replay {

/// Compares messages field by field and remembers the first field that differs.
class Comparison {
 public:
  /// Numbers may differ by `tolerance`; 0 = to the bit.
  explicit Comparison(double tolerance = 0.0) : tolerance_(tolerance) {}

  template <class Value>
  void field(const std::string& name, const Value& log, const Value& replay) {
    if (!found_.empty() || same(log, replay)) return;
    found_ = name + ": log " + text(log) + ", replay " + text(replay);
  }
  /// Lists of one length.
  template <class Numbers>
  void numbers(const std::string& name, const Numbers& log, const Numbers& replay) {
    for (size_t i = 0; i < std::size(log); ++i)
      field(name + "[" + std::to_string(i) + "]", log[i], replay[i]);
  }
  bool equal() const { return found_.empty(); }
  /// "field: log ..., replay ..."; empty if nothing differs.
  const std::string& found() const { return found_; }

 private:
  static std::string text(double value) {
    std::array<char, 40> digits;
    const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    return {digits.data(), result.ptr};
  }
  static std::string text(int64_t value) { return std::to_string(value); }
  static std::string text(int32_t value) { return std::to_string(value); }
  static std::string text(bool value) { return value ? "yes" : "no"; }
  static std::string text(const std::string& value) { return "'" + value + "'"; }

  /// To the bit, so that an unknown value (NaN) equals itself.
  bool same(double a, double b) const {
    return std::memcmp(&a, &b, sizeof a) == 0 || std::abs(a - b) < tolerance_;
  }
  template <class Value>
  bool same(const Value& a, const Value& b) const {
    return a == b;
  }

  double tolerance_;
  std::string found_;
};

}  // namespace tread::replay
