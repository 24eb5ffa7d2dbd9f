// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/vehicle/model_document.hpp"

namespace tread::gap {

/// What a person says of effects before a search.
struct DecisionWords {
  std::vector<std::string> accepted;
  std::vector<std::string> rejected;
  std::string by;
};

/// Decisions on effects of the catalogue, accepted ones first.
/** Throws std::runtime_error with one clear line for a name that the catalogue does not know, for
 * an effect that is accepted and rejected or named twice, for a rejected one that the model has,
 * and for a person who decides nothing. */
std::vector<Decision> decisionsOf(const DecisionWords& words, const ModelDocument& model);

}  // namespace tread::gap
