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

/// One scan of a CARMEN log, and what its logger wrote beside it.
struct CarmenScan {
  RangeScan scan;                ///< without times
  Pose2 T_map_laser;             ///< as odometry or a corrected log has it
  std::optional<double> logged;  ///< [s] since the logger's start
};

/// The problem of lines of other kinds: PARAM, ODOM, comments.
inline constexpr const char* kOtherCarmenLine = "other lines";

/// Takes a line apart; `problem` says in words why it is no scan of a range finder to the front,
/// empty if it is one.
/** Source: CARMEN's log format, in the head of each log and in carmen_logger.
    - FLASER n ranges[n] x y theta odom_x odom_y odom_theta time host logger_time: a half turn
    - ROBOTLASER1 type start field_of_view resolution max_range accuracy remission_mode n ranges[n]
      m remissions[m] ... time host logger_time */
CarmenScan parseCarmenLine(const std::string& line, std::string& problem);

/// Configuration of a CARMEN log as a range finder.
struct CarmenConfig {
  double rate = 10.0;       ///< [Hz] of scans whose log has no times of its own
  double range_max = 80.0;  ///< [m] from here on nothing came back (FLASER does not say it)
};

/// Reads the section `carmen`; throws ConfigError with file:line.
CarmenConfig readCarmenConfig(ConfigReader& reader);

/// Plays a CARMEN log at its own time, beginning when it is opened.
/** A log whose times do not grow is played at a fixed rate. A pause in the log of more than 5 s is
 * shortened to that. Reads ahead a few scans only. */
class CarmenPlayer final : public ScanDevice {
 public:
  explicit CarmenPlayer(const CarmenConfig& config) : config_(config) {}

  void open(int64_t now) override;
  void close() override {}  // what was read before the end of the file is still played
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
