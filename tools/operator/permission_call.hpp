// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/bus/bus.hpp"
#include "tools/operator/call.hpp"

namespace tread::operators {

/// Who asks, and why; both go into the log.
struct Asker {
  std::string by = "operator";
  std::string why;
};

/// Arms or disarms: repeats ARM until MOTOR shows it.
class ArmCall : public Call {
 public:
  ArmCall(Bus& bus, Asker asker, bool arm, double patience);

  CallResult step(int64_t utime) override;
  std::string words(int64_t utime) const override;

 private:
  bool shown() const;

  Bus& bus_;
  Asker asker_;
  bool arm_;
  int64_t patience_;  ///< [us]
  Latest<motor_t> motor_;
  int64_t begun_ = -1;
  int64_t next_ = 0;
  int64_t seq_ = 0;
};

/// Engages or clears the emergency stop: repeats ESTOP until MOTOR shows it.
class StopCall : public Call {
 public:
  StopCall(Bus& bus, Asker asker, bool engage, double patience);

  CallResult step(int64_t utime) override;
  std::string words(int64_t utime) const override;

 private:
  bool shown() const;

  Bus& bus_;
  Asker asker_;
  bool engage_;
  int64_t patience_;  ///< [us]
  Latest<motor_t> motor_;
  int64_t begun_ = -1;
  int64_t next_ = 0;
  int64_t seq_ = 0;
};

}  // namespace tread::operators
