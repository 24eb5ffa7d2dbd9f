// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/lab/gap/what_if.hpp"

namespace tread::gap {

/// Largest command for a model: power 1, or a track speed of 1.25 times its envelope, to reach
/// limits at its end; 1 m/s without an envelope.
double fullCommand(const ModelDocument& model);

/// Manoeuvres that show a model: straights, arcs and turns of 2 s in both directions, at speed and
/// from standstill.
std::vector<Manoeuvre> standardManoeuvres(double full_command);

/// Candidates for a plan: straights, arcs and turns of 2 s with commands up to `full`, from
/// standstill to standstill, so that any order is possible.
std::vector<Manoeuvre> planManoeuvres(const ModelDocument& model, double full);

/// Scales commands down so that the vehicle stays in the envelope, with 1 % margin for rounding.
void keepWithin(const Envelope& envelope, const VehicleModel& vehicle,
                std::vector<Manoeuvre>& manoeuvres);

/// The patterns of a set, each entered in the motion of its class. Throws std::runtime_error if its
/// commands are not the model's or its period is not kManoeuvrePeriod.
std::vector<Manoeuvre> manoeuvresOf(const PatternSet& set, const ModelDocument& model);

/// Converts the chosen manoeuvres to a pattern set for `tread-patterns record`, which drives each
/// pattern once; a repeated manoeuvre appears repeatedly.
/** Patterns from a set keep their classes, and the patterns that connect those with standstill are
 * added. Predictions are the model's. Throws std::runtime_error with one line if the result is no
 * valid set. */
PatternSet planSet(const ModelDocument& model, const std::vector<Manoeuvre>& manoeuvres,
                   const std::vector<size_t>& counts);
PatternSet planSet(const PatternSet& from, const std::vector<size_t>& counts);

}  // namespace tread::gap
