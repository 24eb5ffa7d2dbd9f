// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "common/vehicle/measurement.hpp"
#include "modules/simulator/core/ins.hpp"

namespace tread::sim {

/// An INS that is late, askew or biased as the measurement part of a model file says.
/** Position, heading and yaw rate are measuredAt()'s. The rest goes with them: height, attitude and
 * velocity are as old as the position; the velocity is that of the reported point, turned so that
 * its course in the map stays right under the heading that is said. A negative latency looks ahead
 * along the arc of the last two samples, as an INS does that predicts to make up for its own age.
 */
class ModelIns final : public InsErrors {
 public:
  ModelIns(const MeasurementModel& measurement, int64_t start_utime)
      : measurement_(measurement), start_utime_(start_utime) {}

  InsInput sensed(int64_t utime, const InsInput& truth) override;

 private:
  void remember(const MotionSample& now, const InsInput& truth);
  InsInput inputAt(double time) const;

  MeasurementModel measurement_;
  int64_t start_utime_;
  std::vector<MotionSample> motion_;  ///< of the last seconds
  std::vector<InsInput> truths_;      ///< at the same moments
};

}  // namespace tread::sim
