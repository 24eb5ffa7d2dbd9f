// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/study/hide/hider.hpp"
#include "tests/study/hide/rng.hpp"

namespace tread::blind {

enum class EffectKind {
  kVehicle,
  kMeasurement,
  // Never hidden but in groups that cannot be told apart.
  kVehicleVariant,
  kMeasurementVariant,
  kOutOfCatalogue,
  kAdded,  ///< of the vehicle, by a file: in no suite
};
/// Whether forces and power are changed inside the dynamics, or the motion that comes out of them.
enum class EffectForm { kPhysical, kKinematic };
/// Whether the steady motion follows the catalogue's equation or only resembles it.
enum class EffectShape { kSame, kOther };

/// One effect that can be hidden.
struct EffectSpec {
  std::string name;
  EffectKind kind = EffectKind::kVehicle;
  EffectForm form = EffectForm::kPhysical;
  EffectShape shape = EffectShape::kSame;
  /// The hider for a size: 1 is about the smallest that can be found, 2 and 4 are usual.
  std::function<Hider(double size, double duration, Rng& rng)> make;
  std::string how;  ///< which lever is turned, in words
  /// What no drive can tell from it: each of these alone, effects and numbers of a nominal model.
  std::vector<std::string> group{};
  /// These are the same where they are all there: slip takes speed and yaw rate, a width the yaw
  /// rate, a scale the speed.
  std::vector<std::vector<std::string>> together{};
  std::vector<std::string> depends_on{};  ///< what the rest depends on, if out of catalogue
};

/// All effects: the catalogue's names, variants, those that are in no catalogue, then those of
/// files.
const std::vector<EffectSpec>& effectList();

/// An effect by name; throws std::invalid_argument naming the unknown one.
const EffectSpec& effectNamed(const std::string& name);

/// Adds the effect that a file describes, to be hidden by its formula; before any is hidden. Throws
/// where the list has one of that name.
void addEffectOfFile(const std::string& path);
EffectSpec specOfFile(const std::string& path);

/// Where a vehicle effect is: "drive" before the track, "ground" where forces resist the motion;
/// empty for what only changes the motion or what is said of it.
std::string placeOf(const EffectSpec& effect);

// The hiders by what they act on; a new one is a function and its line in one of these files.
std::vector<EffectSpec> driveEffects();
std::vector<EffectSpec> turningEffects();
std::vector<EffectSpec> bodyEffects();
std::vector<EffectSpec> instrumentEffects();
std::vector<EffectSpec> unknownEffects();  ///< in no catalogue
std::vector<EffectSpec> addedEffects();    ///< those of config/effects, by other means than theirs

}  // namespace tread::blind
