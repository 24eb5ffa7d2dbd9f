// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/report/hand_record.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "common/messages/pattern_messages.hpp"
#include "common/report/text.hpp"
#include "common/statistics/statistics.hpp"

namespace tread::report {
namespace {

constexpr double kTravels = 0.15;  // [m] below this there was no travel
constexpr double kTurns = 0.1;     // [rad] below this there was no turn
constexpr double kSameDirection = 30.0 * kPi / 180.0;
constexpr int64_t kPoseGap = 200'000;  // [us] between poses, and to the requested time
constexpr size_t kMostReasons = 3;

double secondsOf(int64_t us) {
  return static_cast<double>(us) * 1e-6;
}

/// A motion relative to the body: distance, end and turn.
struct BodyMotion {
  explicit BodyMotion(const Pose2& T_start_end)
      : length(std::hypot(T_start_end.x, T_start_end.y)),
        direction(std::atan2(T_start_end.y, T_start_end.x)),
        turn(wrapAngle(T_start_end.yaw)) {}
  bool travels() const { return length > kTravels; }
  bool turns() const { return !travels() && std::abs(turn) > kTurns; }
  bool stands() const { return !travels() && !turns(); }

  double length;
  double direction;
  double turn;
};

bool sameMotion(const BodyMotion& a, const BodyMotion& b) {
  if (a.travels() && b.travels())
    return std::abs(wrapAngle(a.direction - b.direction)) < kSameDirection;
  if (a.turns() && b.turns()) return a.turn * b.turn > 0.0;
  return a.stands() && b.stands();
}

bool isByHand(const MotorNote& note) {
  return note.state == motor_t::STATE_MANUAL;
}

double percent(int part, int whole) {
  return whole == 0 ? 0.0 : 100.0 * part / whole;
}

using Places =
    std::pair<std::vector<InsNote>::const_iterator, std::vector<InsNote>::const_iterator>;

std::optional<Pose2> poseAt(const Places& places, int64_t utime) {
  const auto next =
      std::lower_bound(places.first, places.second, utime,
                       [](const InsNote& place, int64_t time) { return place.utime < time; });
  const auto placed =
      std::find_if(next, places.second, [](const InsNote& place) { return place.placed; });
  if (placed == places.second || placed->utime - utime > kPoseGap) return std::nullopt;
  return placed->T_map_body;
}

/// `places`, `end` [us]: of the manual control.
void compare(const PlanNote& plan, const Places& places, int64_t end, ShadowComparison& result) {
  constexpr int64_t kLook = 1'000'000;  // [us] of the person's motion, if the planner has no plan
  if (plan.goal_id == 0 || (plan.T_map_next && plan.duration == 0)) return;
  const int64_t duration = plan.T_map_next ? plan.duration : kLook;
  const std::optional<Pose2> here = poseAt(places, plan.utime);
  const std::optional<Pose2> there = poseAt(places, plan.utime + duration);
  if (!here || !there || plan.utime + duration > end) return;
  ++result.plans;
  const BodyMotion person(between(*here, *there));
  const BodyMotion planner(plan.T_map_next ? between(*here, *plan.T_map_next) : Pose2{});
  result.same += sameMotion(person, planner) ? 1 : 0;
  if (planner.stands() && !person.stands()) {
    ++result.would_stand;
    ++result.why[plan.reason.words];
  }
  if (!person.travels() || !planner.travels()) return;
  result.turned_away.push_back(std::abs(wrapAngle(person.direction - planner.direction)));
  result.person_speed.push_back(person.length / secondsOf(duration));
  result.planner_speed.push_back(planner.length / secondsOf(duration));
}

}  // namespace

HandRecord::HandRecord(const DriveTimeline& drive) {
  const std::vector<MotorNote>& motors = drive.motors;
  Odometer odometer;
  for (auto note = motors.begin(); note != motors.end();) {
    const auto first = std::find_if(note, motors.end(), isByHand);
    note = std::find_if_not(first, motors.end(), isByHand);
    if (first == motors.end()) break;
    const bool was_armed = first != motors.begin() && mayDrive(std::prev(first)->state);
    ++(was_armed ? taken_over : armed_for_hand);
    const bool ends = note != motors.end();
    if (ends) ++(mayDrive(note->state) ? given_back : stopped);
    const int64_t end = ends ? note->utime : std::prev(note)->until;
    seconds += secondsOf(end - first->utime);
    for (auto at = first; at != note; ++at)
      if (at->command != Command{})
        moving += secondsOf(
            std::max<int64_t>(0, (std::next(at) == note ? end : std::next(at)->utime) - at->utime));
    const size_t last = ends ? note->event : drive.messages;
    const Places places = notesBetween(drive.ins, first->event, last);
    odometer.interrupt();
    std::for_each(places.first, places.second, [&](const InsNote& ins) { odometer.add(ins); });
    const auto [plan, plan_end] = notesBetween(drive.plans, first->event, last);
    std::for_each(plan, plan_end, [&](const PlanNote& one) {
      if (one.utime >= first->utime) compare(one, places, end, shadow);
    });
  }
  distance = odometer.distance();
  for (const auto& pattern : drive.patterns)
    if (pattern.message.learned_run_id == 0) {
      ++taught;
      fair += pattern.message.accepted ? 1 : 0;
    }
}

std::string HandRecord::words() const {
  if (taken_over + armed_for_hand == 0) return "";
  std::string words = formatted(
      "manual control: %.1f s (%.1f s moving, %.1f m); taken over %d times, armed for it %d times; "
      "handed back %d times, stopped %d times\n",
      seconds, moving, distance, taken_over, armed_for_hand, given_back, stopped);
  words += formatted("  it gave %d patterns to learn from, %d of them fair\n", taught, fair);
  if (shadow.plans == 0) return words + "  the planner had no goal meanwhile\n";
  words += formatted("  the planner would have made the same motion in %.0f %% of %d plans",
                     percent(shadow.same, shadow.plans), shadow.plans);
  if (!shadow.turned_away.empty())
    words += formatted("; when both moved: directions %.0f deg apart, ",
                       upperMedian(shadow.turned_away) * 180.0 / kPi) +
             formatted("%.2f m/s by the person, %.2f m/s by the planner (medians)",
                       upperMedian(shadow.person_speed), upperMedian(shadow.planner_speed));
  words += formatted("\n  it would have stopped in %.0f %% while the person moved\n",
                     percent(shadow.would_stand, shadow.plans));
  size_t lines = 0;
  for (const auto& [why, count] : shadow.why)
    if (lines++ < kMostReasons) words += formatted("    %d times: ", count) + why + "\n";
  return words;
}

}  // namespace tread::report
