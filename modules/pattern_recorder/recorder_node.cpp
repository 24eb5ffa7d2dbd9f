// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/pattern_recorder/recorder_node.hpp"

#include <cmath>
#include <utility>

namespace tread::pattern_recorder {
namespace {

constexpr int64_t kTwistWindow = 300'000;  // [us] over which standing is seen
constexpr double kStandingSpeed = 0.15;    // [m/s] and
constexpr double kStandingRate = 0.10;     // [rad/s]: noise of an INS at rest stays below

}  // namespace

RecorderNode::RecorderNode(const PatternSet& set, const RecordingConfig& config, Bus& bus, Say say)
    : config_(config),
      bus_(bus),
      health_(bus, "recorder", "pattern set: " + set.content().name + "\n"),
      robot_(bus, health_),
      drive_(set, config.room, bus.bootId(), say),
      collector_(set, bus.bootId(), config.executions, config.give_up_after, config.limits,
                 std::move(say)) {
  robot_.on_ins = [this](const ins_t& message) { collector_.take(message, bus_.now()); };
  robot_.on_motor = [this](const motor_t& message) { collector_.take(message); };
  robot_.on_execution = [this](const execution_t& message) {
    collector_.take(message, bus_.now());
  };
  bus_.subscribe<program_t>(kProgram, [this](const program_t& message) { take(message); });
}

void RecorderNode::take(const program_t& message) {
  if (message.run_id == drive_.program().runId() || robot_.invalidTime(message.utime, "PROGRAM"))
    return;
  silent_ = true;
  drive_.fail("another planner speaks on PROGRAM (its run is " + std::to_string(message.run_id) +
              "); end it first; config/launch/recording.yaml starts the robot without one");
}

void RecorderNode::step(int64_t utime) {
  if (robot_.timeJumped(utime) || !stepped_) begun_ = utime;
  stepped_ = true;
  const RobotReadings readings = robot_.readings(utime);
  RecordingProgress progress;
  progress.judged = collector_.judge(utime);
  progress.missing = collector_.missing();
  progress.hopeless = collector_.hopeless();
  progress.standing = stands();
  drive_.step(readings, progress, !listens(utime));
  // Whoever brings it back decides anew whether it may go on.
  if (drive_.leftRoom()) robot_.permission().restart(utime);
  publishProgram(utime, readings);
  publishHealth(utime);
}

void RecorderNode::shutdown(int64_t utime) {
  drive_.stop();
  publishProgram(utime, robot_.readings(utime));
}

bool RecorderNode::stands() const {
  const int64_t newest = collector_.track().newest();
  const PoseTrack* track = collector_.track().covering(newest);
  if (track == nullptr) return false;
  const auto twist = track->twistBefore(newest, kTwistWindow, kTwistWindow);
  return twist && std::hypot(twist->v_x, twist->v_y) < kStandingSpeed &&
         std::abs(twist->omega) < kStandingRate;
}

void RecorderNode::publishProgram(int64_t utime, const RobotReadings& readings) {
  if (silent_ || listens(utime)) return;
  // Before the robot speaks its time is unknown, and others would follow ours.
  if (!readings.pose && !readings.bridge) return;
  bus_.publish(kProgram,
               programOf(drive_.program(), bus_, utime, seq_program_++, config_.lease_us));
}

void RecorderNode::publishHealth(int64_t utime) {
  health_.setState(reason().empty() ? health_t::HEALTH_OK : health_t::HEALTH_DEGRADED, reason());
  int64_t fair = 0;
  for (const auto& executions : recorded()) fair += static_cast<int64_t>(executions.size());
  health_.setCounter("recorded", fair);
  health_.setCounter("refused", collector_.refused());
  health_.step(utime);
}

}  // namespace tread::pattern_recorder
