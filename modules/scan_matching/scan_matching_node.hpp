// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include <tread/ins_t.hpp>
#include <tread/motor_t.hpp>
#include <tread/scan_t.hpp>

#include "common/bus/bus.hpp"
#include "common/config/config_reader.hpp"
#include "common/messages/scan_messages.hpp"
#include "modules/scan_matching/core/scan_matcher.hpp"

namespace tread::scan_matching {

/// Configuration of scan_matching, with its defaults.
struct ScanMatchingConfig {
  ScanMatcherConfig matcher;
  bool fills_in = false;  ///< publishes SCAN_MATCHING for ins_driver, not INS
  double lowest = 0.1;    ///< [m] z_body: lower returns are ground
  /// [rad] of the visible ground relative to the robot; 0 = a flat floor
  double ground_tilt = 0.0;
  /// [rad] of a range finder's plane in body: steeper ones look at the ground
  double max_tilt = 0.2;
  double standing_after = 1.0;  ///< [s] of zero commands after which the robot stands
  double silence = 1.0;         ///< [s] without expected data after which HEALTH reports it
  std::string effective;        ///< the whole as YAML, for CONFIG
};

/// Reads the configuration; throws ConfigError with file:line.
ScanMatchingConfig readScanMatchingConfig(ConfigReader& reader);

/// A scan in the matcher's form; nullopt and the reason if its plane is too steep.
std::optional<Sweep> sweepOf(const ReceivedScan& scan, const ScanMatchingConfig& config,
                             std::string& refusal);

/// INS of a robot whose motion is estimated by its range finder alone.
/** Height, roll and pitch are not measured: the ground is assumed level, with z = 0. */
ins_t messageOf(const MatchedPose& pose, int64_t seq);

/// Publishes INS, or SCAN_MATCHING, from SCAN, and reports in HEALTH what it cannot determine and
/// why.
class ScanMatchingNode : public Node {
 public:
  ScanMatchingNode(const ScanMatchingConfig& config, Bus& bus);

  int64_t period() const override { return 10'000; }
  void step(int64_t utime) override;

 private:
  void hear(const scan_t& message);
  void hear(const ins_t& message);
  void hear(const motor_t& message);
  void match(const Sweep& sweep);
  void refuse(const std::string& reason);
  void count(const MatchedPose& pose);
  bool isOwn(int64_t utime) const;
  bool standsAt(int64_t utime) const;
  void reportHealth(int64_t utime);
  std::string problem(int64_t utime) const;

  ScanMatchingConfig config_;
  Bus& bus_;
  HealthReporter health_;
  ScanMatcher matcher_;
  std::deque<Sweep> waiting_;
  std::deque<int64_t> own_;           ///< [us] utimes of recent own messages
  std::optional<int64_t> off_since_;  ///< [us] utime of the first MOTOR with zero commands
  int64_t last_motor_ = 0;            ///< [us] utime of the newest one
  int64_t seq_ = 0;
  bool heard_ = false;          ///< any message: the robot's time is unknown before
  int64_t last_scan_;           ///< [us] when the last SCAN arrived
  int64_t last_pose_;           ///< [us] when the last pose with position and heading was published
  int64_t last_published_ = 0;  ///< [us] utime of the last message
  double interval_ = 0.0;       ///< [us] usual, between messages
  std::optional<int64_t> foreign_;  ///< [us] when another process's INS arrived
  std::string last_refusal_;
};

}  // namespace tread::scan_matching
