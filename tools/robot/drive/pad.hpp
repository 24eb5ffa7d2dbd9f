// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/robot/drive/stick.hpp"

namespace tread::drive {

/// A gamepad's or joystick's state, from the events of Linux's input layer.
/** Left stick: forward and turn. A shoulder button, or a joystick's trigger, is the dead-man's
 * button; START arms, SELECT disarms, the upper or left of the four buttons gives back. */
class PadState {
 public:
  /// Range of an axis (ABS_X, ABS_Y) in counts.
  void setRange(int code, int least, int most);
  /// Initial value of an axis or button. For an axis it is not a measurement: the kernel reports 0
  /// or a stale position until the axis moves.
  void begin(int type, int code, int value);
  /// Processes an event. An axis is valid from the first event that differs from its initial value.
  void take(int type, int code, int value);
  Wishes wishes() const;

 private:
  struct Axis {
    int least = -32768;
    int most = 32767;
    std::optional<int> value;
    bool measured = false;
  };
  /// -1..1, 0 in the dead zone; NaN before the first measurement.
  static double share(const Axis& axis);
  bool anyPressed(std::initializer_list<int> buttons) const;

  std::map<int, Axis> axes_;
  std::map<int, bool> pressed_;
};

/// A recording by evemu-record, played in real time from the first read() on.
class RecordedPad : public Stick {
 public:
  /// Throws std::runtime_error with one clear line, path:line.
  explicit RecordedPad(const std::string& path);

  Wishes read(int64_t now) override;
  std::string name() const override { return "recording " + path_; }
  std::string keys() const override { return "as recorded"; }

 private:
  struct Event {
    int64_t time;  ///< [us] since the first
    int type, code, value;
  };
  void takeLine(const std::string& line, const std::string& where);

  std::string path_;
  PadState state_;
  std::vector<Event> events_;
  size_t next_ = 0;
  int64_t first_ = -1;  ///< [us] as recorded
  int64_t begun_ = -1;  ///< [us] first read()
};

}  // namespace tread::drive
