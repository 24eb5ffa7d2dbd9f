// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tread::lidar {

/// Bytes of a Velodyne's data packet, UDP port 2368.
inline constexpr size_t kVelodynePacket = 1206;
inline constexpr size_t kVelodyneLasers = 16;

/// One firing of all lasers: a point each in the order of firing, NaN without a return.
struct VelodyneFiring {
  std::array<std::array<float, 3>, kVelodyneLasers> points;  ///< [m] forward, left, up
};

/// A data packet of a VLP-16, Puck LITE or Puck Hi-Res.
struct VelodynePacket {
  uint32_t past_hour = 0;               ///< [us] of the first firing after the device's full hour
  std::vector<VelodyneFiring> firings;  ///< 55.296 us apart; 24, or 12 with two returns each
};

/// From one firing to the next [us].
inline constexpr double kVelodyneFiringPeriod = 55.296;

/// Whether bytes of a packet's length have a Velodyne's structure: a flag every 100 bytes, FF EE,
/// or for sensors with more lasers FF DD, FF CC, FF BB.
bool isVelodynePacket(std::string_view bytes);

/// Parses a packet; nullopt, and the reason in words, if it may be invalid.
/** Source: Velodyne VLP-16 user manual 63-9243, section 9: 12 blocks of an azimuth (0.01 degree)
 * and 32 ranges (2 mm) with reflectivity, a time stamp and two factory bytes (return mode,
 * product). Azimuths between two blocks are interpolated to each laser's own time. Of two returns
 * the last is taken, because the obstacle is behind grass and dust. */
std::optional<VelodynePacket> parseVelodynePacket(std::string_view bytes, std::string& problem);

}  // namespace tread::lidar
