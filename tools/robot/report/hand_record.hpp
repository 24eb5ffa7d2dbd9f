// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/drive/drive_timeline.hpp"

namespace tread::report {

/// How a person's driving compares with what the planner would have done meanwhile.
struct ShadowComparison {
  int plans = 0;                     ///< made while a person drove, with what came of it known
  int same = 0;                      ///< ... whose first pattern is the motion that the person made
  int would_stand = 0;               ///< ... that had no way, or stood, while the person moved
  std::map<std::string, int> why;    ///< the planner's reasons for standing
  std::vector<double> turned_away;   ///< [rad] between both directions, where both travelled
  std::vector<double> person_speed;  ///< [m/s] there
  std::vector<double> planner_speed;
};

/// What a person drove by hand, and what the planner would have done.
class HandRecord {
 public:
  explicit HandRecord(const DriveTimeline& drive);

  int takenOver() const { return taken_over_; }
  int givenBack() const { return given_back_; }
  /// Times that it ended by a stop that needed arming.
  int stopped() const { return stopped_; }
  /// [s] in the hand, and of it with a command other than zero.
  double seconds() const;
  double moving() const { return moving_; }
  double distance() const { return odometer_.distance(); }  ///< [m]
  /// For each plan the first pattern, against where the robot was led in the same time.
  ShadowComparison comparison() const;
  /// Some lines; empty where nobody drove by hand.
  std::string words() const;

 private:
  struct Span {
    int64_t begin = 0;  ///< [us]
    int64_t end = 0;
  };
  void follow(const DriveTimeline& drive, const MotorNote& note, const MotorNote* next);
  std::optional<Pose2> poseAt(int64_t utime) const;
  bool inHand(int64_t from, int64_t to) const;

  std::vector<Span> spans_;
  std::vector<PlanNote> plans_;  ///< while in the hand
  std::vector<InsNote> places_;  ///< the same
  Odometer odometer_;            ///< the same
  double moving_ = 0.0;
  int taken_over_ = 0;
  int armed_for_hand_ = 0;
  int given_back_ = 0;
  int stopped_ = 0;
  int taught_ = 0;
  int fair_ = 0;
};

}  // namespace tread::report
