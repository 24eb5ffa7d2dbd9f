// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/rules/ground_scales.hpp"

namespace tread::learner {
namespace {

/// A possible width of the difference between grounds, and its prior probability.
struct Width {
  double deviation;
  double weight;
};
using Widths = std::vector<Width>;

const Widths kGain{{0.03, 0.4}, {0.1, 0.3}, {0.3, 0.2}, {0.6, 0.08}, {1.5, 0.02}};
/// Effect of turns on the velocity, in addition to the gain: a vehicle that drives straight as
/// before may slide in turns.
const Widths kTurns{{0.0, 0.4}, {0.1, 0.4}, {0.3, 0.2}};
const Widths kYawGain{{0.05, 0.3}, {0.15, 0.4}, {0.35, 0.2}, {0.8, 0.1}};
const Widths kYawBias{{0.003, 0.8}, {0.03, 0.15}, {0.1, 0.05}};  // [1] of both sides together
const Widths kResidual{{0.01, 0.5}, {0.04, 0.3}, {0.1, 0.15}, {0.25, 0.05}};
/// Velocities of executions may scatter more than expected: otherwise a single one would identify
/// any ground. Turn rates are measured accurately enough.
const Widths kVelocityNoise{{1.0, 0.88}, {3.2, 0.12}};
/// Residual change of patterns as a share of the change of the gain [1].
constexpr double kResidualOfGain = 0.12;
/// Ground that changes the gains a lot also delays the response: on ice a start takes a second
/// longer, and the twist of the entry persists. Growth of the lags' deviation per unit of gain [1].
constexpr double kLateByGain = 5.0;

/// Variances of the lag and of the persistence of an entry, relative to those of new ground: a set
/// is normally of the same vehicle.
constexpr double kShippedLag = 0.1;

const Widths kShippedGain{{0.02, 1.0}};
const Widths kShippedTurns{{0.0, 1.0}};
const Widths kShippedBias{{0.003, 1.0}};
const Widths kShippedResidual{{0.01, 0.7}, {0.05, 0.3}};

double residual(const Width& gain, const Width& own) {
  return squared(kResidualOfGain * gain.deviation) + squared(own.deviation);
}

/// Variance of the lag and of an entry's persistence, relative to that on ground as shipped.
double late(const Width& gain) {
  return 1.0 + squared(kLateByGain * gain.deviation);
}

VelocityBank::Scales velocityScales(const Widths& gains, const Widths& turns,
                                    const Widths& residuals, double lag, double share) {
  VelocityBank::Scales scales;
  for (const Width& gain : gains)
    for (const Width& turn : turns)
      for (const Width& own : residuals)
        for (const Width& noise : kVelocityNoise)
          scales.push_back({{share * squared(gain.deviation),
                             share * (squared(gain.deviation) + squared(turn.deviation)),
                             share * residual(gain, own), lag * late(gain), lag * late(gain)},
                            squared(noise.deviation),
                            gain.weight * turn.weight * own.weight * noise.weight});
  return scales;
}

YawBank::Scales yawScales(const Widths& gains, const Widths& biases, const Widths& residuals,
                          double lever, double lag, double share) {
  YawBank::Scales scales;
  for (const Width& gain : gains)
    for (const Width& bias : biases)
      for (const Width& own : residuals)
        scales.push_back({{share * squared(gain.deviation), share * squared(bias.deviation / lever),
                           share * residual(gain, own), lag * late(gain), lag * late(gain)},
                          1.0,
                          gain.weight * bias.weight * own.weight});
  return scales;
}

}  // namespace

VelocityBank::Scales velocityScalesOfNewGround(double share) {
  return velocityScales(kGain, kTurns, kResidual, 1.0, share);
}

YawBank::Scales yawScalesOfNewGround(double lever, double share) {
  return yawScales(kYawGain, kYawBias, kResidual, lever, 1.0, share);
}

VelocityBank::Scales velocityScalesAsShipped() {
  return velocityScales(kShippedGain, kShippedTurns, kShippedResidual, kShippedLag, 1.0);
}

YawBank::Scales yawScalesAsShipped(double lever) {
  return yawScales(kShippedGain, kShippedBias, kShippedResidual, lever, kShippedLag, 1.0);
}

}  // namespace tread::learner
