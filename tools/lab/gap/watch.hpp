// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "common/drive/drive_log.hpp"
#include "common/vehicle/model_document.hpp"
#include "modules/identification/core/gap_watch.hpp"

namespace tread::gap {

/// Converts the robot's clock to the time of day.
class WallClock {
 public:
  /// From any process's HEALTH; virtual time has no UTC.
  void set(int64_t utime, int64_t utc);
  /// "14:03:20" in the host's time zone, or "312 s" after `begin` if no UTC is known.
  std::string timeOf(int64_t utime, int64_t begin) const;

 private:
  std::optional<int64_t> ahead_;  ///< [us] UTC minus the robot's clock
};

/// One line on a new difference.
struct WatchLine {
  std::string text;
  bool as_model = false;  ///< all reported differences are gone
};

/// Compares a drive with a model while it runs.
/** Messages come in the order of a log. A reading needs about 10 s of INS and MOTOR without a gap;
 * after a clock jump or a silent channel the watch continues with a new reading. */
class WatchedDrive {
 public:
  /// Throws std::runtime_error with one line for a model whose terms depend on the past: time,
  /// battery, heat.
  WatchedDrive(ModelDocument model, const WatchLimits& limits);

  /// A new difference, if any.
  /** Throws std::runtime_error with one line if the commands are of another kind than the model's.
   */
  std::optional<WatchLine> take(const LogEvent& event);
  /// [s] of driving that was compared.
  double compared() const { return compared_; }

 private:
  std::optional<WatchLine> evaluate();
  void startAt(int64_t utime);
  std::string wordsOf(const NoticedGap& gap) const;

  ModelDocument model_;
  WatchLimits limits_;
  GapWatch watch_;
  WallClock clock_;
  std::deque<LogEvent> recent_;
  std::optional<int64_t> begin_;  ///< [us] of the first message
  int64_t newest_ = 0;            ///< [us]
  int64_t next_ = 0;              ///< [us] start of the next reading
  int64_t driven_ = 0;            ///< [us] last time of driving
  double compared_ = 0.0;
};

}  // namespace tread::gap
