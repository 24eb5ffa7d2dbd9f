// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <string>
#include <vector>

#include "modules/identification/core/fit.hpp"

namespace tread::gap {

inline constexpr double kBin = 0.2;  ///< [s] over which motion and motor signals are averaged

/// A quantity of the left and the right track, or of both together: mean, and half the difference
/// right - left.
using Both = std::array<double, 2>;

/// A short time of a drive, as moved by the whole model.
struct MotionBin {
  size_t drive = 0;
  size_t segment = 0;
  int block = 0;
  double begin = 0.0;
  Both speed{};            ///< [m/s] over ground, of both tracks together
  Both before{}, after{};  ///< [m/s] of the neighbouring bins minus that
  Both tracks{};           ///< [m/s] of left and right track, at the drive
  std::vector<Both> lost;  ///< [m/s] taken by each effect
};

/// All bins of the drives with the speed that each of these effects takes.
std::vector<MotionBin> binsOf(const Fitter& fitter, const FitState& state,
                              const std::vector<std::string>& effects);

}  // namespace tread::gap
