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

/// A factor on a 90 % region that follows how often it held (adaptive conformal prediction).
struct Calibration {
  static constexpr double kNarrowest = -0.7, kWidest = 1.2;

  double log_factor = 0.0;  ///< logarithm of the factor on deviations
  void follow(bool held);
};

/// A multiple-model filter over surfaces, prepared for grounds that differ by 3 and by 60 % (own
/// work). The default rule.
/** On which ground is the vehicle? The hypotheses are the surfaces that it remembers, the first of
 * them the ground of the shipped set, and *fresh* ones: since some moment it is on ground that it
 * has not met. Each is a Surface, a regression whose width is a mixture over scales
 * (scale_bank.hpp): what was measured tells how much grounds differ. After d metres and an
 * execution z
 *    w_i^- = (1 - h) w_i + h pi_i,   h = 1 - exp(-d r),   w_i ~ w_i^- p_i(z).
 * r: changes a metre, learned from those that were sure in the end; what is expected counts for
 * change_prior changes in as many times change_metres. pi: `fresh` for the new hypothesis that
 * begins with this execution, the rest in equal shares for the remembered surfaces. Every fresh one
 * learns from z, a remembered one only while it is sure, so that doubtful executions blur none. Of
 * the fresh ones that have settled and are sure together the likeliest is remembered. The weakest
 * fresh ones and the surface that was met longest ago make room.
 *
 * New ground is expected about m = sum x_k / (1 + K), x_k the corrections of the K surfaces met; of
 * yaw and residuals less, as those surfaces contradict each other, by the factor (James and Stein)
 *    max(0, 1 - (|m|^2 + sum |x_k - m|^2) / (K (K + 1) |m|^2)),
 * with (2 + K) / (2 + 2 K) of the variances of the scales; the weights of the scales are learned
 * from those surfaces. A settled fresh ground that differs from a remembered one by less than half
 * of one execution's deviation is merged with it. Executions are expected to scatter on new ground
 * as they have so far (Scatter). Effects of slope and battery are subtracted from each execution
 * (ContextEffects); predictions are for level ground and the voltage of the last one.
 *
 * Predictions are the mixture's mean, (1 - h / 2) sum_i w_i E[x_i] + (h / 2) sum_i pi_i E[x_i] for
 * a pattern in which the ground changes by h. The region of 90 % is found of the mixture itself,
 * with a change at most so probable that a region of 90 % could hold it; its shape is that of the
 * nearest hypotheses that weigh 90 % together. It follows how often it held, apart while it knows
 * the ground and while it searches: then it begins a tenth wider, as new ground surprises.
 *
 * A change that was noticed while the pattern ran (Context::changed_after) has h = 0.9; only what
 * was measured behind it counts. */
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
  static constexpr double kMostError = 1e3;      ///< [1] of an execution in the scatter

  struct Hypothesis {
    Surface surface;
    double weight = 0.0;
    int64_t last_met = 0;  ///< in executions that the rule has learned from since it began
    int64_t since = 0;     ///< the same, when it was first considered
  };
  SetCorrection commonOf(const std::vector<const Surface*>& met) const;
  SurfacePrior expectNewGround() const;
  void expectNew();
  double hazard(double metres) const;
  /// Whether a change that was noticed proves to be none.
  bool countChange(double metres);
  /// `h`: how probable it is that the ground has changed.
  void expectChange(double h);
  /// A stretch of an execution, and what its slope and battery add to its twist.
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
  /// E[x] of a pattern, in which the ground may change, too.
  TwistCorrection expected(const PatternPart& part) const;
  /// The same at the voltage of the last execution.
  TwistCorrection predicted(size_t pattern) const;
  bool searching() const;
  Moments region(const PatternPart& part) const;
  void calibrate(const TwistSample& sample);
  /// `first`: what the first of them is like before it takes its numbers.
  bool restoreHypotheses(std::vector<Hypothesis>& hypotheses, const Surface& first, size_t most,
                         const std::vector<double>& memory, size_t& at) const;

  GroundConfig config_;
  std::shared_ptr<const GroundModel> model_;
  std::vector<Hypothesis> surfaces_;  ///< remembered; [0] of the shipped set
  std::vector<Hypothesis> fresh_;     ///< since some moment; the one that begins now comes last
  Scatter scatter_;
  Scatter::Factors expected_scatter_;
  Surface new_;      ///< what a new surface would be
  Context context_;  ///< of the execution that comes next
  ContextEffects effects_;
  std::vector<double> changed_;  ///< share of w_i^- that came by a change, remembered ones first
  double change_probability_ = 0.0;
  double changes_ = 0.0;  ///< of ground that were sure in the end
  double metres_ = 0.0;   ///< driven meanwhile
  int64_t ground_ = 0;    ///< `since` of the hypothesis that was sure last
  bool noticed_ = false;  ///< a change, and no ground was sure since
  int64_t clock_ = 1;     ///< 0 is when the shipped set was made
  Calibration calm_, searching_{0.1};
  SetCorrection mean_;          ///< of the mixture, without the next change
  SetCorrection changed_mean_;  ///< behind the next change
};

}  // namespace tread::learner
