// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>

#include "modules/learner/core/rules/ground_model.hpp"
#include "modules/learner/core/rules/learning_rule.hpp"

namespace tread::learner {

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
 * all patterns share (gains, sideslip, turn loss, ...: twist_profile.hpp) and the pattern's own
 * residual, in proportion to their covariances (ground_model.hpp), by a filter that expects jumps
 * (ground_filter.hpp). Predictions are the shipped twist profiles under the filter's mean,
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
