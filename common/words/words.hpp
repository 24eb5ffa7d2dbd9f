// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <sstream>
#include <string>
#include <vector>

// Numbers and values in sentences.
namespace tread {

/// A number with this many decimals.
inline std::string fixed(double value, int decimals) {
  std::ostringstream text;
  text.setf(std::ios::fixed, std::ios::floatfield);
  text.precision(decimals);
  text << value;
  return text.str();
}

/// The same without "-0.0".
inline std::string digits(double value, int decimals = 1) {
  const std::string text = fixed(value, decimals);
  const bool zero = text.find_first_not_of("-0.") == std::string::npos;
  return zero && text[0] == '-' ? text.substr(1) : text;
}

/// A sentence with each "{}" replaced by the next of `values`.
inline std::string filledIn(std::string sentence, const std::vector<std::string>& values) {
  size_t at = 0;
  for (const std::string& value : values) {
    at = sentence.find("{}", at);
    if (at == std::string::npos) break;
    sentence.replace(at, 2, value);
    at += value.size();
  }
  return sentence;
}

}  // namespace tread
