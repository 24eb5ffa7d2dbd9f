// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/experiment/trials.hpp"

#include <algorithm>
#include <random>

#include "common/config/scalars.hpp"
#include "common/report/text.hpp"

namespace tread::experiment {
namespace {

using learner::LearningRule;
using learner::RememberedSurface;
using learner::SurfaceBank;

ExcitationSegment driveSegment(LearningRule& rule, const Ground& ground, int64_t count,
                               std::mt19937_64& random) {
  ExcitationSegment segment{ground.surface};
  while (segment.executions < count) {
    const size_t pattern = drawIndex(random, ground.executions.size());
    const Executions& executions = ground.executions[pattern];
    learner::RuleNote note;
    rule.learn(pattern, executions.of(drawIndex(random, executions.size())), note);
    ++segment.executions;
    if (note.surface_stored && segment.stored_after == 0) segment.stored_after = segment.executions;
  }
  return segment;
}

/// The stored surface on which a ground's recordings are likeliest.
size_t likeliest(const SurfaceBank& bank, const Ground& ground, double period) {
  std::vector<double> logs(bank.size(), 0.0);
  for (size_t p = 0; p < ground.executions.size(); ++p)
    for (size_t i = 0; i < ground.executions[p].size(); ++i) {
      const learner::TwistSample sample{p, learner::meanTwist(ground.executions[p].of(i), period)};
      for (size_t k = 0; k < bank.size(); ++k) logs[k] += bank.logLikelihood(k, sample);
    }
  return static_cast<size_t>(std::max_element(logs.begin(), logs.end()) - logs.begin());
}

std::string namesOf(const std::vector<std::string>& surfaces) {
  return surfaces.empty() ? "-" : joinWords(surfaces);
}

std::string textOfSegments(const ExcitationRun& run) {
  std::string text = "from " + run.segments.back().surface + ", " +
                     std::to_string(run.segments.front().executions) + " executions on each of:";
  for (const ExcitationSegment& segment : run.segments)
    text +=
        " " + segment.surface +
        (segment.stored_after > 0 ? " (stored after " + std::to_string(segment.stored_after) + ")"
                                  : std::string(" (not stored)"));
  return text + "\n";
}

std::string textOfStored(const RememberedSurface& surface, const std::string& explains) {
  std::string text = formatted("  %-18s %10.0f", explains.c_str(), surface.executions());
  for (Eigen::Index i = 0; i < learner::TwistCorrection::kCommon; ++i)
    text += formatted(" %9.3f", surface.x[i]);
  for (const double noise : surface.noise) text += formatted(" %6.2f", noise);
  return text + "\n";
}

std::string textOfResiduals(const RememberedSurface& surface, const std::string& explains,
                            const PatternSet& set) {
  constexpr size_t kInLine = 3;
  std::string text = "  " + explains + ":";
  for (size_t p = 0; p < set.patterns().size(); ++p) {
    const Eigen::Index at = learner::GroundModel::ownAt(p);
    text += std::string(p == 0 ? "" : ";") + (p > 0 && p % kInLine == 0 ? "\n      " : " ") +
            set.patterns()[p].name;
    for (Eigen::Index axis = 0; axis < 3; ++axis) text += formatted(" %+.3f", surface.x[at + axis]);
  }
  return text + "\n";
}

const char* const kHead =
    "  likeliest on       executions   forward       yaw  sideslip turn_loss yaw_speed  yaw_bias"
    "      crab  noise: v      s      w\n";

std::unique_ptr<LearningRule> made(const std::string& name, learner::RuleConfig config,
                                   const PatternSet& shipped) {
  config.rule = name == kBankUnseen || name == kBankEmpty ? "bank" : name;
  return learner::makeRule(config, shipped);
}

}  // namespace

std::vector<ExcitationSegment> driveExcitation(LearningRule& rule,
                                               const std::vector<Ground>& grounds,
                                               const ExcitationPlan& plan, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<size_t> order;
  for (size_t s = 0; s < grounds.size(); ++s)
    if (s != plan.home && s != plan.unseen) order.push_back(s);
  for (size_t left = order.size(); left > 1; --left)
    std::swap(order[left - 1], order[drawIndex(random, left)]);
  if (plan.home != plan.unseen) order.push_back(plan.home);
  std::vector<ExcitationSegment> segments;
  for (const size_t surface : order)
    segments.push_back(driveSegment(rule, grounds[surface], plan.executions, random));
  return segments;
}

ExcitationRun excitationOfBank(const learner::RuleConfig& config,
                               const std::vector<Ground>& grounds, const ExcitationPlan& plan,
                               uint64_t seed) {
  learner::RuleConfig of_bank = config;
  of_bank.rule = "bank";
  const auto rule = learner::makeRule(of_bank, grounds[plan.home].averaged);
  ExcitationRun run;
  run.segments = driveExcitation(*rule, grounds, plan, seed);
  const SurfaceBank& bank = *rule->bank();
  for (size_t k = 0; k < bank.size(); ++k) run.stored.push_back(bank[k].stored());
  run.explains.resize(bank.size());
  const double period = grounds[plan.home].averaged.periodSeconds();
  for (const Ground& ground : grounds)
    if (bank.size() > 0) run.explains[likeliest(bank, ground, period)].push_back(ground.surface);
  return run;
}

std::string textOfExcitation(const std::vector<ExcitationRun>& excitation, const PatternSet& set) {
  if (excitation.empty()) return "";
  std::string text =
      "THE BANK before a transition: it begins empty, drives the other surfaces in random order, "
      "random patterns,\nthen the surface that the transition starts from. One excitation run of "
      "each, and what the bank holds after it:\ncorrections to the set of the surface that the "
      "transition starts from (forward gain [1], yaw gain [1], sideslip [s],\nturn loss [s], yaw "
      "by speed [s/m], yaw bias [rad/m], crab [1]; noise: variance over the expected one), then "
      "what\neach pattern has of its own (forward, lateral, yaw [1]).\n";
  for (const ExcitationRun& run : excitation) {
    text += "\n" + textOfSegments(run) + kHead;
    for (size_t k = 0; k < run.stored.size(); ++k)
      text += textOfStored(run.stored[k], namesOf(run.explains[k]));
    for (size_t k = 0; k < run.stored.size(); ++k)
      text += textOfResiduals(run.stored[k], namesOf(run.explains[k]), set);
  }
  return text;
}

std::vector<std::string> methodNames() {
  std::vector<std::string> names = learner::ruleNames();
  names.emplace_back(kBankUnseen);
  names.emplace_back(kBankEmpty);
  names.emplace_back(kOmniscient);
  return names;
}

Methods::Methods(const std::vector<std::string>& names, const learner::RuleConfig& config,
                 const std::vector<Ground>& grounds, size_t from, size_t to,
                 int64_t excitation_executions, uint64_t excitation_seed) {
  for (const std::string& name : names) {
    Method one;
    if (name == "off") {
      one.fixed = &grounds[from].averaged_ends;
    } else if (name == kOmniscient) {
      one.fixed = &grounds[to].averaged_ends;
    } else {
      one.start = made(name, config, grounds[from].averaged);
      const size_t none = grounds.size();
      if (name == "bank" || name == kBankUnseen)
        driveExcitation(*one.start, grounds,
                        {from, name == "bank" ? none : to, excitation_executions}, excitation_seed);
      one.state = one.start->clone();
    }
    all_.push_back(std::move(one));
  }
}

void Methods::reset() {
  for (Method& one : all_)
    if (one.state) one.state->assign(*one.start);
}

}  // namespace tread::experiment
