// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "modules/identification/core/fit.hpp"
#include "tools/gap/manoeuvres.hpp"

namespace tread::gap {

/// How exactly a drive is measured.
struct InsNoise {
  double fix = 0.01;       ///< [m] of a position
  double heading = 0.003;  ///< [rad]
  double gyro = 0.01;      ///< [rad/s] of its mean over half a second
};

/// A manoeuvre, what a truth does on it, and what takes a difference to units of its noise.
/** Compared are poses and mean yaw rates each half second. The noise is the model's spread from one
 * execution to the next (3 %, 3 % and 1 deg where it states none), which is the same throughout a
 * manoeuvre, and that of the INS, at its begin, too. */
class Probe {
 public:
  Probe(const ModelDocument& truth, const Manoeuvre& manoeuvre, const InsNoise& ins);

  /// Difference of a model from the truth in units of noise.
  Eigen::VectorXd missed(const ModelDocument& model) const;
  double duration() const;  ///< [s]

 private:
  Manoeuvre manoeuvre_;
  Eigen::VectorXd wanted_;
  Eigen::LLT<Eigen::MatrixXd> noise_;
};

/// A model that is refitted to look like the truth.
class Rival {
 public:
  Rival(ModelDocument model, std::vector<FreeParameter> free)
      : model_(std::move(model)), free_(std::move(free)) {}

  /// Fits on manoeuvres so often each, from where it stands; returns the difference that remains
  /// [nats], with what its parameters' priors cost.
  double fit(const std::vector<Probe>& probes, const std::vector<size_t>& counts);

  const ModelDocument& model() const { return model_; }

 private:
  double lossOf(const ModelDocument& model, const std::vector<Probe>& probes,
                const std::vector<size_t>& counts) const;
  double priorLoss(const ModelDocument& model) const;
  Eigen::MatrixXd columnsOf(const Probe& probe, const Eigen::VectorXd& missed) const;
  void linearise(const std::vector<Probe>& probes, const std::vector<size_t>& counts,
                 Eigen::MatrixXd& information, Eigen::VectorXd& pull) const;
  bool step(const Eigen::MatrixXd& information, const Eigen::VectorXd& pull, double damping,
            const std::vector<Probe>& probes, const std::vector<size_t>& counts, double& loss);

  ModelDocument model_;
  std::vector<FreeParameter> free_;
};

}  // namespace tread::gap
