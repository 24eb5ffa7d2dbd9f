// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/config/config_reader.hpp"
#include "modules/lidar_driver/core/scan_device.hpp"

namespace tread::lidar {

/// Checksum of SICK's LMS 2xx telegrams: polynomial 8005, over pairs of bytes (manual, section 4).
uint16_t lmsChecksum(std::string_view bytes);
/// A telegram to the scanner: 02, address 0, length (least significant byte first), command,
/// checksum.
std::string lmsFrame(std::string_view command);

/// Configuration of a SICK LMS 200, 211, 221 or 291 on a serial line.
struct LmsConfig {
  double resolution = 1.0;  ///< [deg] from beam to beam over 180 degrees: 1 or 0.5
  double latency = 0.002;   ///< [s] from the last beam to the arrival of its first byte
};

/// Reads the section `sick_lms2xx`; throws ConfigError with file:line.
LmsConfig readLmsConfig(ConfigReader& reader);

/// The connection to a SICK LMS 2xx. Source: SICK telegrams for LMS2xx, 8007954.
/** Start-up: stream off (20 25), configuration read (74), variant set (3B), stream on (20 24).
 * Nothing is written to the memory of the scanner that wears out. Scans (B0): 13 to 16 bits of
 * range by the measuring mode in the configuration, cm or mm as given in each telegram. The device
 * has no clock: the last beam is dated at the arrival of the first byte, minus the latency; the
 * mirror turns 75 times a second. */
class LmsSession final : public StartedDevice {
 public:
  explicit LmsSession(const LmsConfig& config);

  void receive(std::string_view bytes, int64_t now) override;
  std::string shortcomings() const override {
    return "SICK LMS2xx: beam times (no clock of its own), more than 180 degrees; flags and "
           "intensities are not read";
  }

 private:
  void forget() override;
  bool cutFrame(std::string& payload, int64_t now);
  void skip(size_t bytes, int64_t now);
  void takeFrame(std::string_view payload, int64_t now);
  void takeConfiguration(std::string_view payload, int64_t now);
  void takeScan(std::string_view payload, int64_t now);
  std::string convert(std::string_view payload, RangeScan& scan) const;

  LmsConfig config_;
  std::string buffer_;
  int64_t frame_began_ = 0;        ///< when the first byte in the buffer arrived
  std::optional<int> range_bits_;  ///< of a measured value
};

}  // namespace tread::lidar
