// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/vehicle/measurement.hpp"
#include "common/vehicle/model_document.hpp"

namespace tread::gap {

/// Commands one after the other, and what was commanded long before them.
struct Manoeuvre {
  std::string name;
  TrackCommand before;                 ///< held until the motion is steady
  std::vector<TrackCommand> commands;  ///< each held for kManoeuvrePeriod
};

inline constexpr double kManoeuvrePeriod = 0.05;  ///< [s]

/// What else is the case while it drives.
struct Circumstances {
  double session_time = 0.0;  ///< [s] since the session began
  double battery_drop = 0.0;  ///< [1] relative fall of the voltage
  double roll = 0.0;          ///< [rad]
  double pitch = 0.0;         ///< [rad]
  double worked = 0.0;        ///< [1] mean square of the drive's duty until now, for its heat
};

/// The largest command that a model is asked for: power 1, or a track speed: a quarter more than
/// its envelope's, so that limits at its end are met, or 1 m/s.
double fullCommand(const ModelDocument& model);

/// What is driven to see a model: straights, arcs and turns of two seconds, both ways, at speed and
/// from standing.
std::vector<Manoeuvre> standardManoeuvres(double full_command);

/// Poses and yaw rates as the INS says them, from the begin of the manoeuvre to its end, one per
/// command and one before; poses relative to the first, times from 0 on.
std::vector<MotionSample> drivenByModel(const ModelDocument& model, const Manoeuvre& manoeuvre,
                                        const Circumstances& circumstances = {},
                                        const ExecutionNoise& noise = {});

}  // namespace tread::gap
