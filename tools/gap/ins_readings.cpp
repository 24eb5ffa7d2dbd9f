// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/ins_readings.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>

#include "common/geometry/se3.hpp"
#include "common/messages/ins_messages.hpp"

namespace tread::gap {
namespace {

/// A vehicle that was told to stand this long stands [s].
constexpr double kSettled = 1.0;

bool samePose(const Pose2& a, const Pose2& b) {
  return a.x == b.x && a.y == b.y && a.yaw == b.yaw;
}

InsSample sampleOf(const LogMessages& messages, const ins_t& ins,
                   const std::optional<Pose2>& pose) {
  InsSample sample;
  sample.time = messages.seconds(ins.utime);
  sample.T_map_body = pose.value_or(Pose2{kNotMeasured, kNotMeasured, kNotMeasured});
  if (std::isfinite(ins.rate[2])) sample.omega = ins.rate[2];
  if ((ins.ins_status & ins_t::STATUS_NO_ATTITUDE) != 0) return sample;
  const YawPitchRoll angles = yawPitchRoll(Eigen::Quaterniond(
      ins.orientation[0], ins.orientation[1], ins.orientation[2], ins.orientation[3]));
  sample.roll = angles.roll;
  sample.pitch = angles.pitch;
  return sample;
}

class Reader {
 public:
  Reader(const LogMessages& messages, const CommandSpan& span) : messages_(messages), span_(span) {}

  void add(const ins_t& ins) {
    // A jump counts even if its own message has no pose: what follows is a new track.
    jumped_ = jumped_ || (ins.ins_status & ins_t::STATUS_JUMP) != 0;
    std::optional<Pose2> pose = planarPose(ins);
    const double time = messages_.seconds(ins.utime);
    if (pose && isHeld(*pose, time)) {
      hold(time);
      pose.reset();
    } else if (pose) {
      last_ = *pose;
      last_time_ = time;
      holding_ = false;
    }
    InsReading reading{sampleOf(messages_, ins, pose), pose.has_value(), pose && jumped_};
    if (reading.fresh) jumped_ = false;
    if (reading.fresh || std::isfinite(reading.sample.omega)) result_.readings.push_back(reading);
  }

  SpanReadings result() { return std::move(result_); }

 private:
  bool isHeld(const Pose2& pose, double time) {
    const bool stands = standsBetween(span_, time - kSettled, time);
    if (!stands) ++result_.poses;
    // What hangs while it drives does not come alive because it stands.
    return (!stands || holding_) && last_ && samePose(*last_, pose);
  }

  void hold(double time) {
    ++result_.repeated;
    if (!holding_) result_.held.push_back({last_time_, time});
    result_.held.back().end = time;
    holding_ = true;
  }

  const LogMessages& messages_;
  const CommandSpan& span_;
  SpanReadings result_;
  std::optional<Pose2> last_;
  double last_time_ = 0.0;
  bool holding_ = false;
  bool jumped_ = false;
};

}  // namespace

SpanReadings insReadings(const LogMessages& messages, const CommandSpan& span) {
  Reader reader(messages, span);
  const auto first = std::lower_bound(
      messages.ins.begin(), messages.ins.end(), span.begin(),
      [&](const ins_t& ins, double time) { return messages.seconds(ins.utime) < time; });
  for (auto ins = first; ins != messages.ins.end(); ++ins) {
    if (messages.seconds(ins->utime) > span.end) break;
    reader.add(*ins);
  }
  return reader.result();
}

}  // namespace tread::gap
