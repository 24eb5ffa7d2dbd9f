// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace tread::plan {

/// What the command line of tread-plan says.
struct PlanOptions {
  std::string map;
  std::string patterns;
  bool exact = false;
  std::string footprint;         ///< "LENGTH,WIDTH" [m]
  std::optional<double> radius;  ///< [m]
  std::string start;             ///< "x,y,yaw" [m, m, rad] in the map's frame
  std::string goal;
  std::string tolerance = "0.25,0.26";  ///< "METRES,RADIANS"
  bool come_close = false;              ///< plan to the nearest place if the goal is unreachable
  std::optional<double> deadline_ms;
  std::optional<double> speed;      ///< [m/s]
  std::optional<double> turn_time;  ///< [s]
  std::string queries;
  int64_t random = 0;  ///< queries to draw; 0 = none
  uint64_t seed = 1;
  double apart = 3.0;  ///< [m]
  std::string write_queries;
  std::string json;
  std::string picture;
};

/// Adds all options to a program.
void describe(CLI::App& app, PlanOptions& options);

}  // namespace tread::plan
