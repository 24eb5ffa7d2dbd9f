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
constexpr double kTogether = 0.3;    // [s] between beginnings, and between ends, of one hole
constexpr size_t kMostLines = 30;    // of a kind

bool isContinuous(const std::string& channel) {
  // Only while an operator's program runs.
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

std::vector<GoalStory> goalsOf(const std::vector<PlanNote>& plans) {
  std::vector<GoalStory> goals;
  for (const PlanNote& plan : plans) {
    const bool given = plan.goal_id != 0 && (goals.empty() || goals.back().id != plan.goal_id);
    if (given) goals.push_back({plan.goal_id, plan.time, plan.time, false, ""});
    if (goals.empty() || goals.back().arrived) continue;
    GoalStory& goal = goals.back();
    // Without a goal the planner gives its reason for dropping the last one.
    if (plan.goal_id != 0 || !plan.reason.words.empty()) goal.reason = plan.reason.words;
    if (plan.goal_id == 0) continue;
    goal.ended = plan.time;
    goal.arrived = plan.state == plan_t::PLAN_ARRIVED;
    if (goal.arrived) goal.reason.clear();
  }
  return goals;
}

/// Silences of each channel, ordered by their beginnings.
std::vector<Hole> silencesOf(const DriveTimeline& drive) {
  std::vector<Hole> silences;
  for (const auto& [channel, times] : drive.heard)
    for (size_t i = 1; isContinuous(channel) && i < times.size(); ++i)
      if (times[i] - times[i - 1] > kHole)
        silences.push_back({times[i - 1], times[i] - times[i - 1], {channel}});
  std::stable_sort(silences.begin(), silences.end(), [](const Hole& a, const Hole& b) {
    return std::pair(a.begin, a.length) < std::pair(b.begin, b.length);
  });
  return silences;
}

/// Whether the last loss, a fault or E-stop, lasts until the end of the log.
bool lossLasts(const DriveTimeline& drive) {
  if (drive.losses.empty() || !isSevere(drive.losses.back())) return false;
  const PermissionLoss& last = drive.losses.back();
  const auto [from, to] = notesBetween(drive.motors, last.event, drive.messages);
  // A fault after an E-stop does not end the loss.
  return std::all_of(from, to, [&](const MotorNote& note) {
    return note.state == last.state || note.state == motor_t::STATE_FAULT;
  });
}

std::string countsOf(const Chronicle& log) {
  const auto ended = [&](int16_t state) {
    return std::count_if(log.incidents.begin(), log.incidents.end(),
                         [&](const PermissionLoss& loss) { return loss.state == state; });
  };
  const auto reached = std::count_if(log.goals.begin(), log.goals.end(),
                                     [](const GoalStory& goal) { return goal.arrived; });
  return formatted("%td of %zu goals reached; %zu stops that needed arming ", reached,
                   log.goals.size(), log.incidents.size()) +
         formatted("(%td faults, %td E-stops)", ended(motor_t::STATE_FAULT),
                   ended(motor_t::STATE_ESTOP));
}

}  // namespace

Chronicle::Chronicle(const DriveTimeline& drive)
    : goals(goalsOf(drive.plans)), incidents(drive.losses), incident_lasts(lossLasts(drive)) {
  for (const Hole& silence : silencesOf(drive)) {
    const auto same = std::find_if(holes.begin(), holes.end(), [&](const Hole& hole) {
      return std::abs(hole.begin - silence.begin) < kTogether &&
             std::abs(hole.begin + hole.length - silence.begin - silence.length) < kTogether;
    });
    if (same == holes.end())
      holes.push_back(silence);
    else
      same->channels.push_back(silence.channels.front());
  }
}

std::string Chronicle::summary(int disarmed) const {
  if (goals.size() <= 1 && static_cast<int>(incidents.size()) <= disarmed && !incident_lasts)
    return "";
  std::string line = "in the whole log " + countsOf(*this);
  if (!goals.empty() && !goals.back().arrived) line += ", THE LAST GOAL NOT REACHED";
  if (incident_lasts)
    line += std::string(", IT ENDS WITH ") +
            (incidents.back().state == motor_t::STATE_FAULT ? "A FAULT" : "AN E-STOP");
  return line;
}

std::string Chronicle::words() const {
  if (goals.size() <= 1 && incidents.empty() && holes.empty()) return "";
  std::string words =
      "the whole log: " + countsOf(*this) + formatted("; %zu holes\n", holes.size());
  words += linesOf(goals, lineOf);
  words += linesOf(incidents, [](const PermissionLoss& incident) {
    return formatted("%7.1f s  ", incident.time) + nameOf(incident) + ": " + incident.reason.words;
  });
  words += linesOf(holes, [](const Hole& hole) {
    std::string names;
    for (const std::string& channel : hole.channels) names += (names.empty() ? "" : ", ") + channel;
    return formatted("%7.1f s  no message for %.1f s on ", hole.begin, hole.length) + names;
  });
  return words;
}

}  // namespace tread::report
