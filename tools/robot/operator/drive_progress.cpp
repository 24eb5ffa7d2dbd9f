// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/operator/drive_progress.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "common/report/text.hpp"

namespace tread::operators {
namespace {

constexpr int64_t kFreshAge = 1'000'000;  // [us]

}  // namespace

std::string statusWord(int16_t plan_status) {
  switch (plan_status) {
    case plan_t::PLAN_IDLE:
      return "idle";
    case plan_t::PLAN_DRIVING:
      return "driving";
    case plan_t::PLAN_ARRIVED:
      return "arrived";
    case plan_t::PLAN_WAITING:
      return "waiting";
    case plan_t::PLAN_BLOCKED:
      return "blocked";
    case plan_t::PLAN_UNREACHABLE:
      return "unreachable";
    case plan_t::PLAN_STOPPED:
      return "stopped";
    default:
      return "status " + std::to_string(plan_status);
  }
}

DriveProgress::DriveProgress(Bus& bus, const Pose2& T_map_goal, SurfaceNames surface_names)
    : T_map_goal_(T_map_goal),
      surface_names_(std::move(surface_names)),
      ins_(bus, kIns),
      plan_(bus, kPlan),
      motor_(bus, kMotor),
      execution_(bus, kExecution),
      learning_(bus, kLearning) {
  bus.subscribe<pattern_set_part_t>(kPatternSet, [this](const pattern_set_part_t& part) {
    names_[part.set_pattern_id] = part.pattern_name;
  });
}

double DriveProgress::toGo() const {
  if (!ins_.any()) return std::numeric_limits<double>::quiet_NaN();
  const auto& place = ins_.message().position;
  return std::hypot(T_map_goal_.x - place[0], T_map_goal_.y - place[1]);
}

std::string DriveProgress::patternName(int32_t id) const {
  const auto found = names_.find(id);
  return found == names_.end() ? "pattern " + std::to_string(id) : found->second;
}

std::string DriveProgress::line(int64_t utime) const {
  if (ins_.age(utime) > kFreshAge) return "no INS: is tread-ins-driver running?";
  if (plan_.age(utime) > kFreshAge) return "no PLAN: is tread-planner running?";
  const plan_t& plan = plan_.message();
  std::string text = formatted("to go %5.1f m  ", toGo()) + statusWord(plan.plan_status);
  if (!plan.reason.empty()) text += " (" + plan.reason + ")";
  if (motor_.any() && motor_.message().execution_id != 0 && execution_.any() &&
      !execution_.message().records.empty())
    text += "  " + patternName(execution_.message().records.back().record_pattern_id);
  if (surface_names_) {
    const auto& place = ins_.message().position;
    text += " on " + surface_names_({place[0], place[1]});
  }
  if (learning_.any() && std::isfinite(learning_.message().error_position)) {
    const learning_t& learned = learning_.message();
    text += formatted("  last error %.2f m", learned.error_position) +
            formatted(" %.1f deg", std::abs(learned.error_yaw) * 180.0 / kPi);
  }
  return text + "  set " + std::to_string(plan.set_version);
}

}  // namespace tread::operators
