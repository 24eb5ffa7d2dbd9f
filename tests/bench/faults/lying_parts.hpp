// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>
#include <utility>

#include "modules/simulator/core/car.hpp"

namespace tread::faults {

/// The robot's drive; if `swapped`, the left motor drives the right track.
class LyingDrive : public sim::Plant {
 public:
  explicit LyingDrive(std::unique_ptr<sim::Plant> drive) : drive_(std::move(drive)) {}

  void step(const sim::MotorPower& power, const sim::Ground& ground, double dt) override {
    drive_->step(swapped ? sim::MotorPower{power.right, power.left} : power, ground, dt);
  }
  Twist2 velocity() const override { return drive_->velocity(); }
  const sim::TrackDrive& left() const override { return drive_->left(); }
  const sim::TrackDrive& right() const override { return drive_->right(); }
  const sim::Battery& battery() const override { return drive_->battery(); }
  void stopBody() override { drive_->stopBody(); }

  bool swapped = false;

 private:
  std::unique_ptr<sim::Plant> drive_;
};

}  // namespace tread::faults
