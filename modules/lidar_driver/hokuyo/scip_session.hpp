// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/config/config_reader.hpp"
#include "modules/lidar_driver/core/scan_device.hpp"
#include "modules/lidar_driver/core/tick_clock.hpp"

namespace tread::lidar {

/// Configuration of a Hokuyo range finder.
struct ScipConfig {
  bool short_ranges = false;  ///< two characters per range, up to 4.094 m: for slow serial lines
  double latency = 0.002;     ///< [s] from the last beam to the arrival of the first byte
};

/// Reads the section `hokuyo`; throws ConfigError with file:line.
ScipConfig readScipConfig(ConfigReader& reader);

/// Properties of a SCIP 2.0 device, from its answer to PP.
struct ScipGeometry {
  int first_step = 0;          ///< AMIN
  int last_step = 0;           ///< AMAX
  int front_step = 0;          ///< AFRT: the forward step
  int steps_per_turn = 0;      ///< ARES
  int range_min_mm = 20;       ///< DMIN
  int range_max_mm = 30000;    ///< DMAX
  int turns_per_minute = 600;  ///< SCAN

  double angleFirst() const { return (first_step - front_step) * angleStep(); }
  double angleStep() const { return 6.28318530717958647692 / steps_per_turn; }
  size_t beams() const { return static_cast<size_t>(last_step - first_step + 1); }
  /// From the first to the last beam [us].
  int64_t sweep() const {
    return int64_t{60'000'000} * (last_step - first_step) / steps_per_turn / turns_per_minute;
  }
  /// One clear line if these numbers are impossible for a device; else nullopt.
  std::optional<std::string> problem() const;
};

/// The connection to a Hokuyo with SCIP 2.0, or one that can be switched to it from SCIP 1.1.
/** Source: Hokuyo's specification of SCIP 2.0. Start-up: stop, SCIP 2.0, version, parameters,
 * state, laser on, endless stream. An answer is the command's echo, a status, lines each with a
 * six-bit sum, and an empty line. A scan is used if all its sums match and it has as many beams as
 * the parameters give. Time: the device's own milliseconds, 24 bits, mapped to the host by the
 * shortest delay (DeviceClock): the sweep ends when the first byte of the fastest scan arrived. A
 * range below DMIN is an error code. */
class ScipSession final : public StartedDevice {
 public:
  explicit ScipSession(const ScipConfig& config);

  void receive(std::string_view bytes, int64_t now) override;
  /// Stops the stream and switches the laser off.
  std::string farewell() const override { return "QT\n"; }
  std::string shortcomings() const override {
    return "hokuyo: strong checksums (6 bits a line); intensities and further echoes are not read";
  }
  /// Product, firmware and serial number reported by the device; empty before.
  const std::string& identity() const { return identity_; }

 private:
  /// An answer without its echo.
  struct Answer {
    std::string_view status;              ///< two characters, one in SCIP 1.1
    std::vector<std::string_view> lines;  ///< each with its sum
  };

  void forget() override;
  /// A scan that is still arriving needs a faster line.
  std::string remedyForSilence(int64_t now) const override;
  /// The expected text before an answer's status.
  std::string echo() const;
  void takeBlock(std::string_view block, int64_t now);
  void takeAnswer(const Answer& answer, int64_t now);
  bool takeText(const Answer& answer, const std::string& name, int64_t now);
  bool takeParameters(const std::vector<std::string>& texts, int64_t now);
  void takeScan(const Answer& answer, int64_t now);
  /// Why a scan's ranges are refused; empty if they are in `scan`.
  std::string readRanges(std::string_view values, RangeScan& scan) const;
  /// False if the device has sent this scan before.
  bool takeTime(uint32_t milliseconds);

  ScipConfig config_;
  ScipGeometry geometry_;
  std::string request_;  ///< of the stream
  std::string buffer_;
  int64_t heard_ = 0;   ///< [us] when the last bytes came
  bool whole_ = false;  ///< a block came to its end since the stream began
  int64_t began_ = 0;   ///< [us] when the first byte in the buffer arrived
  std::string identity_;
  std::string state_;  ///< STAT of the answer to II
  TickClock clock_;
  std::optional<uint32_t> last_milliseconds_;
  uint32_t ticks_ = 0;  ///< [us] the device's clock beyond its 24 bits
};

}  // namespace tread::lidar
