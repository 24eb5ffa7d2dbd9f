// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>

#include "common/config/config_reader.hpp"
#include "modules/lidar_driver/core/scan_device.hpp"
#include "modules/lidar_driver/core/tick_clock.hpp"
#include "modules/lidar_driver/sick_cola/cola_framer.hpp"
#include "modules/lidar_driver/sick_cola/cola_telegram.hpp"

namespace tread::lidar {

/// Configuration of a SICK LMS1xx, TiM5xx or TiM7xx.
struct ColaConfig {
  ColaDialect dialect = ColaDialect::kA;  ///< determined by the port (2111, 2112)
  double front = 1.57079632679489662;     ///< [rad] the device's forward angle
  bool zero_is_clear = false;  ///< no echo means free up to range_max, not "no measurement"
  double latency = 0.002;  ///< [s] from the start of the transmission to the arrival of its bytes
};

/// Reads the section `sick_cola`; throws ConfigError with file:line.
ColaConfig readColaConfig(ConfigReader& reader);

/// The connection to a SICK scanner with CoLa: starts its stream, reads its scans.
/** Start-up: stream off, identity, log in as authorised client, measure, run, stream on. Scans in
 * transit from an earlier stream are ignored. Time: the device's own, mapped to the host by the
 * shortest delay (DeviceClock). The telegram's scan time is not a beam's on all models: the last
 * beam is dated no later than the transmission. */
class ColaSession final : public StartedDevice {
 public:
  explicit ColaSession(const ColaConfig& config);

  void receive(std::string_view bytes, int64_t now) override;
  std::string shortcomings() const override;
  /// The device's own name; empty before it was received.
  const std::string& identity() const { return identity_; }

 private:
  void forget() override;
  void nameDialect(std::string_view bytes, int64_t now);
  void takeTelegram(const std::string& telegram, int64_t now);
  void takeAnswer(const std::string& telegram, int64_t now);
  void takeScan(std::string_view fields, int64_t now);
  /// Why a scan is refused, in words; empty if it is not.
  std::string doubt(const ColaScan& scan, int64_t now);
  RangeScan convert(const ColaScan& scan, int64_t now) const;

  ColaConfig config_;
  ColaFramer framer_;
  ColaFramer other_framer_;  ///< in the other dialect, to report it
  bool understood_ = false;  ///< a telegram in the configured dialect was received
  TickClock clock_;
  std::string identity_;
  std::optional<uint16_t> last_telegram_;
};

}  // namespace tread::lidar
