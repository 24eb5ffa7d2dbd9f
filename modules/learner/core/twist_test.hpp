// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <deque>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/se2.hpp"
#include "common/pattern/pattern.hpp"

// Whether the motion is the predicted one, while it is driven: a test of the mean body twist over a
// moving window of T_w seconds, which may begin in the pattern before.
//    d = z - m                                   measured less predicted mean twist of the window
//    S = V max(1, T / T_w) + 2 diag(s_p^2, s_p^2, s_h^2) / T_w^2
//    x = d' S^-1 d                               chi^2 with three degrees of freedom, if predicted
// V = J^-1 P J^-T is the covariance of the mean twist of a pattern of T seconds, P that of its
// predicted end, J the derivative of the end by the mean twist. Part of V is the ground, which is
// wrong all the time; part is chance, which scatters more in a shorter window. All of it counts as
// chance, so that x is rather too small. s_p, s_h are the noise of a measured pose beyond P.
namespace tread::learner {

/// When a motion is not the predicted one.
struct TwistTestLimits {
  double window = 0.8;    ///< [s] T_w
  double chance = 1e-3;   ///< [1] probability that a window of predicted motion is as far off
  int in_a_row = 2;       ///< so many samples; one may be a jump of the INS
  double position = 0.0;  ///< [m] s_p
  double heading = 0.0;   ///< [rad] s_h
};

/// Notices while a pattern runs that the ground is not the one that was predicted.
class TwistTest {
 public:
  explicit TwistTest(const TwistTestLimits& limits);

  /// A pattern begins where the one before ended: predicted poses after each period, relative to
  /// its start, and the covariance of the last of them; where that is unknown nothing is noticed.
  void begin(const std::vector<Pose2>& predicted, const PoseCovariance& end, double period);
  /// The measured pose after the pattern's next period, relative to its start.
  /** Returns whether the motion is not the predicted one, as often as that is so. A pose that is
   * not finite, or beyond the pattern's end, forgets the window. */
  bool add(const Pose2& T_start_body);
  /// Forgets the window: after a stop, a gap of the INS, or what was noticed.
  void clear();

  /// x of the last window; NaN while the window is not full or no covariance is known.
  double statistic() const { return statistic_; }
  /// Of x, from which on it counts.
  double threshold() const { return threshold_; }

 private:
  /// What one period did.
  struct Step {
    Pose2 measured;     ///< relative to its beginning
    Pose2 predicted;    ///< the same
    Eigen::Matrix3d V;  ///< of its pattern's mean twist
    double pattern;     ///< [s] T
    double period;      ///< [s]
  };
  double statisticOfWindow() const;

  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  TwistTestLimits limits_;
  double threshold_;
  std::vector<Pose2> predicted_;
  Eigen::Matrix3d V_ = Eigen::Matrix3d::Constant(kUnknown);
  double period_ = 0.0;
  Pose2 last_;
  size_t next_ = 0;
  std::deque<Step> steps_;
  double seconds_ = 0.0;  ///< of the steps
  double statistic_ = kUnknown;
  int far_ = 0;  ///< windows in a row
};

/// Covariance of the mean twist over `seconds` that leads to an end, of the covariance of the end.
Eigen::Matrix3d twistCovariance(const Pose2& end, const PoseCovariance& covariance, double seconds);

/// x that chi^2 with three degrees of freedom exceeds with a probability.
double chiSquare3(double probability);

}  // namespace tread::learner
