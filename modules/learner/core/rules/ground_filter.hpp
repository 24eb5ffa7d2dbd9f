// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "common/pattern/pattern.hpp"
#include "modules/learner/core/rules/learning_rule.hpp"
#include "modules/learner/core/scaling.hpp"

namespace tread::learner {

/// What ground may do to the body twist of a pattern: corrections relative to the shipped
/// prediction.
/** With v, s, w the shipped forward, lateral and yaw velocity of a sample [m/s, m/s, rad/s]:
 *    forward   v' = v (1 + f + r_x - tau |w|)
 *    lateral   s' = s + kappa |v| w + (c + r_y) v
 *    yaw       w' = w (1 + g + r_w + eta |v|) + b v
 * f forward gain [1], g yaw gain [1], kappa sideslip [s], tau turn loss [s], eta yaw gain by speed
 * [s/m], b yaw bias [rad/m], c crab [1] are common to all patterns; r_x, r_y, r_w [1] are the
 * pattern's own. Linear in the ten, so that a mean twist is corrected exactly by a matrix; only
 * predictions are kept within what ground can do (factors 0..3, lateral +-|v|, bias +-0.5 rad/m).
 */
struct TwistCorrection {
  enum Index { kForward, kYaw, kSideslip, kTurnLoss, kYawBySpeed, kYawBias, kCrab, kCommon };
  static constexpr int kOwn = 3;               ///< r_x, r_y, r_w, after the common ones
  static constexpr int kAll = kCommon + kOwn;  ///< ten
};
using Correction10 = Eigen::Matrix<double, TwistCorrection::kAll, 1>;

/// The body twists of a pattern's shipped prediction, sample by sample.
/** A sample's twist is the constant one that leads from a pose to the next (SE(2) logarithm).
 * Corrected profiles are integrated again exactly: in a sample of dt the pose moves by the chord
 *    dt sinc(w' dt / 2) (v', s'),   turned by the yaw in the middle of the sample. */
class TwistProfile {
 public:
  TwistProfile(const MotionPattern& shipped, double period);

  /// R under a correction. Allocates nothing.
  void integrate(const Correction10& correction, Trajectory prediction) const;
  /// Its last pose alone.
  Pose2 integrateEnd(const Correction10& correction) const;

  /// Mean shipped twist (v, s, w).
  const Eigen::Vector3d& mean() const { return mean_; }
  /// Change of the mean twist per unit of each correction.
  const Eigen::Matrix<double, 3, TwistCorrection::kAll>& meanResponse() const {
    return mean_response_;
  }
  /// Change of the last pose (x, y, yaw) per unit of each correction, at the shipped prediction.
  const Eigen::Matrix<double, 3, TwistCorrection::kAll>& endResponse() const {
    return end_response_;
  }
  /// Change of the last pose per unit of a constant twist (v, s, w) added to all samples [s, m s].
  const Eigen::Matrix3d& endLever() const { return end_lever_; }
  double duration() const { return period_ * static_cast<double>(forward_.size()); }
  /// Mean |v| and |w| along the pattern: how large it is, also where it goes there and back.
  double meanSpeed() const { return mean_speed_; }
  double meanTurn() const { return mean_turn_; }

 private:
  template <typename Put>
  Pose2 walk(const Correction10& correction, Put&& put) const;
  void measureResponses();

  double period_;
  std::vector<double> forward_, lateral_, yaw_;  ///< [m/s, m/s, rad/s] by sample
  Eigen::Vector3d mean_;
  Eigen::Matrix<double, 3, TwistCorrection::kAll> mean_response_;
  Eigen::Matrix<double, 3, TwistCorrection::kAll> end_response_;
  Eigen::Matrix3d end_lever_;
  double mean_speed_ = 0.0;
  double mean_turn_ = 0.0;
};

/// Mean body twist of a trajectory that begins in (0, 0, 0); allocates nothing.
Eigen::Vector3d meanTwist(const ConstTrajectory& trajectory, double period);

/// What is known before anything is measured: patterns as body twists, what one change of ground
/// may do to them, and how exact one execution is. Immutable; filters share it.
/** State x = (f, g, kappa, tau, eta, b, c, then r_x, r_y, r_w of each pattern); see
 * TwistCorrection. D = 7 + 3 n. Residuals of different patterns are correlated by 0.1 k(i, j) + 0.7
 * e(i, j) + 0.2 [i = j],   k = exp(-d(i, j)^2 / 2), d the distance of the patterns' mean (v, w)
 * over 0.6 of the largest |v|, |w| in the set; e the same kernel made even (r_x, r_w) or odd (r_y)
 * under mirroring w -> -w and brought to a unit diagonal: mirrored patterns are correlated by 0.7,
 * neighbours by 0.8. */
class GroundModel {
 public:
  GroundModel(const FilterConfig& config, const PatternSet& shipped);

