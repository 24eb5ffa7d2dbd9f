// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/core/surface.hpp"

namespace tread::sim {

// Friction, constant resistance and the spreads were chosen or taken from calibration.yaml. The
// other five numbers of the first four surfaces were found by a simplex search (Nelder-Mead) per
// surface that compared straight, left and hard_left, entered at steady full power, noise off, with
// the calibration model: squared end errors in x, y and yaw, and a fifth of the largest error on
// the way. With small weight, so that what the calibration does not cover stays near its model, it
// also compared turns in place, the shipped start, stop, step and turn patterns. The vehicle's
// defaults were held fixed; after a change of those the search has to be repeated. Sand and ice are
// judgement, not measurement.
const std::vector<SurfaceParameters>& builtInSurfaces() {
  static const std::vector<SurfaceParameters> surfaces = {
      {"cinder", 0.75, 0.0165, 0.1794, 0.020, 0.2097, 1.183, -0.0292, {0.0149, 0.0373, 0.0474}},
      {"tarmac", 0.90, 0.0188, 0.1794, 0.010, 0.1674, 0.686, -0.0501, {0.0244, 0.0461, 0.0307}},
      {"grass", 0.80, 0.0085, 0.1793, 0.015, 0.0647, 0.507, 0.0837, {0.0418, 0.0831, 0.0147}},
      {"gravel", 0.85, 0.0297, 0.1789, 0.020, 0.1248, 0.984, 0.0948, {0.0440, 0.1220, 0.0251}},
      {"sand", 0.55, 0.0300, 0.1800, 0.030, 0.3000, 1.500, 0.0, {0.0300, 0.0800, 0.0300}},
      {"ice", 0.08, 0.0050, 0.0300, 0.005, 0.0300, 0.0, 0.0, {0.0500, 0.1500, 0.0600}},
  };
  return surfaces;
}

std::optional<SurfaceParameters> builtInSurface(const std::string& name) {
  for (const SurfaceParameters& surface : builtInSurfaces()) {
    if (surface.name == name) return surface;
  }
  return std::nullopt;
}

}  // namespace tread::sim
