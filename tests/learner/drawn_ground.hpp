// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Cholesky>

#include "modules/learner/core/rules/multi_model.hpp"
#include "tests/learner/rule_bench.hpp"

namespace tread::learner::samples {

/// A ground of the ground model: corrections and scatter of executions.
struct DrawnGround {
  SetCorrection x;
  double noise = 1.0;  ///< [1] variance of one execution relative to the expected one
};

/// Moderate differences between drawn grounds: standard deviations relative to a scale [1].
struct DrawnWidths {
  double gain = 0.06, residual = 0.04, yaw = 0.16, yaw_residual = 0.06, yaw_bias = 0.02;
};

inline double chanceOf(std::mt19937_64& random) {
  return std::normal_distribution<double>(0.0, 1.0)(random);
}

/// Grounds drawn from a distribution among the rule's expectations, and executions on them.
class DrawnWorld {
 public:
  explicit DrawnWorld(PatternSet set = richSet(), const GroundConfig& config = {})
      : set_(std::move(set)), model_(config, set_) {}

  const PatternSet& set() const { return set_; }
  const GroundModel& model() const { return model_; }
  size_t patterns() const { return model_.patterns(); }

  /// A ground around a centre, with `share` of the variance between grounds.
  DrawnGround ground(std::mt19937_64& random, double share, const DrawnGround& centre) const {
    const DrawnWidths widths;
    DrawnGround drawn = centre;
    for (Eigen::Index i = 0; i < TwistCorrection::kCommon; ++i) {
      if (i == TwistCorrection::kLag || i == TwistCorrection::kYawLag)
        continue;  // patterns with one twist would not show it
      const double width = i < TwistCorrection::kVelocity ? widths.gain
                           : i < TwistCorrection::kBiasX  ? widths.yaw
                                                          : widths.yaw_bias;
      drawn.x.common[i] += width * std::sqrt(share * model_.spread()[i]) * chanceOf(random);
    }
    for (int own = 0; own < TwistCorrection::kOwn; ++own) {
      const double width = own < TwistCorrection::kYawOwn    ? widths.residual
                           : own == TwistCorrection::kYawOwn ? widths.yaw_residual
                                                             : 0.5 * widths.yaw_bias;
      const Eigen::LLT<Eigen::MatrixXd> root(share * width * width *
                                             model_.alike(static_cast<TwistCorrection::Own>(own)));
      Eigen::VectorXd chance(static_cast<Eigen::Index>(patterns()));
      for (double& number : chance) number = chanceOf(random);
      drawn.x.own.row(own) += (root.matrixL() * chance).transpose();
    }
    return drawn;
  }
  DrawnGround ground(std::mt19937_64& random, double share = 1.0) const {
    return ground(random, share, shipped());
  }
  /// Ground of the shipped set.
  DrawnGround shipped() const { return {SetCorrection::none(patterns())}; }

  /// Motion for a pattern on a ground, without scatter.
  std::vector<Pose2> expected(const DrawnGround& ground, size_t pattern) const {
    const auto samples = model_.profile(pattern).samples();
    std::vector<double> numbers(static_cast<size_t>(3 * samples));
    model_.profile(pattern).integrate(model_.scale(), ground.x.of(pattern),
                                      Trajectory(numbers.data(), samples, 3));
    return posesOf(ConstTrajectory(numbers.data(), samples, 3));
  }
  /// One execution: the same plus a random constant twist.
  std::vector<Pose2> execution(const DrawnGround& ground, size_t pattern,
                               std::mt19937_64& random) const {
    const PatternPart& part = model_.whole(pattern);
    Eigen::Vector3d by_chance = (ground.noise * part.noise).cwiseSqrt();
    for (double& number : by_chance) number *= chanceOf(random);
    by_chance = part.toBody() * by_chance;
    const Twist2 chance{by_chance[0], by_chance[1], by_chance[2]};
    std::vector<Pose2> driven = expected(ground, pattern);
    Pose2 at;
    Pose2 last;
    for (Pose2& pose : driven) {
      const Twist2 twist = twistTo(between(last, pose), model_.period());
      last = pose;
      at = at *
           integrate({twist.v_x + chance.v_x, twist.v_y + chance.v_y, twist.omega + chance.omega},
                     model_.period());
      pose = at;
    }
    return driven;
  }

  /// Executes random patterns on a ground; returns the note of the last execution.
  RuleNote drive(Pupil& pupil, const DrawnGround& ground, int executions,
                 std::mt19937_64& random) const {
    RuleNote note;
    for (int i = 0; i < executions; ++i) {
      const size_t p = random() % patterns();
      note = pupil.learn(p, execution(ground, p, random));
    }
    return note;
  }
  /// Mean distance of predicted ends from the expected ones on a ground [m].
  double endError(const Pupil& pupil, const DrawnGround& ground) const {
    double sum = 0.0;
    for (size_t p = 0; p < patterns(); ++p)
      sum += distance(pupil.end(p), expected(ground, p).back());
    return sum / static_cast<double>(patterns());
  }

 private:
  PatternSet set_;
  GroundModel model_;
};

inline const MultiModel& asMultiModel(Pupil& pupil) {
  return static_cast<const MultiModel&>(pupil.rule());
}

}  // namespace tread::learner::samples
