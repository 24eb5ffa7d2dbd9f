// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/pattern/pattern.hpp"
#include "common/vehicle/kernel.hpp"
#include "common/vehicle/model.hpp"

namespace tread {

/// Covariance of the last pose of a series of commands from the model's execution spread.
/** First order: J diag(spread^2) J^T with J by central differences over one standard deviation.
 * Ground that is not the model's is not in it. */
PoseCovariance endCovariance(const VehicleModel& model, const std::vector<TrackCommand>& commands,
                             double period, const EntryState& entry);

/// The motion class that a steady command keeps up, with the model's twist.
MotionClass classOf(const VehicleModel& model, const std::string& name, const TrackCommand& steady);

/// Fills trajectory and end covariance of a pattern that was never driven, entered in a steady
/// motion.
void predict(const VehicleModel& model, double period, const MotionClass& entry,
             MotionPattern& pattern);

}  // namespace tread
