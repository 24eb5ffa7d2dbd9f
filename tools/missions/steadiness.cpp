// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/missions/steadiness.hpp"

#include <cmath>

namespace tread::missions {

std::optional<FlipDetector::Patterns> FlipDetector::patternsOf(
    const std::vector<int32_t>& ids) const {
  Patterns patterns;
  for (const int32_t id : ids) patterns.push_back(set_->find(id));
  for (const MotionPattern* pattern : patterns)
    if (pattern == nullptr) return std::nullopt;
  return patterns;
}

const MotionPattern* FlipDetector::turnOf(const Patterns& patterns) const {
  double time = 0.0;
  for (const MotionPattern* pattern : patterns) {
    if (time >= kAhead) break;
    if (std::abs(pattern->end().yaw) > kTurn) return pattern;
    time += set_->periodSeconds() * static_cast<double>(pattern->commands.size());
  }
  return nullptr;
}

std::optional<Flip> FlipDetector::hear(const plan_t& plan) {
  if (!set_ || plan.pattern_id.empty()) return std::nullopt;
  const bool begun = plan.execution_id.front() != running_;
  const bool as_intended = begun && !intended_.empty() && intended_.front() == plan.pattern_id[0];
  if (as_intended) intended_.erase(intended_.begin());
  running_ = plan.execution_id.front();
  const bool other_begun = begun && !as_intended;
  const std::vector<int32_t> after(plan.pattern_id.begin() + 1, plan.pattern_id.end());
  const auto present = patternsOf(other_begun ? plan.pattern_id : after);
  const auto before = patternsOf(intended_);
  const MotionPattern* running = set_->find(plan.pattern_id.front());
  if (!present || !before || running == nullptr) return std::nullopt;
  const MotionPattern* to = turnOf(*present);
  const MotionPattern* from = turnOf(*before);
  Pose2 T_map_start{plan.pose[0][0], plan.pose[0][1], plan.pose[0][2]};
  if (other_begun) T_map_start = T_map_start * inverse(running->end());
  if (other_begun || to != nullptr || from == nullptr) intended_ = after;
  const bool turned = to != nullptr && from != nullptr &&
                      std::signbit(to->end().yaw) != std::signbit(from->end().yaw);
  if (!turned || !is_free_(T_map_start, *before)) return std::nullopt;
  return Flip{0.0, from->name, to->name};
}

void StopDetector::step(int64_t utime, const Twist2& v_body, const StopReasons& reasons) {
  const bool slow = std::hypot(v_body.v_x, v_body.v_y) < kSlow && std::abs(v_body.omega) < kSlow;
  if (!slow && begun_ == 0) begun_ = utime;
  if (!slow && last_step_ != 0) driven_ += utime - last_step_;
  last_step_ = utime;
  if (slow && !slow_)
    slowed_ = {utime, utime, reasons.planner.empty() ? reasons.bridge : reasons.planner};
  slow_ = slow;
  if (!slow) resting_ = false;
  if (!slow || begun_ == 0) return;
  if (resting_) {
    rests_.back().to = utime;
  } else if (utime - slowed_.from >= kMoment) {
    rests_.push_back({slowed_.from, utime, slowed_.reason});
    resting_ = true;
  }
}

std::vector<Stop> StopDetector::stops(int64_t start, bool arrived) const {
  std::vector<Stop> stops;
  for (const Rest& rest : rests_)
    stops.push_back({static_cast<double>(rest.from - start) * 1e-6,
                     static_cast<double>(rest.to - rest.from) * 1e-6, rest.reason});
  if (arrived && resting_) stops.pop_back();
  return stops;
}

}  // namespace tread::missions
