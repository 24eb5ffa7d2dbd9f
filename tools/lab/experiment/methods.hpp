// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "common/geometry/se2.hpp"
#include "common/pattern/pattern.hpp"
#include "modules/learner/core/rules/learning_rule.hpp"
#include "modules/learner/core/scaling.hpp"
#include "tools/lab/experiment/ground.hpp"

namespace tread::adaptation {
class Rival;
}

namespace tread::experiment {

/// Rivals by name, in their initial state.
using Rivals = std::map<std::string, std::unique_ptr<adaptation::Rival>>;

/// Surfaces that a method has driven on before a transition from surface A to surface B.
enum class TrialHistory {
  kNone,        ///< none: the initial rule with IP_A (the paper's protocol)
  kHome,        ///< A
  kUnmet,       ///< all but B, A last; for unchanged ground (A = B) all others
  kRemembered,  ///< all surfaces, A last
};

/// A compared method: a learning rule or a rival (adaptation/rivals.hpp) with a history. Without a
/// rule it is the omniscient one.
struct Method {
  std::string rule;
  TrialHistory history = TrialHistory::kNone;
};

/// RULE, RULE_home, RULE_unmet or RULE_remembered, or kOmniscient; `off` learns nothing, so it has
/// no history. nullopt for other names.
std::optional<Method> methodOf(const std::string& name);
/// Names of all methods.
std::vector<std::string> methodNames();
/// The methods compared by default.
std::vector<std::string> defaultMethods();

/// Surfaces of an excitation run from A to B, in driving order: A last, the others shuffled.
std::vector<size_t> excitationOrder(TrialHistory history, size_t surfaces, size_t from, size_t to,
                                    std::mt19937_64& random);

/// An excitation run: a number of executions of random patterns on each of its surfaces.
struct ExcitationRun {
  int64_t executions = 200;
  uint64_t seed = 1;
};

/// All methods that learn: learning rules, then rivals.
std::vector<std::string> learnerNames();

/// The compared methods, prepared for a transition from surface A to surface B.
/** Each starts with IP_A and executes the excitation run of its history. A = B is unchanged ground.
 */
class Methods {
 public:
  Methods(const std::vector<std::string>& names, const learner::RuleConfig& config,
          const std::vector<TrialGround>& grounds, size_t from, size_t to,
          const ExcitationRun& excitation);
  /// The same with rivals already tuned for this transition.
  Methods(const std::vector<std::string>& names, const learner::RuleConfig& config,
          const std::vector<TrialGround>& grounds, size_t from, size_t to,
          const ExcitationRun& excitation, const Rivals& rivals);

  size_t size() const { return all_.size(); }
  /// Resets all methods to the state before the transition; learning rules do not allocate.
  void reset();
  Pose2 predictEnd(size_t i, size_t pattern) const {
    const State& one = all_[i];
    return one.fixed != nullptr ? (*one.fixed)[pattern] : one.now->predictEnd(pattern);
  }
  /// Covariance of predictEnd(); nullopt if the method has none.
  std::optional<PoseCovariance> endCovariance(size_t i, size_t pattern) const {
    return all_[i].now ? all_[i].now->endCovariance(pattern) : std::nullopt;
  }
  void learn(size_t i, size_t pattern, const learner::ConstTrajectory& measured) {
    if (all_[i].now) all_[i].now->learn(pattern, measured, note_);
  }
  /// Number of surfaces remembered before the transition; negative = no memory.
  int remembered(size_t i) const { return all_[i].start ? all_[i].start->remembered() : -1; }

 private:
  struct State {
    const std::vector<Pose2>* fixed = nullptr;  ///< constant predictions
    std::unique_ptr<learner::LearningRule> start;
    std::unique_ptr<learner::LearningRule> now;
  };

  std::vector<State> all_;
  learner::RuleNote note_;
};

}  // namespace tread::experiment
