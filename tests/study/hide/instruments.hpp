// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <vector>

#include "modules/simulator/core/instruments.hpp"
#include "tests/study/hide/hidden_drive.hpp"

namespace tread::blind {

/// The faults of all hiders of a case together.
InstrumentFault faultOf(const std::vector<Hidden>& hidden);

/// The pose that the INS would tell at a time [us], noise apart, out of a track of poses.
Pose2 sensedPose(const std::vector<Pose2>& T_map_body, const InstrumentFault& fault, double time);

/// All measurements of a drive: 50 Hz, times since its beginning, the first at `phase` [us].
std::vector<sim::InsMeasurement> measure(const Track& track, const InstrumentFault& fault,
                                         const NoiseLevel& noise, uint64_t seed, int64_t phase);

/// Two numbers that say how large errors are.
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

/// What the truth without any noise still misses of the measured executions: nobody can do better.
EndPoseError oracleFloor(const HiddenDrive& drive, const InstrumentFault& fault,
                         const std::vector<sim::InsMeasurement>& measured);

/// What the plain vehicle misses of the vehicle with the effect, noise apart: the gap itself.
EndPoseError hiddenGap(const HiddenDrive& with, const InstrumentFault& fault,
                       const HiddenDrive& without);

}  // namespace tread::blind
