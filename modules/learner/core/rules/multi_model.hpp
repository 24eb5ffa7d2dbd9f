// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>
#include <vector>

#include "modules/learner/core/rules/context_effects.hpp"
#include "modules/learner/core/rules/learning_rule.hpp"
#include "modules/learner/core/rules/scatter.hpp"
#include "modules/learner/core/rules/surface.hpp"

namespace tread::learner {

/// A factor on a 90 % region, adapted to its observed coverage (adaptive conformal prediction).
struct Calibration {
  static constexpr double kNarrowest = -0.7, kWidest = 1.2;

  double log_factor = 0.0;  ///< logarithm of the factor on deviations
  void follow(bool held);
};

/// A multiple-model filter over surfaces, designed for grounds that differ by 3 to 60 % (own work).
/// The default rule.
/** On which ground is the vehicle? The hypotheses are the remembered surfaces, the first of them
 * the ground of the shipped set, and *fresh* ones: since some moment the vehicle is on new ground.
 * Each is a Surface, a regression whose width is a mixture over scales (scale_bank.hpp): the
 * measurements show how much grounds differ. After d metres and an execution z
 *    w_i^- = (1 - h) w_i + h pi_i,   h = 1 - exp(-d r),   w_i ~ w_i^- p_i(z).
 * r: changes per metre, learned from those that were finally certain; the prior counts as
 * change_prior changes in as many times change_metres. pi: `fresh` for the new hypothesis that
 * begins with this execution, the rest in equal shares for the remembered surfaces. Every fresh
 * one learns from z, a remembered one only while it is certain, so that ambiguous executions do
 * not blur it. Of the settled fresh ones that are certain together the most probable one is
 * remembered. The weakest fresh ones and the least recently met surface are dropped.
 *
 * New ground is expected about m = sum x_k / (1 + K), x_k the corrections of the K surfaces met;
 * for yaw and residuals the expectation shrinks as those surfaces contradict each other, by the
 * factor (James and Stein)
 *    max(0, 1 - (|m|^2 + sum |x_k - m|^2) / (K (K + 1) |m|^2)),
 * with (2 + K) / (2 + 2 K) of the variances of the scales; the weights of the scales are learned
 * from those surfaces. A settled fresh ground that differs from a remembered one by less than half
 * of one execution's deviation is merged with it. On new ground executions are expected to scatter
 * as they have so far (Scatter). Effects of slope and battery are subtracted from each execution
 * (ContextEffects); predictions are for level ground and the voltage of the last one.
 *
 * Predictions are the mixture's mean, (1 - h / 2) sum_i w_i E[x_i] + (h / 2) sum_i pi_i E[x_i] for
 * a pattern in which the ground changes with probability h. The 90 % region is computed from the
 * mixture itself, with a change at most so probable that a 90 % region could contain it; its shape
 * is that of the nearest hypotheses with a total weight of 90 %. Its size is adapted to its
 * observed coverage, separately while the ground is known and while it is being searched: then it
 * starts a tenth wider, because new ground surprises.
 *
 * For a change detected while the pattern ran (Context::changed_after) h = 0.9, and only the
 * measurement after it counts. */
class MultiModel : public LearningRule {
 public:
  MultiModel(const RuleConfig& config, const PatternSet& shipped);

  void setContext(const Context& context) override { context_ = context; }
  void learn(size_t executed, const ConstTrajectory& measured, RuleNote& note) override;
  bool learnsParts() const override { return true; }
  std::string reason(const RuleNote& note) const override;
  void predict(size_t pattern, Trajectory prediction) const override;
  Pose2 predictEnd(size_t pattern) const override;
  std::optional<PoseCovariance> endCovariance(size_t pattern) const override;
  std::optional<TwistDeparture> departure(size_t pattern, const ConstTrajectory& measured,
                                          Eigen::Index first, Eigen::Index samples) const override;
  int remembered() const override { return static_cast<int>(surfaces_.size()); }
  void assign(const LearningRule& other) override;
  std::unique_ptr<LearningRule> clone() const override {
    return std::make_unique<MultiModel>(*this);
  }
  std::vector<double> memory() const override;
  bool restore(const TrajectoryTable& predictions, const std::vector<double>& memory) override;

