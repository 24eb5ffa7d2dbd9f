// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/vehicle/model_document.hpp"

namespace tread {

/// Reads a model file (YAML that people read and edit; see config/models).
/** Throws ConfigError with one line "file:line: what is wrong; what is allowed" for bad YAML,
 * unknown keys or effects and values out of range. Missing keys get the values of the nominal
 * model (effects: off). Vehicle effects are under effects:, those of the INS under measurement:. A
 * limit may be given directly or as inverse_limit, its reciprocal. */
ModelDocument readModelDocument(const std::string& path);

/// The same from text; `name` stands for the file in messages.
ModelDocument parseModelDocument(const std::string& text, const std::string& name);

/// The same, for computations with two tracks or a car; a holonomic base is refused.
ModelDocument readTrackModelDocument(const std::string& path);

/// Only the vehicle of a model file.
VehicleModel readModelFile(const std::string& path);

/// Text of a model file; parsing it gives the same document, bit for bit. Effects that are off are
/// left out.
std::string formatModelDocument(const ModelDocument& document);

/// An effect by name; throws std::runtime_error with one line that suggests a similar name.
const Effect& effectOrGuess(const std::string& name);

/// Reads the vehicle effects of a section whose keys are their names (not finished here).
void readEffects(ConfigReader& effects, EffectValues& values);

}  // namespace tread
