// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/effects.hpp"

#include <stdexcept>

namespace tread {
namespace {

void applyYawPull(const std::vector<double>& values, VehicleMotion& motion) {
  motion.v_body.omega += values[0];
}

void applySideslip(const std::vector<double>& values, VehicleMotion& motion) {
  motion.v_body.v_y += values[0] * motion.v_body.omega;
}

void applyCrab(const std::vector<double>& values, VehicleMotion& motion) {
  motion.crab += values[0];
}

}  // namespace

const std::vector<Effect>& effectCatalogue() {
  // Yaw pull first: sideslip is what the true yaw rate causes.
  static const std::vector<Effect> catalogue{
      {"yaw_pull",
       "The vehicle turns by itself, whatever the tracks do: omega += rate.",
       {{"rate", "rad/s", -0.5, 0.5}},
       applyYawPull},
      {"sideslip",
       "Turning pushes the vehicle sideways, because it turns about a point ahead of or behind its "
       "middle: v_y += lever omega.",
       {{"lever", "m/rad", -0.5, 0.5}},
       applySideslip},
      {"crab",
       "The vehicle drifts to one side of its heading as it drives: v_y += v_x tan(angle).",
       {{"angle", "rad", -0.5, 0.5}},
       applyCrab},
  };
  return catalogue;
}

size_t effectIndex(const std::string& name) {
  const std::vector<Effect>& catalogue = effectCatalogue();
  for (size_t i = 0; i < catalogue.size(); ++i)
    if (catalogue[i].name == name) return i;
  throw std::out_of_range("no effect '" + name + "' in the catalogue of the vehicle model");
}

}  // namespace tread
