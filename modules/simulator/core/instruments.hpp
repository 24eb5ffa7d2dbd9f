// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/se3.hpp"
#include "modules/simulator/core/noise.hpp"
#include "modules/simulator/core/world.hpp"

namespace tread::sim {

/// Position and attitude of a vehicle on the ground.
struct BodyPose {
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();           ///< of the body origin [m]
  Eigen::Matrix3d R_map_body = Eigen::Matrix3d::Identity();  ///< Rz(yaw) Ry(pitch) Rx(roll)
  double pitch = 0.0;                                        ///< nose down positive [rad]
  double roll = 0.0;                                         ///< left side up positive [rad]
};

/// The body on ground of a height [m] and gradient [1]; yaw is the heading of x_body seen from
/// above.
BodyPose poseOnGround(const Pose2& T_map_body, double height, const Eigen::Vector2d& gradient);

/// An inertial navigation system with satellite positions. Noise is per sample, one sigma.
struct InsParameters {
  Mounting mounting;              ///< p_body: the reported reference point
  int64_t period_us = 20000;      ///< from measurement to measurement
  int64_t latency_us = 20000;     ///< from measurement to output
  double position_noise = 0.003;  ///< [m]
  double position_bias = 0.02;    ///< drifts slowly, one sigma [m]
  double height_noise = 0.005;    ///< [m]
  double heading_noise = 0.001;   ///< [rad]
  double heading_bias = 0.002;    ///< drifts slowly, one sigma [rad]
  double attitude_noise = 0.001;  ///< of roll and pitch [rad]
  double velocity_noise = 0.01;   ///< per axis [m/s]
  double rate_noise = 0.002;      ///< per axis [rad/s]
  double bias_time = 120.0;       ///< correlation time of both biases [s]
};

/// The true values measured by the INS.
struct InsInput {
  BodyPose body;
  double yaw = 0.0;                                     ///< [rad], unwrapped
  Eigen::Vector3d v_body = Eigen::Vector3d::Zero();     ///< [m/s]
  Eigen::Vector3d rate_body = Eigen::Vector3d::Zero();  ///< about x, y, z [rad/s]
};

/// Errors from age, position and mounting of the instrument, before its own noise.
class InsErrors {
 public:
  virtual ~InsErrors() = default;
  /// Input of the INS at a time; called at each measurement, in order of time.
  virtual InsInput sensed(int64_t utime, const InsInput& truth) = 0;
};

/// One measurement.
struct InsMeasurement {
  int64_t utime = 0;                                    ///< of the measurement [us]
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();      ///< of the reference point [m]
  double yaw = 0.0;                                     ///< [rad], unwrapped, counter-clockwise
  double pitch = 0.0;                                   ///< nose down positive [rad]
  double roll = 0.0;                                    ///< left side up positive [rad]
  Eigen::Vector3d v_body = Eigen::Vector3d::Zero();     ///< of that point, forward, left, up [m/s]
  Eigen::Vector3d rate_body = Eigen::Vector3d::Zero();  ///< about the device's axes [rad/s]
};

/// Measures at a fixed rate and returns measurements after the latency.
class Ins {
 public:
  /// The first measurement is at `start_utime`.
  Ins(const InsParameters& parameters, uint64_t seed, int64_t start_utime);

  /// Whether a measurement is due at a time: then call measure().
  bool due(int64_t utime) const { return utime >= next_; }
  /// Takes the due measurement from the present true values.
  void measure(int64_t utime, const InsInput& truth);

  /// Measurements output up to a time, oldest first; each is returned once.
  std::vector<InsMeasurement> takeSamples(int64_t utime);

  const InsParameters& parameters() const { return parameters_; }

 private:
  InsInput atInstrument(InsInput truth) const;
  Eigen::Vector3d noise3(double sigma);

  InsParameters parameters_;
  bool at_origin_;  ///< at the body origin, without rotation
  Gaussian gaussian_;
  OrnsteinUhlenbeck bias_x_;
  OrnsteinUhlenbeck bias_y_;
  OrnsteinUhlenbeck bias_yaw_;
  int64_t next_;
  std::deque<InsMeasurement> pending_;
};

/// A scanning laser range finder: one plane, beams in sequence from right to left.
struct LaserParameters {
  Mounting mounting;
  double field_of_view = 270.0 * kPi / 180.0;  ///< [rad], centred on its x axis
  int beams = 541;
  int64_t period_us = 100000;  ///< from scan to scan
  int64_t sweep_us = 18750;  ///< first to last beam: 270 degrees of a mirror with 40 turns a second
  double range_min = 0.10;   ///< [m]
  double range_max = 15.0;   ///< [m]
  double range_noise = 0.01;  ///< standard deviation [m]
  double dropout = 0.0;       ///< share of beams without a return although something is there
};

/// Result of one sweep.
struct LaserScan {
  int64_t utime = 0;          ///< of the first beam [us]
  int64_t sweep_us = 0;       ///< first to last beam
  double angle_min = 0.0;     ///< of the first beam in the sensor's plane, counter-clockwise [rad]
  double angle_step = 0.0;    ///< [rad]
  std::vector<float> ranges;  ///< [m]; +inf = no hit up to range_max, NaN = no measurement
  bool ground = false;        ///< of the one that looks at the ground ahead
};

/// The laser on a moving body: casts each beam from the sensor's pose at that beam's time.
class Laser {
 public:
  /// The first sweep starts at `start_utime`.
  Laser(const LaserParameters& parameters, uint64_t seed, int64_t start_utime);

  /// Casts the beams due up to a time from a body pose; call it in every simulation step.
  void advanceTo(int64_t utime, const World& world, const BodyPose& body);

  /// Scans completed since the last call, oldest first.
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
