// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <string>

namespace tread::planner {

/// A number of at least 0 in words that people read, such as "3.5".
inline std::string withTenths(double value) {
  const auto tenths = std::lround(10.0 * value);
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10);
}

}  // namespace tread::planner
