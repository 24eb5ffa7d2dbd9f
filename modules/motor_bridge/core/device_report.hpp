// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

namespace tread::motor {

/// What the controller and the link to it are like; reasons in words, empty = good.
struct DeviceReport {
  std::string link_fault;
  std::string device_fault;
  bool stop_latched = false;  ///< the controller holds an emergency stop
};

}  // namespace tread::motor
