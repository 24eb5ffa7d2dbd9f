// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/geometry/se2.hpp"

namespace tread {

/// The motion of a vehicle at one instant, as the effects change it one after the other.
struct VehicleMotion {
  double left = 0.0;   ///< [m/s] speed of the left track
  double right = 0.0;  ///< [m/s] and of the right one
  Twist2 v_body;       ///< what the ground makes of it
  double crab = 0.0;   ///< [rad] direction of travel relative to the heading, left positive
};

/// One parameter of an effect; at 0 it has no influence.
struct EffectParameter {
  std::string name;
  std::string unit;
  double min = 0.0;
  double max = 0.0;
};

/// A named departure from the nominal two-track model: parameters, equation and a sentence.
/** A new effect is one more entry of the catalogue; files, kernel and tools learn of it from there.
 */
struct Effect {
  std::string name;
  std::string sentence;  ///< in the words of the field
  std::vector<EffectParameter> parameters;
  /// Changes the motion; `values` as many as parameters, in their order.
  void (*apply)(const std::vector<double>& values, VehicleMotion& motion);
};

/// All effects in the order in which they act.
const std::vector<Effect>& effectCatalogue();

/// Position of an effect in the catalogue; throws std::out_of_range for an unknown name.
size_t effectIndex(const std::string& name);

}  // namespace tread
