// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>

namespace tread::blindtest {

/// Where a number of the truth stands in a model file.
struct SameQuantity {
  std::string parameter;
  double factor = 1.0;  ///< from the truth's unit to the model's
  bool limit = false;   ///< the value itself; else a change against the nominal model
};

/// The model's parameter for a symbol of gap.md; nothing where there is no equivalent.
/** `duration` [s] of the log: the truth tells a battery's loss by its end. */
std::optional<SameQuantity> sameQuantity(const std::string& effect, const std::string& symbol,
                                         double duration);

}  // namespace tread::blindtest
