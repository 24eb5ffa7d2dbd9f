// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "tests/study/hide/dice.hpp"
#include "tests/study/hide/hider.hpp"

namespace tread::blind {

enum class EffectKind {
  kVehicle,
  kMeasurement,
  // Never hidden but in groups that cannot be told apart.
  kVehicleVariant,
  kMeasurementVariant,
  kOutOfCatalogue,
};
/// Whether forces and power are changed inside the dynamics, or the motion that comes out of them.
enum class EffectForm { kPhysical, kKinematic };
/// Whether the steady motion follows the catalogue's equation or only resembles it.
enum class EffectShape { kSame, kOther };

/// One effect that can be hidden.
struct EffectSpec {
  const char* name;
  EffectKind kind;
  EffectForm form;
  EffectShape shape;
  const char* how;  ///< which lever is turned, in words
  /// The hider for a size: 1 is about the smallest that can be found, 2 and 4 are usual.
  Hider (*make)(double size, double duration, Dice& dice);
  std::vector<std::string> group;  ///< each of these alone is the same for any drive
  /// These are the same where they are all there.
  std::vector<std::vector<std::string>> together;
  std::vector<std::string> depends_on;  ///< what the rest depends on, if out of catalogue
};

/// All effects: the catalogue's names, variants, then those that are in no catalogue.
const std::vector<EffectSpec>& effectList();

/// An effect by name; throws std::invalid_argument naming the unknown one.
const EffectSpec& effectNamed(const std::string& name);

// The hiders by what they act on.
Hider hideSlipRatio(double size, double duration, Dice& dice);
Hider hideTrackAsymmetry(double size, double duration, Dice& dice);
Hider hideMotorDeadband(double size, double duration, Dice& dice);
Hider hideSpeedSaturation(double size, double duration, Dice& dice);
Hider hideActuatorLag(double size, double duration, Dice& dice);
Hider hideCommandDelay(double size, double duration, Dice& dice);
Hider hideSlewLimit(double size, double duration, Dice& dice);
Hider hideLagAsymmetry(double size, double duration, Dice& dice);
Hider hideBatterySag(double size, double duration, Dice& dice);
Hider hideThermalDerating(double size, double duration, Dice& dice);
Hider hideTrackBacklash(double size, double duration, Dice& dice);

Hider hideTrackWidth(double size, double duration, Dice& dice);
Hider hideYawRateSkid(double size, double duration, Dice& dice);
Hider hideTurnPowerLimit(double size, double duration, Dice& dice);
Hider hideYawBreakaway(double size, double duration, Dice& dice);
Hider hideSpeedUndersteer(double size, double duration, Dice& dice);
Hider hideYawPull(double size, double duration, Dice& dice);
Hider hideGripLimit(double size, double duration, Dice& dice);
Hider hideReverseYawGain(double size, double duration, Dice& dice);
Hider hideYawInertia(double size, double duration, Dice& dice);

Hider hidePayloadChange(double size, double duration, Dice& dice);
Hider hideTerrainChange(double size, double duration, Dice& dice);
Hider hideSlopePitch(double size, double duration, Dice& dice);
Hider hideSlopeRoll(double size, double duration, Dice& dice);
Hider hideCentrifugalDrift(double size, double duration, Dice& dice);
Hider hideRollingResistance(double size, double duration, Dice& dice);
Hider hideQuadraticDrag(double size, double duration, Dice& dice);
Hider hideTurnSpeedLoss(double size, double duration, Dice& dice);
Hider hideReverseSpeedGain(double size, double duration, Dice& dice);
Hider hideIcrOffset(double size, double duration, Dice& dice);
Hider hideBodyInertia(double size, double duration, Dice& dice);
Hider hideCrab(double size, double duration, Dice& dice);

Hider hideInsLatency(double size, double duration, Dice& dice);
Hider hideInsLatencyAll(double size, double duration, Dice& dice);
Hider hideHeadingLatency(double size, double duration, Dice& dice);
Hider hideGyroBias(double size, double duration, Dice& dice);
Hider hideHeadingMisalignment(double size, double duration, Dice& dice);
Hider hideLeverArmX(double size, double duration, Dice& dice);
Hider hideLeverArmY(double size, double duration, Dice& dice);
Hider hidePositionScale(double size, double duration, Dice& dice);

Hider hideStribeckFriction(double size, double duration, Dice& dice);
Hider hideLoadTransfer(double size, double duration, Dice& dice);
Hider hideVoltageDeadTime(double size, double duration, Dice& dice);
Hider hideSteeringHysteresis(double size, double duration, Dice& dice);

}  // namespace tread::blind
