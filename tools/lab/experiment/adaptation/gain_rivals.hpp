// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <memory>
#include <string>

#include "tools/lab/experiment/adaptation/rivals.hpp"

// Gains on the mean twist m of the reference: z = m + H x + noise, with x = 0 initially and a
// standard deviation of 0.5:
//   two gains     H = [m_x 0; m_y 0; 0 m_omega]
//   three gains   H = diag(m_x, m_y, m_omega)
// Their priors are fixed for all vehicles and not tuned.
namespace tread::adaptation {

/// Prior standard deviation of each gain [1].
inline constexpr double kGainDeviation = 0.5;

/// Forgetting recursive least squares:
///    P <- P / forgetting while no variance reaches 1, K = P H' (H P H' + R)^-1,
///    x <- x + K (z - m - H x),   P <- P - K H P, forgetting 0.7, R from 3 mm/s and 0.008 rad/s.
class GainRls : public Rival {
 public:
  /// Two or three gains.
  explicit GainRls(Eigen::Index gains);

  void learn(const Sample& sample) override;
  std::vector<Twist2> corrected(std::vector<Twist2> twists, const Sample& sample) const override;
  std::unique_ptr<Rival> clone() const override { return std::make_unique<GainRls>(*this); }

 private:
  Eigen::VectorXd x_;
  Eigen::MatrixXd P_;
};

/// An interacting multiple-model filter (Blom and Bar-Shalom 1988) of three gains: between
/// executions they are nearly constant (calm), or may jump anywhere (changed).
/** With the probabilities mu_i and Pi_ij of going from model i to j, for each model j
 *    c_j = sum_i Pi_ij mu_i,   mu_i|j = Pi_ij mu_i / c_j,
 *    x_j <- sum_i mu_i|j x_i,  P_j <- sum_i mu_i|j (P_i + (x_i - x_j)(x_i - x_j)') + Q_j,
 * a Kalman step of each with the noise of the sample, mu_j ~ c_j N(innovation; 0, S_j). What is
 * predicted is the mean. */
class InteractingGains : public Rival {
 public:
  InteractingGains();

  void learn(const Sample& sample) override;
  std::vector<Twist2> corrected(std::vector<Twist2> twists, const Sample& sample) const override;
  std::unique_ptr<Rival> clone() const override {
    return std::make_unique<InteractingGains>(*this);
  }

 private:
  struct Model {
    double probability;
    double walk;  ///< [1] standard deviation of a gain's step between executions
    Eigen::Vector3d x;
    Eigen::Matrix3d P;
  };
  std::array<Model, 2> mixed() const;
  Eigen::Vector3d mean() const;

  std::array<Model, 2> models_;  ///< calm, changed
};

/// rls2, rls3 or imm; nullptr for other names.
std::unique_ptr<Rival> gainRival(const std::string& name);

}  // namespace tread::adaptation
