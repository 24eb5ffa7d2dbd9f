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

/// One firing of all lasers: a point each in the order of firing, NaN where nothing came back.
struct VelodyneFiring {
  std::array<std::array<float, 3>, kVelodyneLasers> points;  ///< [m] forward, left, up
};

/// A data packet of a VLP-16, Puck LITE or Puck Hi-Res.
struct VelodynePacket {
  uint32_t past_hour = 0;               ///< [us] of the first firing past the device's full hour
  std::vector<VelodyneFiring> firings;  ///< 55.296 us apart; 24, or 12 with two returns each
};

/// From one firing to the next [us].
inline constexpr double kVelodyneFiringPeriod = 55.296;

/// True if bytes of a packet's length are built like a Velodyne's: each 100 bytes a flag, FF EE, or
/// of sensors with more lasers FF DD, FF CC, FF BB.
bool isVelodynePacket(std::string_view bytes);

/// Takes a packet apart; nothing, and why in words, for one that cannot be vouched for.
/** Source: Velodyne VLP-16 user manual 63-9243, section 9: 12 blocks of an azimuth (0.01 degree)
 * and 32 ranges (2 mm) with reflectivity, a time stamp and two factory bytes (return mode,
 * product). Azimuths between two blocks are interpolated to each laser's own time. Of two returns
 * the last is taken: behind grass and dust stands what stops a robot. */
std::optional<VelodynePacket> parseVelodynePacket(std::string_view bytes, std::string& problem);

}  // namespace tread::lidar
