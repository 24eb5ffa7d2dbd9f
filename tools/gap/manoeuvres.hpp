// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/pattern/pattern.hpp"
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

/// What a plan chooses from: two seconds of straights, arcs and turns, each from standing to
/// standing, so that any may follow any; commands up to `full`.
std::vector<Manoeuvre> planManoeuvres(const ModelDocument& model, double full);

/// Scales down what would take a model's vehicle out of an envelope, less a hundredth for rounding.
void keepWithin(const Envelope& envelope, const VehicleModel& vehicle,
                std::vector<Manoeuvre>& manoeuvres);

/// The patterns of a set, each entered in its class. Throws std::runtime_error if its commands are
/// not the model's or its period is not kManoeuvrePeriod.
std::vector<Manoeuvre> manoeuvresOf(const PatternSet& set, const ModelDocument& model);

/// The chosen manoeuvres as a pattern set that `tread-patterns record` drives, each of its patterns
/// once: a manoeuvre that is wanted twice is there twice.
/** From a set, patterns keep their classes; those that lead there from standing and back go along.
 * Predictions are the model's. Throws std::runtime_error with one line if that is no set. */
PatternSet planSet(const ModelDocument& model, const std::vector<Manoeuvre>& manoeuvres,
                   const std::vector<size_t>& counts);
PatternSet planSet(const PatternSet& from, const std::vector<size_t>& counts);

}  // namespace tread::gap
