// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "modules/lidar_driver/core/range_scan.hpp"
#include "modules/lidar_driver/core/reasons.hpp"

namespace tread::lidar {

/// A range finder at the end of a byte stream: the interface for all kinds.
/** Pure: bytes and time [us] are arguments; times must not go back between calls. */
class ScanDevice {
 public:
  virtual ~ScanDevice() = default;

  /// The line was opened. Received data are discarded: no scan spans a disconnection.
  virtual void open(int64_t now) = 0;
  /// The line was closed.
  virtual void close() = 0;
  virtual void receive(std::string_view bytes, int64_t now) = 0;
  /// Bytes to send to the device now.
  virtual std::string poll(int64_t now) = 0;
  /// Bytes that stop its scanning when it is no longer read.
  virtual std::string farewell() const { return {}; }
  /// Scans completed since the last call, oldest first.
  virtual std::vector<RangeScan> take(int64_t now) = 0;
  /// Why there is no good scan.
  NotedReason reason(int64_t now) const { return reasons_.best(now); }
  /// Whether only a new connection can help.
  virtual bool lost() const { return false; }
  /// False while it has enough bytes to process.
  virtual bool hungry() const { return true; }
  /// Its limitations, as one line: clock, checksums, field of view.
  virtual std::string shortcomings() const = 0;
  /// Counters by name, in words.
  const std::map<std::string, int64_t>& counters() const { return counters_; }

 protected:
  void count(const std::string& what, int64_t times = 1) { counters_[what] += times; }
  /// Counts unused data, and keeps the cause with its remedy as the reason for missing scans.
  void refuse(const std::string& what, int64_t now, const std::string& remedy = {},
              int64_t times = 1) {
    count(what, times);
    reasons_.note(Rank::kRefused, what, now, times, remedy);
  }
  /// The same for bytes that are no telegrams.
  void skipUnreadable(const std::string& what, int64_t now, const std::string& remedy,
                      int64_t times) {
    if (times == 0) return;
    count(what, times);
    reasons_.note(Rank::kUnreadable, what, now, times, remedy);
  }
  Reasons& reasons() { return reasons_; }

 private:
  Reasons reasons_;
  std::map<std::string, int64_t> counters_;
};

/// One request of a start-up.
struct StartUpStep {
  std::string name;         ///< for messages
  std::string bytes;        ///< bytes to the device
  bool optional = false;    ///< a device that refuses or does not know it may still scan
  bool unanswered = false;  ///< it has no answer: the next one follows after the timeout
  /// Sent with the last attempt: the equivalent request of a similar device
  std::string otherwise = {};
};

/// A device that needs a step-by-step start-up, which is repeated when it falls silent.
/** Each step is sent up to three times. A device that sends no scan for a second is started up
 * again; after a start-up without an answer, or two without a scan, it is lost(). */
class StartedDevice : public ScanDevice {
 public:
  void open(int64_t now) final;
  void close() final;
  std::string poll(int64_t now) final;
  std::vector<RangeScan> take(int64_t now) final;
  bool lost() const final { return lost_; }

 protected:
  /// `patience_us`: timeout of an answer.
  StartedDevice(std::vector<StartUpStep> steps, int64_t patience_us)
      : steps_(std::move(steps)), patience_us_(patience_us) {}

  /// Discards partly received telegrams and everything learned from the device.
  virtual void forget() = 0;

  /// The step whose answer is awaited; its name is empty while the device scans or is closed.
  const StartUpStep& awaited() const;
  bool streaming() const { return step_ == steps_.size(); }
  void answered(int64_t now);
  void refused(const std::string& words, int64_t now, const std::string& remedy = {});
  /// Sets the request of a step that depends on an earlier answer.
  void setRequest(const std::string& step, std::string bytes);
  void deliver(RangeScan scan, int64_t now);
  /// Repeats its start-up for this reason.
  void restart(const std::string& reason, int64_t now, const std::string& remedy = {});
  /// What to do if no scan comes though the device streams; empty if nothing hints at a cause.
  virtual std::string remedyForSilence(int64_t /*now*/) const { return {}; }

 private:
  void begin(int64_t now);

  std::vector<StartUpStep> steps_;
  int64_t patience_us_;
  bool open_ = false;
  bool lost_ = false;
  size_t step_ = 0;
  int tries_ = 0;
  int starts_without_scan_ = 0;
  int64_t asked_at_ = 0;
  int64_t last_scan_ = 0;
  std::vector<RangeScan> scans_;
};

}  // namespace tread::lidar
