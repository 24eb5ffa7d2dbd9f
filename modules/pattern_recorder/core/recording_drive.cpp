// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/pattern_recorder/core/recording_drive.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <utility>

namespace tread::pattern_recorder {
namespace {

constexpr int kMaxDepth = 6;
constexpr int kMaxExpansions = 20'000;  // about two milliseconds
constexpr double kTimeCost = 0.05;      // [1/s]
constexpr double kFarCost = 0.5;        // at the border of the room
constexpr double kLagGain = 0.5;        // for the pattern furthest behind
constexpr double kLaterShare = 0.9;     // weight of each next pattern relative to the previous one
constexpr double kTurnMoves = 0.05;     // [m] by which turning in place may move the robot outwards

double distance(const Pose2& T_home_body) {
  return std::hypot(T_home_body.x, T_home_body.y);
}

constexpr int64_t kMaxPoseAge = 150'000;    // [us] as the planner's
constexpr int64_t kMaxBridgeAge = 500'000;  // [us] as the planner's
constexpr int64_t kLead =
    600'000;  // [us] before its end, when the running pattern gets its successor
constexpr int64_t kLostAfter = 3'000'000;  // [us] of standstill after which no more records arrive
constexpr double kPlannedShare = 0.85;     // of the room; the rest is a margin for deviations
constexpr int kMaxWithoutGain = 60;        // patterns

/// A number with one decimal, such as "-3.5".
std::string withTenths(double value) {
  const auto tenths = std::lround(10.0 * std::abs(value));
  return (std::signbit(value) ? "-" : "") + std::to_string(tenths / 10) + "." +
         std::to_string(tenths % 10);
}

std::string placeOf(const Pose2& pose) {
  return "(" + withTenths(pose.x) + ", " + withTenths(pose.y) + ")";
}

}  // namespace

/// Iterative deepening search over chains; keeps the first pattern of the best one.
struct ExcitationPlanner::Search {
  const ExcitationPlanner& excitation;
  std::vector<int> needed;
  double most_needed;
  double limit;  // [m] for the place where it would stop
  int expansions = 0;
  double best_value = -std::numeric_limits<double>::infinity();
  std::optional<size_t> best_first;

  Search(const ExcitationPlanner& of, const std::vector<int>& still_needed, double stands_within)
      : excitation(of),
        needed(still_needed),
        most_needed(*std::max_element(needed.begin(), needed.end())),
        limit(stands_within) {}

  void run(size_t motion_class, const Pose2& T_home_body) {
    std::optional<size_t> found;
    for (int depth = 1; depth <= kMaxDepth && expansions < kMaxExpansions; ++depth) {
      best_value = -std::numeric_limits<double>::infinity();
      best_first.reset();
      extend(motion_class, T_home_body, depth, 0.0, 1.0, std::nullopt);
      // A search that was cut short is incomplete: the previous result counts.
      if (expansions < kMaxExpansions || !found) found = best_first;
    }
    best_first = found;
  }

  void extend(size_t motion_class, const Pose2& T_home_body, int depth, double value, double share,
              std::optional<size_t> first) {
    for (const Step& step : excitation.steps_[motion_class]) {
      if (++expansions >= kMaxExpansions) return;
      const Pose2 T_home_end = T_home_body * step.T_start_end;
      if (distance(T_home_end * excitation.ways_[step.to].T_start_end) > limit) continue;
      const double gained = value - kTimeCost * step.duration + share * gain(step.pattern);
      const size_t chain_first = first.value_or(step.pattern);
      note(gained - kFarCost * std::pow(distance(T_home_end) / limit, 2), chain_first);
      if (depth == 1) continue;
      --needed[step.pattern];
      extend(step.to, T_home_end, depth - 1, gained, share * kLaterShare, chain_first);
      ++needed[step.pattern];
    }
  }

  double gain(size_t pattern) const {
    const int times = needed[pattern];
    return times > 0 ? 1.0 + kLagGain * times / most_needed : 0.0;
  }

