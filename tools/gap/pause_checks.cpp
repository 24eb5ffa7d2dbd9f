// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>
#include <optional>

#include "common/messages/ins_messages.hpp"
#include "tools/gap/log_checks.hpp"

namespace tread::gap {
namespace {

constexpr int64_t kLongStep = 1'000'000;  // [us] that no driver needs between two messages
constexpr int64_t kWindow = 500'000;      // [us] over which motion is seen
constexpr int64_t kShortest = 300'000;    // [us] over which motion can be told from noise
constexpr int64_t kTogether = 300'000;    // [us] within which INS and MOTOR pause at one time
constexpr double kMessage = 0.1;          // [s] period of messages
constexpr double kPositionNoise = 0.03;   // [m] between two fixes
constexpr double kHeadingNoise = 0.05;    // [rad]

/// What counts as motion beside a pause. Where MOTOR pauses with the INS, and neither misses a
/// number, there was most likely no pause at all, so that little motion is enough.
struct Motion {
  double speed = 0.3;  ///< [m/s]
  double rate = 1e9;   ///< [rad/s]
};
constexpr Motion kAlone{};
constexpr Motion kTogetherWithMotor{0.08, 0.1};

/// The pose beside a pause, and how the robot moves there.
struct Beside {
  int64_t utime = 0;
  Pose2 pose;
  Motion motion;

  bool moves(const Motion& least) const {
    return motion.speed >= least.speed || motion.rate >= least.rate;
  }
};

/// From `index` on in one direction, within half a second.
std::optional<Beside> beside(const std::vector<ins_t>& ins, size_t index, int direction) {
  std::optional<Beside> found;
  for (size_t i = index; i < ins.size(); i += static_cast<size_t>(direction)) {
    if (std::abs(ins[i].utime - ins[index].utime) > kWindow) break;
    const auto pose = planarPose(ins[i]);
    if (!pose) continue;
    if (!found) found = Beside{ins[i].utime, *pose, {0.0, 0.0}};
    const int64_t since = std::abs(ins[i].utime - found->utime);
    if (since < kShortest) continue;
    const double time = 1e-6 * static_cast<double>(since);
    found->motion.speed = (pose->position() - found->pose.position()).norm() / time;
    found->motion.rate = std::abs(wrapAngle(pose->yaw - found->pose.yaw)) / time;
  }
  return found;
}

/// Whether the next pose from `index` on is said to be on a new track.
bool jumpAnnounced(const std::vector<ins_t>& ins, size_t index) {
  for (size_t i = index; i < ins.size(); ++i) {
    if ((ins[i].ins_status & ins_t::STATUS_JUMP) != 0) return true;
    if (planarPose(ins[i])) return false;
  }
  return false;
}

/// Whether MOTOR, too, is silent from `begin` to `end`, and misses no number.
bool motorPauses(const std::vector<motor_t>& motor, int64_t begin, int64_t end) {
  const auto after =
      std::lower_bound(motor.begin(), motor.end(), begin + (end - begin) / 2,
                       [](const motor_t& message, int64_t utime) { return message.utime < utime; });
  if (after == motor.begin() || after == motor.end()) return false;
  const motor_t& before = *(after - 1);
  return isNext(after->seq, before.seq) && std::abs(before.utime - begin) <= kTogether &&
         std::abs(after->utime - end) <= kTogether;
}

/// What happened in a pause.
struct Pause {
  double length = 0.0;  ///< [s]
  double rest = 0.0;    ///< [s] between the two poses but the pause, and a message's period
  double moved = 0.0;   ///< [m]
  double turned = 0.0;  ///< [rad]
  Motion motion;        ///< the faster one of before and after
};

Pause pauseBetween(const Beside& before, const Beside& after, int64_t step) {
  Pause pause;
  pause.length = 1e-6 * static_cast<double>(step);
  pause.rest = 1e-6 * static_cast<double>(after.utime - before.utime - step) + kMessage;
  pause.moved = (after.pose.position() - before.pose.position()).norm();
  pause.turned = std::abs(wrapAngle(after.pose.yaw - before.pose.yaw));
  pause.motion.speed = std::max(before.motion.speed, after.motion.speed);
  pause.motion.rate = std::max(before.motion.rate, after.motion.rate);
  return pause;
}

/// Whether the robot is where it was one message later, although its motion went on.
bool stoodStill(const Pause& pause, bool with_motor) {
  constexpr double kFarLess = 0.3;
  const Motion& motion = pause.motion;
  const bool one_message =
      pause.moved <= 2.0 * motion.speed * pause.rest + (with_motor ? kPositionNoise : 0.0) &&
      pause.turned <= 2.0 * motion.rate * pause.rest + kHeadingNoise;
  const bool less_way = pause.moved <= kFarLess * motion.speed * pause.length;
  const bool less_turn = pause.turned <= kFarLess * motion.rate * pause.length;
  return one_message && (less_way || (with_motor && less_turn));
}

std::string lineOf(const Pause& pause, const std::string& place, bool with_motor) {
  std::string line = std::string("clock jump: INS") + (with_motor ? " and MOTOR go" : " goes") +
                     " on by " + digits(pause.length, 2) + " s" + place +
                     ", but the robot moves on by " + digits(pause.moved, 2) + " m at " +
                     digits(pause.motion.speed, 2) + " m/s";
  if (with_motor)
    line += " and turns by " + digits(pause.turned, 2) + " rad at " + digits(pause.motion.rate, 2) +
            " rad/s";
  return line + "; cut the log there";
}

}  // namespace

void checkPauses(const LogMessages& messages, NoteBook& notes) {
  const std::vector<ins_t>& ins = messages.ins;
  for (size_t i = 1; i < ins.size(); ++i) {
    const int64_t step = ins[i].utime - ins[i - 1].utime;
    if (step < kLongStep || !isNext(ins[i].seq, ins[i - 1].seq) || jumpAnnounced(ins, i)) continue;
    const bool with_motor = motorPauses(messages.motor, ins[i - 1].utime, ins[i].utime);
    const Motion& least = with_motor ? kTogetherWithMotor : kAlone;
    const auto before = beside(ins, i - 1, -1);
    const auto after = beside(ins, i, 1);
    if (!before || !after) continue;
    const std::string place = " at " + digits(messages.seconds(ins[i - 1].utime)) + " s";
    if (!before->moves(least) || !after->moves(least)) {
      if (with_motor)
        notes.note("INS and MOTOR are silent for " + digits(1e-6 * static_cast<double>(step), 2) +
                   " s" + place +
                   " and miss no number, while the robot stands: if its clock jumped there, what "
                   "depends on time is wrong");
      continue;
    }
    const Pause pause = pauseBetween(*before, *after, step);
    if (!stoodStill(pause, with_motor)) continue;
    return notes.fatal(lineOf(pause, place, with_motor));
  }
}

}  // namespace tread::gap
