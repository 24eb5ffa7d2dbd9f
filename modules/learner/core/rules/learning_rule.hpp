// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/pattern/pattern.hpp"
#include "modules/learner/core/rules/rule_config.hpp"
#include "modules/learner/core/scaling.hpp"

namespace tread::learner {

class SurfaceBank;

/// What a rule made of one measurement. Plain numbers, so that learning allocates nothing.
struct RuleNote {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  Axes scaling = Axes::Constant(kUnknown);  ///< V of equation (1), or the change of the executed
                                            ///< pattern's box (telescoping); NaN = not computed
  bool one_dimensional = false;             ///< guard: the pattern cannot give a V
  bool moved_back = false;                  ///< guard: net x of M against the prediction's
  bool turned_back = false;                 ///< guard: net yaw of M against the prediction's
  std::array<bool, 3> held{};               ///< guard: axes of the executed pattern that are noise
  double change_probability = kUnknown;     ///< [1] that the ground changed (filters)
  int surface = 0;                          ///< likeliest remembered surface, from 1; 0 = unknown
  double surface_probability = kUnknown;    ///< [1] of that, or of "unknown"
  bool surface_stored = false;              ///< the bank has a new surface
};

/// A rule of learning: predictions of all patterns of a set, corrected by measurements.
/** Patterns are named by their index in the shipped set. Same input, same bits; learn() and the
 * predictions allocate nothing, except that the bank does when it classifies a block of executions.
 * Trajectories hold T x 3 numbers: x, y [m], yaw [rad, unwrapped] in the start frame, one row a
 * sample. */
class LearningRule {
 public:
  virtual ~LearningRule() = default;

  /// Learns from a measured trajectory M of pattern `executed` (as many rows as its prediction).
  virtual void learn(size_t executed, const ConstTrajectory& measured, RuleNote& note) = 0;
  /// Whether the set may ever change.
  virtual bool learns() const { return true; }
  /// What the rule took an execution for, in words for LEARNING.
  virtual std::string reason(const RuleNote&) const { return "own prediction moved"; }
  /// Writes R of a pattern.
  virtual void predict(size_t pattern, Trajectory prediction) const = 0;
  /// The last pose of R, which is all that a score needs.
  virtual Pose2 predictEnd(size_t pattern) const = 0;
  /// Of predictEnd(), of ground and execution together; nothing if the rule does not know it.
  virtual std::optional<PoseCovariance> endCovariance(size_t /*pattern*/) const {
    return std::nullopt;
  }

  /// Becomes what `other` is, without allocating; both are of the same rule and shipped set.
  virtual void assign(const LearningRule& other) = 0;
  virtual std::unique_ptr<LearningRule> clone() const = 0;

  /// The surfaces that the rule remembers, or nullptr if it remembers none by nature.
  virtual const SurfaceBank* bank() const { return nullptr; }
  /// Takes over surfaces of the same shipped set; on which of them it stands is not known then.
  virtual void adoptBank(const SurfaceBank&) {}

  /// What the rule knows beside the predictions, for the state file; may be empty.
  virtual std::vector<double> memory() const { return {}; }
  /// Goes on from stored predictions (in the order of the set) and memory().
  /** Returns false and changes nothing if they are not this rule's. */
  virtual bool restore(const TrajectoryTable& predictions, const std::vector<double>& memory) = 0;
};

/// Names of all rules, in the order in which reports list them.
std::vector<std::string> ruleNames();

/// The rule that a configuration names, knowing nothing but the shipped set.
std::unique_ptr<LearningRule> makeRule(const RuleConfig& config, const PatternSet& shipped);

}  // namespace tread::learner
