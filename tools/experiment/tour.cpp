// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/experiment/tour.hpp"

#include <algorithm>
#include <cstdio>
#include <random>

#include "tools/experiment/draw.hpp"

namespace tread::experiment {
namespace {

using learner::LearningRule;
using learner::RememberedSurface;
using learner::SurfaceBank;

TourLeg driveLeg(LearningRule& rule, const Ground& ground, int64_t count, std::mt19937_64& random) {
  TourLeg leg{ground.surface};
  while (leg.executions < count) {
    const size_t pattern = drawIndex(random, ground.executions.size());
    const Executions& executions = ground.executions[pattern];
    learner::RuleNote note;
    rule.learn(pattern, executions.of(drawIndex(random, executions.size())), note);
    ++leg.executions;
    if (note.surface_stored && leg.stored_after == 0) leg.stored_after = leg.executions;
  }
  return leg;
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

std::string formatted(const char* format, double value) {
  char text[48];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text.empty() ? "-" : text;
}

std::string textOfLegs(const Tour& tour) {
  std::string text = "from " + tour.legs.back().surface + ", " +
                     std::to_string(tour.legs.front().executions) + " executions on each of:";
  for (const TourLeg& leg : tour.legs)
    text += " " + leg.surface +
            (leg.stored_after > 0 ? " (stored after " + std::to_string(leg.stored_after) + ")"
                                  : std::string(" (not stored)"));
  return text + "\n";
}

std::string textOfStored(const RememberedSurface& surface, const std::string& explains) {
  char line[200];
  std::snprintf(line, sizeof line, "  %-18s %10.0f", explains.c_str(), surface.executions());
  std::string text = line;
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

}  // namespace

std::vector<TourLeg> driveTour(LearningRule& rule, const std::vector<Ground>& grounds,
                               const TourPlan& plan, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<size_t> order;
  for (size_t s = 0; s < grounds.size(); ++s)
    if (s != plan.home && s != plan.unseen) order.push_back(s);
  for (size_t left = order.size(); left > 1; --left)
    std::swap(order[left - 1], order[drawIndex(random, left)]);
  if (plan.home != plan.unseen) order.push_back(plan.home);
  std::vector<TourLeg> legs;
  for (const size_t surface : order)
    legs.push_back(driveLeg(rule, grounds[surface], plan.executions, random));
  return legs;
}

Tour tourOfBank(const learner::RuleConfig& config, const std::vector<Ground>& grounds,
                const TourPlan& plan, uint64_t seed) {
  learner::RuleConfig of_bank = config;
  of_bank.rule = learner::Rule::kBank;
  const auto rule = learner::makeRule(of_bank, grounds[plan.home].averaged);
  Tour tour;
  tour.legs = driveTour(*rule, grounds, plan, seed);
  const SurfaceBank& bank = *rule->bank();
  for (size_t k = 0; k < bank.size(); ++k) tour.stored.push_back(bank[k].stored());
  tour.explains.resize(bank.size());
  const double period = grounds[plan.home].averaged.periodSeconds();
  for (const Ground& ground : grounds)
    if (bank.size() > 0) tour.explains[likeliest(bank, ground, period)].push_back(ground.surface);
  return tour;
}

std::string textOfTours(const std::vector<Tour>& tours, const PatternSet& set) {
  if (tours.empty()) return "";
  std::string text =
      "THE BANK before a transition: it begins empty, drives the other surfaces in random order, "
      "random patterns,\nthen the surface that the transition starts from. One of the tours of "
      "each, and what the bank holds after it:\ncorrections to the set of the surface that the "
      "transition starts from (forward gain [1], yaw gain [1], sideslip [s],\nturn loss [s], yaw "
      "by speed [s/m], yaw bias [rad/m], crab [1]; noise: variance over the expected one), then "
      "what\neach pattern has of its own (forward, lateral, yaw [1]).\n";
  for (const Tour& tour : tours) {
    text += "\n" + textOfLegs(tour) + kHead;
    for (size_t k = 0; k < tour.stored.size(); ++k)
      text += textOfStored(tour.stored[k], joined(tour.explains[k]));
    for (size_t k = 0; k < tour.stored.size(); ++k)
      text += textOfResiduals(tour.stored[k], joined(tour.explains[k]), set);
  }
  return text;
}

}  // namespace tread::experiment
