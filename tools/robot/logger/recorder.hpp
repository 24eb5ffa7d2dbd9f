// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "common/bus/lcm_bus.hpp"
#include "common/log/event_log.hpp"

namespace lcm {
class LCM;
}

namespace tread::launch {

/// Moves FILE.0 to FILE.1, FILE.1 to FILE.2 and so on, up to the first gap, so that FILE.0 is free;
/// what would become FILE.<keep> is removed. Throws std::filesystem::filesystem_error.
void makeRoomForLog(const std::string& file, int keep);

/// Removes the oldest of FILE.1, FILE.2 and so on until they have at most so many bytes together.
void keepWithin(const std::string& file, int64_t bytes);

/// Where a recorder writes, and how much it keeps.
struct RecorderSettings {
  std::string file;  ///< FILE.0 is the newest, FILE.1 the one before
  std::string lcm_url;
  int keep = 20;                ///< files
  int64_t split = 200'000'000;  ///< [bytes] of a file
  int64_t quota = 0;            ///< [bytes] of all files together; 0 = no limit but `keep`
};

/// Records every message of a bus as LCM event logs, rotated.
/** lcm-logger 1.3.1 keeps 30 messages while it waits for a busy host's processor and loses the rest
 * without a word; here a hundred thousand wait. A full disk ends no recording: HEALTH tells it and
 * what is lost, and a new file begins when there is room. */
class Recorder {
 public:
  /// Throws std::runtime_error with one clear line if LCM or the file cannot be used.
  explicit Recorder(const RecorderSettings& settings);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Until `stop`; then what has arrived is written, too.
  void run(const std::atomic<bool>& stop);

 private:
  void record(const std::string& channel, const uint8_t* bytes, size_t size);
  void begin();
  void maintain(int64_t now);
  void giveUp(const std::string& why);
  void reportHealth(int64_t now);
  int64_t freeBytes() const;

  RecorderSettings settings_;
  std::unique_ptr<lcm::LCM> lcm_;
  std::unique_ptr<LogWriter> writer_;  ///< null while the disk is full
  int64_t written_ = 0;                ///< [bytes] in this file
  int64_t next_maintenance_ = 0;       ///< [us]
  int64_t next_try_ = 0;               ///< [us]
  int64_t lost_ = 0;
  int64_t recorded_ = 0;
  std::string trouble_;  ///< why nothing is recorded now
  LcmBus bus_;           ///< for HEALTH and life signs alone
  HealthReporter health_;
};

}  // namespace tread::launch
