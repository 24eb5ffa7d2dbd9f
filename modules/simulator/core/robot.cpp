// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/core/robot.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "modules/simulator/core/car.hpp"

namespace tread::sim {
namespace {

constexpr int64_t kStepUs = 1000;
constexpr double kStep = 1e-3;       // [s]
constexpr int kStepsPerGround = 10;  // ground, collision and noise are updated every 10 ms
constexpr int64_t kEncounterUs =
    500000;  // after this long without contact, the next contact is a new one

/// Random streams of the parts.
constexpr uint64_t kMotionStream = 0;
constexpr uint64_t kLaserStream = 1;
constexpr uint64_t kInsStream = 2;
constexpr uint64_t kGroundLaserStream = 3;
/// Slower than this counts as standing [m/s].
constexpr double kStanding = 0.05;

double finiteOrZero(double value) {
  return std::isfinite(value) ? value : 0.0;
}

TrackContact::Surfaces surfacesBelow(const World& world, const VehicleParameters& vehicle,
                                     const Pose2& T_map_body, double side) {
  const TrackGeometry geometry{vehicle.contact_length, side * vehicle.gauge / 2.0};
  TrackContact::Surfaces surfaces{};
  for (int i = 0; i < kTrackSegments; ++i) {
    const Eigen::Vector2d p_body(vehicle.centre + geometry.segmentX(i), geometry.lateral);
    surfaces[static_cast<size_t>(i)] = &world.surface(T_map_body * p_body);
  }
  return surfaces;
}

/// Contact area of the tracks.
FootprintSize contactOf(const VehicleParameters& vehicle) {
  return {vehicle.contact_length / 2.0 + vehicle.centre,
          vehicle.contact_length / 2.0 - vehicle.centre, vehicle.gauge / 2.0};
}

}  // namespace

void Shaking::add(double speed, double acceleration, double pitch_rate, double dt) {
  time += dt;
  distance += speed * dt;
  acceleration_sum += acceleration * acceleration * dt;
  acceleration_peak = std::max(acceleration_peak, std::abs(acceleration));
  pitch_rate_sum += pitch_rate * pitch_rate * dt;
  pitch_rate_peak = std::max(pitch_rate_peak, std::abs(pitch_rate));
}

SimulatedRobot::SimulatedRobot(std::shared_ptr<const World> world, const RobotSettings& settings,
                               RobotParts parts)
    : world_(std::move(world)),
      settings_(settings),
      vehicle_(parts.vehicle ? std::move(parts.vehicle) : makeVehicle(settings.vehicle)),
      noise_(streamSeed(settings.seed, kMotionStream), kStep * kStepsPerGround),
      laser_(settings.laser, streamSeed(settings.seed, kLaserStream), settings.start_utime),
      ins_(settings.ins, streamSeed(settings.seed, kInsStream), settings.start_utime),
      ins_errors_(std::move(parts.ins_errors)),
      T_map_free_(settings.start) {
  truth_.utime = settings.start_utime;
  truth_.T_map_body = settings.start;
  // Half a period later than the other, like free-running devices.
  if (settings.ground_laser)
    ground_laser_.emplace(*settings.ground_laser, streamSeed(settings.seed, kGroundLaserStream),
                          settings.start_utime + settings.ground_laser->period_us / 2);
  updateGround();
  settleOnPlane();
  height_before_ = frontHeight();
  pitch_before_ = truth_.body.pitch;
  roll_before_ = truth_.body.roll;
}

void SimulatedRobot::setPower(const MotorPower& power) {
  MotorValues finite{};
  for (size_t i = 0; i < finite.size(); ++i) finite[i] = finiteOrZero(power[i]);
  power_ = MotorPower::of(finite);
}

void SimulatedRobot::advanceTo(int64_t utime) {
  while (truth_.utime + kStepUs <= utime) step();
}

void SimulatedRobot::step() {
  if (ins_.due(truth_.utime)) measureIns();
  laser_.advanceTo(truth_.utime, *world_, truth_.body);
  if (ground_laser_) ground_laser_->advanceTo(truth_.utime, *world_, truth_.body);
  vehicle_->step(power_, ground_, kStep);
  moveBody();
  truth_.utime += kStepUs;
  if (++steps_ % kStepsPerGround == 0) {
    checkCollision();
    noise_.step();
    updateGround();
    updateRates(kStep * kStepsPerGround);
  }
  settleOnPlane();
}

void SimulatedRobot::measureIns() {
  const Eigen::Vector3d v_body(truth_.v_body.v_x, truth_.v_body.v_y, 0.0);
  const InsInput truth{truth_.body, truth_.T_map_body.yaw, v_body, rate_body_};
  ins_.measure(truth_.utime, ins_errors_ ? ins_errors_->sensed(truth_.utime, truth) : truth);
}

void SimulatedRobot::moveBody() {
  truth_.v_body = vehicle_->velocity();
  if (settings_.motion_noise && vehicle_->disturbedByGround())
    truth_.v_body = noise_.disturb(truth_.v_body, surface_->spread);
  const Eigen::Vector3d v_body(truth_.v_body.v_x, truth_.v_body.v_y, 0.0);
  const Eigen::Vector3d v_map = truth_.body.R_map_body * v_body;
  truth_.T_map_body.x += kStep * v_map.x();
  truth_.T_map_body.y += kStep * v_map.y();
  truth_.T_map_body.yaw += kStep * truth_.v_body.omega;
  truth_.distance += kStep * std::hypot(truth_.v_body.v_x, truth_.v_body.v_y);
}

void SimulatedRobot::updateGround() {
  const Pose2& pose = truth_.T_map_body;
  surface_ = &world_->surface(pose.position());
  truth_.surface = surface_->name;
  ground_.left = surfacesBelow(*world_, settings_.vehicle, pose, 1.0);
  ground_.right = surfacesBelow(*world_, settings_.vehicle, pose, -1.0);
  for (size_t i = 0; i < settings_.vehicle.wheels.size(); ++i)
    ground_.wheels[i] = &world_->surface(pose * settings_.vehicle.wheels[i].p_body());
  const auto [height, gradient] = world_->bearing(pose, contactOf(settings_.vehicle));
  plane_ = {pose.position(), height, gradient};
  const double c = std::cos(pose.yaw), s = std::sin(pose.yaw);
  ground_.slope_along = gradient.x() * c + gradient.y() * s;
  ground_.slope_across = -gradient.x() * s + gradient.y() * c;
}

void SimulatedRobot::settleOnPlane() {
  const Eigen::Vector2d from_plane = truth_.T_map_body.position() - plane_.p_map;
  const double height = plane_.height + plane_.gradient.dot(from_plane);
  truth_.body = poseOnGround(truth_.T_map_body, height, plane_.gradient);
}

void SimulatedRobot::updateRates(double dt) {
  const double pitch = truth_.body.pitch, roll = truth_.body.roll;
  rate_body_ = {(roll - roll_before_) / dt, (pitch - pitch_before_) / dt, truth_.v_body.omega};
  pitch_before_ = pitch;
  roll_before_ = roll;
  noteShaking(dt);
}

double SimulatedRobot::frontHeight() const {
  return plane_.height + settings_.vehicle.outline.front * ground_.slope_along;
}

void SimulatedRobot::noteShaking(double dt) {
  const double rise = (frontHeight() - height_before_) / dt;
  const double acceleration = (rise - rise_before_) / dt;
  height_before_ = frontHeight();
  rise_before_ = rise;
  const double speed = std::hypot(truth_.v_body.v_x, truth_.v_body.v_y);
  if (speed < kStanding) return;
  Shaking& shaking = world_->isRough(truth_.T_map_body.position()) ? truth_.rough : truth_.smooth;
  shaking.add(speed, acceleration, rate_body_.y(), dt);
}

std::vector<LaserScan> SimulatedRobot::takeScans() {
  std::vector<LaserScan> scans = laser_.takeScans();
  if (!ground_laser_) return scans;
  for (LaserScan& scan : ground_laser_->takeScans()) {
    scan.ground = true;
    scans.push_back(std::move(scan));
  }
  std::sort(scans.begin(), scans.end(),
            [](const LaserScan& a, const LaserScan& b) { return a.utime < b.utime; });
  return scans;
}

void SimulatedRobot::checkCollision() {
  const FootprintSize& outline = settings_.vehicle.outline;
  const Pose2 T_body_middle{(outline.front - outline.rear) / 2.0, 0.0, 0.0};
  const auto collision = world_->collision({outline.length(), 2.0 * outline.half_width},
                                           truth_.T_map_body * T_body_middle);
  if (!collision) {
    T_map_free_ = truth_.T_map_body;
    return;
  }
  const bool same = last_touch_ != INT64_MIN && truth_.utime - last_touch_ < kEncounterUs;
  if (!same) truth_.collisions.push_back({truth_.utime, collision->obstacle, 0.0});
  CollisionEvent& event = truth_.collisions.back();
  event.penetration = std::max(event.penetration, collision->penetration);
  last_touch_ = truth_.utime;
  truth_.T_map_body = T_map_free_;
  truth_.v_body = {};
  vehicle_->stopBody();
}

}  // namespace tread::sim
