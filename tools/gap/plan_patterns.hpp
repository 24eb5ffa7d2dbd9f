// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "common/pattern/pattern.hpp"
#include "common/vehicle/model_document.hpp"
#include "tools/gap/manoeuvres.hpp"

namespace tread::gap {

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
