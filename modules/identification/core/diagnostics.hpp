// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <iomanip>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "modules/identification/core/drive.hpp"

namespace tread::gap {

/// Notes about one log, in the order in which they were made.
class Diagnostics {
 public:
  explicit Diagnostics(std::string log) : log_(std::move(log)) {}

  /// Nothing can be concluded from the log.
  void fatal(const std::string& what) { notes_.push_back({log_, what, true}); }
  void note(const std::string& what) { notes_.push_back({log_, what, false}); }
  std::vector<LogNote> notes() { return std::move(notes_); }

 private:
  std::string log_;
  std::vector<LogNote> notes_;
};

/// A number with so many digits behind the point.
inline std::string fixed(double value, int decimals) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(decimals) << value;
  return text.str();
}

/// The same without "-0.0".
inline std::string digits(double value, int decimals = 1) {
  const std::string text = fixed(value, decimals);
  const bool zero = text.find_first_not_of("-0.") == std::string::npos;
  return zero && text[0] == '-' ? text.substr(1) : text;
}

}  // namespace tread::gap
