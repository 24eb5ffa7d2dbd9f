// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/track.hpp"
#include "modules/scan_matching/scan_matching_node.hpp"
#include "tools/lab/replay/ins_replay.hpp"
#include "tools/lab/replay/mapping_replay.hpp"
#include "tools/lab/replay/scan_closure.hpp"

namespace tread {

/// Errors of the measured motion between pairs of poses.
struct MotionErrors {
  std::vector<double> position;  ///< [m] of the second pose relative to the first
  std::vector<double> yaw;       ///< [rad] absolute values
  double normalized_position =
      /// root mean square per axis relative to the published standard deviation; 1 = consistent
      0.0;
  double normalized_yaw = 0.0;  ///< the same
  double within_two = 0.0;      ///< share of all axes within two published standard deviations
};

/// Comparison of a measured track with the true one.
struct TrackComparison {
  MotionErrors per_metre;         ///< pairs of poses at least 1 m of true path apart
  MotionErrors per_2s;            ///< at least 2 s apart
  double way = 0.0;               ///< [m] true path compared
  int64_t compared = 0;           ///< poses with position and heading whose true pose is known
  int64_t unknown = 0;            ///< poses that were published without position or heading
  int64_t sideways = 0;           ///< sideways jumps of the true track itself; no pair spans one
  double end_way = 0.0;           ///< [m] since the last new track or jump of the reference
  double end_position = 0.0;      ///< [m] error of the last pose after that path
  double end_yaw = 0.0;           ///< [rad]
  double end_position_std = 0.0;  ///< [m] as published
  double end_yaw_std = 0.0;       ///< [rad]
};

/// `truth`: the true pose at a time, nullopt if unknown. No pair spans a new track.
TrackComparison compareTracks(const std::vector<scan_matching::MatchedPose>& poses,
                              const std::function<std::optional<Pose2>(int64_t utime)>& truth);

/// Errors per metre and per 2 s: three lines of text.
std::string reportOf(const TrackComparison& comparison);

/// Output of scan matching for a recording, compared with its poses.
struct MatchingReplay {
  std::string name;
  std::vector<scan_matching::MatchedPose> poses;
  std::vector<TimedPose> truth;             ///< of the recording
  std::map<std::string, int64_t> outcomes;  ///< scans by outcome
  TrackComparison comparison;
  ScanClosure closure;
  double cpu_mean_ms = 0.0;  ///< of this process, per scan
  double cpu_max_ms = 0.0;
  std::string problem;  ///< damage of the recording in one line
};

/// Feeds a recording's scans to the matcher. The same recording gives the same result except for
/// CPU times.
MatchingReplay replayMatching(const MappingRecording& recording,
                              scan_matching::ScanMatchingConfig config);

std::string reportOf(const MatchingReplay& replay);

/// Draws both tracks; throws std::runtime_error if the file cannot be written.
void drawTracks(const MatchingReplay& replay, const std::string& path);

}  // namespace tread
