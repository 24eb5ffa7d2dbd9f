// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/experiment/adaptation/driving.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/recordings/sessions.hpp"
#include "modules/learner/core/rules/ground_model.hpp"

namespace tread::adaptation {
namespace {

constexpr double kLeastPath = 0.1;  // [m] in a piece that counts
constexpr double kLeastTurn = 0.1;  // [rad]
/// Samples after which a motion that was not known at the beginning no longer matters.
constexpr size_t kLeadIn = 40;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

bool isMeasured(const Pose2& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.yaw);
}

/// What no vehicle does whose fastest commands these are: the lidar's poses jumped.
Twist2 fastest(const Session& session) {
  constexpr double kMargin = 1.5, kJitter = 1.0;  // [1]; [m/s] and [rad/s]
  if (session.kind == CommandKind::kPower)
    return {PatternLimits::kMaxSpeed, 0.0, PatternLimits::kMaxYawRate};
  Twist2 limit{kJitter, 0.0, kJitter};
  for (const Stretch& stretch : session.stretches)
    for (const TrackCommand& command : stretch.commands) {
      const recordings::BodyCommand body = recordings::bodyCommand(command, session.baseline);
      limit.v_x = std::max(limit.v_x, kMargin * std::abs(body.v) + kJitter);
      limit.omega = std::max(limit.omega, kMargin * std::abs(body.w) + kJitter);
    }
  return limit;
}

bool isPossible(const Pose2& from, const Pose2& to, const Twist2& limit) {
  return distanceBetween(from, to) <= kPeriod * limit.v_x &&
         std::abs(to.yaw - from.yaw) <= kPeriod * limit.omega;
}

}  // namespace

Stretch sampled(const gap::Segment& segment, bool entry_known) {
  Stretch stretch;
  stretch.before = segment.command_before;
  stretch.entry_known = entry_known;
  const double begin = segment.begin();
  const auto samples = static_cast<size_t>((segment.end - begin) / kPeriod + 1e-3);
  size_t command = 0, next = 0;
  for (size_t t = 0; t <= samples; ++t) {
    const double time = begin + kPeriod * static_cast<double>(t);
    while (command + 1 < segment.commands.size() &&
           segment.commands[command + 1].time <= time + 0.1 * kPeriod)
      ++command;
    if (t < samples) stretch.commands.push_back(segment.commands[command].command);
    while (next < segment.ins.size() && segment.ins[next].time < time) ++next;
    stretch.poses.push_back(Pose2{kNone, kNone, kNone});
    if (next == 0 || next == segment.ins.size()) continue;
    const gap::InsSample &from = segment.ins[next - 1], &to = segment.ins[next];
    const double gap = to.time - from.time;
    if (gap > kLongestGap || !from.hasPose() || !to.hasPose()) continue;
    const Twist2 twist = twistTo(between(from.T_map_body, to.T_map_body), gap);
    stretch.poses.back() = from.T_map_body * integrate(twist, time - from.time);
  }
  return stretch;
}

void cutPieces(Session& session) {
  session.pieces.clear();
  const Twist2 limit = fastest(session);
  for (size_t s = 0; s < session.stretches.size(); ++s) {
    const Stretch& stretch = session.stretches[s];
    size_t begin = stretch.entry_known ? 0 : kLeadIn;
    size_t known = 0;  // poses in a row, from `begin` on
    for (size_t t = begin; t < stretch.poses.size(); ++t) {
      const bool measured = isMeasured(stretch.poses[t]);
      const bool follows =
          measured && (known == 0 || isPossible(stretch.poses[t - 1], stretch.poses[t], limit));
      known = follows ? known + 1 : (measured ? 1 : 0);
      if (!follows) begin = measured ? t : t + 1;
      if (known <= kPieceSamples) continue;
      Piece piece{s, begin, {}, {}};
      std::vector<double> numbers;
      for (size_t i = 1; i <= kPieceSamples; ++i)
        piece.measured.push_back(between(stretch.poses[begin], stretch.poses[begin + i]));
      begin = t;
      known = 1;
      if (lengthOfPath(piece.measured) < kLeastPath &&
          std::abs(piece.measured.back().yaw) < kLeastTurn)
        continue;
      learner::fill(piece.measured, numbers);
      piece.mean_twist =
          learner::meanTwist({numbers.data(), kPieceSamples, 3}, kPieceSamples, kPeriod);
      session.pieces.push_back(std::move(piece));
    }
  }
}

}  // namespace tread::adaptation
