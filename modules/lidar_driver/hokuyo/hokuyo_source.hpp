// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "common/link/link.hpp"
#include "modules/lidar_driver/core/range_scan.hpp"

namespace tread::lidar {

/// Angles of a SCIP 2.0 device from its own parameters: AMIN, AMAX, AFRT, ARES.
/** Not from the library's aperture, which is one step too wide (n instead of n-1 steps) and ignores
 * AFRT. */
struct ScipGeometry {
  int first_step = 0;      ///< AMIN
  int last_step = 0;       ///< AMAX
  int front_step = 0;      ///< AFRT: the step that looks forward
  int steps_per_turn = 0;  ///< ARES

  double angleFirst() const { return (first_step - front_step) * angleStep(); }
  double angleStep() const { return 6.28318530717958647692 / steps_per_turn; }
  /// Share of a turn between the first and the last beam.
  double shareOfTurn() const {
    return static_cast<double>(last_step - first_step) / steps_per_turn;
  }

  /// One clear line if these numbers cannot be a device's; nothing if they can.
  std::optional<std::string> problem() const {
    if (first_step == 0 && last_step == 0 && front_step == 0 && steps_per_turn == 0)
      return "the device does not tell its parameters: it refuses or does not answer PP of SCIP "
             "2.0";
    if (steps_per_turn < 8 || steps_per_turn > 100000)
      return "the device says ARES " + std::to_string(steps_per_turn) +
             " steps a turn; allowed 8..100000";
    if (first_step < 0 || last_step <= first_step || last_step - first_step >= steps_per_turn)
      return "the device says AMIN " + std::to_string(first_step) + ", AMAX " +
             std::to_string(last_step) +
             "; a sweep must be longer than one step and shorter than a turn";
    if (front_step < 0 || front_step >= steps_per_turn)
      return "the device says AFRT " + std::to_string(front_step) + "; allowed 0..ARES-1";
    return std::nullopt;
  }
};

/// A SCIP 2.0 range finder over TCP, through mrpt::hwdrivers::CHokuyoURG in a thread of its own.
/** What that class does in 2.5.8 and how it is met:
 *  - its device clock wraps after 4 h 39 min and stamps jump by 49.5 days: switched off, we stamp
 * on arrival;
 *  - its aperture is one step too wide and ignores AFRT: recomputed (ScipGeometry);
 *  - with a peer that accepts and closes at once initialize() never returns: each connection is
 * first probed with one command of our own, and a lost one is not left to the library, which would
 * connect again without that; if it still happens, stuckFor() grows and the process ends, so that
 * its supervisor starts it again. */
class HokuyoSource : public ScanSource {
 public:
  /// `address`: tcp:host:port, see checkDeviceAddress();
  /// `latency` [s] from the last beam to the arrival of its bytes.
  HokuyoSource(const std::string& address, double latency);
  /// As end().
  ~HokuyoSource() override;
  bool end() override;  ///< waits for the library to come back, but not for ever
  std::vector<RangeScan> take(int64_t utime) override;
  Reason reason(int64_t utime, bool ground) const override;
  std::string shortcomings() const override {
    return "hokuyo: beam times (stamped on arrival), checksums (the library reads none); "
           "intensities are not read";
  }
  double stuckFor() const override;

 private:
  class Worker;
  /// Shared with its thread, which may be stuck in the library when this source goes.
  std::shared_ptr<Worker> worker_;
};

}  // namespace tread::lidar
