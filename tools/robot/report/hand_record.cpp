// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/report/hand_record.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "common/messages/pattern_messages.hpp"
#include "common/report/text.hpp"

namespace tread::report {
namespace {

constexpr double kTravels = 0.15;  // [m] less is no way
constexpr double kTurns = 0.1;     // [rad] less is no turn
constexpr double kSameDirection = 30.0 * kPi / 180.0;
constexpr int64_t kPoseGap = 200'000;  // [us] between poses, and to the one looked for
constexpr size_t kMostReasons = 3;

double secondsOf(int64_t us) {
  return static_cast<double>(us) * 1e-6;
}

/// A motion from the body's place: how far, to where, how much turned.
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

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

bool isByHand(const MotorNote& note) {
  return note.state == motor_t::STATE_MANUAL;
}

double percent(int part, int whole) {
  return whole == 0 ? 0.0 : 100.0 * part / whole;
}

}  // namespace

HandRecord::HandRecord(const DriveTimeline& drive) {
  for (size_t i = 0; i < drive.motors.size(); ++i) {
    const MotorNote& note = drive.motors[i];
    if (!isByHand(note)) continue;
    if (i == 0 || !isByHand(drive.motors[i - 1])) {
      spans_.push_back({note.utime, note.utime});
      ++(i > 0 && mayDrive(drive.motors[i - 1].state) ? taken_over_ : armed_for_hand_);
      odometer_.interrupt();
    }
    follow(drive, note, i + 1 < drive.motors.size() ? &drive.motors[i + 1] : nullptr);
  }
  for (const auto& pattern : drive.patterns) {
    if (pattern.message.learned_run_id != 0) continue;
    ++taught_;
    fair_ += pattern.message.accepted ? 1 : 0;
  }
}

/// `next`: what motor_bridge did after that; nullptr = the log ends.
void HandRecord::follow(const DriveTimeline& drive, const MotorNote& note, const MotorNote* next) {
  spans_.back().end = next == nullptr ? note.until : next->utime;
  if (note.command != Command{})
    moving_ += secondsOf(std::max<int64_t>(0, spans_.back().end - note.utime));
  if (next != nullptr && !isByHand(*next)) ++(mayDrive(next->state) ? given_back_ : stopped_);
  const size_t end = next == nullptr ? drive.messages : next->event;
  const auto [ins, ins_end] = notesBetween(drive.ins, note.event, end);
  std::for_each(ins, ins_end, [&](const InsNote& place) { odometer_.add(place); });
  std::copy_if(ins, ins_end, std::back_inserter(places_),
               [](const InsNote& place) { return place.placed; });
  const auto [plan, plan_end] = notesBetween(drive.plans, note.event, end);
  std::copy_if(plan, plan_end, std::back_inserter(plans_), [](const PlanNote& shadow) {
    return shadow.goal_id != 0 && (!shadow.T_map_next || shadow.duration > 0);
  });
}

double HandRecord::seconds() const {
  double sum = 0.0;
  for (const Span& span : spans_) sum += secondsOf(span.end - span.begin);
  return sum;
}

std::optional<Pose2> HandRecord::poseAt(int64_t utime) const {
  const auto found =
      std::lower_bound(places_.begin(), places_.end(), utime,
                       [](const InsNote& place, int64_t time) { return place.utime < time; });
  if (found == places_.end() || found->utime - utime > kPoseGap) return std::nullopt;
  return found->T_map_body;
}

bool HandRecord::inHand(int64_t from, int64_t to) const {
  return std::any_of(spans_.begin(), spans_.end(),
                     [&](const Span& span) { return span.begin <= from && to <= span.end; });
}

ShadowComparison HandRecord::comparison() const {
  constexpr int64_t kLook = 1'000'000;  // [us] what a person does where the planner has no way
  ShadowComparison result;
  for (const PlanNote& plan : plans_) {
    const int64_t duration = plan.T_map_next ? plan.duration : kLook;
    const std::optional<Pose2> here = poseAt(plan.utime);
    const std::optional<Pose2> there = poseAt(plan.utime + duration);
    if (!here || !there || !inHand(plan.utime, plan.utime + duration)) continue;
    ++result.plans;
    const BodyMotion person(between(*here, *there));
    const BodyMotion planner(plan.T_map_next ? between(*here, *plan.T_map_next) : Pose2{});
    result.same += sameMotion(person, planner) ? 1 : 0;
    if (planner.stands() && !person.stands()) {
      ++result.would_stand;
      ++result.why[plan.reason.words];
    }
    if (!person.travels() || !planner.travels()) continue;
    result.turned_away.push_back(std::abs(wrapAngle(person.direction - planner.direction)));
    result.person_speed.push_back(person.length / secondsOf(duration));
    result.planner_speed.push_back(planner.length / secondsOf(duration));
  }
  return result;
}

std::string HandRecord::words() const {
  if (spans_.empty()) return "";
  std::string words = formatted(
      "by hand: %.1f s (%.1f s moving, %.1f m); taken over %d times, armed for the hand %d times; "
      "given back %d times, stopped %d times\n",
      seconds(), moving_, distance(), taken_over_, armed_for_hand_, given_back_, stopped_);
  words += formatted("  it taught %d patterns, %d of them fair\n", taught_, fair_);
  const ShadowComparison shadow = comparison();
  if (shadow.plans == 0) return words + "  the planner had no goal meanwhile\n";
  words += formatted("  the planner would have made the same motion in %.0f %% of %d plans",
                     percent(shadow.same, shadow.plans), shadow.plans);
  if (!shadow.turned_away.empty())
    words += formatted("; where both travelled: directions %.0f deg apart, ",
                       median(shadow.turned_away) * 180.0 / kPi) +
             formatted("%.2f m/s by hand, %.2f m/s by the planner (medians)",
                       median(shadow.person_speed), median(shadow.planner_speed));
  words += formatted("\n  it would have stood in %.0f %% while the person moved\n",
                     percent(shadow.would_stand, shadow.plans));
  size_t lines = 0;
  for (const auto& [why, count] : shadow.why)
    if (lines++ < kMostReasons) words += formatted("    %d times: ", count) + why + "\n";
  return words;
}

}  // namespace tread::report
