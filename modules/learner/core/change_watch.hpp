// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <vector>

#include "modules/learner/core/rules/learning_rule.hpp"

// Detects a change of ground while a pattern runs: a test of the running body twist.
//    d   mean twist of a window of T_w seconds minus the rule's expectation on the ground that it
//        assumes; a window may begin in the previous execution
//    S   covariance of d on unchanged ground: uncertainty of the ground's parameters, and scatter
//        of executions over so short a time
//    x = d' S^-1 d     chi^2 with three degrees of freedom on unchanged ground
// A change is decided when x exceeds its threshold in two consecutive windows (a single one may be
// a bad pose). Its time is the one from which on the window differs most from the expectation: the
// largest x over the window's last parts.
namespace tread::learner {

/// When a motion counts as unexpected.
struct ChangeLimits {
  double window = 0.8;   ///< [s] T_w
  double chance = 1e-5;  ///< [1] probability that a window on unchanged ground deviates this much
};

/// A change of ground, in samples from the execution's start.
struct NoticedChange {
  int after = 0;  ///< samples after which the ground is another one; 0: since before the execution,
                  ///< or its start
  int noticed = 0;  ///< samples after which the change was detected
};

/// Watches consecutive executions.
/** A window is tested every tenth of a second of an execution, or every sample of longer periods.
 * The result depends only on the executions and their context, not on how much of them is known at
 * each call. Patterns shorter than half a window are too short for a test. */
class ChangeWatch {
 public:
  explicit ChangeWatch(const ChangeLimits& limits = {});

  /// The first change of ground in an execution; nullopt while there is none.
  /** `rule`: its state when the execution began, with its context set; `measured`: the execution
   * from its start, as far as measured. */
  std::optional<NoticedChange> notice(const LearningRule& rule, size_t pattern,
                                      const ConstTrajectory& measured, double period) const;
  /// The execution has ended; the next one follows without a pause on the same ground.
  void follow(const LearningRule& rule, size_t pattern, const ConstTrajectory& measured,
              double period);
  /// Forgets the previous motion: nothing is known of the motion before the next execution.
  void clear() { tail_.clear(); }

  /// The state as numbers; restore() returns false for invalid numbers.
  std::vector<double> memory() const;
  bool restore(const std::vector<double>& memory);
  static constexpr size_t kEach = 9;  ///< numbers per departure

 private:
  std::optional<double> unlikeness(const LearningRule& rule, size_t pattern,
                                   const ConstTrajectory& measured, Eigen::Index end,
                                   Eigen::Index samples, double period) const;

  ChangeLimits limits_;
  double threshold_;
  /// Of the previous execution: its last tenth of a second, its last two, ...
  std::vector<TwistDeparture> tail_;
};

/// Quantile of chi^2 with three degrees of freedom that is exceeded with a probability.
double chiSquare3(double probability);

}  // namespace tread::learner
