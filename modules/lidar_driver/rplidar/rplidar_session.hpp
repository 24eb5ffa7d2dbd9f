// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/config/config_reader.hpp"
#include "modules/lidar_driver/core/scan_device.hpp"

namespace tread::lidar {

/// Configuration of an RPLIDAR A1, A2 or A3.
struct RplidarConfig {
  double step = 1.0;        ///< [deg] of the beams that samples are sorted into: 0.5 or 1
  double range_max = 12.0;  ///< [m] of the model
  double latency = 0.002;   ///< [s] from a beam to the arrival of its bytes
};

/// Reads the section `rplidar`; throws ConfigError with file:line.
RplidarConfig readRplidarConfig(ConfigReader& reader);

/// The connection to an RPLIDAR in SCAN mode. Source: Slamtec LR001, protocol v2.8, section 4.
/** Start-up: stop, health, motor on, scan. Five bytes a sample, with two check bits; a turn ends
 * with the next start flag. A turn counts if each of its samples is sound, their angles run on, and
 * they cover 350 degrees. Angles are not equidistant: the nearest range in each step is the beam's.
 * A told angle is corrected by the range that was measured at it, by up to 8 degrees; that of a
 * sample without echo is not, so that it lies ahead of its neighbours'. Such a sample's angle is
 * used for nothing but the check that they run on. It keeps no clock: a turn lasts from the arrival
 * of its first sample to that of the next turn. */
class RplidarSession final : public StartedDevice {
 public:
  explicit RplidarSession(const RplidarConfig& config);

  void receive(std::string_view bytes, int64_t now) override;
  std::string shortcomings() const override {
    return "RPLIDAR: beam times (no clock of its own), equidistant angles, checksums (2 bits in a "
           "sample)";
  }

 private:
  struct Sample {
    bool start = false;
    double angle = 0.0;  ///< [deg] clockwise from ahead
    double range = 0.0;  ///< [m]; 0 = none
  };

  void forget() override;
  /// Takes an answer off the buffer; false if it needs more bytes.
  bool takeAnswer(int64_t now);
  bool takeSample(int64_t now);
  void add(const Sample& sample, int64_t now);
  void finishTurn(int64_t now);
  void sortEchoes(RangeScan& scan) const;
  void spoilTurn(const std::string& why, int64_t now);

  RplidarConfig config_;
  std::string buffer_;
  bool in_turn_ = false;
  int64_t turn_began_ = 0;
  double last_angle_ = 0.0;  ///< [deg] the largest of the turn, unwrapped
  size_t samples_ = 0;
  std::vector<Sample> echoes_;  ///< of the turn, with unwrapped angles
};

}  // namespace tread::lidar
