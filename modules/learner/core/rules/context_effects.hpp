// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "common/execution/measurement.hpp"
#include "modules/learner/core/rules/ground_model.hpp"

namespace tread::learner {

/// Influence of slope and battery on a mean twist, the same on every ground.
/** Velocity i of an execution changes by sum_k c_ik f_ik, f of its context:
 *    slope      f = |v| rise along body x for v_x, along body y for v_y and omega
 *    voltage    f = v (V / V_0 - 1) for v_x, omega (V / V_0 - 1) for omega
 * V_0 is the first measured voltage. Constant influences belong to the ground, so c is learned
 * from the deviation of f from its mean on the same ground, by a Kalman filter for each c. A c is
 * used only if it improves the prediction: the differences of the log densities of executions with
 * and without it, each evaluated before learning from the execution, are summed; it is used once
 * the sum reaches `context_evidence`, until it is negative. */
class ContextEffects {
 public:
  enum Input { kSlope, kVoltage, kInputs };
  using Inputs = Eigen::Matrix<double, static_cast<int>(kVelocities), kInputs>;

  explicit ContextEffects(const GroundConfig& config);

  /// Sets the present battery voltage [V], if known. The first one becomes V_0.
  void meet(double voltage);
  /// f at the latest voltage; 0 where the tilt is unknown.
  Inputs inputs(const PatternPart& part, double seconds, const Tilt& tilt) const;
  /// Change of each velocity by the effects in use.
  Eigen::Vector3d effect(const Inputs& f) const;
  /// Their change of forward and yaw gain at the latest voltage [1].
  Eigen::Vector2d gainsNow() const;
  /// Learns from `beyond`: the measured velocities minus those of the ground and effect(f), with
  /// their variance. A new number of `ground` restarts the mean of f.
  void learn(const Inputs& f, const Eigen::Vector3d& beyond, const Eigen::Vector3d& variance,
             int64_t ground);
  bool counts(size_t velocity, Input input) const {
    return counts_(static_cast<Eigen::Index>(velocity), input) > 0.0;
  }

  /// Finite numbers; restore() returns false if they are invalid.
  void save(std::vector<double>& memory) const;
  bool restore(const std::vector<double>& memory, size_t& at);

 private:
  template <class Take>
  static void forEach(Take&& take) {
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(kVelocities); ++i)
      for (Eigen::Index k = 0; k < kInputs; ++k)
        if (i != 1 || k != kVoltage) take(i, k);
  }

  double evidence_;
  Inputs c_ = Inputs::Zero();
  Inputs variance_;                 ///< of c
  Inputs gained_ = Inputs::Zero();  ///< sum of the differences of log densities
  Inputs counts_ = Inputs::Zero();  ///< 1 if in use, 0 if not
  Inputs mean_ = Inputs::Zero();    ///< of f on this ground
  double executions_ = 0.0;         ///< number of executions in the mean
  int64_t ground_ = -1;
  double first_voltage_ = 0.0;  ///< V_0 [V]; 0 before the first measurement
  double sag_ = 0.0;            ///< V / V_0 - 1 at the latest voltage
};

}  // namespace tread::learner
