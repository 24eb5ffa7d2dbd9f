// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>

#include "modules/learner/core/rules/multi_model.hpp"

// Saving and restoring the rule's state.
namespace tread::learner {

std::vector<double> MultiModel::memory() const {
  std::vector<double> memory{static_cast<double>(clock_),  changes_,         metres_,
                             static_cast<double>(ground_), calm_.log_factor, searching_.log_factor,
                             noticed_ ? 1.0 : 0.0};
  memory.insert(memory.end(), scatter_.sums.data(), scatter_.sums.data() + scatter_.sums.size());
  effects_.save(memory);
  for (const auto* hypotheses : {&surfaces_, &fresh_}) {
    memory.push_back(static_cast<double>(hypotheses->size()));
    for (const Hypothesis& hypothesis : *hypotheses) {
      memory.push_back(hypothesis.weight);
      memory.push_back(static_cast<double>(hypothesis.last_met));
      memory.push_back(static_cast<double>(hypothesis.since));
      hypothesis.surface.save(memory);
    }
  }
  return memory;
}

bool MultiModel::restoreHypotheses(std::vector<Hypothesis>& hypotheses, const Surface& first,
                                   size_t most, const std::vector<double>& memory,
                                   size_t& at) const {
  if (at >= memory.size() || !isCount(memory[at], static_cast<double>(most))) return false;
  const auto count = static_cast<size_t>(memory[at++]);
  hypotheses.clear();
  for (size_t i = 0; i < count; ++i) {
    if (memory.size() < at + 3) return false;
    Hypothesis hypothesis{i == 0 ? first : new_, memory[at]};
    if (!(hypothesis.weight >= 0.0 && hypothesis.weight <= 1.0 + 1e-9)) return false;
    if (!isCount(memory[at + 1], static_cast<double>(clock_))) return false;
    if (!isCount(memory[at + 2], static_cast<double>(clock_))) return false;
    hypothesis.last_met = static_cast<int64_t>(memory[at + 1]);
    hypothesis.since = static_cast<int64_t>(memory[at + 2]);
    at += 3;
    if (!hypothesis.surface.restore(config_, memory, at)) return false;
    hypotheses.push_back(std::move(hypothesis));
  }
  return true;
}

bool MultiModel::restore(const TrajectoryTable&, const std::vector<double>& memory) {
  for (const double number : memory)
    if (!std::isfinite(number)) return false;
  size_t at = 7 + static_cast<size_t>(scatter_.sums.size());
  if (memory.size() < at || !isCount(memory[0], kMostExecutions)) return false;
  MultiModel rule = *this;
  rule.clock_ = static_cast<int64_t>(memory[0]);
  rule.changes_ = memory[1];
  rule.metres_ = memory[2];
  if (!(rule.changes_ >= 0.0 && rule.changes_ <= kMostExecutions) ||
      !(rule.metres_ >= 0.0 && rule.metres_ <= kLongestWay) || !isCount(memory[3], memory[0]))
    return false;
  rule.ground_ = static_cast<int64_t>(memory[3]);
  rule.calm_.log_factor = memory[4];
  rule.searching_.log_factor = memory[5];
  for (const Calibration* calibration : {&rule.calm_, &rule.searching_})
    if (calibration->log_factor < Calibration::kNarrowest ||
        calibration->log_factor > Calibration::kWidest)
      return false;
  if (!isCount(memory[6], 1.0)) return false;
  rule.noticed_ = memory[6] == 1.0;
  std::copy_n(memory.begin() + 7, rule.scatter_.sums.size(), rule.scatter_.sums.data());
  if (rule.scatter_.sums.minCoeff() < 0.0 ||
      rule.scatter_.sums.maxCoeff() > kMostError * kMostExecutions)
    return false;
  if (!rule.effects_.restore(memory, at)) return false;
  if (!rule.restoreHypotheses(rule.surfaces_, surfaces_.front().surface,
                              GroundConfig::kMostSurfaces + 1, memory, at) ||
      !rule.restoreHypotheses(rule.fresh_, new_, static_cast<size_t>(config_.moments), memory,
                              at) ||
      at != memory.size() || rule.surfaces_.empty())
    return false;
  double total = 0.0;
  for (const auto* hypotheses : {&rule.surfaces_, &rule.fresh_})
    for (const Hypothesis& hypothesis : *hypotheses) total += hypothesis.weight;
  if (std::abs(total - 1.0) > 1e-6) return false;
  rule.expectNew();
  rule.mix();
  *this = rule;
  return true;
}

}  // namespace tread::learner
