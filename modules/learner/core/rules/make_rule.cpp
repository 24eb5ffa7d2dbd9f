// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <stdexcept>

#include "modules/learner/core/rules/bank.hpp"
#include "modules/learner/core/rules/collective.hpp"
#include "modules/learner/core/rules/local_filter.hpp"
#include "modules/learner/core/rules/off.hpp"
#include "modules/learner/core/rules/single.hpp"
#include "modules/learner/core/rules/telescoping.hpp"

namespace tread::learner {

std::unique_ptr<LearningRule> makeRule(const RuleConfig& config, const PatternSet& shipped) {
  if (!(config.memory >= 0.0 && config.memory < 1.0))
    throw std::invalid_argument("learner: memory must be in 0 <= memory < 1");
  if (config.bank.settled_after < 1 || config.bank.capacity < 1)
    throw std::invalid_argument(
        "learner: settled_after and capacity of the bank must be 1 or more");
  switch (config.rule) {
    case Rule::kOff:
      return std::make_unique<Off>(shipped);
    case Rule::kSingle:
      return std::make_unique<Single>(shipped, config.memory);
    case Rule::kCollective:
      return std::make_unique<Collective>(config, shipped);
    case Rule::kTelescoping:
      return std::make_unique<Telescoping>(config, shipped);
    case Rule::kLocalFilter:
      return std::make_unique<LocalFilter>(config.filter, shipped);
    case Rule::kBank:
      return std::make_unique<Bank>(config, shipped);
  }
  throw std::invalid_argument("learner: unknown rule");
}

}  // namespace tread::learner
