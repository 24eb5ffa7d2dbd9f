// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "tools/lab/experiment/adaptation/reference.hpp"

// Other methods for unknown ground, on the same reference and pieces. Each learns the residual
// twist, per velocity, as a function of the reference's speed (v, w):
//   constant   a forward and a yaw gain, by least squares over all executions so far
//   kalman     the same two gains as a random walk, by a Kalman filter
//   slip       slip regression: v_x: v, |w| v, w; v_y: v w, v, w; omega: w, |v| w, v; recursive
//              least squares with forgetting
//   basis      recursive least squares with forgetting on a few functions of (v, w) that are
//              learned from the training sessions: the directions (SVD) in which their residual
//              maps over random Fourier features differ (a function encoder by least squares)
//   rls2       recursive least squares with forgetting on two gains of the mean twist: of both
//              velocities and of the yaw rate (gain_rivals.hpp)
//   rls3       the same with three gains: of v_x, v_y and omega
//   imm        those three gains by an interacting multiple-model filter: calm or changed
//   gp         a Gaussian process over (v, w), squared exponential kernel with two length scales
// All but the gains weight innovations beyond 2.5 standard deviations less (Huber), as poses may
// jump. Priors are tuned on the training sessions only: prior deviations, forgetting, noise and the
// number of functions by the likelihood of the next execution, the process by its marginal
// likelihood, over runs of 31 pieces that begin with a new rival.
namespace tread::adaptation {

/// Learns the residual of one velocity.
class AxisRival {
 public:
  virtual ~AxisRival() = default;
  virtual void learn(const Sample& sample) = 0;
  /// Residual at the speed (v, w).
  virtual double offset(const Eigen::Vector2d& speed) const = 0;
  virtual std::unique_ptr<AxisRival> clone() const = 0;
};

/// Functions of the speed, as a row vector.
using Functions = std::function<Eigen::VectorXd(const Eigen::Vector2d& speed)>;

/// Prior of a linear rival.
struct LinearTuning {
  Eigen::VectorXd deviation;  ///< prior standard deviation of each coefficient
  double forgetting = 1.0;    ///< [1] weight of the past per execution
  double walk = 0.0;          ///< [1] variance added per execution, relative to the prior
  double noise = 1.0;         ///< [1] factor on the variances of the samples
};

/// Recursive least squares, or a Kalman filter on a random walk, in closed form:
///    P <- P / forgetting + walk P_0,   x <- x + P h (r - h' x) / (h' P h + noise R),   P <- P - P
///    h h' P / (..)
class LinearRival : public AxisRival {
 public:
  /// Starts with the coefficients `start`, or with zero if it is empty.
  LinearRival(size_t axis, Functions functions, const LinearTuning& tuning,
              const Eigen::VectorXd& start = {});

  void learn(const Sample& sample) override;
  double offset(const Eigen::Vector2d& speed) const override;
  std::unique_ptr<AxisRival> clone() const override { return std::make_unique<LinearRival>(*this); }
  /// One filter step with the functions h at the sample; returns the log density of the residual.
  static double step(const LinearTuning& tuning, const Eigen::VectorXd& h, double residual,
                     double noise, Eigen::VectorXd& x, Eigen::MatrixXd& P);
  /// Mean of the functions over a sample's parts.
  static Eigen::VectorXd row(const Functions& functions, const Sample& sample);

 private:
  Eigen::Index axis_;
  Functions functions_;
  LinearTuning tuning_;
  Eigen::VectorXd x_;
  Eigen::MatrixXd P_;
};

/// Hyperparameters of a Gaussian process.
struct KernelTuning {
  double deviation = 0.1;            ///< of the residual [m/s] or [rad/s]
  Eigen::Vector2d length{1.0, 1.0};  ///< of v [m/s] and w [rad/s]
  double noise = 1.0;                ///< [1] factor on the variances of the samples
};

/// Samples are means over their parts, so the kernel of two samples is the mean over pairs.
/** The covariance of all samples is L L'; each sample appends a row to L. */
class GaussianProcess : public AxisRival {
 public:
  GaussianProcess(size_t axis, const KernelTuning& tuning)
      : axis_(static_cast<Eigen::Index>(axis)), tuning_(tuning) {}

  void learn(const Sample& sample) override;
  double offset(const Eigen::Vector2d& speed) const override;
  std::unique_ptr<AxisRival> clone() const override {
    return std::make_unique<GaussianProcess>(*this);
  }
  /// Sum of the log densities of samples, each given the previous ones.
  static double logLikelihood(size_t axis, const KernelTuning& tuning, const Sample* samples,
                              size_t count);

 private:
  Eigen::Index axis_;
  KernelTuning tuning_;
  /// Adds a sample; returns its log density.
  double extend(const Sample& sample);

  std::vector<Sample> samples_;
  Eigen::MatrixXd L_;
  Eigen::VectorXd z_;        ///< L^-1 residuals
  Eigen::VectorXd weights_;  ///< L'^-1 z
};

/// Learns the difference of twists from the reference.
class Rival {
 public:
  virtual ~Rival() = default;
  virtual void learn(const Sample& sample) = 0;
  /// The reference's twists of a piece, corrected; `sample` is the reference's summary of the
  /// piece.
  virtual std::vector<Twist2> corrected(std::vector<Twist2> twists, const Sample& sample) const = 0;
  virtual std::unique_ptr<Rival> clone() const = 0;
};

/// A rival that learns the three velocities separately.
class AxisRivals : public Rival {
 public:
  explicit AxisRivals(std::array<std::unique_ptr<AxisRival>, kAxes> axes)
      : axes_(std::move(axes)) {}
  AxisRivals(const AxisRivals& other);

  void learn(const Sample& sample) override;
  std::vector<Twist2> corrected(std::vector<Twist2> twists, const Sample& sample) const override;
  std::unique_ptr<Rival> clone() const override { return std::make_unique<AxisRivals>(*this); }

 private:
  std::array<std::unique_ptr<AxisRival>, kAxes> axes_;  ///< nullptr: this velocity is not learned
};

/// Fewer sessions do not show how grounds differ.
inline constexpr size_t kLeastSessions = 3;

}  // namespace tread::adaptation
