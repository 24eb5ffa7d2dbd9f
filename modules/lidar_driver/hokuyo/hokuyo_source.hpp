// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>

#include "common/link/address.hpp"
#include "modules/lidar_driver/core/scan_source.hpp"

namespace tread::lidar {

/// A range finder's address in parts; throws std::invalid_argument with one clear line if it is not
/// tcp:host:port.
LinkAddress rangeFinderAddress(const std::string& text);

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
  /// `address` as for rangeFinderAddress();
  /// `latency` [s] from the last beam to the arrival of its bytes.
  HokuyoSource(const std::string& address, double latency);
  /// As end().
  ~HokuyoSource() override;
  bool end() override;  ///< waits for the library to come back, but not for ever
  std::vector<RangeScan> take(int64_t utime) override;
  std::string problem() const override;
  double stuckFor() const override;

 private:
  class Worker;
  /// Shared with its thread, which may be stuck in the library when this source goes.
  std::shared_ptr<Worker> worker_;
};

}  // namespace tread::lidar
