// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>

#include "common/config/config_reader.hpp"
#include "common/geometry/se2.hpp"
#include "modules/lidar_driver/core/scan_device.hpp"

namespace tread::lidar {

/// One scan of a CARMEN log, with its logger's data.
struct CarmenScan {
  RangeScan scan;                ///< without times
  Pose2 T_map_laser;             ///< from odometry or a corrected log
  std::optional<double> logged;  ///< [s] since the logger's start
};

/// The problem of lines of other kinds: PARAM, ODOM, comments.
inline constexpr const char* kOtherCarmenLine = "other lines";

/// Parses a line; `problem` is why it is not a scan of a forward-facing range finder, in words,
/// empty if it is.
/** Source: CARMEN's log format, in the header of each log and in carmen_logger.
 *    - FLASER n ranges[n] x y theta odom_x odom_y odom_theta time host logger_time: a half turn
 *    - ROBOTLASER1 type start field_of_view resolution max_range accuracy remission_mode n
 *      ranges[n] m remissions[m] ... time host logger_time */
CarmenScan parseCarmenLine(const std::string& line, std::string& problem);

/// Configuration of a CARMEN log as a range finder.
struct CarmenConfig {
  double rate = 10.0;  ///< [Hz] of scans in a log without times
  /// [m] range from which there was no return (FLASER does not contain it)
  double range_max = 80.0;
};

/// Reads the section `carmen`; throws ConfigError with file:line.
CarmenConfig readCarmenConfig(ConfigReader& reader);

/// Plays a CARMEN log at its own pace, starting when it is opened.
/** A log whose times do not increase is played at a fixed rate. Pauses of more than 5 s are
 * shortened to 5 s. Reads only a few scans ahead. */
class CarmenPlayer final : public ScanDevice {
 public:
  explicit CarmenPlayer(const CarmenConfig& config) : config_(config) {}

  void open(int64_t now) override;
  void close() override {}  // scans already read are still played
  void receive(std::string_view bytes, int64_t now) override;
  std::string poll(int64_t /*now*/) override { return {}; }
  std::vector<RangeScan> take(int64_t now) override;
  bool hungry() const override { return waiting_.size() < kAhead; }
  std::string shortcomings() const override {
    return "carmen: beam times (a log holds one a scan), checksums; a log is played once";
  }

 private:
  static constexpr size_t kAhead = 20;

  void takeLine(const std::string& line, int64_t now);

  CarmenConfig config_;
  std::string line_;
  bool overlong_ = false;
  std::deque<RangeScan> waiting_;  ///< with the times at which they are due
  int64_t due_ = 0;                ///< of the newest one
  std::optional<double> logged_;   ///< of the newest one
};

}  // namespace tread::lidar
