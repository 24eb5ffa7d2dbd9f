// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <vector>

#include "modules/simulator/core/instruments.hpp"
#include "tests/study/hide/hidden_drive.hpp"

namespace tread::blind {

/// The combined faults of all hiders of a case.
InstrumentFault faultOf(const std::vector<Hidden>& hidden);

/// The INS's pose at a time [us] without noise, from a track of poses.
Pose2 sensedPose(const std::vector<Pose2>& T_map_body, const InstrumentFault& fault, double time);

/// All measurements of a drive: 50 Hz, times since its beginning, the first at `phase` [us].
std::vector<sim::InsMeasurement> measure(const Track& track, const InstrumentFault& fault,
                                         const NoiseLevel& noise, uint64_t seed, int64_t phase);

/// Median and rms of errors.
struct ErrorSize {
  double median = 0.0;
  double rms = 0.0;
};

/// Errors of 2 s end poses over all executions of a programme.
struct EndPoseError {
  ErrorSize position;     ///< [m]
  ErrorSize yaw;          ///< [rad]
  double yaw_rate = 0.0;  ///< rms over 0.25 s, of the gyro [rad/s]
  int executions = 0;
};

/// Error of the noise-free truth on the measured executions: a lower bound.
EndPoseError oracleFloor(const HiddenDrive& drive, const InstrumentFault& fault,
                         const std::vector<sim::InsMeasurement>& measured);

/// Error of the plain vehicle on the vehicle with the effect, without noise: the gap itself.
EndPoseError hiddenGap(const HiddenDrive& with, const InstrumentFault& fault,
                       const HiddenDrive& without);

}  // namespace tread::blind
