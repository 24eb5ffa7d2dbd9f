// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>
#include <vector>

#include "modules/learner/core/rules/context_effects.hpp"
#include "modules/learner/core/rules/ground_model.hpp"
#include "modules/learner/core/rules/learning_rule.hpp"
#include "modules/learner/core/rules/surface.hpp"

namespace tread::learner {

/// How far executions of each pattern scatter about what is known of the ground, whatever ground:
/// v_x, v_y and omega of the mean twist, and the end beyond it (a path that is not steady ends
/// elsewhere than one of the same mean twist that is).
struct Scatter {
  static constexpr Eigen::Index kQuantities = 4;
  using Factors = Eigen::Matrix<double, kQuantities, Eigen::Dynamic>;

  explicit Scatter(size_t patterns)
      : sums(Eigen::MatrixXd::Zero(1 + kQuantities, static_cast<Eigen::Index>(patterns))) {}

  /// Squared errors of an execution over the ground model's variances.
  void add(size_t pattern, const Eigen::Vector4d& squared_error, double longest_memory);
  /// Expected factors on the variances, a column for each pattern: its mean, drawn by `prior`
  /// executions towards that of all patterns, which is drawn by as many towards 1.
  /** A rough ground tells nothing of the next: where the velocities of all patterns together
   * scatter more than expected, only how patterns differ counts. The next ground would look like
   * any, were it expected to be as rough; how rough it is itself is its own q. */
  Factors expected(double prior) const;

  Eigen::MatrixXd sums;  ///< a column for each pattern: executions, then their squared errors
};

/// A multiple-model filter over surfaces (own work). The default rule.
/** On which ground is the vehicle? The hypotheses are the surfaces that it remembers, the first of
 * them the ground of the shipped set, and *fresh* ones: since some moment it is on ground that it
 * has not met, two hypotheses (near, far) for each recent moment. Each is a Surface: a regression
 * of what was measured, with a noise of its own. After d metres and an execution z
 *    w_i^- = (1 - h) w_i + h pi_i,   h = 1 - exp(-d r),
 *    w_i ~ w_i^- p_i(z).
 * r: changes a metre, learned from those that were sure in the end; what is expected counts for
 * change_prior changes in as many times change_metres. pi: `fresh` for the new hypotheses that
 * begin with this execution, the rest in equal shares for the remembered surfaces. Every fresh one
 * learns from z, a remembered one only while it is sure, so that doubtful executions blur none. Of
 * the fresh ones that have settled and are sure together the likeliest is remembered. The weakest
 * fresh ones and the surface that was met longest ago make room.
 *
 * A new surface is expected about what the K surfaces met so far have in common. Of a correction,
 * with x_k = mu + d_k, mu ~ N(0, m), d_k ~ N(0, d), and x_k known by P_k,
 *    g = m / (d + K m),   E[mu] = g sum x_k,   Var[x_new] = d (1 + g) + g^2 sum P_k.
 * Near: m = shared Q, d = (1 - shared) Q, the vehicle is about as its set says. Far: m = vehicle^2,
 * d = Q for the common corrections: it differs from its set on every ground, which is kept where
 * the ground changes; or, before anything was met, it may be anything. Executions are expected to
 * scatter on it as they have so far (Scatter), and also on the shipped set's ground until the
 * vehicle has settled there.
 *
 * Effects of slope and battery are subtracted from each execution (ContextEffects). Predictions are
 * for level ground, the voltage of the last execution and the next `ahead` metres, on which the
 * ground may change, too: the shipped profile under sum_i w_i^- E[x_i], the covariance that of the
 * mixture. */
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
  struct Hypothesis {
    Surface surface;
    double weight = 0.0;
    int64_t last_met = 0;  ///< in executions that the rule has learned from since it began
    int64_t since = 0;     ///< the same, when it was first considered
  };
  /// A hypothesis with its weight after some more metres.
  struct Weighed {
    double weight;
    const Surface* surface;
  };

  /// Of a new surface from the others.
  enum class Distance { kNear, kFar };
  SurfacePrior priorOfNew(Distance distance) const;
  void expectNew();
  double hazard(double metres) const;
  void countChange(double metres);
  double freshShare() const;
  void expectChange(double metres);
  void weigh(const TwistSample& sample);
  void scaleWeights(double total);
  void update(const TwistSample& sample);
  const Hypothesis& likeliest() const;
  void followScatter(const TwistSample& sample, const Eigen::Vector3d& effect, const Pose2& end);
  void forgetWeakest();
  std::vector<Hypothesis>::iterator metLongestAgo();
  void forgetOldest();
  bool rememberSettled();
  void predictMixture();
  template <class Take>
  void forEachAhead(Take&& take) const;
  CorrectionVector correctionOf(const ByVelocity<Eigen::VectorXd>& x, size_t pattern) const;
  bool restoreHypotheses(std::vector<Hypothesis>& hypotheses, size_t most,
                         const std::vector<double>& memory, size_t& at) const;

  GroundConfig config_;
  std::shared_ptr<const GroundModel> model_;
  std::vector<Hypothesis> surfaces_;  ///< remembered; [0] of the shipped set
  std::vector<Hypothesis> fresh_;     ///< since some moment; the two that begin now come last
  Scatter scatter_;
  Scatter::Factors expected_scatter_;  ///< of the next execution
  Surface near_, far_;                 ///< what a new surface would be
  Context context_;                    ///< of the execution that comes next
  ContextEffects effects_;
  std::vector<double> changed_;  ///< share of w_i^- that came by a change, remembered ones first
  double change_probability_ = 0.0;
  double changes_ = 0.0;                    ///< of ground that were sure in the end
  double metres_ = 0.0;                     ///< driven meanwhile
  int64_t ground_ = 0;                      ///< `since` of the hypothesis that was sure last
  int64_t clock_ = 1;                       ///< 0 is when the shipped set was made
  ByVelocity<Eigen::VectorXd> mean_;        ///< of the mixture ahead
  ByVelocity<Eigen::MatrixXd> covariance_;  ///< the same
};

}  // namespace tread::learner
