// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/bus/bus.hpp"
#include "common/link/link.hpp"

namespace tread::setup {

/// The robot's processes, running from its folder for the lifetime of this object.
class RobotSession {
 public:
  virtual ~RobotSession() = default;
  /// The bus of the processes.
  virtual Bus& bus() = 0;
  /// Lets them run for `duration` [us] and handles messages meanwhile.
  virtual void pass(int64_t duration) = 0;
};

/// Processes that a step needs.
enum class Processes {
  kRecording,  ///< only INS and motors: the room is free, no planning
  kAll
};

/// A robot's host with its ports and time: real, or simulated in virtual time. The setup code is
/// the same for both.
class Site {
 public:
  virtual ~Site() = default;
  /// Possible device addresses; those of serial lines without baud rate.
  virtual std::vector<std::string> ports() = 0;
  virtual std::unique_ptr<Link> open(const std::string& address) = 0;
  virtual int64_t now() = 0;  ///< [us]
  virtual void pass(int64_t duration) = 0;
  /// Starts the processes of a robot's folder; throws std::runtime_error, one line.
  virtual std::unique_ptr<RobotSession> start(const std::string& folder, Processes which) = 0;
};

}  // namespace tread::setup