  /// A remembered surface; the first is that of the shipped set.
  const Surface& surface(size_t i) const { return surfaces_[i].surface; }
  const ContextEffects& effects() const { return effects_; }

 private:
  static constexpr double kLongestWay = 2000.0;  ///< [m] after which older changes fade
  /// [1] upper limit of an execution's contribution to the scatter
  static constexpr double kMostError = 1e3;

  struct Hypothesis {
    Surface surface;
    double weight = 0.0;
    int64_t last_met = 0;  ///< in executions learned from since the start
    int64_t since = 0;     ///< the same, when it was created
  };
  SetCorrection commonOf(const std::vector<const Surface*>& met) const;
  SurfacePrior expectNewGround() const;
  void expectNew();
  double hazard(double metres) const;
  /// Counts a change; whether a change detected earlier turns out to be none.
  bool countChange(double metres);
  /// `h`: probability that the ground has changed.
  void expectChange(double h);
  /// A part of an execution, and the change of its twist by slope and battery.
  struct Stretch {
    TwistSample sample;  ///< without that
    ContextEffects::Inputs inputs;
    Eigen::Vector3d effect;
  };
  std::optional<Stretch> stretch(size_t pattern, const ConstTrajectory& measured,
                                 Eigen::Index first, Eigen::Index samples) const {
    return stretch(effects_, pattern, measured, first, samples);
  }
  std::optional<Stretch> stretch(const ContextEffects& effects, size_t pattern,
                                 const ConstTrajectory& measured, Eigen::Index first,
                                 Eigen::Index samples) const;
  void weigh(const TwistSample& sample);
  void scaleWeights(double total);
  void normalizeWeights();
  void update(const TwistSample& sample);
  const Hypothesis& likeliest() const;
  void followScatter(const TwistSample& sample, const Eigen::Vector3d& effect, const Pose2& end);
  void forgetWeakest();
  bool rememberSettled();
  bool settled(const Surface& surface) const;
  bool same(const Surface& a, const Surface& b) const;
  void mix();
  /// E[x] of a pattern, including a change of ground within it.
  TwistCorrection expected(const PatternPart& part) const;
  /// The same, at the voltage of the last execution.
  TwistCorrection predicted(size_t pattern) const;
  bool searching() const;
  Moments region(const PatternPart& part) const;
  void calibrate(const TwistSample& sample);
  /// `first`: initial value of a hypothesis before its numbers are read.
  bool restoreHypotheses(std::vector<Hypothesis>& hypotheses, const Surface& first, size_t most,
                         const std::vector<double>& memory, size_t& at) const;

  GroundConfig config_;
  std::shared_ptr<const GroundModel> model_;
  std::vector<Hypothesis> surfaces_;  ///< remembered; [0] of the shipped set
  std::vector<Hypothesis> fresh_;     ///< since some moment; the one that begins now is last
  Scatter scatter_;
  Scatter::Factors expected_scatter_;
  Surface new_;      ///< initial value of a new surface
  Context context_;  ///< of the next execution
  ContextEffects effects_;
  std::vector<double> changed_;  ///< share of w_i^- caused by a change, remembered ones first
  double change_probability_ = 0.0;
  double changes_ = 0.0;  ///< number of changes of ground that were finally certain
  double metres_ = 0.0;   ///< driven meanwhile
  int64_t ground_ = 0;    ///< `since` of the hypothesis that was last certain
  bool noticed_ = false;  ///< a change was detected, and no ground has been certain since
  int64_t clock_ = 1;     ///< 0 is the making of the shipped set
  Calibration calm_, searching_{0.1};
  SetCorrection mean_;          ///< of the mixture, without the next change
  SetCorrection changed_mean_;  ///< after the next change
};

}  // namespace tread::learner
