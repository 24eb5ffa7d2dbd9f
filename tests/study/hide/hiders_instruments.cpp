// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Effects of the INS, not of the vehicle.
#include "tests/study/hide/effect_list.hpp"

namespace tread::blind {
namespace {

Hider instrument(const char* lever, const char* symbol, double value, const char* unit,
                 double symbol_sign, std::function<void(InstrumentFault&)> sense) {
  Hider hider;
  hider.sense = std::move(sense);
  hider.levers = {{lever, value, unit, false}};
  hider.equivalent = {{symbol, symbol_sign * value, unit, false}};
  return hider;
}

Hider hideInsLatency(double size, double, Rng&) {
  const double late = 0.075 * size;
  return instrument("pose_latency", "L", late, "s", 1.0,
                    [=](InstrumentFault& fault) { fault.pose_latency = late; });
}

Hider hideInsLatencyAll(double size, double, Rng&) {
  const double late = 0.075 * size;
  return instrument("latency_of_all_channels", "L", late, "s", 1.0,
                    [=](InstrumentFault& fault) { fault.all_latency = late; });
}

Hider hideHeadingLatency(double size, double, Rng&) {
  // heading(t - T_h) with position(t): v_y gains T_h v omega, a drift of -T_h.
  const double late = 0.06 * size;
  return instrument("heading_latency", "T_h", late, "s", 1.0,
                    [=](InstrumentFault& fault) { fault.heading_latency = late; });
}

Hider hideGyroBias(double size, double, Rng& rng) {
  const double bias = 0.015 * size * rng.sign();
  Hider hider = instrument("bias", "b", bias, "rad/s", 1.0, [=](InstrumentFault& fault) {
    fault.gyro_bias = bias;
    fault.gyro_warm_up = 0.3 * bias;
  });
  hider.levers.push_back({"more_when_cold", 0.3 * bias, "rad/s", false});
  return hider;
}

Hider hideHeadingMisalignment(double size, double, Rng& rng) {
  const double psi = 0.025 * size * rng.sign();
  return instrument("misalignment", "psi_0", psi, "rad", 1.0,
                    [=](InstrumentFault& fault) { fault.misalignment = psi; });
}

Hider hideLeverArmX(double size, double, Rng& rng) {
  // The field's sign, like a centre of rotation equally far ahead: v_y loses l_x omega, so the
  // antenna is behind for l_x > 0.
  const double arm = 0.05 * size * rng.sign();
  return instrument("antenna_ahead", "l_x", arm, "m", -1.0,
                    [=](InstrumentFault& fault) { fault.antenna_x = arm; });
}

Hider hideLeverArmY(double size, double, Rng& rng) {
  // The catalogue's sign: v_x grows by l_y omega, so the antenna is on the right for l_y > 0.
  const double arm = 0.05 * size * rng.sign();
  return instrument("antenna_left", "l_y", arm, "m", -1.0,
                    [=](InstrumentFault& fault) { fault.antenna_y = arm; });
}

Hider hidePositionScale(double size, double, Rng& rng) {
  const double scale = 0.025 * size * rng.sign();
  return instrument("scale", "k", scale, "1", 1.0,
                    [=](InstrumentFault& fault) { fault.position_scale = scale; });
}

}  // namespace

std::vector<EffectSpec> instrumentEffects() {
  using K = EffectKind;
  using F = EffectForm;
  using S = EffectShape;
  return {
      {"ins_latency", K::kMeasurement, F::kKinematic, S::kSame, hideInsLatency,
       "position and heading late, gyro in time"},
      {"heading_latency",
       K::kMeasurement,
       F::kKinematic,
       S::kSame,
       hideHeadingLatency,
       "heading late",
       {"centrifugal_drift"}},
      {"gyro_bias", K::kMeasurement, F::kKinematic, S::kOther, hideGyroBias,
       "bias of the rate, larger when cold"},
      {"heading_misalignment",
       K::kMeasurement,
       F::kKinematic,
       S::kSame,
       hideHeadingMisalignment,
       "heading turned by an angle",
       {"crab"}},
      {"lever_arm_x",
       K::kMeasurement,
       F::kKinematic,
       S::kSame,
       hideLeverArmX,
       "antenna ahead of the origin",
       {"icr_offset"}},
      {"lever_arm_y", K::kMeasurement, F::kKinematic, S::kSame, hideLeverArmY,
       "antenna beside the origin"},
      {"position_scale",
       K::kMeasurement,
       F::kKinematic,
       S::kSame,
       hidePositionScale,
       "all positions scaled",
       {},
       {{"slip_ratio", "track_width"}}},
      {"ins_latency_all",
       K::kMeasurementVariant,
       F::kKinematic,
       S::kSame,
       hideInsLatencyAll,
       "all that the INS says is late",
       {"ins_latency", "command_delay"}},
  };
}

}  // namespace tread::blind
