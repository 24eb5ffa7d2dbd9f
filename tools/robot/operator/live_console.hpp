// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>
#include <string>

#include "common/bus/lcm_bus.hpp"
#include "common/seal/key_file.hpp"
#include "tools/robot/launch/running_robots.hpp"
#include "tools/robot/operator/console.hpp"

namespace tread::operators {

/// Access of operating and watching programs to a robot.
inline BusAccess accessTo(const launch::RunningRobot& robot) {
  return {robot.lcm_url, robot.here ? hostSealer(robot.key) : stationSealer(robot.key)};
}

/// An operator console over LCM, for the lifetime of its program.
class LiveConsole {
 public:
  LiveConsole(launch::RunningRobot robot, std::string name, std::string why)
      : robot_(std::move(robot)), name_(std::move(name)), why_(std::move(why)) {
    begin();
  }
  OperatorConsole& operator*() { return end_->console; }
  OperatorConsole* operator->() { return &end_->console; }
  int64_t now() const { return end_->bus.now(); }

  /// Handles received messages and sends what is due, without waiting.
  void step() {
    end_->bus.handle(0);
    end_->console.step(end_->bus.now());
    if (end_->console.worn()) begin();
  }

 private:
  struct End {
    End(const launch::RunningRobot& robot, const std::string& name, const std::string& why)
        : bus(accessTo(robot), TimeSource::kHost), console(bus, name, why) {}
    LcmBus bus;
    OperatorConsole console;
  };
  void begin() { end_ = std::make_unique<End>(robot_, name_, why_); }

  launch::RunningRobot robot_;
  std::string name_, why_;
  std::unique_ptr<End> end_;
};

}  // namespace tread::operators
