// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The INS's measurement of a motion, and vehicle effects that it cannot be distinguished from.
#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include "common/vehicle/kernel.hpp"
#include "tests/common/vehicle/rich_drive.hpp"

using namespace tread;

namespace {

/// The rich drive on level ground as a time series, starting from rest at time 0.
std::vector<MotionSample> drive(const VehicleModel& model) {
  VehicleKernel kernel(model, {});
  std::vector<MotionSample> motion{{0.0, {}, 0.0}};
  for (const TrackCommand& command : richCommands())
    for (int i = 0; i < 30; ++i) {
      kernel.step(command, 0.05);
      motion.push_back(
          {0.05 * static_cast<double>(motion.size()), kernel.pose(), kernel.twist().omega});
    }
  return motion;
}

/// A steady circle, sampled at 20 Hz.
std::vector<MotionSample> circle(const Twist2& v_body, int samples = 60) {
  std::vector<MotionSample> motion;
  for (int i = 0; i < samples; ++i)
    motion.push_back({0.05 * i, integrate(v_body, 0.05 * i), v_body.omega});
  return motion;
}

/// Body twist measured by the INS between samples `i` and `i + 1`.
Twist2 seen(const std::vector<MotionSample>& said, size_t i) {
  return twistTo(between(said[i].T_map_body, said[i + 1].T_map_body),
                 said[i + 1].time - said[i].time);
}

/// Largest difference of poses relative to the first one [m and rad].
double apart(const std::vector<MotionSample>& a, const std::vector<MotionSample>& b) {
  double largest = 0.0;
  for (size_t i = 0; i < a.size(); ++i) {
    const Pose2 from_a = between(a[0].T_map_body, a[i].T_map_body);
    const Pose2 from_b = between(b[0].T_map_body, b[i].T_map_body);
    largest = std::max({largest, std::abs(from_a.x - from_b.x), std::abs(from_a.y - from_b.y),
                        std::abs(from_a.yaw - from_b.yaw), std::abs(a[i].omega - b[i].omega)});
  }
  return largest;
}

MeasurementModel ins(double MeasurementModel::*place, double value) {
  MeasurementModel measurement;
  measurement.*place = value;
  return measurement;
}

}  // namespace

TEST_CASE("An INS without effects says the true motion bit for bit, whatever the shapes") {
  const std::vector<MotionSample> motion = drive(plainVehicle());
  MeasurementModel measurement;
  measurement.ins_latency_gyro = 1.0;
  measurement.gyro_bias_heading = 1.0;
  const std::vector<MotionSample> said = measure(motion, measurement);
  for (size_t i = 0; i < motion.size(); ++i) {
    CHECK(said[i].T_map_body.x == motion[i].T_map_body.x);
    CHECK(said[i].T_map_body.y == motion[i].T_map_body.y);
    CHECK(said[i].T_map_body.yaw == motion[i].T_map_body.yaw);
    CHECK(said[i].omega == motion[i].omega);
  }
}

TEST_CASE("ins_latency says older poses, and the yaw rate only with gyro_share") {
  const std::vector<MotionSample> motion = drive(plainVehicle());
  MeasurementModel late = ins(&MeasurementModel::ins_latency, 0.2);
  std::vector<MotionSample> said = measure(motion, late);
  for (size_t i = 4; i < motion.size(); ++i) {
    CHECK(said[i].T_map_body.x == Approx(motion[i - 4].T_map_body.x).margin(1e-6));
    CHECK(said[i].T_map_body.yaw == Approx(motion[i - 4].T_map_body.yaw).margin(1e-6));
    CHECK(said[i].omega == motion[i].omega);
  }
  late.ins_latency_gyro = 1.0;
  said = measure(motion, late);
  for (size_t i = 4; i < motion.size(); ++i)
    CHECK(said[i].omega == Approx(motion[i - 4].omega).margin(1e-9));
}

TEST_CASE("heading_latency: to the side with speed times yaw rate, inwards for a late heading") {
  const auto said = measure(circle({2.0, 0.0, 0.5}), ins(&MeasurementModel::heading_latency, 0.1));
  CHECK(seen(said, 20).v_y == Approx(2.0 * std::sin(0.05)));
  CHECK(seen(said, 20).omega == Approx(0.5));
  const auto spot = measure(circle({0.0, 0.0, 0.5}), ins(&MeasurementModel::heading_latency, 0.1));
  CHECK(seen(spot, 20).v_y == Approx(0.0).margin(1e-9));
}

TEST_CASE("gyro_bias is a constant yaw rate, at standstill, too, and in the heading only as told") {
  MeasurementModel bias = ins(&MeasurementModel::gyro_bias, 0.02);
  const auto said = measure(circle({0.0, 0.0, 0.0}), bias);
  CHECK(said[20].omega == Approx(0.02));
  CHECK(said[20].T_map_body.yaw == 0.0);
  bias.gyro_bias_heading = 0.5;
  CHECK(measure(circle({0.0, 0.0, 0.0}), bias)[20].T_map_body.yaw == Approx(0.5 * 0.02 * 1.0));
}

TEST_CASE("heading_misalignment: to the side with the speed, flipping in reverse") {
  const MeasurementModel askew = ins(&MeasurementModel::heading_misalignment, 0.04);
  CHECK(seen(measure(circle({1.0, 0.0, 0.0}), askew), 10).v_y == Approx(std::sin(0.04)));
  CHECK(seen(measure(circle({-1.0, 0.0, 0.0}), askew), 10).v_y == Approx(-std::sin(0.04)));
}

