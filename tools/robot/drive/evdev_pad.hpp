// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/robot/drive/pad.hpp"

namespace tread::drive {

/// A device of /dev/input.
class EvdevPad : public Stick {
 public:
  /// An empty path selects the first gamepad or joystick. Throws std::runtime_error with one clear
  /// line.
  explicit EvdevPad(const std::string& path);
  ~EvdevPad() override;

  Wishes read(int64_t now) override;
  std::string name() const override;
  std::string keys() const override;

 private:
  struct Device;
  /// Null if there is none.
  static std::unique_ptr<Device> first();

  std::unique_ptr<Device> device_;
  PadState state_;
};

/// Whether /dev/input holds a gamepad or joystick that this user may read.
bool padFound();

}  // namespace tread::drive
