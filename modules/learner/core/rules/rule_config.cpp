// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/rules/rule_config.hpp"

namespace tread::learner {

const std::vector<Rule>& allRules() {
  static const std::vector<Rule> all{Rule::kOff,         Rule::kSingle,      Rule::kCollective,
                                     Rule::kTelescoping, Rule::kLocalFilter, Rule::kBank};
  return all;
}

const char* ruleName(Rule rule) {
  switch (rule) {
    case Rule::kOff:
      return "off";
    case Rule::kSingle:
      return "single";
    case Rule::kCollective:
      return "collective";
    case Rule::kTelescoping:
      return "telescoping";
    case Rule::kLocalFilter:
      return "local_filter";
    case Rule::kBank:
      return "bank";
  }
  return "off";
}

std::optional<Rule> ruleNamed(const std::string& name) {
  for (const Rule rule : allRules())
    if (name == ruleName(rule)) return rule;
  return std::nullopt;
}

std::vector<std::string> ruleNames() {
  std::vector<std::string> names;
  for (const Rule rule : allRules()) names.emplace_back(ruleName(rule));
  return names;
}

}  // namespace tread::learner
