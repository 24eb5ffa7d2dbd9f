// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>

#include "common/geometry/se2.hpp"
#include "modules/ins_driver/core/ins_source.hpp"

namespace tread::ins {

inline constexpr double kRadPerDeg = kPi / 180.0;

/// The little-endian number at an offset of a message (hosts are little-endian); 0 beyond its end.
template <class Number>
Number numberAt(std::string_view bytes, size_t offset) {
  Number number{};
  if (offset + sizeof number <= bytes.size())
    std::memcpy(&number, bytes.data() + offset, sizeof number);
  return number;
}

/// A point from degrees; nullopt if it is not on Earth.
inline std::optional<GeoPoint> pointFromDegrees(double latitude, double longitude) {
  if (!(std::abs(latitude) <= 90.0) || !(std::abs(longitude) <= 360.0)) return std::nullopt;
  return GeoPoint{latitude * kRadPerDeg, wrapAngle(longitude * kRadPerDeg)};
}

/// Yaw counter-clockwise from east of an angle clockwise from north [deg]; nullopt if it is
/// invalid.
inline std::optional<double> yawFromAzimuth(double degrees) {
  if (!(std::abs(degrees) <= 360.0)) return std::nullopt;
  return wrapAngle(kPi / 2.0 - degrees * kRadPerDeg);
}

/// Whether a number is finite and its magnitude at most `limit`.
inline bool within(double number, double limit) {
  return std::abs(number) <= limit;
}

}  // namespace tread::ins
