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

/// A range finder at the end of a byte stream: the door for all kinds.
/** Pure: bytes and time [us] are arguments; times of all calls must not go back. */
class ScanDevice {
 public:
  virtual ~ScanDevice() = default;

  /// The line is up. What was received before is forgotten: no scan outlives a disconnect.
  virtual void open(int64_t now) = 0;
  /// The line is down.
  virtual void close() = 0;
  virtual void receive(std::string_view bytes, int64_t now) = 0;
  /// Bytes that the device is to get now.
  virtual std::string poll(int64_t now) = 0;
  /// Bytes that end its scanning, for when nobody reads it any longer.
  virtual std::string farewell() const { return {}; }
  /// Scans that were completed since the last call, oldest first.
  virtual std::vector<RangeScan> take(int64_t now) = 0;
  /// Why no good scan comes.
  NotedReason reason(int64_t now) const { return reasons_.best(now); }
  /// True if only a new connection can help.
  virtual bool lost() const { return false; }
  /// False while it has enough bytes to work on.
  virtual bool hungry() const { return true; }
  /// What it cannot promise, as one line: clock, checksums, field of view.
  virtual std::string shortcomings() const = 0;
  /// What was counted, by its name in words.
  const std::map<std::string, int64_t>& counters() const { return counters_; }

 protected:
  void count(const std::string& what, int64_t times = 1) { counters_[what] += times; }
  /// Counts what was not used, and keeps it with its remedy as the reason why no scan comes.
  void refuse(const std::string& what, int64_t now, const std::string& remedy = {},
              int64_t times = 1) {
    count(what, times);
    reasons_.note(Rank::kRefused, what, now, times, remedy);
  }
  /// The same of bytes that are no telegrams.
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
  std::string name;            ///< for messages
  std::string bytes;           ///< what the device gets
  bool optional = false;       ///< a device that refuses it or does not know it may still scan
  bool unanswered = false;     ///< it has no answer: the next one follows after the patience
  std::string otherwise = {};  ///< sent with the last try: the same in words of a like device
};

/// A device that is asked step by step to scan, and again when it falls silent.
/** Each step is sent up to three times. A device that sends no scan for a second is started up
 * anew, and after a start-up without an answer or two without a scan it is lost(). */
class StartedDevice : public ScanDevice {
 public:
  void open(int64_t now) final;
  void close() final;
  std::string poll(int64_t now) final;
  std::vector<RangeScan> take(int64_t now) final;
  bool lost() const final { return lost_; }

 protected:
  /// `patience_us`: how long an answer may take.
  StartedDevice(std::vector<StartUpStep> steps, int64_t patience_us)
      : steps_(std::move(steps)), patience_us_(patience_us) {}

  /// Drops half received telegrams and everything learned from the device.
  virtual void forget() = 0;

  /// The step whose answer is awaited; its name is empty when the device scans or is closed.
  const StartUpStep& awaited() const;
  bool streaming() const { return step_ == steps_.size(); }
  void answered(int64_t now);
  void refused(const std::string& words, int64_t now, const std::string& remedy = {});
  /// Of a step whose request depends on an answer before it.
  void setRequest(const std::string& step, std::string bytes);
  void deliver(RangeScan scan, int64_t now);
  /// Starts it up anew for this reason.
  void restart(const std::string& reason, int64_t now, const std::string& remedy = {});
  /// What to do if no scan comes though the device streams; empty if nothing hints at a cause.
  virtual std::string remedyForSilence() const { return {}; }

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
