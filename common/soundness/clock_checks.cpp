// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/soundness/clock_checks.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "common/messages/ins_messages.hpp"
#include "common/statistics/statistics.hpp"

namespace tread::gap {
namespace {

constexpr int64_t kClockStep = 500'000;           // [us]
constexpr int64_t kLongestLog = 172'800'000'000;  // [us] two days
constexpr size_t kWindow = 200;                   // messages
constexpr size_t kShortWindow = 20;               // messages
constexpr int64_t kLongStep = 1'000'000;          // [us] longer than any driver's period
constexpr int64_t kMotionWindow = 500'000;        // [us] over which motion is detected
constexpr int64_t kShortest = 300'000;            // [us] over which motion exceeds noise
constexpr int64_t kTogether =
    300'000;  // [us] of difference between pauses of INS and MOTOR that count as simultaneous
constexpr double kMessage = 0.1;         // [s] period of messages
constexpr double kPositionNoise = 0.03;  // [m] between two fixes
constexpr double kHeadingNoise = 0.05;   // [rad]

/// Least delay from message to recording among up to `kWindow` messages [us]: within them a delayed
/// recorder has caught up.
int64_t leastDelay(const std::vector<Stamp>& stamps, size_t begin, size_t end) {
  int64_t least = INT64_MAX;
  for (size_t i = begin; i < end; ++i) least = std::min(least, stamps[i].logged - stamps[i].utime);
  return least;
}

/// Whether the offset between robot's and recorder's clocks changes here.
bool clocksPart(const std::vector<Stamp>& stamps, size_t index) {
  const size_t begin = index > kWindow ? index - kWindow : 0;
  const size_t end = std::min(stamps.size(), index + kWindow);
  return std::abs(leastDelay(stamps, begin, index) - leastDelay(stamps, index, end)) > kClockStep;
}

/// Whether recorder and robot run at the same rate: a replay may be recorded at any.
bool samePace(const std::vector<Stamp>& stamps) {
  std::vector<double> paces;
  for (size_t i = kShortWindow; i < stamps.size(); i += kShortWindow) {
    const Stamp& before = stamps[i - kShortWindow];
    const auto logged = static_cast<double>(stamps[i].logged - before.logged);
    if (stamps[i].utime > before.utime)
      paces.push_back(logged / static_cast<double>(stamps[i].utime - before.utime));
  }
  if (paces.empty()) return true;
  const double usual = quantileOf(std::move(paces), 0.5);
  return usual > 0.8 && usual < 1.25;
}

/// Checks for time going back, and for the robot's clock against the recorder's.
void checkStamps(const std::string& channel, const std::vector<Stamp>& stamps, const SortedLog& log,
                 Diagnostics& notes) {
  size_t overtaken = 0;
  const bool same_pace = samePace(stamps);
  for (size_t i = 1; i < stamps.size(); ++i) {
    const int64_t step = stamps[i].utime - stamps[i - 1].utime;
    const int64_t logged = stamps[i].logged - stamps[i - 1].logged;
    const std::string place = digits(log.seconds(stamps[i - 1].utime));
    if (step < -kOvertaking)
      return notes.add(findings::kClockGoesBack,
                       {channel, digits(-1e-6 * static_cast<double>(step), 2), place});
    overtaken += step < 0 ? 1 : 0;
    const bool parts = same_pace && std::abs(logged - step) > kClockStep && clocksPart(stamps, i);
    if (parts && step > kClockStep)
      return notes.add(findings::kClockGoesOn,
                       {channel, digits(1e-6 * static_cast<double>(step), 2), place,
                        digits(1e-6 * static_cast<double>(logged), 2)});
  }
  if (overtaken > 0) notes.add(findings::kOutOfOrder, {std::to_string(overtaken), channel});
}

/// Threshold of motion around a pause. If MOTOR pauses with the INS, and neither misses a number,
/// there was most likely no pause at all, so that little motion is enough.
struct Motion {
  double speed = 0.3;  ///< [m/s]
  double rate = 1e9;   ///< [rad/s]
};
constexpr Motion kAlone{};
constexpr Motion kTogetherWithMotor{0.08, 0.1};

/// The pose next to a pause, and the robot's motion there.
struct Beside : TimedPose {
  Motion motion;

