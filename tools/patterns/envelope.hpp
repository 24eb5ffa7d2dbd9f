// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "common/pattern/pattern.hpp"
#include "common/vehicle/model_document.hpp"

namespace tread::patterns {

/// Largest motions of a model that drives each pattern of a set, entered in its class's steady
/// motion.
Envelope envelopeOf(const VehicleModel& model, const PatternSet& set);

/// Warns on stderr, a line each, of what a set asks of a model that it was not made from; silent
/// where the model's file has no envelope.
/** Throws std::runtime_error if the set commands another kind than the model's. */
void warnOutside(const ModelDocument& document, const std::string& model_file,
                 const PatternSet& set);

}  // namespace tread::patterns
