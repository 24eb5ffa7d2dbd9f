// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "modules/simulator/core/body_pose.hpp"
#include "modules/simulator/core/random.hpp"
#include "modules/simulator/core/world.hpp"

namespace tread::sim {

/// A scanning laser range finder: one plane, beams in turn from right to left.
struct LaserParameters {
  Eigen::Vector3d p_body{0.0, 0.0, 0.0};       ///< where it is mounted [m]
  double yaw = 0.0;                            ///< mounting, R = Rz(yaw) Ry(pitch) Rx(roll) [rad]
  double pitch = 0.0;                          ///< nose down positive [rad]
  double roll = 0.0;                           ///< [rad]
  double field_of_view = 270.0 * kPi / 180.0;  ///< [rad], centred on its x axis
  int beams = 541;
  int64_t period_us = 100000;  ///< from scan to scan
  int64_t sweep_us = 18750;  ///< first to last beam: 270 degrees of a mirror with 40 turns a second
  double range_min = 0.10;   ///< [m]
  double range_max = 15.0;   ///< [m]
  double range_noise = 0.01;  ///< standard deviation [m]
  double dropout = 0.0;       ///< share of beams that come back empty although something is there
};

/// What the laser saw in one sweep.
struct LaserScan {
  int64_t utime = 0;          ///< of the first beam [us]
  int64_t sweep_us = 0;       ///< first to last beam
  double angle_min = 0.0;     ///< of the first beam in the sensor's plane, counter-clockwise [rad]
  double angle_step = 0.0;    ///< [rad]
  std::vector<float> ranges;  ///< [m]; +inf = nothing hit up to range_max, NaN = no measurement
};

/// The laser on a moving body: casts each beam from where the sensor is at that beam's time.
class Laser {
 public:
  /// The first sweep starts at `start_utime`.
  Laser(const LaserParameters& parameters, uint64_t seed, int64_t start_utime);

  /// Casts the beams due up to a time from a body pose; call it at every simulation step.
  void advanceTo(int64_t utime, const World& world, const BodyPose& body);

  /// Finished scans since the last call, oldest first.
  std::vector<LaserScan> takeScans();

  const LaserParameters& parameters() const { return parameters_; }

 private:
  int64_t beamTime(int beam) const;
  float measure(const World& world, const Eigen::Vector3d& p_map,
                const Eigen::Matrix3d& R_map_sensor, int beam);
  void startSweep(int64_t utime);

  LaserParameters parameters_;
  Eigen::Matrix3d R_body_sensor_;
  std::vector<Eigen::Vector3d> directions_;  ///< of the beams in the sensor frame
  Gaussian gaussian_;
  std::mt19937_64 dropouts_;
  LaserScan current_;
  std::vector<LaserScan> finished_;
};

}  // namespace tread::sim
