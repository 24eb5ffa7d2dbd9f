// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <stdexcept>

#include "modules/learner/core/rules/bank.hpp"
#include "modules/learner/core/rules/ground_filter.hpp"
#include "modules/learner/core/rules/scaling_rules.hpp"

namespace tread::learner {
namespace {

template <class Made>
std::unique_ptr<LearningRule> make(const RuleConfig& config, const PatternSet& shipped) {
  return std::make_unique<Made>(config, shipped);
}

struct NamedRule {
  const char* name;
  std::unique_ptr<LearningRule> (*make)(const RuleConfig& config, const PatternSet& shipped);
};

/// All rules, in the order in which reports list them. A new rule is one line here.
const NamedRule kRules[] = {
    {"off", &make<Off>},
    {"single", &make<Single>},
    {"collective", &make<Collective>},
    {"telescoping", &make<Telescoping>},
    {"local_filter", &make<LocalFilter>},
    {"bank", &make<Bank>},
};

}  // namespace

std::vector<std::string> ruleNames() {
  std::vector<std::string> names;
  for (const NamedRule& rule : kRules) names.emplace_back(rule.name);
  return names;
}

std::unique_ptr<LearningRule> makeRule(const RuleConfig& config, const PatternSet& shipped) {
  if (!(config.memory >= 0.0 && config.memory < 1.0))
    throw std::invalid_argument("learner: memory must be in 0 <= memory < 1");
  if (config.bank.settled_after < 1 || config.bank.capacity < 1)
    throw std::invalid_argument(
        "learner: settled_after and capacity of the bank must be 1 or more");
  for (const NamedRule& rule : kRules)
    if (config.rule == rule.name) return rule.make(config, shipped);
  throw std::invalid_argument("learner: unknown rule '" + config.rule + "'");
}

}  // namespace tread::learner
