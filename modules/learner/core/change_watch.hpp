// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <vector>

#include "modules/learner/core/rules/learning_rule.hpp"

// Whether the ground changes while a pattern runs: a test of the running body twist.
//    d   mean twist of a window of T_w seconds less what the rule expects of it on the ground that
//        it believes in; a window may begin in the execution before
//    S   covariance of d while the ground stays the same: what is not known of the ground, and how
//        one execution scatters in so short a time
//    x = d' S^-1 d     chi^2 with three degrees of freedom on unchanged ground
// The ground is decided to have changed where x exceeds its threshold in two windows one after the
// other (one bad pose is none). It has changed since the moment from which on the window is
// most unlike what was expected: the largest x of its last parts.
namespace tread::learner {

/// When a motion is no longer the expected one.
struct ChangeLimits {
  double window = 0.8;   ///< [s] T_w
  double chance = 1e-5;  ///< [1] probability that a window on unchanged ground is as far off
};

/// A change of ground, in samples from the execution's start.
struct NoticedChange {
  int after = 0;    ///< the ground is another one after so many; 0: since before, or the start
  int noticed = 0;  ///< so many showed it
};

/// Watches executions that follow each other.
/** A window is looked at every tenth of a second of an execution, or every sample of longer
 * periods. The same executions in the same context give the same answers, however much of each is
 * known when it is asked. Patterns shorter than half a window are too short to be told from chance.
 */
class ChangeWatch {
 public:
  explicit ChangeWatch(const ChangeLimits& limits = {});

  /// The first change of ground in an execution; nothing while it is the same.
  /** `rule`: as it was when the execution began, its context set; `measured`: the execution as far
   * as it was measured, from its start on. */
  std::optional<NoticedChange> notice(const LearningRule& rule, size_t pattern,
                                      const ConstTrajectory& measured, double period) const;
  /// The execution has ended; the next one follows without a pause, on the same ground.
  void follow(const LearningRule& rule, size_t pattern, const ConstTrajectory& measured,
              double period);
  /// Nothing is known of the motion before the next execution.
  void clear() { tail_.clear(); }

  /// What is known of it, as numbers; restore() returns false if they are none of these.
  std::vector<double> memory() const;
  bool restore(const std::vector<double>& memory);
  static constexpr size_t kEach = 9;  ///< numbers of a departure

 private:
  std::optional<double> unlikeness(const LearningRule& rule, size_t pattern,
                                   const ConstTrajectory& measured, Eigen::Index end,
                                   Eigen::Index samples, double period) const;

  ChangeLimits limits_;
  double threshold_;
  /// Of the execution before: its last tenth of a second, its last two, ...
  std::vector<TwistDeparture> tail_;
};

/// x that chi^2 with three degrees of freedom exceeds with a probability.
double chiSquare3(double probability);

}  // namespace tread::learner
