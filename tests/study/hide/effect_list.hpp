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
  // Hidden only within groups of indistinguishable effects.
  kVehicleVariant,
  kMeasurementVariant,
  kOutOfCatalogue,
  kAdded,  ///< of the vehicle, from a file: in no suite
};
/// Whether the effect acts on forces and power inside the dynamics, or on the resulting motion.
enum class EffectForm { kPhysical, kKinematic };
/// Whether the steady motion follows the catalogue's equation or only resembles it.
enum class EffectShape { kSame, kOther };

/// An effect that can be hidden.
struct EffectSpec {
  std::string name;
  EffectKind kind = EffectKind::kVehicle;
  EffectForm form = EffectForm::kPhysical;
  EffectShape shape = EffectShape::kSame;
  /// The hider for a size: 1 is about the smallest detectable, 2 and 4 are usual.
  std::function<Hider(double size, double duration, Rng& rng)> make;
  std::string how;  ///< what is modified, in words
  /// Effects and nominal numbers that no drive can distinguish from it, each alone.
  std::vector<std::string> group{};
  /// Combinations that are equivalent to it: slip changes speed and yaw rate, a width the yaw rate,
  /// a scale the speed.
  std::vector<std::vector<std::string>> together{};
  /// variables of the residual, for effects outside of the catalogue
  std::vector<std::string> depends_on{};
};

/// All effects: the catalogue's names, variants, effects in no catalogue, then those of files.
const std::vector<EffectSpec>& effectList();

/// An effect by name; throws std::invalid_argument naming the unknown one.
const EffectSpec& effectNamed(const std::string& name);

/// Adds the effect of a file, which is hidden by its formula; call before hiding any. Throws if the
/// list has the name already.
void addEffectOfFile(const std::string& path);
EffectSpec specOfFile(const std::string& path);

/// Place of a vehicle effect: "drive" before the track, "ground" for forces that resist the motion;
/// empty for those that only change the motion or its measurement.
std::string placeOf(const EffectSpec& effect);

// The hiders by what they act on; a new one is a function and a line in one of these files.
std::vector<EffectSpec> driveEffects();
std::vector<EffectSpec> turningEffects();
std::vector<EffectSpec> bodyEffects();
std::vector<EffectSpec> instrumentEffects();
std::vector<EffectSpec> unknownEffects();  ///< in no catalogue
std::vector<EffectSpec> addedEffects();    ///< those of config/effects, implemented differently

}  // namespace tread::blind
