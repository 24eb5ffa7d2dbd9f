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
 *   - standard, precise: 3.9. GPS SPS Performance Standard (4th ed., 2008): 7.8 m at 95 %, all
 *     ages of data;
 *   - differential, augmented: 1.0. A quarter of it, the ratio that gpsd uses between the two
 *     (15 m : 3.75 m);
 *   - RTK fixed: 0.02, float: 0.4. Common specifications of dual-frequency receivers: 1 cm + 1 ppm
 *     of the baseline, here 10 km; float 0.4 m;
 *   - estimated (dead reckoning): unknown, because it grows with time.
 * HDOP covers both horizontal axes, so each has 1/sqrt(2) of it; the vertical one is assumed twice
 * the horizontal. */
Eigen::Vector3d positionStd(const Gga& gga);

/// The content of a sentence in the common form of all devices; ZDA contains only the date.
/** GGA has priority over RMC, and VTG over RMC, because its km/h have a finer resolution than
 * knots. A heading alone (HDT, THS) comes from two antennas or another source of the device; PASHR
 * is inertial. */
DeviceEpoch partOf(const NmeaSentence& sentence, const InsConfig& config);

}  // namespace tread::ins
