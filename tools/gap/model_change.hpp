// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/vehicle/model_document.hpp"

namespace tread::gap {

/// What shall be otherwise in a model.
struct ModelChange {
  std::vector<std::string> remove;  ///< effects
  std::vector<std::string> add;     ///< effects; at their typical size unless set
  /// parameter=value: effect.parameter, a parameter of the last effect added, or a number of the
  /// nominal model; limits by their natural names, too.
  std::vector<std::string> set;
};

/// Turns an effect off.
void turnOff(ModelDocument& model, const Effect& effect);

/// Gives an effect's first strength its typical value, and its shapes theirs.
void turnOn(ModelDocument& model, const Effect& effect);

/// The model after the change; throws std::runtime_error with one line for what is not possible:
/// unknown names, values beyond what is plausible, removing what is off, adding what is on.
ModelDocument changed(const ModelDocument& model, const ModelChange& change);

}  // namespace tread::gap
