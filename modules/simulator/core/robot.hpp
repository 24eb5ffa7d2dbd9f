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

/// How the motors hang on the channels of their controller.
/** The controller gives power, or holds the speed of each track. */
struct MotorWiring {
  int left_channel = 1;  ///< 1 or 2; the right track has the other one
  bool invert_left = false;
  bool invert_right = false;
  std::optional<double>
      top_speed;             ///< [m/s] held at full command; none: the controller gives power
  bool four_motors = false;  ///< two on each side, each with a controller of its own
  std::vector<bool> invert_wheels{};  ///< of a holonomic base, one for each; else none
};

/// How a simulated robot is built.
struct RobotSettings {
  VehicleParameters vehicle;
  LaserParameters laser;
  std::optional<LaserParameters> ground_laser;  ///< one more, which looks at the ground ahead
  InsParameters ins;
  MotorWiring wiring;
  Pose2 start;               ///< T_map_body at the beginning
  int64_t start_utime = 0;   ///< [us]
  uint64_t seed = 1;         ///< of ground and instruments
  bool motion_noise = true;  ///< false: the calibrated mean motion only
};

/// Parts that the user may exchange; what is null is as it always is.
struct RobotParts {
  std::unique_ptr<Plant> vehicle;         ///< in the place of the dynamic vehicle
  std::unique_ptr<InsErrors> ins_errors;  ///< of an INS that is late or askew
};

/// The footprint met an obstacle: one entry per encounter, ended by half a second without touch.
struct CollisionEvent {
  int64_t utime = 0;         ///< of the first touch [us]
  size_t obstacle = 0;       ///< index in the world's description
  double penetration = 0.0;  ///< deepest attempt [m]
};

/// How the front end of the body was shaken while it moved, looked at every 10 ms.
/** There the vehicle's rise and its pitching add up: what arms, cameras and range finders feel. */
struct Shaking {
  double time = 0.0;               ///< [s]
  double distance = 0.0;           ///< [m] driven in that time
  double acceleration_sum = 0.0;   ///< squared vertical acceleration over that time [m2/s3]
  double acceleration_peak = 0.0;  ///< [m/s2]
  double pitch_rate_sum = 0.0;     ///< squared pitch rate over that time [rad2/s]
  double pitch_rate_peak = 0.0;    ///< [rad/s]

  void add(double speed, double acceleration, double pitch_rate, double dt);
  /// RMS over the time of a squared quantity's sum; 0 without any time.
  double rms(double sum) const { return time > 0.0 ? std::sqrt(sum / time) : 0.0; }
};

/// What is really the case.
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
/** An obstacle stops the body where it last stood free; the tracks go on turning until told
 * otherwise. */
class SimulatedRobot {
 public:
  SimulatedRobot(std::shared_ptr<const World> world, const RobotSettings& settings,
                 RobotParts parts = {});

  /// Power on the motors from now on, -1..1; what is not a number counts as zero.
  void setPower(const MotorPower& power);

  /// Simulates up to a time; less than 1 ms may be left for the next call.
  void advanceTo(int64_t utime);

  const RobotTruth& truth() const { return truth_; }
  const Plant& vehicle() const { return *vehicle_; }
  const World& world() const { return *world_; }
  const RobotSettings& settings() const { return settings_; }

  /// INS measurements that came out since the last call.
  std::vector<InsMeasurement> takeInsSamples() { return ins_.takeSamples(truth_.utime); }
  /// Laser scans finished since the last call, oldest first.
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
  /// The ground near the vehicle, renewed every 10 ms.
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
  Pose2 T_map_free_;            ///< where the body last stood free
  int64_t last_touch_ = INT64_MIN;
  int64_t steps_ = 0;
};

}  // namespace tread::sim
