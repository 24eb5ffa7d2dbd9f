// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/vehicle/omni_wheels.hpp"

namespace tread {

/// The list `wheels` of a description: angle and distance of each wheel from the body origin, or
/// its position; throws ConfigError with file:line.
/** `inverted`: whether each motor is mounted in reverse; may be null. */
OmniWheels readOmniWheels(ConfigReader& reader, std::vector<bool>* inverted = nullptr);

}  // namespace tread
