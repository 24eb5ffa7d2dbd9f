// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/rules/make_rule.hpp"

#include <stdexcept>

#include "modules/learner/core/rules/collective.hpp"
#include "modules/learner/core/rules/multi_model.hpp"
#include "modules/learner/core/rules/off.hpp"
#include "modules/learner/core/rules/single.hpp"
#include "modules/learner/core/rules/telescoping.hpp"

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

/// All rules, in the order of reports. A new rule needs one line here.
const NamedRule kRules[] = {
    {"off", &make<Off>},
    {"single", &make<Single>},
    {"collective", &make<Collective>},
    {"telescoping", &make<Telescoping>},
    {"multi_model", &make<MultiModel>},
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
  if (config.ground.settled_after < 1 || config.ground.capacity < 1 || config.ground.moments < 3)
    throw std::invalid_argument(
        "learner: settled_after and capacity must be 1 or more, moments 3 or more");
  for (const NamedRule& rule : kRules)
    if (config.rule == rule.name) return rule.make(config, shipped);
  throw std::invalid_argument("learner: unknown rule '" + config.rule + "'");
}

}  // namespace tread::learner
