// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

namespace tread::launch {

/// The lock of a run folder: held by tread-launch and by the supervisor that it starts.
/** Two locks on one file. The one of flock(2) is passed on to the supervisor and is free only when
 * both have gone, also by SIGKILL; the one of fcntl(2) is tread-launch's own and tells its pid. */
class RunLock {
 public:
  /// Takes the lock; throws std::runtime_error with one line if it is held or cannot be made.
  explicit RunLock(const std::string& path);
  ~RunLock();
  RunLock(const RunLock&) = delete;
  RunLock& operator=(const RunLock&) = delete;

  int descriptor() const { return descriptor_; }

  static bool isHeld(const std::string& path);
  /// The pid of the tread-launch that holds it; 0 if none does.
  static int owner(const std::string& path);

 private:
  int descriptor_ = -1;
};

}  // namespace tread::launch
