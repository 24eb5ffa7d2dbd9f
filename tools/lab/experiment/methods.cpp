// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/experiment/methods.hpp"

#include "tools/lab/experiment/trials.hpp"

#include <algorithm>

#include "modules/learner/core/rules/make_rule.hpp"
#include "tools/lab/experiment/adaptation/tuning.hpp"
#include "tools/lab/experiment/rival_rule.hpp"

namespace tread::experiment {
namespace {

constexpr const char* kOff = "off";

struct NamedHistory {
  const char* suffix;
  TrialHistory history;
};
const NamedHistory kHistories[] = {{"", TrialHistory::kNone},
                                   {"_home", TrialHistory::kHome},
                                   {"_unmet", TrialHistory::kUnmet},
                                   {"_remembered", TrialHistory::kRemembered}};

void drive(learner::LearningRule& rule, const TrialGround& ground, int64_t executions,
           std::mt19937_64& random) {
  learner::RuleNote note;
  for (int64_t i = 0; i < executions; ++i) {
    const size_t pattern = drawIndex(random, ground.known.size());
    const Executions& known = ground.known[pattern];
    rule.learn(pattern, known.of(drawIndex(random, known.size())), note);
  }
}

}  // namespace

std::vector<std::string> learnerNames() {
  std::vector<std::string> names = learner::ruleNames();
  names.insert(names.end(), adaptation::rivalNames().begin(), adaptation::rivalNames().end());
  return names;
}

std::optional<Method> methodOf(const std::string& name) {
  if (name == kOmniscient) return Method{};
  for (const std::string& rule : learnerNames())
    for (const NamedHistory& one : kHistories)
      if (name == rule + one.suffix && (rule != kOff || one.history == TrialHistory::kNone))
        return Method{rule, one.history};
  return std::nullopt;
}

std::vector<std::string> methodNames() {
  std::vector<std::string> names;
  for (const std::string& rule : learnerNames())
    for (const NamedHistory& one : kHistories)
      if (methodOf(rule + one.suffix)) names.push_back(rule + one.suffix);
  names.emplace_back(kOmniscient);
  return names;
}

std::vector<std::string> defaultMethods() {
  std::vector<std::string> names{kOff,
                                 "single",
                                 "collective",
                                 "collective_home",
                                 "telescoping",
                                 "multi_model",
                                 "multi_model_home",
                                 "multi_model_unmet",
                                 "multi_model_remembered"};
  names.insert(names.end(), adaptation::rivalNames().begin(), adaptation::rivalNames().end());
  names.emplace_back(kOmniscient);
  return names;
}

std::vector<size_t> excitationOrder(TrialHistory history, size_t surfaces, size_t from, size_t to,
                                    std::mt19937_64& random) {
  std::vector<size_t> order;
  const bool unmet = history == TrialHistory::kUnmet;
  for (size_t s = 0; s < surfaces; ++s)
    if (history == TrialHistory::kRemembered || unmet)
      if (s != from && !(unmet && s == to)) order.push_back(s);
  for (size_t left = order.size(); left > 1; --left)
    std::swap(order[left - 1], order[drawIndex(random, left)]);
  if (history != TrialHistory::kNone && !(unmet && from == to)) order.push_back(from);
  return order;
}

Methods::Methods(const std::vector<std::string>& names, const learner::RuleConfig& config,
                 const std::vector<TrialGround>& grounds, size_t from, size_t to,
                 const ExcitationRun& excitation)
    : Methods(names, config, grounds, from, to, excitation, tunedRivals(names, grounds, from, to)) {
}

Methods::Methods(const std::vector<std::string>& names, const learner::RuleConfig& config,
                 const std::vector<TrialGround>& grounds, size_t from, size_t to,
                 const ExcitationRun& excitation, const Rivals& rivals) {
  for (const std::string& name : names) {
    const Method method = methodOf(name).value();
    State one;
    if (name == kOff || name == kOmniscient) {
      one.fixed = &grounds[name == kOff ? from : to].averaged_ends;
    } else {
      learner::RuleConfig of_method = config;
      of_method.rule = method.rule;
      const auto rival = rivals.find(method.rule);
      one.start = rival != rivals.end() ? rivalRule(*rival->second, grounds[from])
                                        : learner::makeRule(of_method, grounds[from].averaged);
      std::mt19937_64 random(excitation.seed);
      for (const size_t s : excitationOrder(method.history, grounds.size(), from, to, random))
        drive(*one.start, grounds[s], excitation.executions, random);
      one.now = one.start->clone();
    }
    all_.push_back(std::move(one));
  }
}

void Methods::reset() {
  for (State& one : all_)
    if (one.now) one.now->assign(*one.start);
}

}  // namespace tread::experiment
