// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <tread/operator_t.hpp>

#include "common/bus/bus.hpp"
#include "common/bus/robot_clock.hpp"
#include "common/execution/operator_lease.hpp"

namespace tread {

/// nullopt for a message without a name, or with a name that does not fit in a line.
std::optional<OperatorNotice> noticeFrom(const operator_t& message);

/// Who holds the robot, according to MOTOR.
class HolderWatch {
 public:
  explicit HolderWatch(Bus& bus);
  HolderWatch(const HolderWatch&) = delete;  // the bus calls it back
  HolderWatch& operator=(const HolderWatch&) = delete;

  /// Empty = nobody; nullopt: not reported since `utime` [us] of the robot's time.
  std::optional<std::string> since(int64_t utime) const {
    return told_ > utime ? std::optional(name_) : std::nullopt;
  }

 private:
  int64_t told_ = 0;  ///< [us]
  std::string name_;
};

/// An operator program's sign of life: OPERATOR at 5 Hz, as soon as MOTOR has given the robot's
/// time.
class OperatorBeacon {
 public:
  /// `name`: the operator; programs of one name share the lease.
  OperatorBeacon(Bus& bus, std::string name);
  OperatorBeacon(const OperatorBeacon&) = delete;  // the bus calls it back
  OperatorBeacon& operator=(const OperatorBeacon&) = delete;

  /// Call about every 20 ms with the bus's time [us].
  void step(int64_t utime);
  /// Goal that this program vouches for; 0 = none.
  void standFor(int64_t goal_id) {
    goal_id_ = goal_id;
    next_ = 0;
  }
  void handOverTo(const std::string& name) { hand_over_to_ = name; }
  /// Releases the lease at an orderly end, so that no failsafe has to detect it.
  void letGo(int64_t utime);

  const std::string& name() const { return name_; }
  int64_t station() const { return station_; }
  /// utime of the newest MOTOR received [us]; 0 = none.
  int64_t seenUtime() const { return seen_utime_; }
  bool hearsRobot() const { return clock_.offset().has_value(); }
  /// The robot's time [us] at the bus's time; equal to it before the first message of the robot.
  int64_t robotTime(int64_t utime) const { return utime + clock_.offset().value_or(0); }
  /// "; clocks differ by 1.2 s, which is taken into account", or empty if they hardly differ.
  std::string clockWords() const;
  /// A warning that another program of the same operator is running, perhaps started by another
  /// person with the same account; else empty.
  std::string namesakeWords(int64_t utime) const;

 private:
  static constexpr int64_t kPeriod = 200'000;  ///< [us]
  void send(int64_t utime, int16_t allowed);

  Bus& bus_;
  std::string name_;
  int64_t station_;
  std::string hand_over_to_;
  RobotClock clock_;
  int64_t seen_utime_ = 0;
  std::optional<int64_t> namesake_;  ///< [us] last received
  int64_t goal_id_ = 0;
  int64_t next_ = 0;
  int64_t seq_ = 0;
};

}  // namespace tread
