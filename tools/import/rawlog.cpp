// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/import/rawlog.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/messages/scan_messages.hpp"
#include "common/recordings/csv_table.hpp"
#include "tools/import/rawlog_records.hpp"

namespace tread::import {
namespace {

class RawlogDrive {
 public:
  explicit RawlogDrive(ForeignDrive& result) : result_(result) {}

  void operator()(const OdometryPose& pose) {
    const Pose2& at = pose.T_odom_body;
    const auto time = since(pose.time);
    if (!time || !std::isfinite(at.yaw) || !(std::max(std::abs(at.x), std::abs(at.y)) <= kFarthest))
      return leaveOut("poses: numbers or times out of range");
    auto& fixes = result_.drive.fixes;
    if (!fixes.empty() && *time <= fixes.back().time)
      return leaveOut("poses: not later than the last");
    recordings::Fix fix;
    fix.time = *time;
    fix.unix_time = pose.time;
    fix.T_map_body = at;
    fix.new_track = fixes.empty();
    fixes.push_back(fix);
  }
  void operator()(RawlogScan scan) {
    const auto time = since(scan.time);
    std::string refusal;
    if (!time) return leaveOut("scans: times out of range");
    scan.message.utime = 1;  // set by makeLog
    if (!readScan(scan.message, refusal)) return leaveOut("scans: " + refusal);
    result_.drive.scans.push_back({*time, std::move(scan.message)});
  }
  void operator()(const LeftOut& left) { leaveOut(left.what); }
  void operator()(const RawlogProblem& problem) {
    problem_ = problem.what;
    leaveOut("what follows: " + problem.what);
  }

  const std::string& problem() const { return problem_; }

 private:
  /// [s] since the first record that has a time.
  std::optional<double> since(double time) {
    if (!std::isfinite(time)) return std::nullopt;
    if (!begin_) begin_ = time;
    const double since = time - *begin_;
    return std::abs(since) > kLongest ? std::nullopt : std::optional(since);
  }
  void leaveOut(const std::string& what) { ++result_.left_out[what]; }

  ForeignDrive& result_;
  std::optional<double> begin_;
  std::string problem_;
};

}  // namespace

ForeignDrive readRawlog(const std::string& path) {
  ForeignDrive result;
  RawlogDrive drive(result);
  readRawlogRecords(path, [&](const RawlogRecord& record) { std::visit(drive, record); });
  if (result.drive.fixes.empty() && result.drive.scans.empty())
    throw recordings::RecordingError(
        path + ": holds neither odometry nor scans" +
        (drive.problem().empty() ? "" : ": " + drive.problem() + "; is it an MRPT rawlog?"));
  std::stable_sort(result.drive.scans.begin(), result.drive.scans.end(),
                   [](const auto& a, const auto& b) { return a.time < b.time; });
  if (!result.drive.fixes.empty()) result.poses = "odometry";
  return result;
}

}  // namespace tread::import
