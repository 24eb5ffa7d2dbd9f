// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>

#include <Eigen/Geometry>

#include "common/bus/bus.hpp"
#include "common/config/config_reader.hpp"
#include "common/vehicle/robot_description.hpp"
#include "modules/lidar_driver/scan_connection.hpp"
#include "modules/lidar_driver/scan_devices.hpp"

namespace tread::lidar {

/// Configuration of lidar_driver, with its defaults.
struct LidarDriverConfig {
  DeviceChoice device;                             ///< the configured kind
  std::string address = "tcp:192.168.0.10:10940";  ///< of the device
  Mounting mounting;                               ///< of the sensor in body
  std::string ground_address;               ///< of a second one that looks at the ground ahead
  std::optional<Mounting> ground_mounting;  ///< nullopt: there is none
  double latency = 0.002;                   ///< [s] from the last beam to the arrival of its bytes
  double silence = 1.0;  ///< [s] without a scan after which the device counts as silent
  ScanLimits limits;
  std::string effective;  ///< the whole as YAML, for CONFIG
};

/// Reads the configuration; throws ConfigError with file:line.
LidarDriverConfig readLidarDriverConfig(ConfigReader& reader);

/// Publishes SCAN from one or two range finders, and HEALTH with every refusal and its reason.
/** The device's limitations are counters in HEALTH and, once, a line for `say`; so is each start
 * and end of scanning, and each more significant reason. */
class LidarDriverNode : public Node {
 public:
  using Say = std::function<void(const std::string& line)>;
  /// `ground_line`: of the range finder that looks at the ground, if configured.
  LidarDriverNode(const LidarDriverConfig& config, Bus& bus, Link& line,
                  Link* ground_line = nullptr, Say say = {});

  int64_t period() const override { return 5'000; }
  void step(int64_t utime) override;

 private:
  /// One of the range finders.
  struct Finder {
    std::string address;
    Mounting mounting;
    ScanConnection connection;
    ScanCheck check;
    int64_t last_scan;  ///< [us] of the last good one
    Reasons reasons{};  ///< why scans were refused since then
  };

  void take(Finder& finder, int64_t utime);
  void publish(const RangeScan& scan, const Mounting& mounting);
  void reportHealth(int64_t utime);
  void sayOnce(const NotedReason& problem);
  NotedReason silenceOf(const Finder& finder, int64_t utime) const;

  LidarDriverConfig config_;
  Bus& bus_;
  Say say_;
  NotedReason said_;  ///< the last reported problem; kNone: it scans
  HealthReporter health_;
  std::vector<Finder> finders_;  ///< the second one looks at the ground, if present
  int64_t seq_ = 0;
  int64_t next_counters_ = 0;
};

}  // namespace tread::lidar
