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

/// The robot's processes, running from its folder until this is gone.
class RobotSession {
 public:
  virtual ~RobotSession() = default;
  /// Where they are heard and told.
  virtual Bus& bus() = 0;
  /// Lets them run on [us]; messages are handled meanwhile.
  virtual void pass(int64_t duration) = 0;
};

/// Which processes a step needs.
enum class Processes {
  kRecording,  ///< INS and motors only: the room is free, and nobody plans
  kAll
};

/// A robot's host with its ports and its time: a real one, or a simulated one in virtual time. The
/// setup does not know which.
class Site {
 public:
  virtual ~Site() = default;
  /// Addresses where a device may be; those of serial lines without a rate.
  virtual std::vector<std::string> ports() = 0;
  virtual std::unique_ptr<Link> open(const std::string& address) = 0;
  virtual int64_t now() = 0;  ///< [us]
  virtual void pass(int64_t duration) = 0;
  /// Starts the processes of a robot's folder; throws std::runtime_error, one line.
  virtual std::unique_ptr<RobotSession> start(const std::string& folder, Processes which) = 0;
};

}  // namespace tread::setup
