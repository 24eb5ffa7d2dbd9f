// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "modules/learner/core/rules/learning_rule.hpp"
#include "modules/learner/core/rules/surface_bank.hpp"
#include "tools/experiment/ground.hpp"

namespace tread::experiment {

/// What the rule `bank` met on one surface of an excitation run.
struct ExcitationSegment {
  std::string surface;
  int executions = 0;
  int stored_after = 0;  ///< executions until it was put into the bank; 0 = it was not
};

/// The drive that fills a bank before a transition, and what the bank holds after it.
struct ExcitationRun {
  std::vector<ExcitationSegment> segments;
  std::vector<learner::RememberedSurface> stored;
  /// By stored surface: the surfaces whose recordings are likelier on it than on any other stored.
  std::vector<std::vector<std::string>> explains;
};

/// Surfaces of an excitation run: all but `home` and `unseen`, then `home` unless it is `unseen`.
struct ExcitationPlan {
  size_t home = 0;
  size_t unseen = 0;         ///< the number of surfaces = none is left out
  int64_t executions = 200;  ///< on each surface
};

/// Drives random patterns of the whole set on each surface, the others in random order.
std::vector<ExcitationSegment> driveExcitation(learner::LearningRule& rule,
                                               const std::vector<Ground>& grounds,
                                               const ExcitationPlan& plan, uint64_t seed);
/// One run of the rule `bank`, which begins with an empty bank and the home surface's set.
ExcitationRun excitationOfBank(const learner::RuleConfig& config,
                               const std::vector<Ground>& grounds, const ExcitationPlan& plan,
                               uint64_t seed);

/// Segments and stored surfaces of runs, with the corrections by name.
std::string textOfExcitation(const std::vector<ExcitationRun>& excitation, const PatternSet& set);

/// The right set from the beginning, learning off: column d of the paper's Table I.
inline constexpr const char* kOmniscient = "omniscient";
/// Rule `bank` on a surface that it has never met; `bank` itself has met it.
inline constexpr const char* kBankUnseen = "bank_unseen";
/// Rule `bank` as it begins: it has met nothing.
inline constexpr const char* kBankEmpty = "bank_empty";

/// All methods: the learner's rules and the three above.
std::vector<std::string> methodNames();

/// The methods that are compared, ready for a transition from surface A to surface B.
/** Each starts with IP_A; `bank` has driven an excitation run before, over all surfaces
 * (`bank_unseen`: all but B) and back to A. A = B is unchanged ground. */
class Methods {
 public:
  Methods(const std::vector<std::string>& names, const learner::RuleConfig& config,
          const std::vector<Ground>& grounds, size_t from, size_t to, int64_t excitation_executions,
          uint64_t excitation_seed);

  size_t size() const { return all_.size(); }
  /// All methods as they were before the transition; allocates nothing.
  void reset();
  Pose2 predictEnd(size_t i, size_t pattern) const {
    const Method& one = all_[i];
    return one.fixed != nullptr ? (*one.fixed)[pattern] : one.state->predictEnd(pattern);
  }
  void learn(size_t i, size_t pattern, const learner::ConstTrajectory& measured) {
    if (all_[i].state) all_[i].state->learn(pattern, measured, note_);
  }

 private:
  struct Method {
    const std::vector<Pose2>* fixed = nullptr;  ///< predictions that never change
    std::unique_ptr<learner::LearningRule> start;
    std::unique_ptr<learner::LearningRule> state;
  };

  std::vector<Method> all_;
  learner::RuleNote note_;
};

}  // namespace tread::experiment
