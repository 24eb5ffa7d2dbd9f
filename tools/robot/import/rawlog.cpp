// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/import/rawlog.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/messages/scan_messages.hpp"
#include "common/recordings/csv_table.hpp"
#include "common/report/text.hpp"
#include "tools/robot/import/rawlog_records.hpp"

namespace tread::import {
namespace {

using recordings::RecordedDrive;

class RawlogDrive {
 public:
  explicit RawlogDrive(ForeignDrive& result) : result_(result) {}

  void operator()(const PoseSample& pose) {
    const Pose2& at = pose.T_map_body;
    const auto time = since(pose.time);
    if (!time || !std::isfinite(at.yaw) || !(std::max(std::abs(at.x), std::abs(at.y)) <= kFarthest))
      return lose("poses: numbers or times out of range");
    recordings::Fix fix;
    fix.time = *time;
    fix.unix_time = pose.time;
    fix.T_map_body = at;
    result_.drive.fixes.push_back(fix);
  }
  void operator()(RawlogScan scan) {
    const auto time = since(scan.time);
    std::string refusal;
    if (!time) return lose("scans: times out of range");
    scan.message.utime = 1;  // set by makeLog
    if (!readScan(scan.message, refusal)) return lose("scans: " + refusal);
    result_.drive.scans.push_back({*time, std::move(scan.message)});
  }
  void operator()(const LeftOut& left) {
    if (left.lost) return lose(left.what);
    ++result_.left_out[left.what];
  }
  void operator()(const RawlogProblem& problem) {
    problem_ = problem.what;
    result_.losses.push_back({"what follows: " + problem.what, 0.0, 0.0, ""});
  }

  const std::string& problem() const { return problem_; }

  void finish() {
    RecordedDrive& drive = result_.drive;
    size_t all = drive.fixes.size() + drive.scans.size();
    for (const auto& [what, count] : lost_) all += count;
    for (const auto& [what, count] : lost_) result_.lose(what, count, all, "poses and scans");
    sortByTime(
        drive.fixes, "poses",
        [](const auto& a, const auto& b) {
          return distanceBetween(a.T_map_body, b.T_map_body) == 0.0 &&
                 a.T_map_body.yaw == b.T_map_body.yaw;
        },
        result_);
    if (!drive.fixes.empty()) drive.fixes.front().new_track = true;
    takeJumpsOut(
        drive.fixes, [&](size_t i) { return fixed(drive.fixes[i].time, 2) + " s"; }, result_);
    std::stable_sort(drive.scans.begin(), drive.scans.end(),
                     [](const auto& a, const auto& b) { return a.time < b.time; });
  }

 private:
  /// [s] since the first record that has a time.
  std::optional<double> since(double time) {
    if (!std::isfinite(time)) return std::nullopt;
    if (!begin_) begin_ = time;
    const double since = time - *begin_;
    return std::abs(since) > kLongest ? std::nullopt : std::optional(since);
  }
  void lose(const std::string& what) { ++lost_[what]; }

  ForeignDrive& result_;
  std::map<std::string, size_t> lost_;
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
  drive.finish();
  if (!result.drive.fixes.empty()) result.poses = "odometry";
  return result;
}

}  // namespace tread::import
