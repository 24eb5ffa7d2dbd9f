// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <optional>

#include "common/soundness/core/drive.hpp"
#include "common/vehicle/model_document.hpp"

namespace tread::gap {

/// What a vehicle that is driven is compared with its model by.
enum class Watched {
  kLeft,     ///< what the left drive gives of what is asked [1]
  kRight,    ///< the right one
  kTurning,  ///< yaw rate over what the tracks make of it [1]
  kDelay,    ///< commands act that much later [s]
};
inline constexpr size_t kWatched = 4;
using WatchedNumbers = std::array<double, kWatched>;  ///< in the order of Watched

/// How a few seconds of driving differ from a model.
struct WatchReading {
  double begin = 0.0;       ///< [s]
  double end = 0.0;         ///< [s]
  WatchedNumbers change{};  ///< less the model's; gains relative to the model's
  WatchedNumbers
      uncertainty{};  ///< standard deviations; the prior's where the driving tells nothing
};

/// Least squares over the rows that begin between two times [s] of a drive with track commands.
/** Residuals are linear in the changes, with derivatives by finite differences of the simulation;
 * rows count by Student's distribution, and a change that the driving does not show is drawn to 0:
 * before it, gains are known to .3 and the delay to .3 s. Nothing where no row lies between. A pull
 * to one side is not among them: seconds of driving cannot tell it from a weak drive. */
std::optional<WatchReading> readChanges(const Drive& drive, const ModelDocument& model, double from,
                                        double to);

}  // namespace tread::gap
