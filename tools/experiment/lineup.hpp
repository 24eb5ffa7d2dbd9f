// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "modules/learner/core/rules/learning_rule.hpp"
#include "tools/experiment/tour.hpp"

namespace tread::experiment {

/// The right set from the beginning, learning off: column d of the paper's Table I.
inline constexpr const char* kOmniscient = "omniscient";
/// Rule `bank` on a surface that it has never met; `bank` itself has met it.
inline constexpr const char* kBankUnseen = "bank_unseen";
/// Rule `bank` as it begins: it has met nothing.
inline constexpr const char* kBankEmpty = "bank_empty";

/// Names that a line-up accepts: the learner's rules and those above.
std::vector<std::string> contestantNames();

/// The rules of an experiment, ready for a transition from one surface to another.
/** Every rule starts with IP_A; the rule `bank` has driven a tour before, over all surfaces
 * (`bank_unseen`: all but the one to come) and back to A. The same surface as both: unchanged
 * ground. */
class Lineup {
 public:
  Lineup(const std::vector<std::string>& names, const learner::RuleConfig& config,
         const std::vector<Ground>& grounds, size_t from, size_t to, int64_t tour_executions,
         uint64_t tour_seed);

  size_t size() const { return contestants_.size(); }
  /// All rules as they were before the transition; allocates nothing.
  void reset();
  Pose2 predictEnd(size_t i, size_t pattern) const {
    const Contestant& one = contestants_[i];
    return one.fixed != nullptr ? (*one.fixed)[pattern] : one.state->predictEnd(pattern);
  }
  void learn(size_t i, size_t pattern, const learner::ConstTrajectory& measured) {
    if (contestants_[i].state) contestants_[i].state->learn(pattern, measured, note_);
  }

 private:
  struct Contestant {
    const std::vector<Pose2>* fixed = nullptr;  ///< predictions that never change
    std::unique_ptr<learner::LearningRule> start;
    std::unique_ptr<learner::LearningRule> state;
  };

  std::vector<Contestant> contestants_;
  learner::RuleNote note_;
};

}  // namespace tread::experiment
