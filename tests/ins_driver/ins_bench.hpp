// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <catch2/catch.hpp>

#include <string>
#include <vector>

#include "modules/ins_driver/nmea/nmea_ins.hpp"
#include "tests/helpers.hpp"
#include "tests/ins_driver/nmea_lines.hpp"

namespace tread::ins {

using tread::testing::kDeg;
using tread::testing::kSecond;
inline constexpr double kNoon = 43200.0;

/// A device on a line, the core behind it, and its output.
class Bench {
 public:
  explicit Bench(const InsConfig& config = {}) : ins(config) {}

  /// Bytes received at this time; then the line is quiet.
  void at(int64_t utime, const std::string& bytes) {
    collect(utime);
    ins.push(bytes, utime);
    collect(utime + 15'000);
  }
  const InsEstimate& last() const {
    REQUIRE_FALSE(out.empty());
    return out.back();
  }
  YawPitchRoll angles() const { return yawPitchRoll(last().R_map_body); }

  NmeaIns ins;
  std::vector<InsEstimate> out;

 private:
  void collect(int64_t now) {
    while (const auto estimate = ins.next(now)) out.push_back(*estimate);
  }
};

inline InsConfig withOrigin() {
  InsConfig config;
  config.origin = GeoOrigin{{kStartLatitude * kDeg, kStartLongitude * kDeg}, 221.0, 0.0};
  return config;
}

inline std::string hdt(double heading) {
  return line("GPHDT," + std::to_string(heading) + ",T");
}

}  // namespace tread::ins
