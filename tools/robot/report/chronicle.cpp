// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/report/chronicle.hpp"

#include <algorithm>
#include <cmath>

#include "common/report/text.hpp"

namespace tread::report {
namespace {

constexpr double kContinuous = 5.0;  // [Hz] a channel of this rate is never silent for long
constexpr double kHole = 0.5;        // [s] of silence of a channel of 5 Hz or more
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

bool isSevere(const PermissionLoss& loss) {
  return loss.state == motor_t::STATE_FAULT || loss.state == motor_t::STATE_ESTOP;
}

std::string nameOf(const PermissionLoss& loss) {
  if (!isSevere(loss)) return "disarmed";
  return loss.state == motor_t::STATE_FAULT ? "fault" : "E-stop";
}

std::string lineOf(const GoalStory& goal) {
  const std::string time = formatted("%7.1f s  goal ", goal.given) + std::to_string(goal.id);
  if (goal.arrived) return time + formatted(": arrived after %.1f s", goal.ended - goal.given);
  return time + formatted(": NOT reached in %.1f s", goal.ended - goal.given) +
         (goal.reason.empty() ? "" : ": " + goal.reason);
}

}  // namespace

Chronicle::Chronicle(const DriveTimeline& drive) : incidents_(drive.losses) {
  for (const PlanNote& plan : drive.plans) follow(plan);
  for (const auto& [channel, times] : drive.heard)
    for (size_t i = 1; isContinuous(channel) && i < times.size(); ++i)
      if (times[i] - times[i - 1] > kHole)
        silences_.push_back({times[i - 1], times[i] - times[i - 1], {channel}});
  if (incidents_.empty() || !isSevere(incidents_.back())) return;
  // A fault after an E-stop is no better an end.
  const auto [from, to] = notesBetween(drive.motors, incidents_.back().event, drive.messages);
  lasts_ = std::all_of(from, to, [&](const MotorNote& note) {
    return note.state == incidents_.back().state || note.state == motor_t::STATE_FAULT;
  });
}

void Chronicle::follow(const PlanNote& plan) {
  if (plan.goal_id == 0) {
    // Why the planner follows the last goal no more.
    if (!goals_.empty() && !goals_.back().arrived && !plan.reason.words.empty())
      goals_.back().reason = plan.reason.words;
    return;
  }
  if (goals_.empty() || goals_.back().id != plan.goal_id)
    goals_.push_back({plan.goal_id, plan.time, plan.time, false, ""});
  GoalStory& goal = goals_.back();
  if (goal.arrived) return;
  goal.ended = plan.time;
  goal.arrived = plan.state == plan_t::PLAN_ARRIVED;
  goal.reason = goal.arrived ? "" : plan.reason.words;
}

std::vector<Hole> Chronicle::holes() const {
  std::vector<Hole> sorted = silences_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Hole& a, const Hole& b) {
    return std::pair(a.begin, a.length) < std::pair(b.begin, b.length);
  });
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

int Chronicle::count(int16_t state) const {
  return static_cast<int>(
      std::count_if(incidents_.begin(), incidents_.end(),
                    [&](const PermissionLoss& incident) { return incident.state == state; }));
}

int Chronicle::reached() const {
  return static_cast<int>(std::count_if(goals_.begin(), goals_.end(),
                                        [](const GoalStory& goal) { return goal.arrived; }));
}

std::string Chronicle::counts() const {
  return formatted("%d of %zu goals reached; %zu stops that needed arming ", reached(),
                   goals_.size(), incidents_.size()) +
         formatted("(%d faults, %d E-stops)", count(motor_t::STATE_FAULT),
                   count(motor_t::STATE_ESTOP));
}

std::string Chronicle::summary(int disarmed) const {
  if (goals_.size() <= 1 && static_cast<int>(incidents_.size()) <= disarmed && !lasts_) return "";
  std::string line = "in the whole log " + counts();
  if (!goals_.empty() && !goals_.back().arrived) line += ", THE LAST GOAL NOT REACHED";
  if (lasts_)
    line += std::string(", IT ENDS WITH ") +
            (incidents_.back().state == motor_t::STATE_FAULT ? "A FAULT" : "AN E-STOP");
  return line;
}

std::string Chronicle::words() const {
  const std::vector<Hole> holes = this->holes();
  if (goals_.size() <= 1 && incidents_.empty() && holes.empty()) return "";
  std::string words = "the whole log: " + counts() + formatted("; %zu holes\n", holes.size());
  words += linesOf(goals_, lineOf);
  words += linesOf(incidents_, [](const PermissionLoss& incident) {
    return formatted("%7.1f s  ", incident.time) + nameOf(incident) + ": " + incident.reason.words;
  });
  words += linesOf(holes, [](const Hole& hole) {
    std::string names;
    for (const std::string& channel : hole.channels) names += (names.empty() ? "" : ", ") + channel;
    return formatted("%7.1f s  nothing for %.1f s of ", hole.begin, hole.length) + names;
  });
  return words;
}

}  // namespace tread::report
