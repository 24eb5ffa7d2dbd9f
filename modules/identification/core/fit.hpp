// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "common/parallel/parallel_for.hpp"
#include "common/vehicle/unnamed_terms.hpp"
#include "modules/identification/core/likelihood.hpp"

namespace tread::gap {

/// A number of a model that a fit may change.
struct FreeParameter {
  std::string path;  ///< see findParameter()
  double min = 0.0;  ///< hard bounds: what is physically plausible
  double max = 0.0;
  double step = 0.0;  ///< of differences, in the parameter's unit
  /// Prior of it; infinite deviation = no prior.
  double expected = 0.0;
  double deviation = std::numeric_limits<double>::infinity();
};

/// The part of a path before the dot: the effect, or a number of the nominal model.
inline std::string effectOf(const std::string& path) {
  return path.substr(0, path.find('.'));
}

/// Bound and step of a value of an unnamed term, in any unit.
inline constexpr double kAnyTermValue = kLargestTermValue;
inline constexpr double kTermStep = 0.01;

/// A parameter of the catalogue, of the nominal model or of an unnamed term, free within its
/// plausible bounds.
/** Throws std::out_of_range for an unknown path. */
FreeParameter freeParameter(const ModelDocument& model, const std::string& path);

/// Model, prediction and noise of a fit.
struct FitState {
  ModelDocument model;
  std::vector<FreeParameter> free;
  Eigen::VectorXd predicted;  ///< rows x 1, see Fitter::predict()
  Eigen::VectorXd scales;     ///< rows x 1, held during a fit
  /// Rows x free: derivative of the prediction; may belong to earlier values
  Eigen::MatrixXd jacobian;
  double loss = 0.0;  ///< of the rows that count, including the prior [nats]
};

/// Fits models to rows by iterated, damped least squares within bounds.
class Fitter {
 public:
  /// Uses all rows; the rows must outlive it. `rest`: the conditions of the models' rest, see
  /// restConditions() (rows x terms); without columns models have no rest.
  explicit Fitter(const Observations& data, ParallelFor parallel = serialFor,
                  Eigen::MatrixXd rest = {})
      : data_(data),
        mask_(data.all().size(), 1),
        segments_(data.segmentsOf(mask_)),
        parallel_(std::move(parallel)),
        rest_(std::move(rest)) {}

  /// The same with other rows; those whose mask is 0 do not count.
  Fitter onRows(std::vector<char> mask) const;

  /// The same with all rows.
  Fitter onAllRows() const { return Fitter(data_, parallel_, rest_); }

  /// The rows predicted by the model's vehicle and INS, with its rest (rows x 1); segments without
  /// rows that count are not simulated.
  Eigen::VectorXd predict(const ModelDocument& model) const;
  /// A state of a model with its prediction and its own noise, without a fit.
  FitState start(const ModelDocument& model, std::vector<FreeParameter> free) const;
  /// Re-estimates noise and scales from the state's residuals (and its loss with them).
  void renewNoise(FitState& state) const;
  /// Frees a parameter in the state, with a start value.
  void add(FitState& state, const FreeParameter& parameter, double value) const;
  /// Fixes one of them at its value.
  void release(FitState& state, size_t index) const;
  /// Minimises the loss; first computes missing columns of the Jacobian.
  void fit(FitState& state) const;
  /// The same to within half a nat, with a Jacobian updated from the steps (Broyden): for
  /// comparisons.
  void fitRoughly(FitState& state) const;
  /// The Jacobian at the state's values.
  void renewJacobian(FitState& state) const;
  /// Change of the prediction when a parameter is set to `value` (rows x 1); 0 if it is equal.
  Eigen::VectorXd secant(const FitState& state, const ModelDocument& changed, double change) const;

  const Observations& data() const { return data_; }
  const std::vector<char>& mask() const { return mask_; }
  /// Which blocks have rows that count.
  std::vector<char> blocksThatCount() const { return data_.blocksOf(mask_); }
  const ParallelFor& parallel() const { return parallel_; }
  /// Conditions of the rest of its models (rows x terms).
  const Eigen::MatrixXd& rest() const { return rest_; }

 private:
  double lossOf(const FitState& state) const;
  Eigen::VectorXd column(const FitState& state, size_t index) const;
  bool stepOnce(FitState& state, double& damping, double& gained) const;

  const Observations& data_;
  std::vector<char> mask_;
  std::vector<char> segments_;  ///< those with rows that count
  ParallelFor parallel_;
  Eigen::MatrixXd rest_;  ///< rows x terms
};

/// Normal equations of one iterated least squares step.
struct Normal {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd pull;
};

/// For rows whose mask is not 0, without the prior.
Normal normalOf(const FitState& state, const Eigen::VectorXd& residuals,
                const std::vector<char>& mask);

/// Prior precision of the free parameters (free x free); zero rows for parameters without a prior.
/** Deviations are the parameters' own, correlations those of the model's covariance: delay and lag
 * may each be vague while their sum is known. */
Eigen::MatrixXd priorPrecision(const FitState& state);

/// Inverse of the prior precision; zero rows for parameters without a prior (free x free).
Eigen::MatrixXd priorCovariance(const FitState& state);

/// Standard deviation of a number by the model's covariance; infinite if it has none.
double knownDeviation(const ModelDocument& model, const std::string& path);

/// Difference of the free parameters from their prior means (free x 1).
Eigen::VectorXd offExpected(const FitState& state);

/// Whether a parameter belongs to a term that the model already had, not to a found one.
inline bool isGiven(const FreeParameter& parameter) {
  return parameter.expected != 0.0;
}

/// Whether a parameter is at one of its bounds.
bool onBound(const ModelDocument& model, const FreeParameter& parameter);

/// Whether a parameter's name makes it a time: a change point, a time constant, the time of a
/// drift.
/** The ratio of a time to its error is meaningless, and a time cannot run to the end of its range.
 */
inline bool isTime(const FreeParameter& parameter) {
  return parameter.path.find(".time") != std::string::npos;
}

/// Whether a size ran to the end of its plausible range, which makes it invalid.
/** An effect that is off has no size, a change point no range; the lag or delay of a model may
 * vanish completely. */
bool runsToBound(const ModelDocument& model, const FreeParameter& parameter);

/// Whether a strength of a change point is not 0.
bool hasChanged(const Effect& effect, const ChangePoint& change, const ModelDocument& model);

/// Paths of the change points of a model's effects that are on.
std::vector<std::string> changePointsOn(const ModelDocument& model);

/// Moves a change point to the minimum of the loss, with everything else fixed.
/** The loss is not smooth over its time (each time affects other data), so it is searched directly:
 * halving steps down to a quarter of a second. */
void refineChangePoint(const Fitter& fitter, FitState& state, const std::string& path);

/// Times between which the loss stays within `allowed` nats of the state's [s], at least from the
/// last execution that contradicts the change to the first that supports it.
/** Everything else is fixed, so that the loss alone would be too certain; between these executions
 * the drive has no information about the time. */
std::pair<double, double> changePointInterval(const Fitter& fitter, const FitState& state,
                                              const std::string& path, double allowed);

}  // namespace tread::gap
