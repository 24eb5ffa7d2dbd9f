// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>
#include <string>

#include "tools/robot/drive/stick.hpp"
#include "tools/robot/operator/calls.hpp"

namespace tread::drive {

/// A person at the stick: MANUAL at 50 Hz, OPERATOR, and ARM at the press of a button.
/** Ends when the device is unplugged or its recording is over. A robot under manual control is then
 * disarmed and stands until it is armed again. */
class DriveCall : public operators::Call {
 public:
  DriveCall(Bus& bus, const operators::Requester& requester, std::unique_ptr<Stick> stick);

  operators::CallResult step(int64_t utime) override;
  /// One line: state, commands, battery, why.
  std::string describe(int64_t utime) const override;
  void letGo(int64_t utime) override;

 private:
  bool armed() const;
  void serveButtons(int64_t utime);
  void tell(int64_t utime);
  void sendManual(int64_t utime, const Wishes& wishes);

  Bus& bus_;
  operators::Requester requester_;
  std::unique_ptr<Stick> stick_;
  OperatorBeacon beacon_;
  Latest<motor_t> motor_;
  Wishes wishes_;
  Wishes told_;
  std::string gone_;        ///< why the stick cannot be read; empty = it can
  int64_t arms_until_ = 0;  ///< [us]
  int64_t gives_back_until_ = 0;
  int64_t next_arm_ = 0;
  int64_t next_ = 0;
  int64_t seq_ = 0;
  int64_t seq_arm_ = 0;
};

}  // namespace tread::drive
