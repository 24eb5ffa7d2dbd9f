// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tread/learning_t.hpp>
#include <tread/motor_t.hpp>
#include <tread/pattern_set_part_t.hpp>
#include <tread/plan_t.hpp>

#include "common/drive/odometer.hpp"
#include "common/geometry/se2.hpp"

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
  void take(const DriveEvent& event);

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
  struct ShadowPlan {
    int64_t utime = 0;
    std::optional<Pose2> T_map_end;  ///< of the first pattern; none = it had no way
    int64_t duration = 0;            ///< [us]
    std::string reason;
  };
  struct Place {
    int64_t utime;
    Pose2 T_map_body;
  };
  void hear(const motor_t& motor);
  void hear(const plan_t& plan);
  void hear(const learning_t& learning);
  void hear(const pattern_set_part_t& part);
  std::optional<Pose2> poseAt(int64_t utime) const;
  bool inHand(int64_t from, int64_t to) const;

  std::vector<Span> spans_;
  std::vector<ShadowPlan> plans_;
  std::vector<Place> places_;             ///< while in the hand
  Odometer odometer_;                     ///< the same
  std::map<int32_t, int64_t> durations_;  ///< [us] by pattern
  bool by_hand_ = false;
  bool was_armed_ = false;
  motor_t last_{};
  double moving_ = 0.0;
  int taken_over_ = 0;
  int armed_for_hand_ = 0;
  int given_back_ = 0;
  int stopped_ = 0;
  int taught_ = 0;
  int fair_ = 0;
};

}  // namespace tread::report
