// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <optional>

#include "common/soundness/core/drive.hpp"
#include "common/vehicle/model_document.hpp"

namespace tread::gap {

/// Quantities by which a driving vehicle is compared with its model.
enum class Watched {
  kLeft,     ///< ratio of the left drive's output to its command [1]
  kRight,    ///< the right one
  kTurning,  ///< ratio of the yaw rate to that of the tracks [1]
  kDelay,    ///< additional delay of commands [s]
};
inline constexpr size_t kWatched = 4;
using WatchedNumbers = std::array<double, kWatched>;  ///< in the order of Watched

/// Difference of a few seconds of driving from a model.
struct WatchReading {
  double begin = 0.0;       ///< [s]
  double end = 0.0;         ///< [s]
  WatchedNumbers change{};  ///< minus the model's; gains relative to the model's
  /// Standard deviations; the prior's if the driving is uninformative
  WatchedNumbers uncertainty{};
};

/// Least squares over the rows that begin between two times [s] of a drive with track commands.
/** Residuals are linear in the changes, with derivatives by finite differences of the simulation;
 * rows are weighted by Student's distribution, and a change that the driving does not excite is
 * drawn to 0 by the prior: .3 for gains and .3 s for the delay. nullopt if no row lies between the
 * times. A pull to one side is not included: within seconds it cannot be distinguished from a weak
 * drive. */
std::optional<WatchReading> readChanges(const Drive& drive, const ModelDocument& model, double from,
                                        double to);

}  // namespace tread::gap