  bool moves(const Motion& least) const {
    return motion.speed >= least.speed || motion.rate >= least.rate;
  }
};

/// From `index` on in one direction, within half a second.
std::optional<Beside> beside(const std::vector<ins_t>& ins, size_t index, int direction) {
  std::optional<Beside> found;
  for (size_t i = index; i < ins.size(); i += static_cast<size_t>(direction)) {
    if (std::abs(ins[i].utime - ins[index].utime) > kMotionWindow) break;
    const auto pose = planarPose(ins[i]);
    if (!pose) continue;
    if (!found) found = Beside{{ins[i].utime, *pose}, {0.0, 0.0}};
    const int64_t since = std::abs(ins[i].utime - found->utime);
    if (since < kShortest) continue;
    const double time = 1e-6 * static_cast<double>(since);
    found->motion.speed = (pose->position() - found->T_map_body.position()).norm() / time;
    found->motion.rate = std::abs(wrapAngle(pose->yaw - found->T_map_body.yaw)) / time;
  }
  return found;
}

/// Whether the next pose from `index` on is flagged as a new track.
bool jumpAnnounced(const std::vector<ins_t>& ins, size_t index) {
  for (size_t i = index; i < ins.size(); ++i) {
    if ((ins[i].ins_status & ins_t::STATUS_JUMP) != 0) return true;
    if (planarPose(ins[i])) return false;
  }
  return false;
}

/// MOTOR around the middle of a pause: the last message before it, and the next one.
std::optional<std::pair<const motor_t*, const motor_t*>> motorAround(
    const std::vector<motor_t>& motor, int64_t begin, int64_t end) {
  const auto after =
      std::lower_bound(motor.begin(), motor.end(), begin + (end - begin) / 2,
                       [](const motor_t& message, int64_t utime) { return message.utime < utime; });
  if (after == motor.begin() || after == motor.end()) return std::nullopt;
  return std::pair(&*(after - 1), &*after);
}

/// Whether MOTOR is also silent from `begin` to `end`, without a missing number.
bool motorPauses(const std::vector<motor_t>& motor, int64_t begin, int64_t end) {
  const auto around = motorAround(motor, begin, end);
  return around && isNext(around->second->seq, around->first->seq) &&
         std::abs(around->first->utime - begin) <= kTogether &&
         std::abs(around->second->utime - end) <= kTogether;
}

/// Whether MOTOR has no message in half of the pause: recording was interrupted. The streams of an
/// import need not end together.
bool isBreak(const std::vector<motor_t>& motor, int64_t begin, int64_t end) {
  const auto around = motorAround(motor, begin, end);
  return around && around->second->utime - around->first->utime >= (end - begin) / 2;
}

/// What happened in a pause.
struct Pause {
  double length = 0.0;  ///< [s]
  double rest = 0.0;    ///< [s] between the two poses, without the pause and a message's period
  double moved = 0.0;   ///< [m]
  double turned = 0.0;  ///< [rad]
  Motion motion;        ///< the faster one of before and after
};

Pause pauseBetween(const Beside& before, const Beside& after, int64_t step) {
  Pause pause;
  pause.length = 1e-6 * static_cast<double>(step);
  pause.rest = 1e-6 * static_cast<double>(after.utime - before.utime - step) + kMessage;
  pause.moved = (after.T_map_body.position() - before.T_map_body.position()).norm();
  pause.turned = std::abs(wrapAngle(after.T_map_body.yaw - before.T_map_body.yaw));
  pause.motion.speed = std::max(before.motion.speed, after.motion.speed);
  pause.motion.rate = std::max(before.motion.rate, after.motion.rate);
  return pause;
}

/// Whether the pose after the pause is that of one message later, although the robot was moving.
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

void addJump(const Pause& pause, const std::string& place, bool with_motor, Diagnostics& notes) {
  const std::string turn = " and turns by " + digits(pause.turned, 2) + " rad at " +
                           digits(pause.motion.rate, 2) + " rad/s";
  notes.add(findings::kClockLeavesRobot,
            {with_motor ? "INS and MOTOR go" : "INS goes", digits(pause.length, 2), place,
             digits(pause.moved, 2), digits(pause.motion.speed, 2), with_motor ? turn : ""});
}

/// Checks for pauses after which the robot is where it was one message later, although it moves:
/// time advanced, the robot did not.
/** If MOTOR pauses too, only the robot's message numbers distinguish such a jump from a gap in the
 * recording. An import numbers its own rows, so its pauses are gaps, whatever the poses are. A
 * robot that turns on the spot may face the same direction again. */
void checkPauses(const SortedLog& log, Numbering numbering, Diagnostics& notes) {
  const std::vector<ins_t>& ins = log.ins;
  for (size_t i = 1; i < ins.size(); ++i) {
    const int64_t step = ins[i].utime - ins[i - 1].utime;
    if (step < kLongStep || !isNext(ins[i].seq, ins[i - 1].seq) || jumpAnnounced(ins, i)) continue;
    if (numbering == Numbering::kByImport && isBreak(log.motor, ins[i - 1].utime, ins[i].utime))
      continue;
    const bool with_motor = motorPauses(log.motor, ins[i - 1].utime, ins[i].utime);
    const Motion& least = with_motor ? kTogetherWithMotor : kAlone;
    const auto before = beside(ins, i - 1, -1);
    const auto after = beside(ins, i, 1);
    if (!before || !after) continue;
    const std::string place = digits(log.seconds(ins[i - 1].utime));
    if (!before->moves(least) || !after->moves(least)) {
      if (with_motor)
        notes.add(findings::kPauseStanding, {digits(1e-6 * static_cast<double>(step), 2), place});
      continue;
    }
    const Pause pause = pauseBetween(*before, *after, step);
    if (!stoodStill(pause, with_motor)) continue;
    return addJump(pause, place, with_motor, notes);
  }
}

}  // namespace

void checkClocks(const SortedLog& log, Numbering numbering, Diagnostics& notes) {
  checkStamps("MOTOR", log.drive.motor_stamps, log, notes);
  checkStamps("INS", log.drive.ins_stamps, log, notes);
  checkPauses(log, numbering, notes);
  int64_t last = log.origin;
  if (!log.motor.empty()) last = std::max(last, log.motor.back().utime);
  if (!log.ins.empty()) last = std::max(last, log.ins.back().utime);
  if (last - log.origin > kLongestLog)
    notes.add(findings::kClockSpan, {digits(log.seconds(last) / 3600.0)});
}

}  // namespace tread::gap
