// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/note_book.hpp"

#include <cstdio>

namespace tread::gap {

std::string digits(double value, int behind) {
  char text[400];
  std::snprintf(text, sizeof text, "%.*f", behind, value);
  // No "-0.0".
  const std::string result = text;
  const bool zero = result.find_first_not_of("-0.") == std::string::npos;
  return zero && result[0] == '-' ? result.substr(1) : result;
}

}  // namespace tread::gap
