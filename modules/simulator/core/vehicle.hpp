// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <string>
#include <vector>

#include "common/geometry/se2.hpp"
#include "modules/simulator/core/terrain.hpp"

namespace tread::sim {

/// Segments of a track's contact patch, front to rear.
inline constexpr int kTrackSegments = 5;

/// Contact geometry of a track: axes of the body, origin midway between the two patches.
struct TrackGeometry {
  double length = 0.0;   ///< of the contact patch [m]
  double lateral = 0.0;  ///< y of the track's middle [m]

  /// x of the middle of a segment, from the middle of the patch [m].
  double segmentX(int i) const { return length * (0.5 - (i + 0.5) / kTrackSegments); }
};

/// The weight on one track.
struct ContactLoad {
  double force = 0.0;  ///< normal force [N]
  /// Of its centre ahead of the middle, in addition to that of the surface [m]
  double offset = 0.0;
};

/// Force and yaw moment of the ground on one track.
struct TrackForce {
  double along = 0.0;   ///< shear along the track, forward positive [N]
  double across = 0.0;  ///< shear across it, to the left positive [N]
  /// Rolling resistance that grows with speed, on the body, forward positive [N]
  double resistance = 0.0;
  double moment = 0.0;        ///< of the three about the middle of the patches [N m]
  double dry_friction = 0.0;  ///< rolling resistance that does not depend on speed, >= 0 [N]
};

/// The contact patch of one track: shear displacement of the ground below each segment.
/** The ground below a segment is sheared by the slip velocity and carried backwards by the belt, so
 * that undisturbed ground enters at the leading edge (Janosi and Hanamoto's shear displacement as
 * a state). Shear force = friction x load x u / sqrt(1 + |u|^2), u = displacement over the
 * displacement of saturation. A standing belt keeps its displacement: the track then holds like a
 * spring and does not creep. */
class TrackContact {
 public:
  using Surfaces = std::array<const SurfaceParameters*, kTrackSegments>;

  /// Advances by dt [s] under the twist of the middle, the belt speed [m/s] and the load on the
  /// track.
  TrackForce step(const TrackGeometry& geometry, const Surfaces& surfaces, const Twist2& v_middle,
                  double belt_speed, const ContactLoad& load, double dt);

 private:
  void shear(const TrackGeometry& geometry, const Surfaces& surfaces, const Twist2& v_middle,
             double belt_speed, double dt);
  void carry(std::array<double, kTrackSegments>& displacement, double share, bool forward);

