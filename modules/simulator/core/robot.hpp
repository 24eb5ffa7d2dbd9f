// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "modules/simulator/core/instruments.hpp"
#include "modules/simulator/core/noise.hpp"
#include "modules/simulator/core/vehicle.hpp"
#include "modules/simulator/core/world.hpp"

namespace tread::sim {

/// How the motors are connected to the channels of their controller.
/** The controller sets the power, or controls the speed of each track. */
struct MotorWiring {
  int left_channel = 1;  ///< 1 or 2; the right track uses the other
  bool invert_left = false;
  bool invert_right = false;
  /// [m/s] at full command; nullopt: the controller sets the power
  std::optional<double> top_speed;
  bool four_motors = false;           ///< two on each side, each with its own controller
  std::vector<bool> invert_wheels{};  ///< of a holonomic base, one per wheel; otherwise empty
};

/// How a simulated robot is built.
struct RobotSettings {
  VehicleParameters vehicle;
  LaserParameters laser;
  std::optional<LaserParameters> ground_laser;  ///< a second one, which looks at the ground ahead
  InsParameters ins;
  MotorWiring wiring;
  Pose2 start;               ///< T_map_body at the beginning
  int64_t start_utime = 0;   ///< [us]
  uint64_t seed = 1;         ///< for ground and instruments
  bool motion_noise = true;  ///< false: only the calibrated mean motion
};

/// Exchangeable parts; null = the default.
struct RobotParts {
  std::unique_ptr<Plant> vehicle;         ///< replaces the dynamic vehicle
  std::unique_ptr<InsErrors> ins_errors;  ///< of an INS with delays or misalignment
};

/// The footprint touched an obstacle: one entry per encounter, which ends after half a second
/// without contact.
struct CollisionEvent {
  int64_t utime = 0;         ///< of the first touch [us]
  size_t obstacle = 0;       ///< index in the world's description
  double penetration = 0.0;  ///< deepest attempt [m]
};

/// Vertical motion of the body's front end while it moved, sampled every 10 ms.
/** Heave and pitch add up there: this is the motion of arms, cameras and range finders. */
struct Shaking {
  double time = 0.0;               ///< [s]
  double distance = 0.0;           ///< [m] driven in that time
  double acceleration_sum = 0.0;   ///< squared vertical acceleration over that time [m2/s3]
  double acceleration_peak = 0.0;  ///< [m/s2]
  double pitch_rate_sum = 0.0;     ///< squared pitch rate over that time [rad2/s]
  double pitch_rate_peak = 0.0;    ///< [rad/s]

  void add(double speed, double acceleration, double pitch_rate, double dt);
  /// RMS over the time, from the sum of squares; 0 without any time.
  double rms(double sum) const { return time > 0.0 ? std::sqrt(sum / time) : 0.0; }
};

/// The true state.
struct RobotTruth {
  int64_t utime = 0;                       ///< [us]
  Pose2 T_map_body;                        ///< yaw unwrapped
  Twist2 v_body;                           ///< in the tangent plane of the ground
  BodyPose body;                           ///< place and attitude in space
  std::string surface;                     ///< below the body origin
  double distance = 0.0;                   ///< path length of the body origin so far [m]
  std::vector<CollisionEvent> collisions;  ///< so far
  Shaking smooth;                          ///< so far, on ground without bumps
  Shaking rough;                           ///< and on ground with them
};

/// World, vehicle and instruments, stepped together at 1 ms.
/** An obstacle stops the body at its last free pose; the tracks continue until they get another
 * command. */
class SimulatedRobot {
 public:
  SimulatedRobot(std::shared_ptr<const World> world, const RobotSettings& settings,
                 RobotParts parts = {});

  /// Motor power from now on, -1..1; NaN counts as zero.
  void setPower(const MotorPower& power);

  /// Simulates up to a time; a remainder below 1 ms is left for the next call.
  void advanceTo(int64_t utime);

  const RobotTruth& truth() const { return truth_; }
  const Plant& vehicle() const { return *vehicle_; }
  const World& world() const { return *world_; }
  const RobotSettings& settings() const { return settings_; }

  /// INS measurements output since the last call.
  std::vector<InsMeasurement> takeInsSamples() { return ins_.takeSamples(truth_.utime); }
  /// Laser scans completed since the last call, oldest first.
  std::vector<LaserScan> takeScans();

 private:
  void step();
  void measureIns();
  void moveBody();
  void settleOnPlane();
  void checkCollision();
  void updateGround();
  void updateRates(double dt);
  double frontHeight() const;
  void noteShaking(double dt);

  std::shared_ptr<const World> world_;
  RobotSettings settings_;
  std::unique_ptr<Plant> vehicle_;
  MotionNoise noise_;
  Laser laser_;
  std::optional<Laser> ground_laser_;
  Ins ins_;
  std::unique_ptr<InsErrors> ins_errors_;
  MotorPower power_;
  Ground ground_;
  const SurfaceParameters* surface_ = nullptr;
  /// The ground near the vehicle, updated every 10 ms.
  struct TangentPlane {
    Eigen::Vector2d p_map = Eigen::Vector2d::Zero();
    double height = 0.0;
    Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  } plane_;
  RobotTruth truth_;
  Eigen::Vector3d rate_body_ = Eigen::Vector3d::Zero();
  double pitch_before_ = 0.0;
  double roll_before_ = 0.0;
  double height_before_ = 0.0;  ///< of the front [m]
  double rise_before_ = 0.0;    ///< [m/s]
  Pose2 T_map_free_;            ///< last free pose of the body
  int64_t last_touch_ = INT64_MIN;
  int64_t steps_ = 0;
};

}  // namespace tread::sim
