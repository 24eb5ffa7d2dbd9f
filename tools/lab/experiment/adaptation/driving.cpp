// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/experiment/adaptation/driving.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/recordings/sessions.hpp"
#include "modules/learner/core/rules/ground_model.hpp"

namespace tread::adaptation {
namespace {

constexpr double kLeastPath = 0.1;  // [m] least path of a piece
constexpr double kLeastTurn = 0.1;  // [rad]
/// Samples after which the unknown motion before the start no longer matters.
constexpr size_t kLeadIn = 40;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

bool isMeasured(const Pose2& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.yaw);
}

/// Largest plausible twist for a vehicle with these commands; above it the poses have jumped.
Twist2 fastest(const SampledSession& session) {
  constexpr double kMargin = 1.5, kJitter = 1.0;  // [1]; [m/s] and [rad/s]
  if (session.kind == CommandKind::kPower)
    return {PatternLimits::kMaxSpeed, 0.0, PatternLimits::kMaxYawRate};
  Twist2 limit{kJitter, 0.0, kJitter};
  for (const SampledSegment& segment : session.segments)
    for (const TrackCommand& command : segment.commands) {
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

SampledSegment sampled(const gap::Segment& recorded, bool entry_known) {
  SampledSegment segment;
  segment.before = recorded.command_before.tracks();
  segment.entry_known = entry_known;
  const double begin = recorded.begin();
  const auto samples = static_cast<size_t>((recorded.end - begin) / kPeriod + 1e-3);
  size_t command = 0, next = 0;
  for (size_t t = 0; t <= samples; ++t) {
    const double time = begin + kPeriod * static_cast<double>(t);
    while (command + 1 < recorded.commands.size() &&
           recorded.commands[command + 1].time <= time + 0.1 * kPeriod)
      ++command;
    if (t < samples) segment.commands.push_back(recorded.commands[command].command.tracks());
    while (next < recorded.ins.size() && recorded.ins[next].time < time) ++next;
    segment.poses.push_back(Pose2{kNone, kNone, kNone});
    if (next == 0 || next == recorded.ins.size()) continue;
    const gap::InsSample &from = recorded.ins[next - 1], &to = recorded.ins[next];
    const double gap = to.time - from.time;
    if (gap > kLongestGap || !from.hasPose() || !to.hasPose()) continue;
    const Twist2 twist = twistTo(between(from.T_map_body, to.T_map_body), gap);
    segment.poses.back() = from.T_map_body * integrate(twist, time - from.time);
  }
  return segment;
}

void cutPieces(SampledSession& session) {
  session.pieces.clear();
  const Twist2 limit = fastest(session);
  for (size_t s = 0; s < session.segments.size(); ++s) {
    const SampledSegment& segment = session.segments[s];
    size_t begin = segment.entry_known ? 0 : kLeadIn;
    size_t known = 0;  // consecutive poses from `begin` on
    for (size_t t = begin; t < segment.poses.size(); ++t) {
      const bool measured = isMeasured(segment.poses[t]);
      const bool follows =
          measured && (known == 0 || isPossible(segment.poses[t - 1], segment.poses[t], limit));
      known = follows ? known + 1 : (measured ? 1 : 0);
      if (!follows) begin = measured ? t : t + 1;
      if (known <= kPieceSamples) continue;
      SampledPiece piece{s, begin, {}, {}};
      std::vector<double> numbers;
      for (size_t i = 1; i <= kPieceSamples; ++i)
        piece.measured.push_back(between(segment.poses[begin], segment.poses[begin + i]));
      begin = t;
      known = 1;
      if (lengthOfPath(piece.measured) < kLeastPath &&
          std::abs(piece.measured.back().yaw) < kLeastTurn)
        continue;
      learner::fill(piece.measured, numbers);
      piece.mean_twist =
          learner::meanTwist({numbers.data(), kPieceSamples, 3}, 0, kPieceSamples, kPeriod);
      session.pieces.push_back(std::move(piece));
    }
  }
}

}  // namespace tread::adaptation
