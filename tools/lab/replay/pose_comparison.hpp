// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "tools/lab/replay/learner_report.hpp"

namespace tread::replay {

/// Sizes of changes of the patterns' ends, summed over patterns.
struct EndChanges {
  double position = 0.0;  ///< [m]
  double yaw = 0.0;       ///< [rad]
};

/// Results of the learner for one drive with the INS's poses and with another channel's.
struct PoseComparison {
  std::string channel;
  int64_t learned_with_ins = 0;    ///< executions
  int64_t learned_with_other = 0;  ///< the same
  ErrorSummary errors_with_ins;    ///< of predictions, measured by the poses that it learned from
  ErrorSummary errors_with_other;  ///< the same
  size_t patterns = 0;
  EndChanges corrected;  ///< from the shipped set to the last one, with the INS's poses
  EndChanges apart;      ///< between the last sets of the two
  /// [m] root mean square difference of the measured ends that both have
  double measured_apart = 0.0;
  double measured_yaw_apart = 0.0;  ///< [rad] the same
};

/// Replays the executions of a log twice, from an empty store.
/** Throws std::runtime_error with one clear line if the log has no poses on `channel`. */
PoseComparison comparePoses(const std::string& name, const std::vector<LogEvent>& events,
                            const std::string& channel, const learner::LearnerNodeConfig& config);

std::string reportOf(const PoseComparison& comparison);

}  // namespace tread::replay