  size_t patterns() const { return profiles_.size(); }
  Eigen::Index dimension() const { return dimension_; }
  double period() const { return period_; }
  const TwistProfile& profile(size_t pattern) const { return profiles_[pattern]; }

  /// The ten corrections of a pattern out of a state.
  Correction10 correctionOf(const Eigen::VectorXd& x, size_t pattern) const;
  /// Their covariance out of the state's.
  Eigen::Matrix<double, 10, 10> covarianceOf(const Eigen::MatrixXd& P, size_t pattern) const;
  /// Predicted mean twist under a state: shipped mean + H x.
  Eigen::Vector3d meanTwistUnder(const Eigen::VectorXd& x, size_t pattern) const;
  /// P H' (D x 3), for the pattern's H.
  void timesResponse(const Eigen::MatrixXd& P, size_t pattern,
                     Eigen::Matrix<double, Eigen::Dynamic, 3>& result) const;
  /// H A (3 x 3) of a D x 3 matrix.
  Eigen::Matrix3d response(const Eigen::Matrix<double, Eigen::Dynamic, 3>& A, size_t pattern) const;

  /// Q: covariance of what one change of ground does.
  const Eigen::MatrixXd& changeCovariance() const { return change_; }
  /// Q^-1.
  const Eigen::MatrixXd& changeInformation() const { return change_information_; }
  /// Q H' of a pattern.
  const Eigen::Matrix<double, Eigen::Dynamic, 3>& changeResponse(size_t pattern) const {
    return change_response_[pattern];
  }
  /// R: covariance of one execution's mean twist on unchanged ground.
  /** Where the shipped set knows the spread of a pattern's end, half of it and half of what the
   * configuration expects: other grounds may be rougher or smoother than the shipped one. */
  const Eigen::Matrix3d& noise(size_t pattern) const { return noise_[pattern]; }
  /// The same of its end pose (x, y, yaw).
  const Eigen::Matrix3d& endNoise(size_t pattern) const { return end_noise_[pattern]; }
  /// Position in the state of a pattern's own residuals.
  static Eigen::Index ownAt(size_t pattern) {
    return TwistCorrection::kCommon + 3 * static_cast<Eigen::Index>(pattern);
  }

 private:
  void fillChangeCovariance(const FilterConfig& config);
  void fillNoise(const FilterConfig& config, const PatternSet& shipped);

  double period_;
  Eigen::Index dimension_;
  std::vector<TwistProfile> profiles_;
  Eigen::MatrixXd change_;
  Eigen::MatrixXd change_information_;
  std::vector<Eigen::Matrix<double, Eigen::Dynamic, 3>> change_response_;
  std::vector<Eigen::Matrix3d> noise_;
  std::vector<Eigen::Matrix3d> end_noise_;
};

/// R with factors q on its variances: sqrt(q_i q_j) R_ij.
Eigen::Matrix3d scaledNoise(const Eigen::Matrix3d& R, const Eigen::Vector3d& factors);

/// Kalman filter of the ground's corrections, which may jump: two hypotheses a step, merged again.
/** z = mean body twist of M, y = z - (shipped mean + H x), R the noise of an execution
 *  times caution^2.
 *  Before each execution the ground either stayed (s) or changed (c, probability h):
 *    P_s = (1 - drift) P + drift steady Q,   P_c = P + Q,   S = H P H' + R
 *    x_k = x + P_k H' S_k^-1 y,   P_k' = P_k - P_k H' S_k^-1 H P_k
 *    w_s ~ (1 - h) N(y; 0, S_s),   w_c ~ h N(y; 0, S_c),   w_s + w_c = 1
 *  and the two are merged to one normal distribution of equal mean and covariance (generalised
 *  pseudo-Bayes of first order, Ackerson and Fu 1970). Begins with x = 0, P = steady Q. */
class GroundFilter {
 public:
  GroundFilter(std::shared_ptr<const GroundModel> model, const FilterConfig& config);

