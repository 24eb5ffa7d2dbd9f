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
  double step = 1.0;        ///< [deg] width of the beams into which samples are sorted: 0.5 or 1
  double range_max = 12.0;  ///< [m] of the model
  double latency = 0.002;   ///< [s] from a beam to the arrival of its bytes
};

/// Reads the section `rplidar`; throws ConfigError with file:line.
RplidarConfig readRplidarConfig(ConfigReader& reader);

/// The connection to an RPLIDAR in SCAN mode. Source: Slamtec LR001, protocol v2.8, section 4.
/** Start-up: stop, health, motor on, scan. Five bytes per sample, with two check bits; a revolution
 * ends at the next start flag. It is used if all its samples are valid, their angles increase, and
 * they cover 350 degrees. Angles are not equidistant: the nearest range in each step is the
 * beam's. A reported angle is corrected as a function of its range, by up to 8 degrees; the angle
 * of a sample without echo is not, so that it is ahead of its neighbours'. Such an angle is used
 * only to check that angles increase. The device has no clock: a revolution lasts from the arrival
 * of its first sample to that of the next revolution's. */
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
    double angle = 0.0;  ///< [deg] clockwise from forward
    double range = 0.0;  ///< [m]; 0 = none
  };

  void forget() override;
  /// Takes an answer from the buffer; false if it is incomplete.
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
  double last_angle_ = 0.0;  ///< [deg] the largest of the revolution, unwrapped
  size_t samples_ = 0;
  std::vector<Sample> echoes_;  ///< of the revolution, with unwrapped angles
};

}  // namespace tread::lidar
