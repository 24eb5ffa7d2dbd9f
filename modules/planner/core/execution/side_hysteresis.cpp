// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/execution/side_hysteresis.hpp"

#include <cmath>

namespace tread::planner {
namespace {

std::vector<int> idsOf(const std::vector<PlanStep>& plan) {
  std::vector<int> ids;
  for (const PlanStep& step : plan) ids.push_back(step.pattern_id);
  return ids;
}

bool isCutOff(const SearchResult& result) {
  return result.end == SearchEnd::kProgress;
}

}  // namespace

std::optional<SideHysteresis::Turn> SideHysteresis::turnOf(const std::vector<int>& ids,
                                                           const PatternTable& table) const {
  double time = 0.0;
  for (size_t i = 0; i < ids.size() && time < config_.ahead; ++i) {
    const TablePattern* pattern = table.find(ids[i]);
    if (pattern == nullptr) return std::nullopt;
    const double yaw = pattern->end().pose.yaw;
    if (std::abs(yaw) > config_.turn) return Turn{i, yaw > 0.0};
    time += pattern->duration;
  }
  return std::nullopt;
}

void SideHysteresis::begun(int pattern_id) {
  if (!intended_.empty() && intended_.front() == pattern_id)
    intended_.erase(intended_.begin());
  else
    intended_.clear();
}

void SideHysteresis::take(const std::vector<PlanStep>& plan, const PatternTable& table) {
  std::vector<int> ids = idsOf(plan);
  if (turnOf(ids, table) || !turnOf(intended_, table)) intended_ = std::move(ids);
}

std::vector<int> SideHysteresis::opposedBy(const std::vector<PlanStep>& plan,
                                           const PatternTable& table) const {
  const std::optional<Turn> wanted = turnOf(intended_, table);
  const std::optional<Turn> turn = turnOf(idsOf(plan), table);
  if (!wanted || !turn || wanted->left == turn->left) return {};
  return {intended_.begin(), intended_.begin() + static_cast<std::ptrdiff_t>(wanted->index) + 1};
}

bool SideHysteresis::isWorth(const SearchResult& fresh, const SearchResult& along_branch) const {
  if (along_branch.end == SearchEnd::kNothing) return true;
  if (isCutOff(fresh) != isCutOff(along_branch)) return isCutOff(along_branch);
  // What was cut off ends anywhere: only how near it comes to the goal can be compared.
  if (isCutOff(fresh)) return fresh.expected + config_.gain < along_branch.expected;
  return fresh.cost + fresh.expected + config_.gain < along_branch.cost + along_branch.expected;
}

}  // namespace tread::planner
