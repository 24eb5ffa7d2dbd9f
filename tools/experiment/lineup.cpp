// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/experiment/lineup.hpp"

#include <algorithm>
#include <stdexcept>

namespace tread::experiment {
namespace {

using learner::LearningRule;
using learner::Rule;

std::unique_ptr<LearningRule> made(const std::string& name, learner::RuleConfig config,
                                   const PatternSet& shipped) {
  const bool banks = name == kBankUnseen || name == kBankEmpty;
  const auto rule = banks ? Rule::kBank : learner::ruleNamed(name);
  if (!rule) throw std::invalid_argument("no rule is called '" + name + "'");
  config.rule = *rule;
  return learner::makeRule(config, shipped);
}

}  // namespace

std::vector<std::string> contestantNames() {
  std::vector<std::string> names = learner::ruleNames();
  names.emplace_back(kBankUnseen);
  names.emplace_back(kBankEmpty);
  names.emplace_back(kOmniscient);
  return names;
}

Lineup::Lineup(const std::vector<std::string>& names, const learner::RuleConfig& config,
               const std::vector<Ground>& grounds, size_t from, size_t to, int64_t tour_executions,
               uint64_t tour_seed) {
  const std::string bank = learner::ruleName(Rule::kBank);
  for (const std::string& name : names) {
    Contestant one;
    if (name == learner::ruleName(Rule::kOff)) {
      one.fixed = &grounds[from].averaged_ends;
    } else if (name == kOmniscient) {
      one.fixed = &grounds[to].averaged_ends;
    } else {
      one.start = made(name, config, grounds[from].averaged);
      const size_t none = grounds.size();
      if (name == bank || name == kBankUnseen)
        driveTour(*one.start, grounds, {from, name == bank ? none : to, tour_executions},
                  tour_seed);
      one.state = one.start->clone();
    }
    contestants_.push_back(std::move(one));
  }
}

void Lineup::reset() {
  for (Contestant& one : contestants_)
    if (one.state) one.state->assign(*one.start);
}

}  // namespace tread::experiment
