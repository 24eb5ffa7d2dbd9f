// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <functional>

#include "core_rig.hpp"

// Drives of vehicles with motion that no effect of the catalogue explains.
namespace tread::gap::samples {

/// Additional yaw rate [rad/s] and motion to the left [m/s]; called in the order of time, with the
/// time since the last call [s].
struct More {
  double omega = 0.0;
  double sideways = 0.0;
};
using Nameless = std::function<More(double omega, double dt)>;

/// A synthetic drive whose vehicle has the additional motion.
inline Drive namelessDrive(const Values& hidden, uint64_t seed, const Nameless& more_of) {
  Drive drive = syntheticDrive(vehicleWith(hidden), 400.0, seed);
  for (Segment& segment : drive.segments) {
    std::vector<InsSample> said = segment.ins;
    double turned = 0.0;
    for (size_t i = 1; i < said.size(); ++i) {
      Pose2 moved = between(segment.ins[i - 1].T_map_body, segment.ins[i].T_map_body);
      const double dt = said[i].time - said[i - 1].time;
      const More more = more_of(segment.ins[i].omega, dt);
      moved.y += more.sideways * dt;
      turned += more.omega * dt;
      said[i].omega += more.omega;
      Pose2 from = said[i - 1].T_map_body;
      from.yaw = segment.ins[i - 1].T_map_body.yaw + turned;
      said[i].T_map_body = from * moved;
      said[i].T_map_body.yaw = segment.ins[i].T_map_body.yaw + turned;
    }
    segment.ins = said;
  }
  return drive;
}

/// A drive whose vehicle additionally turns to the left by a share of its squared yaw rate [s], and
/// slides to the left by another [m s].
inline Drive turningDrive(const Values& hidden, double share, uint64_t seed, double slide = 0.0) {
  return namelessDrive(hidden, seed, [=](double omega, double) {
    const double square = std::pow(omega, 2);
    return More{share * square, slide * square};
  });
}

/// A drive whose body follows its tracks late while a turn builds up, and faster while it decays:
/// times [s].
inline Drive frictionDrive(double winds_up, double is_braked, uint64_t seed) {
  double body = 0.0;
  return namelessDrive({}, seed, [=](double omega, double dt) mutable {
    const bool winding = std::abs(omega) > std::abs(body) && omega * body >= 0.0;
    body += (omega - body) * (1.0 - std::exp(-dt / (winding ? winds_up : is_braked)));
    return More{body - omega, 0.0};
  });
}

}  // namespace tread::gap::samples
