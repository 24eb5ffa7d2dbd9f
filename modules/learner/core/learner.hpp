// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>

#include "common/pattern/pattern.hpp"
#include "modules/learner/core/end_residuals.hpp"
#include "modules/learner/core/measurement.hpp"
#include "modules/learner/core/scaling.hpp"

namespace tread::learner {

/// What is made of a measurement.
enum class Rule {
  kOff,         ///< nothing: the set never changes
  kSingle,      ///< the executed pattern is smoothed towards M (the paper's predecessor)
  kCollective,  ///< and all others by V: equations (1) and (2), Algorithm 1
};

/// off, single, collective.
const char* ruleName(Rule rule);
/// The rule of that name, or nothing.
std::optional<Rule> ruleNamed(const std::string& name);

/// The rule of learning and its guards.
struct RuleConfig {
  Rule rule = Rule::kCollective;
  double memory = 0.5;  ///< w of equation (2): weight of the OLD prediction, 0 <= w < 1
  ScalingLimits scaling;
  ResidualLimits residuals;
  double sign_sigmas = 3.0;  ///< how far beyond the noise M and R must disagree in sign
  Axes relative_noise{0.03, 0.03,
                      0.08};  ///< [1] of a prediction's end where no covariance is known
  Axes absolute_noise{0.02, 0.02, 0.02};  ///< [m, m, rad] added to it
};

/// What a measurement did to the set.
struct Correction {
  bool changed = false;
  Axes scaling = Axes::Constant(Measurement::kUnknown);  ///< V; NaN = not computed
  std::string guards;  ///< which guards held it back, in words; empty = none
};

/// What has been learned, beside the set itself.
using ResidualTable = std::map<int, EndResiduals>;

/// Learns a pattern set from measured executions. Every change makes a new version with its parent.
class Learner {
 public:
  Learner(RuleConfig config, PatternSet shipped);

  /// The newest set.
  const PatternSet& set() const { return set_; }
  const PatternSet& shipped() const { return shipped_; }
  const ResidualTable& residuals() const { return residuals_; }

  /// Learns from a fair measurement of the pattern with this id, which must be in the set.
  /** `end_error`: measured relative to the prediction that the planner used, nothing if the end was
   * not measured. `utime` [us] is that of the execution's end. */
  Correction learn(int pattern_id, const Measurement& measurement,
                   const std::optional<Pose2>& end_error, int64_t utime);

  /// Goes on from a restored set and its residuals; both belong to the same shipped set.
  void restore(PatternSet set, ResidualTable residuals);

  /// The same content under a higher version number, with `parent`.
  void renumber(int64_t version, int64_t parent);

 private:
  /// V, or nothing together with the guard that forbids it.
  std::optional<Axes> scalingFrom(const MotionPattern& pattern, const Measurement& measurement,
                                  std::string& guards) const;
  bool turnsTheOtherWay(const MotionPattern& pattern, const Pose2& measured_end,
                        std::string& guards) const;

  RuleConfig config_;
  PatternSet shipped_;
  PatternSet set_;
  std::map<int, PatternRole> roles_;
  ResidualTable residuals_;
};

/// End pose of M seen from the end of a prediction, in the start frame of both; yaw wrapped.
Pose2 endError(const Measurement& measurement, const MotionPattern& predicted);

}  // namespace tread::learner
