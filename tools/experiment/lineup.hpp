// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "modules/learner/core/rules/learning_rule.hpp"
#include "tools/experiment/ground.hpp"

namespace tread::experiment {

/// The right set from the beginning, learning off: column d of the paper's Table I.
inline constexpr const char* kOmniscient = "omniscient";
/// Rule `bank` on a surface that it has never met; `bank` itself has met it.
inline constexpr const char* kBankUnseen = "bank_unseen";

/// Names that a line-up accepts: the learner's rules and the two above.
std::vector<std::string> contestantNames();

/// A recording of a pattern, drawn by chance.
inline size_t drawIndex(std::mt19937_64& random, size_t count) {
  return static_cast<size_t>(((random() >> 32) * static_cast<uint64_t>(count)) >> 32);
}

/// What the rule `bank` met on one surface of its tour.
struct TourLeg {
  std::string surface;
  int executions = 0;
  int stored_after = 0;  ///< executions until it was put into the bank; 0 = it was not
};

/// Drives the tour of the rule `bank`, which begins with an empty bank: all surfaces but `home` and
/// `unseen` in random order, then home; random patterns, on each surface until it is known, for 40
/// executions at least.
std::vector<TourLeg> driveTour(learner::LearningRule& rule, const std::vector<Ground>& grounds,
                               size_t home, size_t unseen, uint64_t seed);
/// The tour that a bank drives first in an experiment with this seed, over all surfaces.
std::vector<TourLeg> tourOfBank(const learner::RuleConfig& config,
                                const std::vector<Ground>& grounds, size_t home, uint64_t seed);

/// The rules of an experiment, ready for a transition from one surface to another.
/** Every rule starts with IP_A; the rule `bank` has driven a tour before, over all surfaces
 * (`bank_unseen`: all but the one to come) and back to A. */
class Lineup {
 public:
  Lineup(const std::vector<std::string>& names, const learner::RuleConfig& config,
         const std::vector<Ground>& grounds, size_t from, size_t to, uint64_t tour_seed);

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
