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

namespace tread::logger {

/// Moves FILE.0 to FILE.1, FILE.1 to FILE.2 and so on, up to the first gap, so that FILE.0 is free.
/// A file that would become FILE.<keep> is removed. Throws std::filesystem::filesystem_error.
void makeRoomForLog(const std::string& file, int keep);

/// Removes the oldest of FILE.1, FILE.2 and so on until their sizes sum to at most `bytes`.
void keepWithin(const std::string& file, int64_t bytes);

/// Output of a recorder, and its limits.
struct RecorderSettings {
  std::string file;  ///< FILE.0 is the newest, FILE.1 the one before
  std::string lcm_url;
  int keep = 20;                ///< files
  int64_t split = 200'000'000;  ///< [bytes] of a file
  int64_t quota = 0;            ///< [bytes] of all files together; 0 = no limit but `keep`
};

/// Records every message of a bus as LCM event logs, rotated.
/** lcm-logger 1.3.1 queues 30 messages while a busy host delays it and silently drops the rest; the
 * queue here holds 100 000. A full disk does not end the recording: HEALTH reports it and the
 * number of lost messages, and a new file begins when there is space. */
class Recorder {
 public:
  /// Throws std::runtime_error with one clear line if LCM or the file cannot be used.
  explicit Recorder(const RecorderSettings& settings);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Runs until `stop`, then writes the messages that have arrived.
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
  std::string trouble_;  ///< why nothing is recorded now; empty: recording
  LcmBus bus_;           ///< only for HEALTH and signs of life
  HealthReporter health_;
};

}  // namespace tread::logger
