// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/experiment/lineup.hpp"

#include <algorithm>
#include <stdexcept>

namespace tread::experiment {
namespace {

using learner::LearningRule;
using learner::Rule;

constexpr int kLeg = 40;          // executions on each surface of a tour
constexpr int kLongestLeg = 120;  // if the surface is still unknown by then

TourLeg driveLeg(LearningRule& rule, const Ground& ground, std::mt19937_64& random) {
  TourLeg leg{ground.surface};
  bool known = false;
  while (leg.executions < kLeg || (!known && leg.executions < kLongestLeg)) {
    const size_t pattern = drawIndex(random, ground.executions.size());
    const Executions& executions = ground.executions[pattern];
    learner::RuleNote note;
    rule.learn(pattern, executions.of(drawIndex(random, executions.size())), note);
    ++leg.executions;
    if (note.surface_stored && leg.stored_after == 0) leg.stored_after = leg.executions;
    // At first it may still be taken for the surface before.
    known = leg.stored_after > 0 || (leg.executions >= kLeg && note.surface > 0);
  }
  return leg;
}

std::unique_ptr<LearningRule> made(const std::string& name, learner::RuleConfig config,
                                   const PatternSet& shipped) {
  const auto rule = name == kBankUnseen ? Rule::kBank : learner::ruleNamed(name);
  if (!rule) throw std::invalid_argument("no rule is called '" + name + "'");
  config.rule = *rule;
  return learner::makeRule(config, shipped);
}

}  // namespace

std::vector<TourLeg> driveTour(LearningRule& rule, const std::vector<Ground>& grounds, size_t home,
                               size_t unseen, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<size_t> others;
  for (size_t s = 0; s < grounds.size(); ++s)
    if (s != home && s != unseen) others.push_back(s);
  for (size_t left = others.size(); left > 1; --left)
    std::swap(others[left - 1], others[drawIndex(random, left)]);
  std::vector<TourLeg> legs;
  for (const size_t surface : others) legs.push_back(driveLeg(rule, grounds[surface], random));
  legs.push_back(driveLeg(rule, grounds[home], random));
  return legs;
}

std::vector<TourLeg> tourOfBank(const learner::RuleConfig& config,
                                const std::vector<Ground>& grounds, size_t home, uint64_t seed) {
  const auto rule = made(learner::ruleName(Rule::kBank), config, grounds[home].averaged);
  return driveTour(*rule, grounds, home, grounds.size(), seed);
}

std::vector<std::string> contestantNames() {
  std::vector<std::string> names = learner::ruleNames();
  names.emplace_back(kBankUnseen);
  names.emplace_back(kOmniscient);
  return names;
}

Lineup::Lineup(const std::vector<std::string>& names, const learner::RuleConfig& config,
               const std::vector<Ground>& grounds, size_t from, size_t to, uint64_t tour_seed) {
  const std::string bank = learner::ruleName(Rule::kBank);
  for (const std::string& name : names) {
    Contestant one;
    if (name == learner::ruleName(Rule::kOff)) {
      one.fixed = &grounds[from].averaged_ends;
    } else if (name == kOmniscient) {
      one.fixed = &grounds[to].averaged_ends;
    } else {
      one.start = made(name, config, grounds[from].averaged);
      if (name == bank) driveTour(*one.start, grounds, from, grounds.size(), tour_seed);
      // On an unchanged surface nothing was met before: the bank is empty.
      if (name == kBankUnseen && from != to) driveTour(*one.start, grounds, from, to, tour_seed);
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
