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

/// Relates the robot's clock to the time of day.
class WallClock {
 public:
  /// From any process's HEALTH; virtual time has none.
  void set(int64_t utime, int64_t utc);
  /// "14:03:20" in the host's time zone, or "312 s" after `begin` where no clock is known.
  std::string timeOf(int64_t utime, int64_t begin) const;

 private:
  std::optional<int64_t> ahead_;  ///< [us] of UTC before the robot's clock
};

/// One line on what is new.
struct WatchLine {
  std::string text;
  bool as_model = false;  ///< nothing that was said holds any more
};

/// Compares a drive with a model while it goes on.
/** Messages come in the order of a log. A reading needs some ten seconds of INS and MOTOR without a
 * gap; where a clock jumps or a channel is silent the watch goes on behind it. */
class WatchedDrive {
 public:
  /// Throws std::runtime_error with one line for a model whose terms depend on what was before the
  /// last seconds: time, battery, heat.
  WatchedDrive(ModelDocument model, const WatchLimits& limits);

  /// What is new; mostly nothing.
  /** Throws std::runtime_error with one line where the commands are not the model's. */
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
  int64_t next_ = 0;              ///< [us] begin of the next reading
  int64_t driven_ = 0;            ///< [us] when it last drove
  double compared_ = 0.0;
};

}  // namespace tread::gap
