// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/core/track_contact.hpp"

#include <algorithm>
#include <cmath>

namespace tread::sim {
namespace {

/// Slip velocity counts as displacement over this time: damps the spring of a standing track [s].
constexpr double kDampingTime = 0.08;
/// Belt speed from which on nothing needs damping: the ground is renewed [m/s].
constexpr double kDampingSpeed = 0.1;
/// Displacement beyond this many saturation displacements is not remembered.
constexpr double kMemory = 3.0;

/// Share of the load's offset that one metre of x_body gives to a segment [1/m^2].
double offsetGain(const TrackGeometry& geometry) {
  constexpr double kDiscrete = 1.0 - 1.0 / (kTrackSegments * kTrackSegments);
  return 12.0 / (geometry.length * geometry.length * kDiscrete);
}

}  // namespace

TrackForce TrackContact::step(const TrackGeometry& geometry, const Surfaces& surfaces,
                              const Twist2& v_middle, double belt_speed, const ContactLoad& load,
                              double dt) {
  shear(geometry, surfaces, v_middle, belt_speed, dt);
  const double speed_over_ground = v_middle.v_x - v_middle.omega * geometry.lateral;
  const double gain = offsetGain(geometry);
  const double damping = kDampingTime * std::max(0.0, 1.0 - std::abs(belt_speed) / kDampingSpeed);
  TrackForce total;
  for (size_t i = 0; i < kTrackSegments; ++i) {
    const SurfaceParameters& surface = *surfaces[i];
    const double x = geometry.segmentX(static_cast<int>(i));
    const double share = 1.0 + gain * (load.offset + surface.pressure_offset) * x;
    const double normal = load.force / kTrackSegments * std::max(0.0, share);
    const double u_x = (along_[i] + damping * slip_along_[i]) / surface.shear_displacement;
    const double u_y = (across_[i] + damping * slip_across_[i]) / surface.lateral_displacement;
    const double shear = surface.friction * normal / std::sqrt(1.0 + u_x * u_x + u_y * u_y);
    // Ground heaped up beside the track: pushed aside, not sheared, so friction does not limit it.
    const double across = -shear * u_y - normal * surface.scrub_resistance * slip_across_[i];
    total.along -= shear * u_x;
    total.across += across;
    total.resistance -= normal * surface.resistance_viscous * speed_over_ground;
    total.dry_friction += normal * surface.resistance_constant;
    total.moment += x * across;
  }
  total.moment -= geometry.lateral * (total.along + total.resistance);
  return total;
}

void TrackContact::shear(const TrackGeometry& geometry, const Surfaces& surfaces,
                         const Twist2& v_middle, double belt_speed, double dt) {
  const double slip_x = v_middle.v_x - v_middle.omega * geometry.lateral - belt_speed;
  for (size_t i = 0; i < kTrackSegments; ++i) {
    slip_along_[i] = slip_x;
    slip_across_[i] = v_middle.v_y + v_middle.omega * geometry.segmentX(static_cast<int>(i));
  }
  const double share = std::min(1.0, std::abs(belt_speed) * dt * kTrackSegments / geometry.length);
  carry(along_, share, belt_speed > 0.0);
  carry(across_, share, belt_speed > 0.0);
  for (size_t i = 0; i < kTrackSegments; ++i) {
    const double limit_x = kMemory * surfaces[i]->shear_displacement;
    const double limit_y = kMemory * surfaces[i]->lateral_displacement;
    along_[i] = std::clamp(along_[i] + slip_along_[i] * dt, -limit_x, limit_x);
    across_[i] = std::clamp(across_[i] + slip_across_[i] * dt, -limit_y, limit_y);
  }
}

void TrackContact::carry(std::array<double, kTrackSegments>& displacement, double share,
                         bool forward) {
  double upstream = 0.0;
  for (size_t k = 0; k < kTrackSegments; ++k) {
    double& here = displacement[forward ? k : kTrackSegments - 1 - k];
    const double before = here;
    here += share * (upstream - before);
    upstream = before;
  }
}

}  // namespace tread::sim