  /// Takes the mean twist of an execution; returns the logarithm of its probability density before.
  double update(size_t executed, const Eigen::Vector3d& mean_twist);
  /// Factors on the variances of v_x, v_y and omega of an execution from now on [1].
  void setNoise(const Eigen::Vector3d& noise) { noise_ = noise; }
  const Eigen::Vector3d& noise() const { return noise_; }

  const GroundModel& model() const { return *model_; }
  const Eigen::VectorXd& mean() const { return x_; }
  const Eigen::MatrixXd& covariance() const { return P_; }
  /// w_c of the last update [1].
  double changeProbability() const { return change_probability_; }

  /// Begins anew about a state: P = share Q.
  void restartAt(const Eigen::VectorXd& x, double share);
  void assign(const GroundFilter& other);
  void save(std::vector<double>& memory) const;
  /// Reads what save() appended, from `at` on; false if it is not there, not of this size or no
  /// state of a filter. What was there before is lost then.
  bool restore(const std::vector<double>& memory, size_t& at);

 private:
  struct Hypothesis {
    Eigen::Matrix<double, Eigen::Dynamic, 3> PH;    ///< P_k H'
    Eigen::Matrix<double, Eigen::Dynamic, 3> root;  ///< PH S^-1/2: root root' leaves P
    Eigen::VectorXd step;                           ///< x_k - x
    double log_likelihood = 0.0;                    ///< with caution, to weigh the two
    double log_density = 0.0;                       ///< without, to be compared with other models
  };
  /// P_k = kept P + opened Q.
  void consider(Hypothesis& hypothesis, double kept, double opened, size_t executed,
                const Eigen::Vector3d& y);

  /// The update where nothing ever changes: P' = P - root root', x' = x + step.
  double follow();

  std::shared_ptr<const GroundModel> model_;
  double hazard_;
  double drift_;
  double steady_;
  double caution_;  ///< factor on the noise's variances
  Eigen::VectorXd x_;
  Eigen::MatrixXd P_;
  double change_probability_ = 0.0;
  Eigen::Vector3d noise_ = Eigen::Vector3d::Ones();
  Eigen::Matrix<double, Eigen::Dynamic, 3> PH_;
  Hypothesis stayed_, changed_;
  Eigen::VectorXd apart_;
};

/// Logarithm of the normal density of `y` about zero with covariance S.
double logNormal(const Eigen::Vector3d& y, const Eigen::Matrix3d& S);

/// No vehicle's mean twist is beyond 100 m/s, 100 rad/s, whatever was measured.
Eigen::Vector3d plausible(const Eigen::Vector3d& twist);

/// A hierarchical Kalman filter in body-twist space (own work).
/** What the ground does to the executed pattern's mean body twist is split into corrections that
 * all patterns share (gains, sideslip, turn loss, ...: TwistCorrection) and the pattern's own
 * residual, in proportion to their covariances (GroundModel), by a filter that expects jumps
 * (GroundFilter). Predictions are the shipped twist profiles under the filter's mean,
 * integrated again; so a strong turn is corrected along its arc, which scaling x and y cannot do.
 * Covariance of an end pose [m2, m rad, rad2]: J P J' + that of one execution, J the response of
 * the end pose. It knows no driven trajectory by heart: shapes stay the shipped ones. */
class LocalFilter : public LearningRule {
 public:
  LocalFilter(const RuleConfig& config, const PatternSet& shipped);

  void learn(size_t executed, const ConstTrajectory& measured, RuleNote& note) override;
  std::string reason(const RuleNote& note) const override;
  void predict(size_t pattern, Trajectory prediction) const override;
  Pose2 predictEnd(size_t pattern) const override;
  std::optional<PoseCovariance> endCovariance(size_t pattern) const override;
  void assign(const LearningRule& other) override;
  std::unique_ptr<LearningRule> clone() const override {
    return std::make_unique<LocalFilter>(*this);
  }
  std::vector<double> memory() const override;
  bool restore(const TrajectoryTable& predictions, const std::vector<double>& memory) override;

 private:
  std::shared_ptr<const GroundModel> model_;
  GroundFilter filter_;
};

/// A probability in words: "97 %".
std::string percent(double probability);

/// The upper triangle of a symmetric matrix.
PoseCovariance upperTriangle(const Eigen::Matrix3d& covariance);

}  // namespace tread::learner
