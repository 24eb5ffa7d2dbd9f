// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <stdexcept>

namespace tread::drive_patterns {

/// Drives that cannot become patterns: what() is one line: where, what is wrong, what to do.
class DriveError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace tread::drive_patterns
