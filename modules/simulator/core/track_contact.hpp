// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>

#include "common/geometry/se2.hpp"
#include "modules/simulator/core/terrain.hpp"

namespace tread::sim {

/// Pieces of a track's contact patch, front to rear.
inline constexpr int kTrackSegments = 5;

/// Where the track touches the ground: axes of the body, origin midway between the two patches.
struct TrackGeometry {
  double length = 0.0;   ///< of the contact patch [m]
  double lateral = 0.0;  ///< y of the track's middle [m]

  /// x of the middle of a segment, from the middle of the patch [m].
  double segmentX(int i) const { return length * (0.5 - (i + 0.5) / kTrackSegments); }
};

/// The weight on one track.
struct ContactLoad {
  double force = 0.0;   ///< normal force [N]
  double offset = 0.0;  ///< of its centre ahead of the middle, beside that of the surface [m]
};

/// Force and yaw moment of the ground on one track.
struct TrackForce {
  double along = 0.0;   ///< shear along the track, forward positive [N]
  double across = 0.0;  ///< shear across it, to the left positive [N]
  double resistance =
      0.0;              ///< of rolling, grows with speed, acts on the body, forward positive [N]
  double moment = 0.0;  ///< of the three about the middle of the patches [N m]
  double dry_friction = 0.0;  ///< rolling resistance that does not depend on speed, >= 0 [N]
};

/// The contact patch of one track: shear displacement of the ground below each segment.
/** The ground below a segment is sheared by the slip velocity and is carried backwards by the belt,
   so that undisturbed ground enters at the leading edge (Janosi and Hanamoto's shear displacement
   as a state). Shear force = friction x load x u / sqrt(1 + |u|^2), u = displacement over the
   displacement of saturation. A standing belt keeps its displacement: the track then holds like a
   spring and does not creep. */
class TrackContact {
 public:
  using Surfaces = std::array<const SurfaceParameters*, kTrackSegments>;

  /// Advances by dt [s] under the twist of the middle, the belt speed [m/s] and the load on the
  /// track.
  TrackForce step(const TrackGeometry& geometry, const Surfaces& surfaces, const Twist2& v_middle,
                  double belt_speed, const ContactLoad& load, double dt);

 private:
  void shear(const TrackGeometry& geometry, const Surfaces& surfaces, const Twist2& v_middle,
             double belt_speed, double dt);
  void carry(std::array<double, kTrackSegments>& displacement, double share, bool forward);

  std::array<double, kTrackSegments> along_{};        ///< [m]
  std::array<double, kTrackSegments> across_{};       ///< [m]
  std::array<double, kTrackSegments> slip_along_{};   ///< [m/s]
  std::array<double, kTrackSegments> slip_across_{};  ///< [m/s]
};

}  // namespace tread::sim
