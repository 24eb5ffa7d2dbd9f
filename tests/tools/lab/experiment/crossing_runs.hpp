// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <cstdio>
#include <fstream>
#include <random>
#include <string>

// Synthetic drives of a three-wheel robot from one floor to the next, for tread-experiment
// crossings.
namespace tread::samples {

inline std::string seamMapping() {
  return std::string(TREAD_SOURCE_DIR) + "/config/imports/three_wheels_seam.yaml";
}

/// Runs of a robot whose speed falls to a share when it enters the next floor.
inline void writeRuns(const std::string& path, int runs, double share) {
  constexpr double kStep = 0.05;    // [s]
  constexpr double kLength = 16.0;  // [s] of a run
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  std::ofstream file(path);
  file << "run,t_s,cmd_w1_rad_s,cmd_w2_rad_s,cmd_w3_rad_s,w1_rad_s,w2_rad_s,w3_rad_s,i1_A,i2_A,i3_"
          "A,x_m,y_m,yaw_rad,pose_new,w1_on,w2_on,w3_on\n";
  double t = 0.0;
  for (int run = 0; run < runs; ++run, t += 5.0) {
    const double direction = 0.5 * run;
    const double changes = 8.2 + 0.07 * run;  // [s] after its start
    double way = 0.0;
    for (double at = 0.0; at < kLength; at += kStep, t += kStep) {
      const bool behind = at >= changes;
      const double speed = 0.1 * (behind ? share : 1.0) * (1.0 + 0.1 * normal(random));
      const char* const floor = behind ? "felt" : "wood";
      char line[256];
      std::snprintf(line, sizeof line, "%d,%.3f,%.2f,%.2f,2.5,0,0,0,0,0,0,%.5f,%.5f,0,1,%s,%s,%s\n",
                    run, t, -1.0 - 0.1 * run, -2.0 + 0.1 * run, way * std::cos(direction),
                    way * std::sin(direction), floor, floor, floor);
      file << line;
      way += speed * kStep;
    }
  }
}

}  // namespace tread::samples
