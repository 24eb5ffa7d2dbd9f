// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace tread {

/// Reports this process's state to its parent by systemd's notifications (see sd_notify(3)), which
/// tread-launch reads, too. Without $NOTIFY_SOCKET it does nothing.
/** Does not use libsystemd, which blocks while the reader is stuck: motor control must not wait. */
class LifeSign {
 public:
  LifeSign();
  ~LifeSign();
  LifeSign(const LifeSign&) = delete;
  LifeSign& operator=(const LifeSign&) = delete;

  /// Call in each round of the working loop. The first call ends the start-up (READY=1); each
  /// reports that the process lives (WATCHDOG=1), at most every 0.25 s. `host` as hostNow().
  void beat(int64_t host);
  /// Reports the state in one line (STATUS=).
  void tell(const std::string& line);
  /// The process is ending (STOPPING=1).
  void stopping() { send("STOPPING=1"); }

 private:
  bool send(const std::string& lines) const;

  std::string place_;  ///< of the socket; empty = no listener
  int descriptor_ = -1;
  bool ready_ = false;
  int64_t next_ = INT64_MIN;  ///< [us]
  std::string told_;
};

/// The other end: receives from the processes whose $NOTIFY_SOCKET is its path.
class LifeSignListener {
 public:
  /// Makes the socket, for this user alone; throws std::runtime_error with one line.
  explicit LifeSignListener(std::string path);
  ~LifeSignListener();
  LifeSignListener(const LifeSignListener&) = delete;
  LifeSignListener& operator=(const LifeSignListener&) = delete;

  struct Word {
    int pid;            ///< of the sender, as reported by the kernel
    std::string lines;  ///< no line end after the last one
  };
  /// The oldest message not taken yet, without waiting.
  std::optional<Word> take();
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  int descriptor_;
};

}  // namespace tread
