// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "modules/learner/core/rules/learning_rule.hpp"
#include "tools/lab/experiment/adaptation/rivals.hpp"
#include "tools/lab/experiment/trials.hpp"

namespace tread::experiment {

/// A rival of `adaptation` as a learning rule; its reference is the shipped set.
class RivalRule : public learner::LearningRule {
 public:
  /// `noise`: variances of a pattern's mean twist between executions, by pattern.
  RivalRule(std::unique_ptr<adaptation::Rival> rival, const PatternSet& shipped,
            const std::vector<Eigen::Vector3d>& noise);
  RivalRule(const RivalRule& other);

  void learn(size_t executed, const learner::ConstTrajectory& measured,
             learner::RuleNote& note) override;
  void predict(size_t pattern, learner::Trajectory prediction) const override;
  Pose2 predictEnd(size_t pattern) const override;
  void assign(const learner::LearningRule& other) override;
  std::unique_ptr<learner::LearningRule> clone() const override {
    return std::make_unique<RivalRule>(*this);
  }
  /// The state of rivals is not stored.
  bool restore(const learner::TrajectoryTable&, const std::vector<double>&) override {
    return false;
  }

 private:
  /// The shipped set's predictions.
  struct Reference {
    double period;
    std::vector<std::vector<Twist2>> twists;  ///< by pattern and sample
    std::vector<adaptation::Sample> samples;  ///< by pattern
  };
  std::vector<Pose2> poses(size_t pattern) const;

  std::shared_ptr<const Reference> reference_;
  std::unique_ptr<adaptation::Rival> rival_;
};

/// The rivals among the named methods, tuned for a transition between two surfaces.
/** Tuning uses the excitation recordings of all surfaces but the new one, each as a session,
 * relative to the initial set: they show how grounds differ. */
Rivals tunedRivals(const std::vector<std::string>& methods, const std::vector<TrialGround>& grounds,
                   size_t from, size_t to);

/// A rival that starts with a surface's averaged set.
std::unique_ptr<learner::LearningRule> rivalRule(const adaptation::Rival& rival,
                                                 const TrialGround& ground);

}  // namespace tread::experiment
