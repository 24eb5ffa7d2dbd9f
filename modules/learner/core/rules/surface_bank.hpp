// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "modules/learner/core/rules/ground_filter.hpp"
#include "modules/learner/core/rules/learning_rule.hpp"

namespace tread::learner {

/// No count of executions is beyond this; a double holds all whole numbers up to it.
inline constexpr double kMostExecutions = 9e15;

/// Whether a number from a file is a whole one in [0, most]: only then it may become an integer.
inline bool isCount(double number, double most) {
  return number >= 0.0 && number <= most && number == std::floor(number);
}

/// The mean twist of one execution.
struct TwistSample {
  size_t pattern = 0;
  Eigen::Vector3d mean_twist = Eigen::Vector3d::Zero();
};

/// What is stored of a surface: a state of the ground model, how often it was driven, how noisy.
struct RememberedSurface {
  Eigen::VectorXd x;           ///< corrections, see GroundModel
  std::vector<double> driven;  ///< executions of each pattern that are in it
  /// [1] variance of one execution over the ground model's, for v_x, v_y and omega.
  Eigen::Vector3d noise = Eigen::Vector3d::Ones();
  int64_t last_met = 0;  ///< in executions that the rule has learned from since it began

  double executions() const;
};

/// A stored surface with what follows from it; immutable, so that copies of a bank share it.
class KnownSurface {
 public:
  /** Covariance of x, with R_p the ground model's noise times the surface's own:
   *    P = (Q^-1 + sum_p driven_p H_p' R_p^-1 H_p)^-1
   * driven cut to a total of 200: ground changes with the weather. */
  KnownSurface(const GroundModel& model, RememberedSurface stored);

  const RememberedSurface& stored() const { return stored_; }
  const Eigen::VectorXd& mean() const { return stored_.x; }
  const Eigen::MatrixXd& covariance() const { return P_; }
  /// Covariance of one execution's mean twist on this surface: R q.
  Eigen::Matrix3d executionNoise(const GroundModel& model, size_t pattern) const {
    return scaledNoise(model.noise(pattern), stored_.noise);
  }
  /// Logarithm of the density of an execution on this surface.
  double logLikelihood(const GroundModel& model, const TwistSample& sample) const;
  /// This surface after some executions that were on it: a Kalman update each.
  std::shared_ptr<const KnownSurface> after(const GroundModel& model,
                                            const std::vector<TwistSample>& samples,
                                            int64_t now) const;

 private:
  RememberedSurface stored_;
  Eigen::MatrixXd P_;
  std::vector<Eigen::Matrix3d> spreads_;  ///< H P H' + R of each pattern
};

/// Surfaces that were met and settled.
class SurfaceBank {
 public:
  /// The ground model's noise counts for so many executions, and is never wrong by more than this.
  static constexpr double kNoisePrior = 5.0;
  static constexpr double kLeastNoise = 0.05;
  static constexpr double kMostNoise = 20.0;

  explicit SurfaceBank(std::shared_ptr<const GroundModel> model) : model_(std::move(model)) {}

  size_t size() const { return surfaces_.size(); }
  const KnownSurface& operator[](size_t i) const { return *surfaces_[i]; }
  /// The largest last_met; 0 if there is none.
  int64_t newest() const;
  double logLikelihood(size_t surface, const TwistSample& sample) const {
    return surfaces_[surface]->logLikelihood(*model_, sample);
  }

  /// Adds one; if the bank is full it takes the place of the one that was met longest ago. Returns
  /// its place.
  size_t store(RememberedSurface surface, size_t capacity);
  /// Executions that were on this surface.
  void refine(size_t surface, const std::vector<TwistSample>& samples, int64_t now) {
    surfaces_[surface] = surfaces_[surface]->after(*model_, samples, now);
  }

  /// Whether two are the same surface, met twice: log N(d; 0, P_i + P_j) - log N(d; 0, P_i + P_j +
  /// Q) with d = x_i - x_j is above zero.
  bool alike(size_t i, size_t j) const;
  /// Makes one of two, in the place of the first; the places above the second move down.
  /** x = P (P_i^-1 x_i + P_j^-1 x_j), P^-1 = P_i^-1 + P_j^-1 - Q^-1: what both know, the common
   * prior once. */
  void merge(size_t i, size_t j);

  /// Numbers, all of them finite; restore() returns false and changes nothing if they do not fit.
  void save(std::vector<double>& memory) const;
  bool restore(const std::vector<double>& memory, size_t& at);

 private:
  std::shared_ptr<const GroundModel> model_;
  std::vector<std::shared_ptr<const KnownSurface>> surfaces_;
};

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
