// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <Eigen/Core>

#include "modules/ins_driver/core/device_epoch.hpp"
#include "modules/ins_driver/nmea/nmea_parser.hpp"

namespace tread::ins {

/// Standard deviation of a GGA position along east, north, up [m]; NaN without HDOP or for an
/// estimated fix.
/** Range error times dilution of precision. Range errors by fix quality [m, one sigma]:
    - standard, precise: 3.9. GPS SPS Performance Standard (4th ed., 2008): 7.8 m at 95 %, all ages
   of data;
    - differential, augmented: 1.0. A quarter of it, the ratio that gpsd uses between the two (15
   : 3.75 m);
    - RTK fixed: 0.02, float: 0.4. What makers of dual-frequency receivers commonly promise: 1 cm +
   1 ppm of the base line, here 10 km; float 0.4 m;
    - estimated (dead reckoning): unknown, because it grows with time.
    HDOP holds both horizontal axes, so each has 1/sqrt(2) of it; the vertical one is taken as twice
   the horizontal. */
Eigen::Vector3d positionStd(const Gga& gga);

/// What a sentence says in the words that all devices share; ZDA says nothing but the date.
/** GGA counts before RMC, VTG before RMC: it also tells km/h, which are finer than knots. A heading
   alone (HDT, THS) is one of two antennas or of whatever the device has; PASHR is inertial. */
DeviceEpoch partOf(const NmeaSentence& sentence, const InsConfig& config);

}  // namespace tread::ins
