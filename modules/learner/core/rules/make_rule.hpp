// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/learner/core/rules/learning_rule.hpp"

namespace tread::learner {

/// Names of all rules, in the order in which reports list them.
std::vector<std::string> ruleNames();

/// The rule that a configuration names, knowing nothing but the shipped set.
std::unique_ptr<LearningRule> makeRule(const RuleConfig& config, const PatternSet& shipped);

}  // namespace tread::learner
