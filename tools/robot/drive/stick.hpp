// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "common/pattern/pattern.hpp"

namespace tread::drive {

/// What a person wants at one moment.
struct Wishes {
  /// [1] -1..1, turn + to the left; NaN: where the stick is has not been measured.
  double forward = std::numeric_limits<double>::quiet_NaN();
  double turn = std::numeric_limits<double>::quiet_NaN();
  bool hold = false;  ///< the dead-man's button is pressed
  bool arm = false;   ///< ... and these buttons
  bool disarm = false;
  bool give_back = false;
  bool stop = false;   ///< whoever drives: a robot that drives by itself is disarmed
  bool ended = false;  ///< nothing will come any more, in good order
};

/// Something that a person moves the robot with.
class Stick {
 public:
  virtual ~Stick() = default;
  Stick() = default;
  Stick(const Stick&) = delete;
  Stick& operator=(const Stick&) = delete;

  /// Takes in what has come by now [us]. Throws std::runtime_error with one clear line when the
  /// device is gone.
  virtual Wishes read(int64_t now) = 0;
  /// "gamepad Xbox, /dev/input/event7".
  virtual std::string name() const = 0;
  /// How to drive with it, one line.
  virtual std::string keys() const = 0;
};

/// Shares of the largest command for both tracks, -1..1; a turn keeps its radius where one of them
/// would be larger. Where forward or turn is not known, neither track is (NaN).
TrackCommand mixed(double forward, double turn);

}  // namespace tread::drive
