// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "modules/mapping/core/scan_suspicion.hpp"

namespace tread::mapping {

/// One scan as it was told.
struct ToldScan {
  const Scan& scan;
  uint64_t fingerprint;  ///< of all its ranges and points, bit for bit
};

/// Whether one range finder shows what is there: its scans against each other and against the
/// motion.
/** 1. A scan with the bits of an earlier one is a repeated one once the robot has moved.
    2. What the last good scan saw in the plane of this one is hit again.
    3. The scan is laid on earlier ones by the motion as it was told. Where much of it does not
       fit, it is laid on them mirrored, turned, and as a scan of earlier, once as if it alone were
       so and once as if all were. What then explains nearly all of the misfit with each of them,
       and hardly breaks what fitted, is the defect: points that fit both ways count for nothing
       (McNemar's test), so a corridor is no proof of anything, and moving things explain no whole
       scan. A point proves most where an earlier scan saw through its place: what that one could
       not see, behind a corner or a rise, may be new.
    A scan that decides nothing, but that most of does not fit or that fits a recent suspicion as
       well, counts for nothing and is compared with no later one for a while: else the first wrong
       scans would vouch for the others.
    On ground steeper than 0.25 rad only 1. is asked.
    Three scans of the last five make a verdict, one in the minute after another verdict. It stands
    until scans were good for a second; one that sees nothing is none of them. */
class ScanMonitor {
 public:
  /// The body's pose at a time [us], where it is known.
  using PoseAt = std::function<std::optional<Eigen::Isometry3d>(int64_t utime)>;

  ScanMonitor(const FootprintSize& robot, double height) : robot_(robot), height_(height) {}

  /// Takes the next scan. What it is suspected of: such a scan must not go into a map.
  ScanDefect update(const ToldScan& told, const PoseAt& poseAt);

  ScanDefect verdict() const { return verdict_; }
  /// The verdict in words: what was seen; empty while there is none.
  const std::string& words() const { return words_; }

 private:
  /// Bits that were seen, and how far the robot has moved since.
  struct Bits {
    uint64_t fingerprint;
    Eigen::Isometry3d T_map_body;  ///< when they came first
    int64_t utime;                 ///< [us] the same
    int repeats = 0;
    double moved = 0.0;   ///< [m] farthest
    double turned = 0.0;  ///< [rad]
  };

  /// What the scan is suspected of; nullopt if it decides nothing.
  std::optional<ScanSuspicion> suspect(const ToldScan& told, const PoseAt& poseAt);
  std::optional<ScanSuspicion> compare(const Scan& scan, const PoseAt& poseAt);
  bool repeats(const ToldScan& told);
  int64_t returnsOf(const Scan& scan) const;  ///< from elsewhere than the robot itself
  bool seesThrough(const Scan& scan) const;
  /// Whether the range finder was not good of late.
  bool doubted() const;
  /// Whether there was a verdict a moment ago.
  bool onProbation(int64_t utime) const;
  /// Whether the newest good scan is too old for a comparison.
  bool apart(int64_t utime) const;
  std::vector<const ScanView*> references(const ScanView& view) const;
  std::vector<ScanDoubt> doubts(const ScanView& view) const;
  ScanSuspicion explain(const ScanView& view, const std::vector<ScanDoubt>& doubts,
                        const PoseAt& poseAt) const;
  /// With the points that the suspicion explains; none if it is no explanation.
  ScanSuspicion weigh(ScanSuspicion suspicion, const ScanView& view,
                      const std::vector<ScanDoubt>& doubts, const PoseAt& poseAt) const;
  /// Whether the scan fits so badly, or a recent suspicion so well, that it may be a wrong one.
  bool undecided(const ScanView& view, const std::vector<ScanDoubt>& doubts,
                 const PoseAt& poseAt) const;
  /// Where the scan lies on an earlier one under a suspicion.
  std::optional<PlaneMove> placed(const ScanSuspicion& suspicion, const ScanView& view,
                                  const ScanView& reference, const PoseAt& poseAt) const;
  std::optional<PlaneMove> sensorAt(int64_t utime, const PoseAt& poseAt) const;
  void keep(ScanView view);
  void judge(const ScanSuspicion& suspicion, int64_t utime);
  std::string wordsOf(const ScanSuspicion& suspicion) const;

  FootprintSize robot_;
  double height_;  ///< [m] of the robot
  PlaneMove T_body_sensor_ = PlaneMove::Identity();
  bool level_ = true;  ///< looks about parallel to the ground
  std::deque<Bits> bits_;
  std::deque<ScanView> views_;      ///< good ones along the way
  std::optional<ScanView> newest_;  ///< the newest good one
  bool unsettled_ = false;          ///< since then, scans decided nothing
  std::deque<ScanSuspicion> recent_;
  int64_t last_suspected_ = 0;        ///< [us]
  std::optional<int64_t> convicted_;  ///< [us] when a verdict was last made or confirmed
  ScanDefect verdict_ = ScanDefect::kNone;
  std::string words_;
};

}  // namespace tread::mapping
