// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/core/robot.hpp"

#include <cmath>
#include <utility>

namespace tread::sim {
namespace {

constexpr int64_t kStepUs = 1000;
constexpr double kStep = 1e-3;            // [s]
constexpr int kStepsPerGround = 10;       // ground, collision and noise are looked at every 10 ms
constexpr int64_t kEncounterUs = 500000;  // without touch this long, the next touch is a new one

/// Random streams of the parts.
constexpr uint64_t kMotionStream = 0;
constexpr uint64_t kLaserStream = 1;
constexpr uint64_t kInsStream = 2;

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

}  // namespace

SimulatedRobot::SimulatedRobot(std::shared_ptr<const World> world, const RobotSettings& settings,
                               RobotParts parts)
    : world_(std::move(world)),
      settings_(settings),
      vehicle_(parts.vehicle ? std::move(parts.vehicle)
                             : std::make_unique<TrackedVehicle>(settings.vehicle)),
      noise_(streamSeed(settings.seed, kMotionStream), kStep * kStepsPerGround),
      laser_(settings.laser, streamSeed(settings.seed, kLaserStream), settings.start_utime),
      ins_(settings.ins, streamSeed(settings.seed, kInsStream), settings.start_utime),
      ins_errors_(std::move(parts.ins_errors)),
      T_map_free_(settings.start) {
  truth_.utime = settings.start_utime;
  truth_.T_map_body = settings.start;
  updateGround();
  settleOnPlane();
  pitch_before_ = truth_.body.pitch;
  roll_before_ = truth_.body.roll;
}

void SimulatedRobot::setPower(const MotorPower& power) {
  power_ = {finiteOrZero(power.left), finiteOrZero(power.right)};
}

void SimulatedRobot::advanceTo(int64_t utime) {
  while (truth_.utime + kStepUs <= utime) step();
}

void SimulatedRobot::step() {
  if (ins_.due(truth_.utime)) measureIns();
  laser_.advanceTo(truth_.utime, *world_, truth_.body);
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
  const Eigen::Vector2d gradient = world_->gradient(pose.position());
  plane_ = {pose.position(), world_->height(pose.position()), gradient};
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