  std::array<double, kTrackSegments> along_{};        ///< [m]
  std::array<double, kTrackSegments> across_{};       ///< [m]
  std::array<double, kTrackSegments> slip_along_{};   ///< [m/s]
  std::array<double, kTrackSegments> slip_across_{};  ///< [m/s]
};

/// Battery, power stage, motors and gears of a tracked vehicle, referred to the tracks; defaults
/// are those of a 24 V machine, except for values that depend on size and weight.
struct DriveParameters {
  double free_speed = 0.0;     ///< track speed at full power, nominal voltage and no load [m/s]
  double stiffness = 0.0;      ///< loss of drive force per track speed, one track [N s/m]
  double force_limit = 0.0;    ///< current limit of the power stage, as force at the track [N]
  double power_lag = 0.09;     ///< first-order lag of the power stage's output [s]
  double dead_power = 0.0;     ///< smaller commands give no power, larger ones lose as much [1]
  double track_mass = 0.0;     ///< belt, sprockets, gear and rotor, as mass at the track [kg]
  double gear_friction = 0.0;  ///< dry friction of gear and belt, one track [N]
  double brake_force = 0.0;    ///< parking brake, engaged while there is no power [N]
  double brake_power = 0.004;  ///< below this output the parking brake may close [1]
  double brake_speed = 0.02;   ///< and only below this track speed [m/s]
  double force_per_current = 20.0;   ///< [N/A] of motor current
  double nominal_voltage = 25.0;     ///< [V]
  double full_voltage = 25.6;        ///< without load, battery full [V]
  double empty_voltage = 22.5;       ///< without load, battery empty [V]
  double inner_resistance = 0.015;   ///< of battery and cables [ohm]
  double capacity = 100.0 * 3600.0;  ///< [A s]
  double idle_current = 3.0;         ///< electronics and instruments [A]
};

/// State of one motor with its track.
struct TrackDrive {
  double power = 0.0;    ///< output of the power stage, -1..1
  double speed = 0.0;    ///< belt speed, forward positive [m/s]
  double current = 0.0;  ///< motor current, positive when driving forward [A]
};

/// The battery now.
struct Battery {
  double charge = 1.0;    ///< remaining share, 1 = full
  double voltage = 25.6;  ///< at the terminals [V]
  double current = 0.0;   ///< [A], positive when discharging
};

/// External forces on one track.
struct TrackLoad {
  double ground_force = 0.0;  ///< of the ground on the belt, forward positive [N]
  double dry_friction = 0.0;  ///< rolling resistance that does not depend on speed [N]
};

/// Advances one track by dt [s] under the commanded power (-1..1) and the battery's voltage [V].
void stepTrack(const DriveParameters& parameters, double commanded_power, double voltage,
               const TrackLoad& load, double dt, TrackDrive& track);

/// Advances the battery by dt, loaded by the power stage's current for the motors [A].
void stepBattery(const DriveParameters& parameters, double motors_current, double dt,
                 Battery& battery);

/// The same, loaded by both motors.
void stepBattery(const DriveParameters& parameters, const TrackDrive& left, const TrackDrive& right,
                 double dt, Battery& battery);

/// Upper limit of a vehicle's motors.
inline constexpr size_t kMostMotors = 8;
/// A number for each motor or channel of a vehicle; of two tracks left and right.
using MotorValues = std::array<double, kMostMotors>;

/// Motor power, -1..1 per track; for a holonomic base per wheel, where the first two replace left
/// and right.
struct MotorPower {
  double left = 0.0;
  double right = 0.0;
  std::array<double, kMostMotors - 2> more{};

  double operator[](size_t motor) const {
    return motor == 0 ? left : motor == 1 ? right : more[motor - 2];
  }
  static MotorPower of(const MotorValues& values) {
    MotorPower power{values[0], values[1]};
    for (size_t i = 2; i < kMostMotors; ++i) power.more[i - 2] = values[i];
    return power;
  }
};

/// The ground below the vehicle at one instant.
struct Ground {
  TrackContact::Surfaces left{};   ///< below the segments, front to rear; never null
  TrackContact::Surfaces right{};  ///< below the segments, front to rear; never null
  /// Below the wheels of a holonomic base; not null for existing wheels.
  std::array<const SurfaceParameters*, kMostMotors> wheels{};
  double slope_along = 0.0;   ///< height gained per metre ahead [1]
  double slope_across = 0.0;  ///< height gained per metre to the left [1]
};

/// The vehicle of a simulated robot as used by its devices and the world: power in, motion out.
/** One that takesSpeeds() contains the speed controller: its "power" is the wanted track speed
 * [m/s]. */
/** Body origin on the ground midway between the tracks, x forward, y left. */
class Plant {
 public:
  virtual ~Plant() = default;

  virtual bool takesSpeeds() const { return false; }
  /// Advances by dt [s]. Power is clamped to -1..1.
  virtual void step(const MotorPower& power, const Ground& ground, double dt) = 0;
  /// Velocity of the body origin in the body frame, which moves it through the next step.
  virtual Twist2 velocity() const = 0;
  virtual const TrackDrive& left() const = 0;
  virtual const TrackDrive& right() const = 0;
  virtual size_t motors() const { return 2; }
  /// The drive of each motor, in the order of their channels.
  virtual const TrackDrive& motor(size_t i) const { return i == 0 ? left() : right(); }
  virtual const Battery& battery() const = 0;
  /// Stops the body at once, as at a hard obstacle; the tracks continue.
  virtual void stopBody() = 0;

