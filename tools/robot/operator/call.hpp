// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>

namespace tread::operators {

/// What came of a call to the robot.
enum class CallResult { kGoesOn, kDone, kRefused };

/// Something that the operator asks of the robot, repeated until the robot shows that it did it.
/** It listens to its bus and so must live until the bus is no longer handled. */
class Call {
 public:
  virtual ~Call() = default;
  Call() = default;
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  /// Call every 20 ms or so. Sends what is due and looks at what came.
  virtual CallResult step(int64_t utime) = 0;
  /// What to tell the operator now; the outcome in words once the call has ended.
  virtual std::string words(int64_t utime) const = 0;
  /// The operator has lost patience: takes back what must not go on.
  virtual void cancel(int64_t /*utime*/) {}
};

}  // namespace tread::operators
