// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "modules/lidar_driver/sick_cola/cola_framer.hpp"

namespace tread::lidar {

/// A scan from LMDscandata. Source: SICK telegram listing 8014631, LMDscandata.
struct ColaScan {
  uint16_t device_status = 0;     ///< low byte: bit 0 error, bits 1 and 2 dirty window
  uint16_t telegram_counter = 0;  ///< of this connection
  uint32_t started_us = 0;        ///< device time of the scan, since power on
  uint32_t sent_us = 0;           ///< device time of the transmission
  uint16_t layer = 0;             ///< 0: the scan plane
  double scan_frequency = 0.0;    ///< revolutions per second [Hz]
  double angle_first = 0.0;       ///< [rad] in the device's frame, counter-clockwise from above
  double angle_step = 0.0;        ///< [rad]
  double scale = 1.0;             ///< [mm] a digit
  std::vector<float> ranges;      ///< [m], 0 = no return; channel DIST1
};

/// Parses a telegram; `problem` is why it is no scan, in words, empty if it is one.
/** `fields` is the text after "sSN LMDscandata ". Each field must be complete and have its width;
 * numbers must be possible for a scanner: up to 4000 beams within a turn, 1 to 200 turns a second.
 */
ColaScan parseColaScan(ColaDialect dialect, std::string_view fields, std::string& problem);

}  // namespace tread::lidar
