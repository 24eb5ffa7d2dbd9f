// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "modules/mapping/core/scan_view.hpp"

namespace tread::mapping {

/// How the scans of a range finder can be wrong although they come.
enum class ScanDefect {
  kNone,
  kEmpty,        ///< no beam measures anything
  kFrozen,       ///< repeated bit for bit while the robot moves
  kSeesThrough,  ///< nothing where something stood a moment ago
  kMirrored,
  kTurned,
  kDelayed  ///< an old scan under a new time
};

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
       scan.
    Three scans of the last five make a verdict. It stands until scans were good for a second. It
    cannot judge a range finder that sees nothing, and calls none good. */
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
  /// A suspicion with what it rests on.
  struct Suspicion {
    ScanDefect defect = ScanDefect::kNone;
    double gain = 0.0;    ///< points that it explains more than it breaks
    double angle = 0.0;   ///< [rad] turned by
    double delay = 0.0;   ///< [s]
    bool always = false;  ///< earlier scans were wrong in the same way
  };
  /// An earlier scan that much of the new one does not fit.
  struct Doubt {
    const ScanView* reference;
    std::vector<Eigen::Vector2d> missed, matched;  ///< points of the new one
  };
  /// Bits that were seen, and how far the robot has moved since.
  struct Bits {
    uint64_t fingerprint;
    Eigen::Isometry3d T_map_body;  ///< when they came first
    int64_t utime;                 ///< [us] the same
    int repeats = 0;
    double moved = 0.0;   ///< [m] farthest
    double turned = 0.0;  ///< [rad]
  };

  Suspicion suspect(const ToldScan& told, const PoseAt& poseAt);
  bool repeats(const ToldScan& told);
  bool seesThrough(const Scan& scan) const;
  std::vector<const ScanView*> references(const ScanView& view) const;
  Suspicion explain(const ScanView& view, const PoseAt& poseAt) const;
  std::vector<Doubt> doubts(const ScanView& view) const;
  /// All that a scan may be suspected of, the simplest first.
  static std::vector<Suspicion> hypotheses();
  /// Where the scan lies on an earlier one under a suspicion.
  std::optional<PlaneMove> placed(const Suspicion& suspicion, const ScanView& view,
                                  const ScanView& reference, const PoseAt& poseAt) const;
  std::optional<PlaneMove> sensorAt(int64_t utime, const PoseAt& poseAt) const;
  void keep(ScanView view);
  static bool agree(const Suspicion& a, const Suspicion& b);
  void judge(const Suspicion& suspicion, int64_t utime);
  std::string describe(const Suspicion& suspicion) const;

  FootprintSize robot_;
  double height_;  ///< [m] of the robot
  PlaneMove T_body_sensor_ = PlaneMove::Identity();
  bool level_ = true;  ///< looks about parallel to the ground
  std::deque<Bits> bits_;
  std::deque<ScanView> views_;      ///< good ones along the way
  std::optional<ScanView> newest_;  ///< the newest good one
  std::deque<Suspicion> recent_;
  int64_t last_suspected_ = 0;  ///< [us]
  ScanDefect verdict_ = ScanDefect::kNone;
  std::string words_;
};

}  // namespace tread::mapping