TEST_CASE("Lever arms: along the vehicle to the side, across it along the track, with the turn") {
  const Twist2 along =
      seen(measure(circle({1.0, 0.0, 0.5}), ins(&MeasurementModel::lever_arm_x, 0.2)), 10);
  CHECK(along.v_x == Approx(1.0));
  CHECK(along.v_y == Approx(-0.1));
  const Twist2 across =
      seen(measure(circle({1.0, 0.0, 0.5}), ins(&MeasurementModel::lever_arm_y, 0.2)), 10);
  CHECK(across.v_x == Approx(1.1));
  CHECK(across.v_y == Approx(0.0).margin(1e-9));
}

TEST_CASE("position_scale lengthens the way and leaves the heading") {
  const Twist2 scaled =
      seen(measure(circle({1.0, 0.0, 0.5}), ins(&MeasurementModel::position_scale, 0.03)), 10);
  CHECK(scaled.v_x == Approx(1.03));
  CHECK(scaled.omega == Approx(0.5));
}

TEST_CASE("Poses between samples lie on the arc, beyond the ends on its continuation") {
  const Twist2 v_body{1.0, 0.1, 0.8};
  const std::vector<MotionSample> motion = circle(v_body);
  for (const double time : {-0.3, 0.0, 0.012, 1.0, 1.234, 3.3}) {
    const Pose2 expected = time < 0.0 ? inverse(integrate(v_body, -time)) : integrate(v_body, time);
    const Pose2 pose = poseAt(motion, time);
    CHECK(pose.x == Approx(expected.x).margin(1e-9));
    CHECK(pose.y == Approx(expected.y).margin(1e-9));
    CHECK(pose.yaw == Approx(expected.yaw).margin(1e-9));
  }
}

TEST_CASE("A centre of rotation and a lever arm along the vehicle give the same poses") {
  VehicleModel moved = plainVehicle();
  VehicleModel plain = plainVehicle();
  for (VehicleModel* model : {&moved, &plain}) {
    model->effects.yaw_inertia = 0.3;  // also while the body lags
    model->effects.crab = 0.03;
  }
  moved.effects.icr_offset = 0.15;
  const auto other = measure(drive(plain), ins(&MeasurementModel::lever_arm_x, 0.15));
  CHECK(apart(drive(moved), other) < 1e-9);
}

TEST_CASE("A command delay and an INS that is late with pose and gyro give the same poses") {
  VehicleModel delayed = plainVehicle();
  delayed.effects.command_delay = 0.2;
  MeasurementModel late = ins(&MeasurementModel::ins_latency, 0.2);
  late.ins_latency_gyro = 1.0;
  CHECK(apart(drive(delayed), measure(drive(plainVehicle()), late)) < 1e-6);
}

TEST_CASE("A scale of positions is slip and track width together") {
  VehicleModel slipping = plainVehicle();
  slipping.effects.slip_ratio = -0.03;
  slipping.effects.track_width = 0.03;
  const auto scaled = measure(drive(plainVehicle()), ins(&MeasurementModel::position_scale, 0.03));
  CHECK(apart(drive(slipping), scaled) < 1e-9);
}

TEST_CASE("Slip is a factor on full speed, or on both gains of the nominal model") {
  VehicleModel slipping = plainVehicle();
  slipping.effects.slip_ratio = 0.1;
  VehicleModel gains = plainVehicle();
  gains.forward_gain = gains.yaw_gain = 0.9;
  CHECK(apart(drive(slipping), drive(gains)) < 1e-9);
  for (VehicleModel* model : {&slipping, &gains}) {
    model->kind = CommandKind::kPower;
    model->forward_gain = model->yaw_gain = 1.0;
  }
  gains.full_speed = 0.9;
  CHECK(apart(drive(slipping), drive(gains)) < 1e-9);
}

TEST_CASE("Centrifugal drift is a latency of the heading to first order, with the other sign") {
  const double time = -0.01;
  for (const double omega : {-0.6, 0.4}) {
    const auto late =
        measure(circle({1.5, 0.0, omega}), ins(&MeasurementModel::heading_latency, time));
    CHECK(apart(late, circle({1.5, time * 1.5 * omega, omega})) < 1e-4);
  }
}

TEST_CASE("Crabbing is an INS mounted askew, to first order") {
  VehicleModel crabbing = plainVehicle();
  crabbing.effects.crab = 0.002;
  const auto askew =
      measure(drive(plainVehicle()), ins(&MeasurementModel::heading_misalignment, 0.002));
  CHECK(apart(drive(crabbing), askew) < 1e-4);
}

TEST_CASE("A payload that changes turning is a change of ground at the same moment") {
  VehicleModel loaded = plainVehicle();
  loaded.effects.payload_yaw = -0.2;
  loaded.effects.payload_time = 7.0;
  VehicleModel ground = plainVehicle();
  ground.effects.terrain_width_1 = 0.25;
  ground.effects.terrain_time_1 = 7.0;
  CHECK(apart(drive(loaded), drive(ground)) < 1e-9);
}

TEST_CASE("At one constant speed slip, deadband, rolling resistance and drag are one") {
  const std::vector<TrackCommand> straight(100, {1.0, 1.0});
  std::vector<double> ends;
  for (double EffectValues::*place :
       {&EffectValues::slip_ratio, &EffectValues::motor_deadband, &EffectValues::rolling_resistance,
        &EffectValues::quadratic_drag}) {
    VehicleModel model = plainVehicle();
    model.effects.*place = 0.08;
    ends.push_back(simulate(model, straight, 0.05, steadyEntry(model, straight.front())).back().x);
  }
  for (const double end : ends) CHECK(end == Approx(ends.front()));
}