  /// Whether the spread of the world's surfaces disturbs its motion; otherwise it includes all its
  /// noise itself.
  virtual bool disturbedByGround() const { return true; }
  /// Its name, if the user chose it; may be empty.
  virtual std::string name() const { return {}; }
  /// Why its motion is unreliable, in one line; empty = no known reason.
  virtual std::string warning() const { return {}; }
};

/// A wheel with rollers on its rim, axes of the body.
struct WheelMount {
  double x = 0.0;        ///< [rad] rolling direction when driven forward
  double y = 0.0;        ///< [m]
  double heading = 0.0;  ///< [rad] where it rolls when it is driven forward
  double rollers = 0.0;  ///< [rad] from there to its rollers' axis

  Eigen::Vector2d p_body() const { return {x, y}; }
};

/// A tracked machine; there are no defaults for its size.
/** Body origin on the ground midway between the tracks, x forward, y left. */
struct VehicleParameters {
  double mass = 0.0;               ///< [kg]
  double yaw_inertia = 0.0;        ///< about the centre of mass, tracks included [kg m^2]
  double gauge = 0.0;              ///< effective, between the middles of the tracks [m]
  double contact_length = 0.0;     ///< of each track on the ground [m]
  double centre = 0.0;             ///< x_body of the middle of the contact patches [m]
  double mass_height = 0.0;        ///< of the centre of mass above the ground [m]
  double wheelbase = 0.0;          ///< [m] of a car (car.hpp); 0: it has tracks
  double max_steering = 0.0;       ///< [rad] of a car, to either side
  double steering_rate = 2.0;      ///< [rad/s] of a car's servo
  std::vector<WheelMount> wheels;  ///< of a holonomic base (omni_base.hpp); else none
  /// Position of the centre of mass relative to the middle of the contact patches, or to a
  /// holonomic base's origin [m].
  double mass_ahead = 0.0;
  FootprintSize outline;     ///< what obstacles stop
  double left_power = 1.0;   ///< share of the commanded power that the left drive gives [1]
  double right_power = 1.0;  ///< the same for the right drive [1]
  double left_drag = 0.0;    ///< dry friction on the left track, as of a jammed brake [N]
  double right_drag = 0.0;   ///< the same on the right [N]
  double charge = 1.0;       ///< of the battery at the start, 1 = full
  DriveParameters drive;
};

/// Other forces on the body at the centre of mass, axes of the body: a plough, a trailer, wind.
struct OutsideForce {
  double along = 0.0;   ///< forward positive [N]
  double across = 0.0;  ///< to the left positive [N]
  double moment = 0.0;  ///< counter-clockwise positive [N m]
};

/// The same surface everywhere, level. The surface must outlive the ground.
Ground levelGround(const SurfaceParameters& surface);

/// The hidden ground truth: a dynamic tracked vehicle on sheared ground.
/** Motor power -> drive force against belt speed -> belt speed -> slip -> shear of the ground ->
 * motion of the body in the tangent plane of the ground. Semi-implicit integration, for steps of 1
 * ms. */
class TrackedVehicle final : public Plant {
 public:
  explicit TrackedVehicle(const VehicleParameters& parameters);

  void step(const MotorPower& power, const Ground& ground, double dt) override;

  Twist2 velocity() const override {
    return {v_centre_.v_x, v_centre_.v_y - v_centre_.omega * parameters_.centre, v_centre_.omega};
  }
  const TrackDrive& left() const override { return left_; }
  const TrackDrive& right() const override { return right_; }
  const Battery& battery() const override { return battery_; }
  const VehicleParameters& parameters() const { return parameters_; }

  void stopBody() override { v_centre_ = {}; }
  /// Acts on the body from now on.
  void setOutsideForce(const OutsideForce& force) { outside_ = force; }
  /// Changes the parameters, for instance for a new payload; the body origin keeps its velocity.
  void rebuild(const VehicleParameters& parameters);
  /// Sets the battery's charge, 0..1.
  void setCharge(double charge) { battery_.charge = charge; }

 private:
  void moveBody(const TrackForce& left, const TrackForce& right, const Ground& ground, double dt);

  VehicleParameters parameters_;
  TrackContact left_contact_;
  TrackContact right_contact_;
  TrackDrive left_;
  TrackDrive right_;
  Battery battery_;
  OutsideForce outside_;
  Twist2 v_centre_;  ///< of the middle of the contact patches, axes of the body
};

}  // namespace tread::sim
