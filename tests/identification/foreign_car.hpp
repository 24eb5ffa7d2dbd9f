// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cmath>
#include <random>

#include "common/soundness/core/drive.hpp"

namespace tread::gap {

/// A full-size car that the car model does not describe: four gears with a force set by the
/// throttle, air drag, and saturating tyres with longitudinal and lateral load transfer.
struct FullSizeCar {
  double v = 0.0, v_y = 0.0, omega = 0.0;  ///< [m/s], [m/s], [rad/s] of the centre of mass
  double steering = 0.0, engine = 0.0;     ///< [rad], [1]
  Pose2 pose{};

  static constexpr double kMass = 1500.0, kYawInertia = 2600.0;  // [kg], [kg m2]
  static constexpr double kFront = 1.25, kRear = 1.45;           // [m] axles from the centre
  static constexpr double kHeight = 0.55, kTrack = 1.5;          // [m]

  static double tyre(double slip, double load) {
    const double grip = 0.9 * load * (1.0 - 0.08 * (load / 4000.0 - 1.0));
    return grip * std::sin(1.5 * std::atan(9.0 * slip));
  }

  /// Both tyres of an axle; `shifted` is the load transfer from one to the other.
  static double axle(double slip, double load, double shifted) {
    const double shift = std::min(std::abs(shifted), 0.45 * load);
    return tyre(slip, 0.5 * load + shift) + tyre(slip, 0.5 * load - shift);
  }

  double push() const {
    if (engine <= 0.0) return v > 0.3 ? 9000.0 * engine : 0.0;
    const double gear = v < 6.0 ? 5200.0 : v < 12.0 ? 3600.0 : v < 19.0 ? 2400.0 : 1700.0;
    return engine * std::min(gear, 90000.0 / std::max(v, 1.0));
  }

  void step(double throttle, double angle, double dt) {
    steering += std::clamp(angle - steering, -0.6 * dt, 0.6 * dt);
    engine += (throttle - engine) * dt / 0.25;
    const double forward = (push() - 0.42 * v * v - (v > 0.1 ? 180.0 : 0.0)) / kMass;
    if (v < 2.0) {
      const double share = std::min(1.0, 20.0 * dt);
      omega += (v * std::tan(steering) / (kFront + kRear) - omega) * share;
      v_y += (omega * kRear - v_y) * share;
      v = std::max(0.0, v + forward * dt);
    } else {
      slide(forward, dt);
    }
    pose = pose * integrate({v, v_y, omega}, dt);
  }

 private:
  void slide(double forward, double dt) {
    const double length = kFront + kRear;
    const double along = kMass * forward * kHeight / length;
    const double across = kMass * v * omega * kHeight / kTrack;
    const double front = axle(steering - std::atan2(v_y + kFront * omega, v),
                              kMass * 9.81 * kRear / length - along, 0.6 * across);
    const double rear = axle(-std::atan2(v_y - kRear * omega, v),
                             kMass * 9.81 * kFront / length + along, 0.4 * across);
    const double c = std::cos(steering);
    v = std::max(0.0, v + (forward - front * std::sin(steering) / kMass + v_y * omega) * dt);
    v_y += ((front * c + rear) / kMass - v * omega) * dt;
    omega += (kFront * front * c - kRear * rear) / kYawInertia * dt;
  }
};

/// A drive with throttle (a driver holds random speeds up to `fastest`) and steering, INS at 50 Hz
/// on the rear axle.
inline Drive fullSizeDrive(double seconds, unsigned seed, double fastest = 24.0) {
  std::mt19937 random(seed);
  std::normal_distribution<double> gauss;
  const auto uniform = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  constexpr double kStep = 0.002;
  Drive drive;
  drive.name = "full-size car";
  drive.layout = VehicleLayout::kCar;
  Segment segment;
  FullSizeCar car;
  double next = 0.0;
  Command command;
  for (int i = 0; kStep * i < seconds; ++i) {
    const double time = kStep * i;
    if (time >= next) {
      const double wanted = uniform(1.0, fastest);
      const double most = std::min(0.35, 16.0 / std::max(9.0, car.v * car.v));
      command = {std::clamp(0.15 * (wanted - car.v) + 0.12, -0.6, 1.0), uniform(-most, most)};
      segment.commands.push_back({time, command});
      next = time + uniform(1.0, 4.0);
    }
    car.step(command[0], command[1], kStep);
    if (i % 10 != 0) continue;
    const Pose2 rear = car.pose * Pose2{-FullSizeCar::kRear, 0.0, 0.0};
    InsSample sample;
    sample.time = time + kStep;
    sample.T_map_body = {rear.x + 0.02 * gauss(random), rear.y + 0.02 * gauss(random),
                         rear.yaw + 0.003 * gauss(random)};
    sample.omega = car.omega + 0.01 * gauss(random);
    segment.ins.push_back(sample);
  }
  segment.end = seconds;
  for (double begin = 0.0; begin + 2.0 <= seconds; begin += 2.0)
    drive.executions.push_back({0, begin, begin + 2.0});
  drive.segments.push_back(std::move(segment));
  return drive;
}

}  // namespace tread::gap
