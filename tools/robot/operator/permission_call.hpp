// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "common/bus/bus.hpp"

namespace tread::operators {

/// What came of a call to the robot.
enum class CallResult { kPending, kDone, kRefused };

/// Something that the operator asks of the robot, repeated until the robot shows that it did it.
/** It listens to its bus and so must live until the bus is no longer handled. */
class Call {
 public:
  virtual ~Call() = default;
  Call() = default;
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  /// Call every 20 ms or so. Sends what is due and looks at what came.
  virtual CallResult step(int64_t utime) = 0;
  /// What to tell the operator now; the outcome in words once the call has ended.
  virtual std::string describe(int64_t utime) const = 0;
  /// The operator has lost patience: takes back what must not go on.
  virtual void cancel(int64_t /*utime*/) {}
};

/// Who asks, and why; both go into the log.
struct Requester {
  std::string by = "operator";
  std::string why;
};

/// A request to the motor bridge, repeated until MOTOR shows that it was served.
class PermissionCall : public Call {
 public:
  CallResult step(int64_t utime) override;
  std::string describe(int64_t utime) const override;

 protected:
  struct Request {
    std::function<void(int64_t utime, int64_t seq)> send;
    /// Whether a bridge in this state (motor_t::STATE_*) has served it.
    std::function<bool(int16_t bridge_state)> served;
    std::string text_if_served;
    std::string text_if_not;
    int64_t repeat;  ///< [us]
  };
  /// `patience` [s] for which it is repeated.
  PermissionCall(Bus& bus, double patience, Request request);

 private:
  bool shown(int64_t utime) const;

  Request request_;
  int64_t patience_;  ///< [us]
  Latest<motor_t> motor_;
  std::optional<int64_t> started_;  ///< [us]
  int64_t next_ = 0;                ///< [us]
  int64_t seq_ = 0;
};

/// Arms or disarms.
class ArmCall : public PermissionCall {
 public:
  ArmCall(Bus& bus, const Requester& requester, bool arm, double patience);
};

/// Engages or clears the emergency stop.
class StopCall : public PermissionCall {
 public:
  StopCall(Bus& bus, const Requester& requester, bool engage, double patience);
};

}  // namespace tread::operators
