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

/// A scan with its claimed time and pose.
struct ToldScan {
  const Scan& scan;
  uint64_t fingerprint;  ///< of all its ranges and points, bit for bit
};

/// Whether one range finder measures its surroundings: compares its scans with each other and with
/// the motion.
/** 1. A scan with the bits of an earlier one is a repetition once the robot has moved.
 *   2. Objects that the last good scan saw in the plane of this one must be hit again.
 *   3. The scan is aligned with earlier ones by the claimed motion. If much of it does not fit, it
 *      is aligned mirrored, rotated, and as an earlier scan, once assuming that only this scan is
 *      wrong and once that all are. The hypothesis that then explains nearly all of the misfit
 *      with each of them, and hardly breaks what fitted, is the defect. Points that fit both ways
 *      do not count (McNemar's test), so a corridor proves nothing, and moving objects do not
 *      explain a whole scan. The strongest evidence is a point where an earlier scan saw free
 *      space: a place that was hidden from it, behind a corner or a rise, may be new.
 *   A scan that is inconclusive, but mostly does not fit, or fits a recent suspicion as well, is
 *   ignored and not used for later comparisons for a while: otherwise the first wrong scans would
 *   confirm the others.
 *   On ground steeper than 0.25 rad only 1. is tested.
 *   Three scans of the last five give a verdict, one in the minute after another verdict. It
 *   stands until scans were good for a second; a scan without returns is not good. */
class ScanMonitor {
 public:
  /// The body's pose at a time [us], where it is known.
  using PoseAt = std::function<std::optional<Eigen::Isometry3d>(int64_t utime)>;

  ScanMonitor(const FootprintSize& robot, double height) : robot_(robot), height_(height) {}

  /// Takes the next scan. Returns its suspected defect: such a scan must not go into a map.
  ScanDefect update(const ToldScan& told, const PoseAt& poseAt);

  ScanDefect verdict() const { return verdict_; }
  /// The verdict in words: the observation; empty while there is none.
  const std::string& words() const { return words_; }

 private:
  /// Bits of an earlier scan, and the robot's motion since then.
  struct Bits {
    uint64_t fingerprint;
    Eigen::Isometry3d T_map_body;  ///< when they first came
    int64_t utime;                 ///< [us] the same
    int repeats = 0;
    double moved = 0.0;   ///< [m] farthest
    double turned = 0.0;  ///< [rad]
  };

  /// The suspected defect of a scan; nullopt if it is inconclusive.
  std::optional<ScanSuspicion> suspect(const ToldScan& told, const PoseAt& poseAt);
  std::optional<ScanSuspicion> compare(const Scan& scan, const PoseAt& poseAt);
  bool repeats(const ToldScan& told);
  int64_t returnsOf(const Scan& scan) const;  ///< not from the robot itself
  bool seesThrough(const Scan& scan) const;
  /// Whether the range finder was recently not good.
  bool doubted() const;
  /// Whether there was a recent verdict.
  bool onProbation(int64_t utime) const;
  /// Whether the newest good scan is too old for a comparison.
  bool apart(int64_t utime) const;
  std::vector<const ScanView*> references(const ScanView& view) const;
  std::vector<ScanDoubt> doubts(const ScanView& view) const;
  ScanSuspicion explain(const ScanView& view, const std::vector<ScanDoubt>& doubts,
                        const PoseAt& poseAt) const;
  /// Adds the points that the suspicion explains; none if it explains too little.
  ScanSuspicion weigh(ScanSuspicion suspicion, const ScanView& view,
                      const std::vector<ScanDoubt>& doubts, const PoseAt& poseAt) const;
  /// Whether the scan fits so badly, or a recent suspicion so well, that it may be wrong.
  bool undecided(const ScanView& view, const std::vector<ScanDoubt>& doubts,
                 const PoseAt& poseAt) const;
  /// Alignment of the scan with an earlier one under a suspicion.
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
  std::deque<ScanView> views_;      ///< good ones along the path
  std::optional<ScanView> newest_;  ///< the newest good one
  bool unsettled_ = false;          ///< since then scans were inconclusive
  std::deque<ScanSuspicion> recent_;
  int64_t last_suspected_ = 0;        ///< [us]
  std::optional<int64_t> convicted_;  ///< [us] when a verdict was last given or confirmed
  ScanDefect verdict_ = ScanDefect::kNone;
  std::string words_;
};

}  // namespace tread::mapping
