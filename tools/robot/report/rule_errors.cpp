// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/report/drive_report.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/config/problem_words.hpp"
#include "common/drive/robot_log.hpp"
#include "common/report/text.hpp"
#include "tools/robot/report/logged_learner.hpp"

namespace tread::report {
namespace {

using Executions = std::vector<const report::ShadowedExecution*>;

/// Executions entirely on one surface, with their numbers on it, from 1, and their segments.
struct Numbered {
  const report::ShadowedExecution* execution = nullptr;
  size_t segment = 0;
  int number = 0;
};

std::vector<Numbered> numbered(const RuleErrors& errors, const std::vector<int64_t>& changes) {
  std::vector<Numbered> result;
  size_t segment = 0;
  int number = 0;
  for (const report::ShadowedExecution& execution : errors.executions) {
    while (segment < changes.size() && changes[segment] <= execution.ended) {
      ++segment;
      number = 0;
    }
    const bool across = segment > 0 && execution.began < changes[segment - 1];
    if (execution.measured && !across) result.push_back({&execution, segment, ++number});
  }
  return result;
}

/// The last five of each segment after a change.
Executions beforeChanges(const std::vector<Numbered>& all, size_t changes) {
  Executions chosen;
  for (size_t i = 0; i < all.size(); ++i)
    if (all[i].segment < changes && (i + 5 >= all.size() || all[i + 5].segment != all[i].segment))
      chosen.push_back(all[i].execution);
  return chosen;
}

Executions afterChanges(const std::vector<Numbered>& all, int first, int last) {
  Executions chosen;
  for (const Numbered& one : all)
    if (one.segment > 0 && one.number >= first && one.number <= last)
      chosen.push_back(one.execution);
  return chosen;
}

std::string meanText(const Executions& executions, size_t rule) {
  if (executions.empty()) return "                  -";
  double position = 0.0, yaw = 0.0;
  for (const report::ShadowedExecution* execution : executions) {
    position += execution->by_rule[rule].position;
    yaw += std::abs(execution->by_rule[rule].yaw);
  }
  const auto count = static_cast<double>(executions.size());
  return formatted("%7.3f m %5.2f deg", position / count, yaw / count * 180.0 / kPi);
}

}  // namespace

RuleErrors errorsByRule(const std::vector<std::string>& logs, const std::string& patterns_folder,
                        const std::vector<learner::Rule>& rules) {
  RuleErrors errors;
  errors.rules = rules;
  try {
    // Without large channels, which the learner does not need.
    const RobotLog log =
        readRobotLog(logs, {kScan.name, kPlanTree.name, kMap.name, kLearnerState.name});
    const learner::LearnerNodeConfig config = report::learnerConfigOf(log, patterns_folder);
    errors.driven = config.rule.rule;
    report::ShadowLearners shadows(config, rules, log.events.front().utime);
    for (const LogEvent& event : log.events) shadows.hear(event);
    shadows.finish();
    errors.executions = shadows.executions();
  } catch (const std::exception& error) {
    errors.problem = wordsOf(error);
  }
  return errors;
}

std::string reportOf(const RuleErrors& errors, const std::vector<int64_t>& changes) {
  if (!errors.problem.empty()) return "prediction error by rule: none, " + errors.problem + "\n";
  const std::vector<Numbered> all = numbered(errors, changes);
  Executions whole;
  for (const Numbered& one : all) whole.push_back(one.execution);
  std::string words =
      "the same executions predicted by each rule, from the shipped set on (driven: " +
      errors.driven + "):\n";
  words += formatted("  %-12s  %-18s", "rule", "all on one surface");
  if (!changes.empty()) {
    words +=
        formatted("  %-18s  %-18s  %-18s", "before a change", "1..3 after it", "5..15 after it");
  }
  words += "\n";
  for (size_t rule = 0; rule < errors.rules.size(); ++rule) {
    words += formatted("  %-12s", errors.rules[rule].c_str());
    words += "  " + meanText(whole, rule);
    if (!changes.empty())
      words += "  " + meanText(beforeChanges(all, changes.size()), rule) + "  " +
               meanText(afterChanges(all, 1, 3), rule) + "  " +
               meanText(afterChanges(all, 5, 15), rule);
    words += "\n";
  }
  return words;
}

}  // namespace tread::report
