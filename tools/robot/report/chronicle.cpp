// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/report/chronicle.hpp"

#include <algorithm>
#include <cmath>

#include "common/drive/drive_log.hpp"
#include "common/messages/pattern_messages.hpp"
#include "common/report/text.hpp"

namespace tread::report {
namespace {

constexpr double kContinuous = 5.0;  // [Hz] a channel of this rate is never silent for long
constexpr double kTogether = 0.3;    // [s] between beginnings, and ends, of the same hole
constexpr size_t kMostLines = 30;    // of a kind

bool isContinuous(const std::string& channel) {
  // These come while an operator's program runs.
  if (channel == kOperator.name || channel == kManual.name) return false;
  return std::any_of(kChannels.begin(), kChannels.end(), [&](const ChannelSpec& spec) {
    return channel == spec.name && spec.rate_hz >= kContinuous;
  });
}

template <class Item, class Line>
std::string linesOf(const std::vector<Item>& items, Line line) {
  std::string words;
  for (size_t i = 0; i < items.size() && i < kMostLines; ++i) words += "  " + line(items[i]) + "\n";
  if (items.size() > kMostLines)
    words += "  and " + std::to_string(items.size() - kMostLines) + " more\n";
  return words;
}

std::string lineOf(const GoalStory& goal) {
  const std::string time = formatted("%7.1f s  goal ", goal.given) + std::to_string(goal.id);
  if (goal.arrived) return time + formatted(": arrived after %.1f s", goal.ended - goal.given);
  return time + formatted(": NOT reached in %.1f s", goal.ended - goal.given) +
         (goal.reason.empty() ? "" : ": " + goal.reason);
}

}  // namespace

void Chronicle::take(const LogEvent& event) {
  if (begun_ < 0) begun_ = event.utime;
  const double time = static_cast<double>(event.utime - begun_) * 1e-6;
  listen(event, time);
  plan_t plan;
  motor_t motor;
  if (decode(event, kPlan, plan)) hear(plan, time);
  if (decode(event, kMotor, motor)) hear(motor, time);
}

void Chronicle::listen(const LogEvent& event, double time) {
  if (!isContinuous(event.channel)) return;
  const auto [last, first] = heard_.try_emplace(event.channel, time);
  if (!first && time - last->second > kHole)
    silences_.push_back({last->second, time - last->second, {event.channel}});
  last->second = time;
}

void Chronicle::hear(const plan_t& plan, double time) {
  if (plan.goal_id == 0) {
    // Why the planner follows the last goal no more.
    if (!goals_.empty() && !goals_.back().arrived && !plan.reason.empty())
      goals_.back().reason = plan.reason;
    return;
  }
  if (goals_.empty() || goals_.back().id != plan.goal_id) {
    goals_.push_back({plan.goal_id, time, time, false, ""});
  }
  GoalStory& goal = goals_.back();
  if (goal.arrived) return;
  goal.ended = time;
  goal.arrived = plan.plan_status == plan_t::PLAN_ARRIVED;
  goal.reason = goal.arrived ? "" : plan.reason;
}

void Chronicle::hear(const motor_t& motor, double time) {
  const int16_t state = motor.bridge_state;
  const bool may = mayDrive(state);
  const bool entered = state != state_;
  std::string what;
  if (entered && state == motor_t::STATE_ESTOP) what = "E-stop";
  if (entered && state == motor_t::STATE_FAULT && may_drive_) what = "fault";
  // A fault after an E-stop is no better an end.
  if (entered && (!what.empty() || state != motor_t::STATE_FAULT)) ends_ = what;
  if (!what.empty())
    incidents_.push_back({time, what, motor.state_reason});
  else if (may_drive_ && !may)
    incidents_.push_back({time, "disarmed", motor.state_reason});
  state_ = state;
  may_drive_ = may;
}

std::vector<Hole> Chronicle::holes() const {
  std::vector<Hole> sorted = silences_;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Hole& a, const Hole& b) { return a.begin < b.begin; });
  std::vector<Hole> holes;
  for (const Hole& silence : sorted) {
    const auto same = std::find_if(holes.begin(), holes.end(), [&](const Hole& hole) {
      return std::abs(hole.begin - silence.begin) < kTogether &&
             std::abs(hole.begin + hole.length - silence.begin - silence.length) < kTogether;
    });
    if (same == holes.end())
      holes.push_back(silence);
    else
      same->channels.push_back(silence.channels.front());
  }
  return holes;
}

int Chronicle::count(const std::string& what) const {
  return static_cast<int>(
      std::count_if(incidents_.begin(), incidents_.end(),
                    [&](const Incident& incident) { return incident.what == what; }));
}

int Chronicle::reached() const {
  return static_cast<int>(std::count_if(goals_.begin(), goals_.end(),
                                        [](const GoalStory& goal) { return goal.arrived; }));
}

std::string Chronicle::counts() const {
  return formatted("%d of %zu goals reached; %zu stops that needed arming ", reached(),
                   goals_.size(), incidents_.size()) +
         formatted("(%d faults, %d E-stops)", count("fault"), count("E-stop"));
}

std::string Chronicle::summary(int disarmed) const {
  if (goals_.size() <= 1 && static_cast<int>(incidents_.size()) <= disarmed && ends_.empty())
    return "";
  std::string line = "in the whole log " + counts();
  if (!goals_.empty() && !goals_.back().arrived) line += ", THE LAST GOAL NOT REACHED";
  return ends_.empty() ? line
                       : line + ", IT ENDS WITH " + (ends_ == "fault" ? "A FAULT" : "AN E-STOP");
}

std::string Chronicle::words() const {
  const std::vector<Hole> holes = this->holes();
  if (goals_.size() <= 1 && incidents_.empty() && holes.empty()) return "";
  std::string words = "the whole log: " + counts() + formatted("; %zu holes\n", holes.size());
  words += linesOf(goals_, lineOf);
  words += linesOf(incidents_, [](const Incident& incident) {
    return formatted("%7.1f s  ", incident.time) + incident.what + ": " + incident.reason;
  });
  words += linesOf(holes, [](const Hole& hole) {
    std::string names;
    for (const std::string& channel : hole.channels) names += (names.empty() ? "" : ", ") + channel;
    return formatted("%7.1f s  nothing for %.1f s of ", hole.begin, hole.length) + names;
  });
  return words;
}

}  // namespace tread::report
