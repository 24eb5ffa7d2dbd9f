// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/learner/core/rules/ground_filter.hpp"
#include "modules/learner/core/rules/learning_rule.hpp"
#include "modules/learner/core/rules/surface_bank.hpp"

namespace tread::learner {

/// Remembered surfaces over the local filter: a hidden Markov model (own
/// work). The default rule.
/** Hidden state: on which of the K stored surfaces the vehicle is, or on an unknown one (0), which
 * the local filter follows. With hazard h and prior pi_0 = unknown_prior, pi_k = (1 - pi_0) / K:
 *    w_k^- = (1 - h) w_k + h pi_k
 *    w_k ~ w_k^- L_k,   L_0 the filter's predictive density, L_k = N(z; shipped mean + H x_k, R_k)
 * R_k = R q_k + H P_k H', q_k the surface's own noise, P_k what is not known of it. Prediction: the
 * shipped profile under sum_k w_k x_k. While a stored surface is sure, the filter stands ready at
 * it. Begins empty. What is stored is decided by blocks of `settled_after` executions without a
 * change: a block is a new surface if it is likelier drawn from N(0, Q) as a whole, with the noise
 * that it shows itself, than from the stored surfaces with few changes between them; else these
 * take its executions as theirs. Stored surfaces that prove to be the same become one. */
class Bank : public LearningRule {
 public:
  Bank(const RuleConfig& config, const PatternSet& shipped);

  void learn(size_t executed, const ConstTrajectory& measured, RuleNote& note) override;
  std::string reason(const RuleNote& note) const override;
  void predict(size_t pattern, Trajectory prediction) const override;
  Pose2 predictEnd(size_t pattern) const override;
  std::optional<PoseCovariance> endCovariance(size_t pattern) const override;
  void assign(const LearningRule& other) override;
  std::unique_ptr<LearningRule> clone() const override { return std::make_unique<Bank>(*this); }
  std::vector<double> memory() const override;
  bool restore(const TrajectoryTable& predictions, const std::vector<double>& memory) override;

  const SurfaceBank* bank() const override { return &surfaces_; }
  void adoptBank(const SurfaceBank& bank) override;

 private:
  /// One execution of a block, and the stored surface that explains it best (0 = none is stored).
  struct Entry {
    TwistSample sample;
    size_t surface = 0;
  };
  void weigh(double log_unknown);
  void weighKnown();
  void addToBlock(const TwistSample& sample);
  void refineKnown();
  void closeBlock(RuleNote& note);
  void storeBlock(RuleNote& note);
  /// Log density of the block if it is a new surface; the block filter learns it.
  double logDensityAsNew();
  double logDensityAsNew(const Eigen::Vector3d& noise);
  /// Makes one of stored surfaces that are the same; whether there were any.
  bool mergeAlike();
  void clearBlock();
  /// Reads the executions of a block, the rest of `memory` from `at` on; false if it is not one.
  bool restoreBlock(const std::vector<double>& memory, size_t at);
  void mix();

  BankConfig config_;
  std::shared_ptr<const GroundModel> model_;
  GroundFilter filter_;  ///< of the unknown surface
  GroundFilter
      block_filter_;  ///< density of a block as a new surface: from N(0, Q), without changes
  SurfaceBank surfaces_;
  std::vector<double> weights_;  ///< w: [0] unknown, [k] of surface k - 1; sum 1
  std::vector<double>
      known_;                 ///< the same among the stored surfaces alone, [k - 1], slow to change
  std::vector<double> logs_;  ///< of the last execution's densities, [k]
  std::vector<Entry> block_;
  double block_log_known_ = 0.0;  ///< log density of the block if it is of stored surfaces
  int64_t clock_ = 0;             ///< executions learned from
  Eigen::VectorXd mean_;          ///< of the mixture
};

}  // namespace tread::learner
