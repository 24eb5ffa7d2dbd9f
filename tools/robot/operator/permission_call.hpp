// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/bus/bus.hpp"
#include "tools/robot/operator/call.hpp"

namespace tread::operators {

/// Who asks, and why; both go into the log.
struct Asker {
  std::string by = "operator";
  std::string why;
};

/// A request to the motor bridge, repeated until MOTOR shows that it was served.
class PermissionCall : public Call {
 public:
  CallResult step(int64_t utime) override;
  std::string words(int64_t utime) const override;

 protected:
  /// `patience` [s] for which it is repeated; `repeat` [us] between two.
  PermissionCall(Bus& bus, double patience, int64_t repeat);

  virtual void send(Bus& bus, int64_t utime, int64_t seq) = 0;
  /// Whether a bridge in this state (motor_t::STATE_*) has served the request.
  virtual bool served(int16_t bridge_state) const = 0;
  virtual std::string wordsWhenServed() const = 0;
  virtual std::string wordsWhenNot() const = 0;

 private:
  bool shown(int64_t utime) const;

  Bus& bus_;
  int64_t patience_;  ///< [us]
  int64_t repeat_;    ///< [us]
  Latest<motor_t> motor_;
  int64_t begun_ = -1;
  int64_t next_ = 0;
  int64_t seq_ = 0;
};

/// Arms or disarms.
class ArmCall : public PermissionCall {
 public:
  ArmCall(Bus& bus, Asker asker, bool arm, double patience);

 private:
  void send(Bus& bus, int64_t utime, int64_t seq) override;
  bool served(int16_t bridge_state) const override;
  std::string wordsWhenServed() const override;
  std::string wordsWhenNot() const override;

  Asker asker_;
  bool arm_;
};

/// Engages or clears the emergency stop.
class StopCall : public PermissionCall {
 public:
  StopCall(Bus& bus, Asker asker, bool engage, double patience);

 private:
  void send(Bus& bus, int64_t utime, int64_t seq) override;
  bool served(int16_t bridge_state) const override;
  std::string wordsWhenServed() const override;
  std::string wordsWhenNot() const override;

  Asker asker_;
  bool engage_;
};

}  // namespace tread::operators
