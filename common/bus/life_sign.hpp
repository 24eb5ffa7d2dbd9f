// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace tread {

/// Tells who started this process how it is: systemd's notifications (see sd_notify(3)), which
/// tread-launch reads, too. Without $NOTIFY_SOCKET it says nothing.
/** Not libsystemd's: that waits for a reader who has stopped reading, and the motors must not. */
class LifeSign {
 public:
  LifeSign();
  ~LifeSign();
  LifeSign(const LifeSign&) = delete;
  LifeSign& operator=(const LifeSign&) = delete;

  /// The loop that does the work has done a round. The first one ends the start (READY=1); each
  /// tells that the process lives (WATCHDOG=1), at most every 0.25 s. `host` as hostNow().
  void beat(int64_t host);
  /// How it is, in one line (STATUS=).
  void tell(const std::string& line);
  /// From now on it ends (STOPPING=1).
  void stopping() { send("STOPPING=1"); }

 private:
  bool send(const std::string& lines) const;

  std::string place_;  ///< of the socket; empty = nobody listens
  int descriptor_ = -1;
  bool ready_ = false;
  int64_t next_ = INT64_MIN;  ///< [us]
  std::string told_;
};

/// The other end: hears the processes whose $NOTIFY_SOCKET is its path.
class LifeSignListener {
 public:
  /// Makes the socket, for this user alone; throws std::runtime_error with one line.
  explicit LifeSignListener(std::string path);
  ~LifeSignListener();
  LifeSignListener(const LifeSignListener&) = delete;
  LifeSignListener& operator=(const LifeSignListener&) = delete;

  struct Word {
    int pid;            ///< who said it, as the kernel knows
    std::string lines;  ///< without a line end after the last
  };
  /// The oldest that was not taken yet, without waiting.
  std::optional<Word> take();
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  int descriptor_;
};

}  // namespace tread
