// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/vehicle/effects.hpp"
#include "common/vehicle/model_document.hpp"

namespace tread {

class ConfigReader;

/// An effect described by a file, with its confounded groups.
struct EffectEntry {
  Effect effect;
  std::vector<ConfoundedGroup> groups;
};

/// Reads the file of an effect (YAML; config/effects has examples, common/vehicle/README.md the
/// keys).
/** Throws ConfigError with one line for an invalid effect: a formula that does not compile, is
 * undefined or changes something while the strengths are 0, missing ranges, a name that is taken.
 */
EffectEntry readEffectFile(const std::string& path);

/// The same from a section of another file.
EffectEntry readEffectEntry(ConfigReader& reader);

/// Reads all files of a folder (*.yaml, by name) and adds their effects to the catalogue.
/** An identical effect is not added twice; a different one of the same name is refused. Throws
 * ConfigError. */
void addEffectsOf(const std::string& folder);

/// Adds an entry to the catalogue as addEffectsOf() does; `reader` is where it was read.
void addEntry(EffectEntry entry, const ConfigReader& reader);

/// Text of an effect's file; reading it gives the same effect.
std::string formatEffect(const EffectEntry& entry);

/// The entry of an added effect of the catalogue.
EffectEntry entryOf(const Effect& effect);

}  // namespace tread
