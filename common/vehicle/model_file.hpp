// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "common/vehicle/model.hpp"

namespace tread {

/// Reads a model file (YAML that people read and edit; see config/models).
/** Throws ConfigError with one line "file:line: what is wrong; what is allowed" for bad YAML,
 * unknown keys or effects and values out of their ranges. What the file does not name has the value
 * of the nominal model (effects: off). */
VehicleModel readModelFile(const std::string& path);

/// The same from text; `name` stands for the file in messages.
VehicleModel parseModel(const std::string& text, const std::string& name);

/// Text of a model file; parseModel() of it gives the same model, bit for bit. Effects that are off
/// are left out.
std::string formatModel(const VehicleModel& model);

}  // namespace tread
