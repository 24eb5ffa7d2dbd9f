// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tread::blindtest {

/// What may be known of a case before it is opened, and how it is hidden.
struct HiddenCase {
  std::string name;
  std::string nominal;  ///< which nominal model is the robot's: low, mid, high, recording-NAME
  std::vector<std::string> arguments;  ///< of tread-hide, for a case of its own; empty: of a suite
};

/// Twelve cases that are hidden one by one: what must be right whenever the tests run.
std::vector<HiddenCase> quickSuite(double minutes, uint64_t seed);

/// The model that calibration begins with: a vehicle of the generator's size, all effects off.
extern const char* const kBaseModel;

}  // namespace tread::blindtest
