// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "common/vehicle/kernel.hpp"
#include "common/vehicle/measurement.hpp"
#include "common/vehicle/model_document.hpp"
#include "modules/identification/core/drive.hpp"

namespace tread::gap {

/// The commands of a stretch cut into short pieces, each with what is known of its moment.
/** Made once a drive; simulating again with other parameters is then one pass over it. */
class StretchPlan {
 public:
  /// Pieces of at most `piece` seconds, of twice that where a command has held for a while; cut
  /// also at these moments, in order [s], at which poses will be asked for: within a piece they are
  /// interpolated. The stretch may go away afterwards.
  StretchPlan(const Drive& drive, const Stretch& stretch, double piece,
              const std::vector<double>& cuts = {});

  /// True poses of a model through the stretch, relative to its beginning; one entry a piece.
  /// Yaw rates are left at 0: rows take theirs from the yaws.
  std::vector<MotionSample> simulate(const VehicleModel& vehicle) const;

 private:
  struct Piece {
    double duration;  ///< [s]
    TrackCommand command;
    DriveContext context;
  };

  /// Where pieces end between two moments, the last one included.
  static std::vector<double> endsBetween(double from, double to, double longest,
                                         const std::vector<double>& cuts);

  EntryState entryFor(const VehicleModel& vehicle) const;

  double begin_ = 0.0;
  double longest_ = 1e-3;  ///< piece [s]
  std::vector<Piece> pieces_;
  std::optional<TrackCommand> entry_speeds_;
  TrackCommand command_before_;
};

}  // namespace tread::gap
