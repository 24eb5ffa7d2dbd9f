// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "common/pattern/pattern.hpp"

namespace tread::drive {

/// State of the controls at one time.
struct Wishes {
  /// [1] -1..1, turn + to the left; NaN: the stick has not been measured.
  double forward = std::numeric_limits<double>::quiet_NaN();
  double turn = std::numeric_limits<double>::quiet_NaN();
  bool hold = false;  ///< the dead-man's button is pressed
  bool arm = false;   ///< this and the next three: a button is pressed
  bool disarm = false;
  bool give_back = false;
  bool stop = false;   ///< also disarms a robot that drives by itself
  bool ended = false;  ///< end of the recording, without an error
};

/// A device for manual control.
class Stick {
 public:
  virtual ~Stick() = default;
  Stick() = default;
  Stick(const Stick&) = delete;
  Stick& operator=(const Stick&) = delete;

  /// Reads the events that have arrived by `now` [us]. Throws std::runtime_error with one clear
  /// line when the device is gone.
  virtual Wishes read(int64_t now) = 0;
  /// "gamepad Xbox, /dev/input/event7".
  virtual std::string name() const = 0;
  /// How to drive with it, one line.
  virtual std::string keys() const = 0;
};

/// Commands of both tracks as shares of the largest, -1..1. Where one would exceed 1 both are
/// scaled, which keeps the turn radius. Both are NaN if forward or turn is NaN.
TrackCommand mixed(double forward, double turn);

}  // namespace tread::drive