  void note(double value, size_t first) {
    if (value <= best_value) return;
    best_value = value;
    best_first = first;
  }
};

ExcitationPlanner::ExcitationPlanner(const PatternSet& set, double room) : room_(room) {
  const std::vector<MotionClass>& classes = set.content().classes;
  standing_ = classes.size();
  for (size_t c = 0; c < classes.size(); ++c) {
    class_names_.push_back(classes[c].name);
    if (standing_ == classes.size() && classes[c].steady == Command{}) standing_ = c;
  }
  if (standing_ == classes.size())
    throw std::runtime_error("no class of set '" + set.content().name +
                             "' stands still (steady command 0, 0): nothing to begin and end with");
  steps_.resize(classes.size());
  for (size_t p = 0; p < set.patterns().size(); ++p) {
    const MotionPattern& pattern = set.patterns()[p];
    steps_[classIndex(pattern.entry_class)].push_back(
        {p, classIndex(pattern.exit_class), pattern.end(),
         static_cast<double>(pattern.commands.size()) * set.periodSeconds()});
  }
  findWays();
  requireConnected(set);
}

size_t ExcitationPlanner::classIndex(const std::string& name) const {
  const auto found = std::find(class_names_.begin(), class_names_.end(), name);
  return static_cast<size_t>(found - class_names_.begin());
}

/// Bellman-Ford, because there are few patterns.
void ExcitationPlanner::findWays() {
  ways_.assign(class_names_.size(), {});
  ways_[standing_].duration = 0.0;
  for (size_t round = 0; round < class_names_.size(); ++round)
    for (size_t from = 0; from < steps_.size(); ++from)
      for (const Step& step : steps_[from]) {
        const Way& rest = ways_[step.to];
        if (rest.duration < 0.0) continue;
        const double duration = step.duration + rest.duration;
        if (ways_[from].duration >= 0.0 && ways_[from].duration <= duration) continue;
        ways_[from] = {duration, step.T_start_end * rest.T_start_end, step.pattern};
      }
}

void ExcitationPlanner::requireConnected(const PatternSet& set) const {
  const std::set<std::string> reached = connectedClasses(set, {standing()}, false);
  for (size_t c = 0; c < class_names_.size(); ++c) {
    const std::string which =
        "class '" + class_names_[c] + "' of set '" + set.content().name + "' ";
    if (reached.count(class_names_[c]) == 0)
      throw std::runtime_error(which +
                               "cannot be reached from standing: add a pattern that leads "
                               "into it");
    if (ways_[c].duration < 0.0)
      throw std::runtime_error(which + "cannot be left: add a pattern that leads to standing");
  }
}

std::optional<size_t> ExcitationPlanner::next(const std::string& motion_class,
                                              const Pose2& T_home_body,
                                              const std::vector<int>& needed) const {
  const size_t from = classIndex(motion_class);
  if (*std::max_element(needed.begin(), needed.end()) <= 0) return ways_[from].first;
  // If it is already too far away, no pattern may lead farther, except for turns, which it needs to
  // turn back.
  const double stands_at = distance(T_home_body * ways_[from].T_start_end);
  Search search(*this, needed, std::max(room_, stands_at + kTurnMoves));
  search.run(from, T_home_body);
  return search.best_first ? search.best_first : ways_[from].first;
}

RecordingDrive::RecordingDrive(const PatternSet& set, double room, int64_t run_id, Say say)
    : set_(set),
      room_(room),
      say_(std::move(say)),
      excitation_(set, kPlannedShare * room),
      tracker_(run_id) {}

void RecordingDrive::step(const RobotReadings& readings, const RecordingProgress& progress,
                          bool may_begin) {
  for (const int64_t execution : progress.judged) under_way_.erase(execution);
  if (!progress.hopeless.empty()) fail(progress.hopeless);
  const ExecutionTracker::Event event = tracker_.follow(readings);
  if (event == ExecutionTracker::Event::kAborted || event == ExecutionTracker::Event::kNeverStarted)
    say_("stopped: " + tracker_.abortReason().words);
  if (tracker_.running().empty()) forgetUnplayed(readings);
  left_room_ = false;
  if (state_ == State::kRunning) drive(readings, progress, may_begin);
}

/// Slots that the bridge never started get no result.
void RecordingDrive::forgetUnplayed(const RobotReadings& readings) {
  for (auto it = under_way_.begin(); it != under_way_.end();) {
    const bool known = std::any_of(
        readings.executions.begin(), readings.executions.end(), [&](const ExecutionRecord& record) {
          return record.run_id == tracker_.runId() && record.execution_id == it->first;
        });
    it = known ? std::next(it) : under_way_.erase(it);
  }
}

std::string RecordingDrive::roomExceeded(const Pose2& T_map_body) {
  if (!T_map_home_) return "";
  const Pose2 T_home_body = fromHome(T_map_body);
  const double away = std::hypot(T_home_body.x, T_home_body.y);
  if (away <= room_) return "";
  left_room_ = true;
  return withTenths(std::ceil(away * 2.0) / 2.0) + " m from where it began " +
         placeOf(*T_map_home_) + ", the room is " + withTenths(room_) +
         " m: drive it back, then arm it again";
}

std::string RecordingDrive::obstacle(const RobotReadings& readings) {
  if (!readings.pose) return "waiting for INS";
  if (readings.now - readings.pose->utime > kMaxPoseAge) return "INS is silent";
  if (!readings.bridge) return "waiting for MOTOR of motor_bridge";
  if (readings.now - readings.bridge->utime > kMaxBridgeAge) return "MOTOR is silent";
  if (readings.estopped) return "emergency stop: clear it (tread-stop --clear) and arm";
  if (std::string away = roomExceeded(readings.pose->T_map_body); !away.empty()) return away;
  if (!readings.armed_by_operator || !readings.bridge->armed())
    return "not armed: tread-arm allows it to drive";
  return "";
}

void RecordingDrive::drive(const RobotReadings& readings, const RecordingProgress& progress,
                           bool may_begin) {
  const std::string why = obstacle(readings);
  if (!why.empty()) {
    tracker_.stop();
    forgetUnplayed(readings);
    standing_since_.reset();
    return setReason(why);
  }
  if (!tracker_.running().empty()) {
    standing_since_.reset();
    setReason("");
    return appendNext(readings, progress.missing);
  }
  if (!standing_since_) standing_since_ = readings.now;
  if (readings.now - *standing_since_ > kLostAfter) under_way_.clear();
  const bool stands = readings.bridge->state == BridgeState::kArmed && progress.standing;
  if (!may_begin || !stands) return;
  const auto& missing = progress.missing;
  if (std::all_of(missing.begin(), missing.end(), [](int count) { return count <= 0; })) {
    state_ = State::kDone;
    return setReason("everything is recorded");
  }
  begin(readings, missing);
}

void RecordingDrive::begin(const RobotReadings& readings, const std::vector<int>& missing) {
  const std::vector<int> open = needed(missing);
  // An execution in progress may be refused, and then it is needed again.
  if (*std::max_element(open.begin(), open.end()) <= 0) return;
  if (!T_map_home_) T_map_home_ = readings.pose->T_map_body;
  const std::optional<size_t> pattern =
      excitation_.next(excitation_.standing(), fromHome(readings.pose->T_map_body), open);
  if (!pattern)
    return setReason("no pattern fits into the room from here: drive it back to where it began " +
                     placeOf(*T_map_home_));
  setReason("");
  if (!gains(open[*pattern] > 0)) return;
  tracker_.begin(set_, set_.patterns()[*pattern].id, readings.now);
  under_way_[tracker_.running().execution_id] = *pattern;
}

void RecordingDrive::appendNext(const RobotReadings& readings, const std::vector<int>& missing) {
  if (!tracker_.confirmed() || !tracker_.next().empty() || tracker_.ends() - readings.now > kLead)
    return;
  const std::vector<int> open = needed(missing);
  const std::optional<size_t> pattern = excitation_.next(
      tracker_.running().pattern().exit_class, fromHome(predictedEnd(*readings.pose)), open);
  if (!pattern || !gains(open[*pattern] > 0)) return;
  tracker_.setNext(set_, set_.patterns()[*pattern].id);
  under_way_[tracker_.next().execution_id] = *pattern;
}

bool RecordingDrive::gains(bool is_needed) {
  without_gain_ = is_needed ? 0 : without_gain_ + 1;
  if (without_gain_ <= kMaxWithoutGain) return true;
  fail("no pattern that is still needed fits into the room; give it a larger --room");
  return false;
}

Pose2 RecordingDrive::predictedEnd(const PoseReading& pose) const {
  const MotionPattern& pattern = tracker_.running().pattern();
  const int64_t driven = (pose.utime - tracker_.started()) / set_.content().period_us;
  const auto samples = static_cast<size_t>(
      std::clamp<int64_t>(driven, 0, static_cast<int64_t>(pattern.trajectory.size())));
  const Pose2 T_start_now = samples == 0 ? Pose2{} : pattern.trajectory[samples - 1];
  return pose.T_map_body * between(T_start_now, pattern.end());
}

std::vector<int> RecordingDrive::needed(const std::vector<int>& missing) const {
  std::vector<int> open = missing;
  for (const auto& [execution, pattern] : under_way_) --open[pattern];
  return open;
}

void RecordingDrive::setReason(const std::string& reason) {
  if (reason == reason_) return;
  reason_ = reason;
  if (!reason_.empty()) say_(reason_);
}

void RecordingDrive::fail(const std::string& reason) {
  if (state_ != State::kRunning) return;
  tracker_.stop();
  state_ = State::kFailed;
  reason_ = reason;
}

}  // namespace tread::pattern_recorder
