// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/patterns/live_recorder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <utility>

#include "common/messages/blank.hpp"
#include "common/messages/ins_messages.hpp"
#include "modules/planner/planner_messages.hpp"

namespace tread::patterns {
namespace {

using planner::BridgeReading;
using planner::ProgramBook;

constexpr int64_t kMaxFuture = 100'000;     // [us] by which a utime may be ahead
constexpr int64_t kTimeJump = 1'000'000;    // [us] between two steps
constexpr int64_t kListenFirst = 500'000;   // [us] for another planner, before anything is said
constexpr int64_t kMaxPoseAge = 150'000;    // [us] as the planner's
constexpr int64_t kMaxBridgeAge = 500'000;  // [us] the same
constexpr int64_t kLead = 600'000;  // [us] before its end the running pattern gets its successor
constexpr int64_t kLostAfter = 3'000'000;  // [us] of standing after which no record comes any more
constexpr int64_t kTwistWindow = 300'000;  // [us] over which standing is seen
constexpr double kStandingSpeed = 0.15;    // [m/s] and
constexpr double kStandingRate = 0.10;     // [rad/s]: noise of an INS at rest stays below
constexpr double kPlannedShare = 0.85;     // of the room; the rest is for what comes otherwise
constexpr int kMaxWithoutGain = 60;        // patterns

template <typename... Values>
std::string line(const char* format, Values... values) {
  std::array<char, 320> text{};
  std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

double distance(const Pose2& T_home_body) {
  return std::hypot(T_home_body.x, T_home_body.y);
}

bool senseless(int64_t utime, int64_t now) {
  return utime <= 0 || utime > now + kMaxFuture;
}

}  // namespace

LiveRecorder::LiveRecorder(const PatternSet& set, const LiveRecording& how, Bus& bus, Say say)
    : set_(set),
      how_(how),
      bus_(bus),
      say_(std::move(say)),
      tour_(set, kPlannedShare * how.room),
      health_(bus, "recorder", "pattern set: " + set.content().name + "\n"),
      book_(bus.bootId()),
      permission_(bus.now()),
      collector_(set, book_.runId(), how.executions, how.give_up_after, how.limits, say_) {
  subscribe();
}

void LiveRecorder::subscribe() {
  bus_.subscribe<ins_t>(kIns, [this](const ins_t& message) { take(message); });
  bus_.subscribe<motor_t>(kMotor, [this](const motor_t& message) { take(message); });
  bus_.subscribe<execution_t>(kExecution, [this](const execution_t& message) { take(message); });
  bus_.subscribe<program_t>(kProgram, [this](const program_t& message) { take(message); });
  bus_.subscribe<arm_t>(kArm,
                        [this](const arm_t& message) { permission_.take(message, bus_.now()); });
  bus_.subscribe<estop_t>(
      kEstop, [this](const estop_t& message) { permission_.take(message, bus_.now()); });
}

void LiveRecorder::take(const ins_t& message) {
  if (senseless(message.utime, bus_.now())) return;
  collector_.take(message, bus_.now());
  const std::optional<Pose2> pose = planarPose(message);
  if (!pose || (situation_.pose && message.utime <= situation_.pose->utime)) return;
  situation_.pose = planner::PoseReading{message.utime, *pose, planarTwist(message)};
}

void LiveRecorder::take(const motor_t& message) {
  if (senseless(message.utime, bus_.now())) return;
  collector_.take(message);
  if (situation_.bridge && message.utime < situation_.bridge->utime) return;
  situation_.bridge = planner::readingFrom(message);
  permission_.take(*situation_.bridge);
}

void LiveRecorder::take(const execution_t& message) {
  if (senseless(message.utime, bus_.now())) return;
  collector_.take(message, bus_.now());
  if (message.utime < executions_utime_) return;
  executions_utime_ = message.utime;
  situation_.executions = planner::readingsFrom(message);
}

void LiveRecorder::take(const program_t& message) {
  if (message.run_id == book_.runId() || senseless(message.utime, bus_.now())) return;
  silent_ = true;
  fail("another planner speaks on PROGRAM (its run is " + std::to_string(message.run_id) +
       "); end it first; config/launch/recording.yaml starts the robot without one");
}

void LiveRecorder::followTime(int64_t utime) {
  // Who armed before a time that jumped did not arm this run; see the planner.
  if (stepped_ && std::abs(utime - *stepped_) > kTimeJump) permission_.restart(utime);
  if (!stepped_ || std::abs(utime - *stepped_) > kTimeJump) begun_ = utime;
  stepped_ = utime;
}

void LiveRecorder::step(int64_t utime) {
  followTime(utime);
  situation_.now = utime;
  followExecutions(utime);
  if (state_ == State::kGoesOn) drive(utime);
  publishProgram(utime);
  publishHealth(utime);
}

void LiveRecorder::shutdown(int64_t utime) {
  book_.stop();
  publishProgram(utime);
}

void LiveRecorder::followExecutions(int64_t utime) {
  for (const int64_t execution : collector_.judge(utime)) under_way_.erase(execution);
  if (!collector_.hopeless().empty()) fail(collector_.hopeless());
  const ProgramBook::Event event = book_.follow(situation_);
  if (event == ProgramBook::Event::kAborted || event == ProgramBook::Event::kNeverStarted)
    say_("stopped: " + book_.abortReason());
  if (book_.running().empty()) forgetUnplayed();
}

/// Slots that the bridge never began will not be judged.
void LiveRecorder::forgetUnplayed() {
  for (auto it = under_way_.begin(); it != under_way_.end();) {
    const auto is_known = [&](const planner::ExecutionReading& record) {
      return record.run_id == book_.runId() && record.execution_id == it->first;
    };
    const bool known =
        std::any_of(situation_.executions.begin(), situation_.executions.end(), is_known);
    it = known ? std::next(it) : under_way_.erase(it);
  }
}

std::string LiveRecorder::roomExceeded() {
  if (!T_map_home_) return "";
  const double away = distance(fromHome(situation_.pose->T_map_body));
  if (away <= how_.room) return "";
  // Whoever brings it back decides anew whether it may go on.
  permission_.restart(situation_.now);
  return line(
      "%.1f m from where it began (%.1f, %.1f), the room is %.1f m: drive it back, then "
      "arm it again",
      std::ceil(away * 2.0) / 2.0, T_map_home_->x, T_map_home_->y, how_.room);
}

std::string LiveRecorder::obstacle(int64_t utime) {
  if (!situation_.pose) return "waiting for INS";
  if (utime - situation_.pose->utime > kMaxPoseAge) return "INS is silent";
  if (!situation_.bridge) return "waiting for MOTOR of motor_bridge";
  if (utime - situation_.bridge->utime > kMaxBridgeAge) return "MOTOR is silent";
  if (permission_.estopped()) return "emergency stop: clear it (tread-stop --clear) and arm";
  if (std::string away = roomExceeded(); !away.empty()) return away;
  if (!permission_.armed() || !situation_.bridge->armed())
    return "not armed: tread-arm allows it to drive";
  return "";
}

void LiveRecorder::drive(int64_t utime) {
  const std::string why = obstacle(utime);
  if (!why.empty()) {
    book_.stop();
    forgetUnplayed();
    standing_since_ = 0;
    return setReason(why);
  }
  if (book_.running().empty()) return goOnFromStanding(utime);
  standing_since_ = 0;
  setReason("");
  appendNext(utime);
}

void LiveRecorder::goOnFromStanding(int64_t utime) {
  if (standing_since_ == 0) standing_since_ = utime;
  if (utime - standing_since_ > kLostAfter) under_way_.clear();
  if (utime < begun_ + kListenFirst || !stands()) return;
  if (collector_.complete()) {
    state_ = State::kDone;
    return setReason("everything is recorded");
  }
  begin(utime);
}

void LiveRecorder::begin(int64_t utime) {
  const std::vector<int> open = needed();
  // What is on its way to be judged may be refused, and then it is needed again.
  if (*std::max_element(open.begin(), open.end()) <= 0) return;
  if (!T_map_home_) T_map_home_ = situation_.pose->T_map_body;
  const Pose2 T_home_body = fromHome(situation_.pose->T_map_body);
  const std::optional<size_t> pattern = tour_.next(tour_.standing(), T_home_body, open);
  if (!pattern)
    return setReason(
        line("no pattern fits into the room from here: drive it back to where it "
             "began (%.1f, %.1f)",
             T_map_home_->x, T_map_home_->y));
  setReason("");
  if (!counts(*pattern)) return;
  book_.begin(set_, set_.patterns()[*pattern].id, utime);
  under_way_[book_.running().execution_id] = *pattern;
}

void LiveRecorder::appendNext(int64_t utime) {
  if (!book_.confirmed() || !book_.next().empty() || book_.ends() - utime > kLead) return;
  const std::optional<size_t> pattern =
      tour_.next(book_.running().pattern().exit_class, fromHome(predictedEnd()), needed());
  if (!pattern || !counts(*pattern)) return;
  book_.setNext(set_, set_.patterns()[*pattern].id);
  under_way_[book_.next().execution_id] = *pattern;
}

bool LiveRecorder::counts(size_t pattern) {
  without_gain_ = needed()[pattern] > 0 ? 0 : without_gain_ + 1;
  if (without_gain_ <= kMaxWithoutGain) return true;
  fail("no pattern that is still needed fits into the room; give it a larger --room");
  return false;
}

bool LiveRecorder::stands() const {
  if (situation_.bridge->state != BridgeReading::State::kArmed) return false;
  const int64_t newest = collector_.track().newest();
  const PoseTrack* track = collector_.track().covering(newest);
  if (track == nullptr) return false;
  const auto twist = track->twistBefore(newest, kTwistWindow, kTwistWindow);
  return twist && std::hypot(twist->v_x, twist->v_y) < kStandingSpeed &&
         std::abs(twist->omega) < kStandingRate;
}

Pose2 LiveRecorder::predictedEnd() const {
  const MotionPattern& pattern = book_.running().pattern();
  const int64_t driven = (situation_.pose->utime - book_.started()) / set_.content().period_us;
  const auto samples = static_cast<size_t>(
      std::clamp<int64_t>(driven, 0, static_cast<int64_t>(pattern.trajectory.size())));
  const Pose2 T_start_now = samples == 0 ? Pose2{} : pattern.trajectory[samples - 1];
  return situation_.pose->T_map_body * between(T_start_now, pattern.end());
}

std::vector<int> LiveRecorder::needed() const {
  std::vector<int> open;
  for (size_t p = 0; p < set_.patterns().size(); ++p) open.push_back(collector_.missing(p));
  for (const auto& [execution, pattern] : under_way_) --open[pattern];
  return open;
}

void LiveRecorder::setReason(const std::string& reason) {
  if (reason == reason_) return;
  reason_ = reason;
  if (!reason_.empty()) say_(reason_);
}

void LiveRecorder::fail(const std::string& reason) {
  if (state_ != State::kGoesOn) return;
  book_.stop();
  state_ = State::kFailed;
  reason_ = reason;
}

void LiveRecorder::publishProgram(int64_t utime) {
  // A planner that was there before must not be stopped by a second voice: listen first.
  if (silent_ || utime < begun_ + kListenFirst) return;
  // Before the robot speaks its time is not known, and one that were told would be followed.
  if (!situation_.pose && !situation_.bridge) return;
  auto message = blank<program_t>();
  message.utime = utime;
  message.seq = seq_program_++;
  message.run_id = book_.runId();
  message.lease = static_cast<int32_t>(how_.lease_us);
  message.running = planner::toMessage(book_.running());
  message.next = planner::toMessage(book_.next());
  const BusStatistics& statistics = bus_.statistics();
  message.inputs_heard = statistics.received;
  message.newest_input = statistics.newest.channel;
  message.newest_input_utime = statistics.newest.utime;
  message.newest_input_seq = statistics.newest.seq;
  bus_.publish(kProgram, message);
}

void LiveRecorder::publishHealth(int64_t utime) {
  health_.setState(reason_.empty() ? health_t::HEALTH_OK : health_t::HEALTH_DEGRADED, reason_);
  int64_t fair = 0;
  for (const auto& executions : recorded()) fair += static_cast<int64_t>(executions.size());
  health_.setCounter("recorded", fair);
  health_.setCounter("refused", collector_.refused());
  health_.step(utime);
}

}  // namespace tread::patterns
