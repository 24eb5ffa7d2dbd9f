// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/learner/core/rules/stored_predictions.hpp"

namespace tread::learner {

/// Whether an execution of a pattern may tell the others how to scale.
class ScalingGuards {
 public:
  ScalingGuards(const RuleConfig& config, const PatternSet& shipped);

  /// Whether a box is one that a vehicle can drive; what is not must not become a prediction.
  static bool possible(const Axes& box) { return (box < kLargestBox).all(); }
  /// Fills the guards of `note`; true if a V may be computed from this measurement.
  bool allow(size_t executed, const ConstTrajectory& measured, const Pose2& predicted_end,
             RuleNote& note) const;
  const PatternRole& role(size_t pattern) const { return roles_[pattern]; }

 private:
  static constexpr double kLargestBox = 1e6;  ///< [m, m, rad]

  bool opposite(size_t executed, int axis, double measured, double predicted) const;

  std::vector<PatternRole> roles_;
  std::vector<Axes> variances_;  ///< of the shipped ends; NaN = unknown
  Axes relative_noise_;
  Axes absolute_noise_;
  double sign_sigmas_;
};

/// What collective.hpp and telescoping.hpp have in common: the executed pattern is smoothed by
/// equation (2), all others are scaled by one factor an axis.
class ScalingRule : public StoredPredictions {
 public:
  ScalingRule(const RuleConfig& config, const PatternSet& shipped)
      : StoredPredictions(shipped),
        limits_(config.scaling),
        memory_(config.memory),
        guards_(config, shipped) {}

  void learn(size_t executed, const ConstTrajectory& measured, RuleNote& note) final;

 protected:
  /// Boxes of M, and of the executed pattern's prediction before and after the update.
  struct Boxes {
    Axes measured, before, after;
  };
  /// What the others are scaled by; fills `note.scaling`.
  virtual Axes factors(const Boxes& boxes, const PatternRole& role, RuleNote& note) const = 0;

  ScalingLimits limits_;
  double memory_;

 private:
  ScalingGuards guards_;
};

}  // namespace tread::learner
