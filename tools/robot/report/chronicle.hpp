// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/log/event_log.hpp"

namespace tread::report {

/// What became of a goal.
struct GoalStory {
  int64_t id = 0;
  double given = 0.0;  ///< [s] since the log began, when the planner first had it
  double ended = 0.0;  ///< [s] of the arrival, or when the planner had it last
  bool arrived = false;
  std::string reason;  ///< the planner's last one, where it did not arrive
};

/// A permission to drive that was lost, a fault or an emergency stop.
struct Incident {
  double time = 0.0;  ///< [s] since the log began
  std::string what;   ///< "disarmed", "fault" or "E-stop"
  std::string reason;
};

/// A time in which channels were silent that spoke before and after it.
struct Hole {
  double begin = 0.0;   ///< [s] since the log began
  double length = 0.0;  ///< [s]
  std::vector<std::string> channels;
};

/// The whole log, beyond the first arrival: goals, incidents, holes.
class Chronicle {
 public:
  void take(const LogEvent& event);

  const std::vector<GoalStory>& goals() const { return goals_; }
  const std::vector<Incident>& incidents() const { return incidents_; }
  /// In the order of their beginnings; channels that fell silent and came back together are one.
  std::vector<Hole> holes() const;
  /// Whether the last goal was reached, and no fault or E-stop lasts to the log's end.
  bool endsWell() const { return !goals_.empty() && goals_.back().arrived && ends_.empty(); }
  /// What became of it all, for one line; empty where nothing followed the first goal but
  /// `disarmed` losses of the permission.
  std::string summary(int disarmed) const;
  /// Some lines; empty for a log with one goal at most, where nothing else happened.
  std::string words() const;

 private:
  static constexpr double kHole = 0.5;  ///< [s] of silence of a channel of 5 Hz or more

  void listen(const LogEvent& event, double time);
  void hear(const plan_t& plan, double time);
  void hear(const motor_t& motor, double time);
  int count(const std::string& what) const;
  int reached() const;
  std::string counts() const;

  int64_t begun_ = -1;  ///< [us]
  std::vector<GoalStory> goals_;
  std::vector<Incident> incidents_;
  std::map<std::string, double> heard_;  ///< [s] by channel, the last message
  std::vector<Hole> silences_;           ///< of one channel each
  int16_t state_ = 0;
  std::string ends_;  ///< "fault" or "E-stop" while it lasts
  bool may_drive_ = false;
};

}  // namespace tread::report
