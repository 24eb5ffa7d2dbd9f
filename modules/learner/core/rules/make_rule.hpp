// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/learner/core/rules/learning_rule.hpp"

namespace tread::learner {

/// Names of all rules, in the order of reports.
std::vector<std::string> ruleNames();

/// The rule that a configuration names, in its initial state for the shipped set.
std::unique_ptr<LearningRule> makeRule(const RuleConfig& config, const PatternSet& shipped);

}  // namespace tread::learner
