// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/execution/way_back.hpp"

#include <cmath>

namespace tread::planner {
namespace {

constexpr int64_t kSteady = 2'000'000;  // [us] for which a link must have been good
constexpr int64_t kPause = 3'000'000;   // [us] before it sets off, so that people nearby notice it
constexpr int64_t kListen = 3'000'000;  // [us] at a place before it continues
constexpr double kSpacing = 0.5;        // [m] between remembered places
constexpr double kStep = 3.0;           // [m] to the next place if there is no operator
constexpr double kReached = 0.5;        // [m]
constexpr double kThere = 0.7;          // [m] coasting distance beyond a stopping place
constexpr double kMoreStd = 1.0;        // [m] by which the pose's uncertainty may have grown
constexpr size_t kMostPlaces = 4000;    // 2 km

}  // namespace

std::optional<Goal> WayBack::update(const LinkReading& link) {
  if (!link.good) good_since_.reset();
  if (!link.lost || !link.armed) {
    lost_since_.reset();
    there_since_.reset();
    given_up_ = false;
    state_ = {};
    remember(link);
    return std::nullopt;
  }
  if (!lost_since_) {
    lost_since_ = link.now;
    --goal_id_;
  }
  if (given_up_) return std::nullopt;
  return follow(link);
}

void WayBack::giveUp(const std::string& why) {
  if (!lost_since_ || given_up_) return;
  given_up_ = true;
  state_ = {StopReason::kOperatorLost, "the operator is lost, and the return has ended: " + why};
}

void WayBack::remember(const LinkReading& link) {
  if (!link.good || !link.T_map_body) return;
  good_since_ = good_since_.value_or(link.now);
  if (link.now - *good_since_ < kSteady) return;
  const Eigen::Vector2d p_map = link.T_map_body->position();
  if (!places_.empty() && (p_map - places_.back().p_map).norm() < kSpacing) return;
  places_.push_back({p_map, link.position_std});
  if (places_.size() > kMostPlaces) places_.pop_front();
}

/// An INS that never reports its accuracy is trusted while it has a position. One that stops
/// reporting it is not.
bool WayBack::uncertain(const LinkReading& link) const {
  const double std = places_.back().std;
  return std::isfinite(std) && !(link.position_std <= std + kMoreStd);
}

void WayBack::stepBack() {
  const Eigen::Vector2d p_map = places_.back().p_map;
  while (places_.size() > 1 && (places_.back().p_map - p_map).norm() < kStep) places_.pop_back();
  there_since_.reset();
  --goal_id_;
}

std::optional<Goal> WayBack::follow(const LinkReading& link) {
  state_ = StopReason::kOperatorLost;
  if (link.now - *lost_since_ < kPause || !link.T_map_body) return std::nullopt;
  if (places_.empty()) {
    giveUp("the link was never good");
    return std::nullopt;
  }
  if (uncertain(link)) {
    giveUp("the position has become too uncertain");
    return std::nullopt;
  }
  const bool there = (link.T_map_body->position() - places_.back().p_map).norm() < kThere;
  if (there) there_since_ = there_since_.value_or(link.now);
  if (there_since_ && link.now - *there_since_ > kListen) {
    if (places_.size() == 1) {
      giveUp("it is where its path began, and there is no operator");
      return std::nullopt;
    }
    stepBack();
  }
  state_ = StopReason::kReturns;
  Goal goal;
  goal.id = goal_id_;
  goal.T_map_goal = {places_.back().p_map.x(), places_.back().p_map.y(), 0.0};
  goal.position_tolerance = kReached;
  goal.yaw_tolerance = kPi;
  return goal;
}

}  // namespace tread::planner
