// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

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
  Hider (*make)(double size, double duration, Rng& rng);
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
Hider hideSlipRatio(double size, double duration, Rng& rng);
Hider hideTrackAsymmetry(double size, double duration, Rng& rng);
Hider hideMotorDeadband(double size, double duration, Rng& rng);
Hider hideSpeedSaturation(double size, double duration, Rng& rng);
Hider hideActuatorLag(double size, double duration, Rng& rng);
Hider hideCommandDelay(double size, double duration, Rng& rng);
Hider hideSlewLimit(double size, double duration, Rng& rng);
Hider hideLagAsymmetry(double size, double duration, Rng& rng);
Hider hideBatterySag(double size, double duration, Rng& rng);
Hider hideThermalDerating(double size, double duration, Rng& rng);
Hider hideTrackBacklash(double size, double duration, Rng& rng);

Hider hideTrackWidth(double size, double duration, Rng& rng);
Hider hideYawRateSkid(double size, double duration, Rng& rng);
Hider hideTurnPowerLimit(double size, double duration, Rng& rng);
Hider hideYawBreakaway(double size, double duration, Rng& rng);
Hider hideSpeedUndersteer(double size, double duration, Rng& rng);
Hider hideYawPull(double size, double duration, Rng& rng);
Hider hideGripLimit(double size, double duration, Rng& rng);
Hider hideReverseYawGain(double size, double duration, Rng& rng);
Hider hideYawInertia(double size, double duration, Rng& rng);

Hider hidePayloadChange(double size, double duration, Rng& rng);
Hider hideTerrainChange(double size, double duration, Rng& rng);
Hider hideSlopePitch(double size, double duration, Rng& rng);
Hider hideSlopeRoll(double size, double duration, Rng& rng);
Hider hideCentrifugalDrift(double size, double duration, Rng& rng);
Hider hideRollingResistance(double size, double duration, Rng& rng);
Hider hideQuadraticDrag(double size, double duration, Rng& rng);
Hider hideTurnSpeedLoss(double size, double duration, Rng& rng);
Hider hideReverseSpeedGain(double size, double duration, Rng& rng);
Hider hideIcrOffset(double size, double duration, Rng& rng);
Hider hideBodyInertia(double size, double duration, Rng& rng);
Hider hideCrab(double size, double duration, Rng& rng);

Hider hideInsLatency(double size, double duration, Rng& rng);
Hider hideInsLatencyAll(double size, double duration, Rng& rng);
Hider hideHeadingLatency(double size, double duration, Rng& rng);
Hider hideGyroBias(double size, double duration, Rng& rng);
Hider hideHeadingMisalignment(double size, double duration, Rng& rng);
Hider hideLeverArmX(double size, double duration, Rng& rng);
Hider hideLeverArmY(double size, double duration, Rng& rng);
Hider hidePositionScale(double size, double duration, Rng& rng);

Hider hideStribeckFriction(double size, double duration, Rng& rng);
Hider hideLoadTransfer(double size, double duration, Rng& rng);
Hider hideVoltageDeadTime(double size, double duration, Rng& rng);
Hider hideSteeringHysteresis(double size, double duration, Rng& rng);

}  // namespace tread::blind
