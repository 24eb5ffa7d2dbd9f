// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/fit.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace tread::gap {
namespace {

constexpr int kMostSteps = 25;
constexpr int kMostRounds = 8;    // with new Jacobians
constexpr double kEnough = 0.02;  // [nats] a smaller gain ends a fit
constexpr double kRoughlyEnough = 0.5;
constexpr double kMostDamping = 1e6;  // above it no step remains
constexpr double kStepOfTypical = 0.02;

double& valueOf(ModelDocument& model, const std::string& path) {
  double* value = findParameter(model, path);
  if (value == nullptr) throw std::out_of_range("no parameter '" + path + "' in a vehicle model");
  return *value;
}

double valueOf(const ModelDocument& model, const std::string& path) {
  return valueOf(const_cast<ModelDocument&>(model), path);
}

FreeParameter nominalNumber(const std::string& path, double value) {
  if (path == "lag" || path == "steering_lag") return {path, 0.0, 3.0, 0.005, value};
  if (path == "delay") return {path, 0.0, 2.0, 0.005, value};
  if (path == "gauge") return {path, 0.05, 10.0, 0.01, value};
  return {path, 0.02, 5.0, 0.01, value};  // gains and full speed
}

/// Share of a correlation that is used. It was estimated from few blocks: the smallest of many
/// combinations is underestimated.
constexpr double kCorrelationKept = 0.9;
constexpr double kLeastShare = 0.02;  // of a variance, in any combination: lower limit

/// The prior of the free parameters.
struct Known {
  std::vector<Eigen::Index> at;  // which of them
  Eigen::VectorXd deviation;
  Eigen::VectorXd values;  // of their correlation, with eigenvectors
  Eigen::MatrixXd vectors;
};

Known knownOf(const FitState& state) {
  Known known;
  for (size_t i = 0; i < state.free.size(); ++i)
    if (std::isfinite(state.free[i].deviation)) known.at.push_back(static_cast<Eigen::Index>(i));
  const auto count = static_cast<Eigen::Index>(known.at.size());
  const ParameterCovariance& covariance = state.model.covariance;
  std::vector<size_t> rows;  // of the covariance; its size = absent
  known.deviation.resize(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const FreeParameter& parameter =
        state.free[static_cast<size_t>(known.at[static_cast<size_t>(k)])];
    known.deviation[k] = parameter.deviation;
    rows.push_back(static_cast<size_t>(std::distance(
        covariance.parameters.begin(),
        std::find(covariance.parameters.begin(), covariance.parameters.end(), parameter.path))));
  }
  Eigen::MatrixXd correlation = Eigen::MatrixXd::Identity(count, count);
  for (Eigen::Index a = 0; a < count; ++a)
    for (Eigen::Index b = 0; b < count; ++b) {
      const size_t i = rows[static_cast<size_t>(a)];
      const size_t j = rows[static_cast<size_t>(b)];
      if (a == b || std::max(i, j) >= covariance.parameters.size()) continue;
      const double size = std::sqrt(covariance.matrix[i][i] * covariance.matrix[j][j]);
      if (size > 0.0) correlation(a, b) = kCorrelationKept * covariance.matrix[i][j] / size;
    }
  if (count == 0) return known;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(correlation);
  known.values = eigen.eigenvalues().cwiseMax(kLeastShare);
  known.vectors = eigen.eigenvectors();
  return known;
}

/// A matrix over the parameters with a prior, extended to all; 0 elsewhere.
Eigen::MatrixXd spread(const Known& known, const Eigen::VectorXd& eigenvalues,
                       const Eigen::VectorXd& units, size_t free) {
  const Eigen::MatrixXd vectors = units.asDiagonal() * known.vectors;
  const Eigen::MatrixXd part = vectors * eigenvalues.asDiagonal() * vectors.transpose();
  Eigen::MatrixXd all =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(free), static_cast<Eigen::Index>(free));
  for (size_t a = 0; a < known.at.size(); ++a)
    for (size_t b = 0; b < known.at.size(); ++b)
      all(known.at[a], known.at[b]) =
          part(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
  return all;
}

double priorLoss(const FitState& state) {
  const Eigen::VectorXd off = offExpected(state);
  return 0.5 * off.dot(priorPrecision(state) * off);
}

Normal priorNormal(const FitState& state, const Eigen::VectorXd& residuals,
                   const std::vector<char>& mask) {
  Normal normal = normalOf(state, residuals, mask);
  const Eigen::MatrixXd prior = priorPrecision(state);
  normal.matrix += prior;
  normal.pull -= prior * offExpected(state);
  return normal;
}

/// A damped step; fixes parameters that are at a bound and are pulled outwards.
Eigen::VectorXd dampedStep(const FitState& state, Normal normal, double damping) {
  for (Eigen::Index i = 0; i < normal.pull.size(); ++i) {
    const FreeParameter& parameter = state.free[static_cast<size_t>(i)];
    const double value = valueOf(state.model, parameter.path);
    const bool held = (value <= parameter.min && normal.pull[i] < 0.0) ||
                      (value >= parameter.max && normal.pull[i] > 0.0);
    if (held || normal.matrix(i, i) <= 0.0) {
      normal.matrix.row(i).setZero();
      normal.matrix.col(i).setZero();
      normal.matrix(i, i) = 1.0;
      normal.pull[i] = 0.0;
    }
    normal.matrix(i, i) *= 1.0 + damping;
  }
  return normal.matrix.ldlt().solve(normal.pull);
}

constexpr double kFirstStep = 16.0;  // [s]
constexpr double kLastStep = 0.25;   // [s]
constexpr double kFarthest = 120.0;  // [s] search range of an interval to either side

double lossAt(const Fitter& fitter, const FitState& state, const std::string& path, double time) {
  ModelDocument model = state.model;
  *findParameter(model, path) = time;
  const Observations& data = fitter.data();
  return totalLoss(data.residuals(fitter.predict(model)), state.scales, fitter.mask());
}

}  // namespace

FreeParameter freeParameter(const ModelDocument& model, const std::string& path) {
  FreeParameter free;
  free.path = path;
  free.expected = valueOf(model, path);
  const EffectParameter* known = findEffectParameter(path);
  if (termOfPath(model, path) != nullptr) {
    // An unnamed term has no plausible range: its values are determined by the data.
    free = {path, -kAnyTermValue, kAnyTermValue, kTermStep, free.expected};
  } else if (known == nullptr) {
    free = nominalNumber(path, free.expected);
  } else {
    free.step = known->role == ParameterRole::kShape && known->unit == "s"
                    ? 1.0
                    : kStepOfTypical * std::abs(known->typical);
  }
  if (const auto bounds = plausibleBounds(model, path)) {
    free.min = bounds->min;
    free.max = bounds->max;
  }
  return free;
}

Eigen::MatrixXd priorCovariance(const FitState& state) {
  const Known known = knownOf(state);
  return spread(known, known.values, known.deviation, state.free.size());
}

Eigen::MatrixXd priorPrecision(const FitState& state) {
  const Known known = knownOf(state);
  return spread(known, known.values.cwiseInverse(), known.deviation.cwiseInverse(),
                state.free.size());
}

double knownDeviation(const ModelDocument& model, const std::string& path) {
  const ParameterCovariance& known = model.covariance;
  for (size_t i = 0; i < known.parameters.size(); ++i) {
    const double deviation = known.parameters[i] == path ? std::sqrt(known.matrix[i][i]) : 0.0;
    if (deviation > 0.0 && std::isfinite(deviation)) return deviation;
  }
  return std::numeric_limits<double>::infinity();
}

Eigen::VectorXd offExpected(const FitState& state) {
  Eigen::VectorXd off(static_cast<Eigen::Index>(state.free.size()));
  for (size_t i = 0; i < state.free.size(); ++i)
    off[static_cast<Eigen::Index>(i)] =
        valueOf(state.model, state.free[i].path) - state.free[i].expected;
  return off;
}

bool onBound(const ModelDocument& model, const FreeParameter& parameter) {
  const double value = valueOf(model, parameter.path);
  const double near = 1e-6 * (parameter.max - parameter.min);
  return value <= parameter.min + near || value >= parameter.max - near;
}

bool runsToBound(const ModelDocument& model, const FreeParameter& parameter) {
  const double value = valueOf(model, parameter.path);
  const EffectParameter* known = findEffectParameter(parameter.path);
  const bool to_nothing = value < 0.0 && known != nullptr && known->adds_to != nullptr;
  return value != 0.0 && !to_nothing && !isTime(parameter) && onBound(model, parameter);
}

Normal normalOf(const FitState& state, const Eigen::VectorXd& residuals,
                const std::vector<char>& mask) {
  Eigen::VectorXd weights(residuals.size());
  for (Eigen::Index i = 0; i < residuals.size(); ++i)
    weights[i] = mask[static_cast<size_t>(i)] ? weightOf(residuals[i], state.scales[i]) : 0.0;
  const Eigen::MatrixXd weighted = weights.asDiagonal() * state.jacobian;
  // Symmetric: only half of it is computed.
  Eigen::MatrixXd half = Eigen::MatrixXd::Zero(weighted.cols(), weighted.cols());
  half.triangularView<Eigen::Lower>() += state.jacobian.transpose() * weighted;
  return {half.selfadjointView<Eigen::Lower>(), weighted.transpose() * residuals};
}

Eigen::VectorXd Fitter::predict(const ModelDocument& model) const {
  Eigen::VectorXd predicted =
      data_.predict(data_.simulate(model.vehicle, segments_), model.measurement);
  for (Eigen::Index i = 0; i < rest_.cols(); ++i)
    predicted += (*model.rest)[static_cast<size_t>(i)].size * rest_.col(i);
  return predicted;
}

Fitter Fitter::onRows(std::vector<char> mask) const {
  Fitter other = *this;
  other.mask_ = std::move(mask);
  other.segments_ = data_.segmentsOf(other.mask_);
  return other;
}

FitState Fitter::start(const ModelDocument& model, std::vector<FreeParameter> free) const {
  FitState state;
  state.model = model;
  state.free = std::move(free);
  state.predicted = predict(model);
  renewNoise(state);
  return state;
}

void Fitter::renewNoise(FitState& state) const {
  const Eigen::VectorXd activity = activityOf(data_.all(), state.predicted);
  const Noise noise = estimateNoise(data_.all(), data_.residuals(state.predicted), activity, mask_);
  state.scales = scalesOf(data_.all(), noise, activity);
  state.loss = lossOf(state);
}

void Fitter::add(FitState& state, const FreeParameter& parameter, double value) const {
  if (state.jacobian.cols() != static_cast<Eigen::Index>(state.free.size())) renewJacobian(state);
  state.free.push_back(parameter);
  valueOf(state.model, parameter.path) = value;
  state.predicted = predict(state.model);
  state.loss = lossOf(state);
  state.jacobian.conservativeResize(state.predicted.size(), state.jacobian.cols() + 1);
  state.jacobian.rightCols(1) = column(state, state.free.size() - 1);
}

void Fitter::release(FitState& state, size_t index) const {
  const auto at = static_cast<Eigen::Index>(index);
  state.free.erase(state.free.begin() + static_cast<std::ptrdiff_t>(index));
  if (state.jacobian.cols() <= at) return;
  for (Eigen::Index i = at; i + 1 < state.jacobian.cols(); ++i)
    state.jacobian.col(i) = state.jacobian.col(i + 1);
  state.jacobian.conservativeResize(state.jacobian.rows(), state.jacobian.cols() - 1);
}

double Fitter::lossOf(const FitState& state) const {
  return totalLoss(data_.residuals(state.predicted), state.scales, mask_) + priorLoss(state);
}

Eigen::VectorXd Fitter::secant(const FitState& state, const ModelDocument& changed,
                               double change) const {
  return (predict(changed) - state.predicted) / change;
}

Eigen::VectorXd Fitter::column(const FitState& state, size_t index) const {
  const FreeParameter& parameter = state.free[index];
  if (const auto term = restTermOf(parameter.path))
    return rest_.col(static_cast<Eigen::Index>(*term));
  ModelDocument changed = state.model;
  double& value = valueOf(changed, parameter.path);
  // Inwards if the step would leave the bounds.
  const double step = value + parameter.step > parameter.max ? -parameter.step : parameter.step;
  value += step;
  return secant(state, changed, step);
}

void Fitter::renewJacobian(FitState& state) const {
  state.jacobian.resize(state.predicted.size(), static_cast<Eigen::Index>(state.free.size()));
  parallel_(state.free.size(),
            [&](size_t i) { state.jacobian.col(static_cast<Eigen::Index>(i)) = column(state, i); });
}

bool Fitter::stepOnce(FitState& state, double& damping, double& gained) const {
  const Normal normal = priorNormal(state, data_.residuals(state.predicted), mask_);
  while (damping < kMostDamping) {
    FitState tried = state;
    const Eigen::VectorXd step = dampedStep(state, normal, damping);
    Eigen::VectorXd taken(step.size());
    for (Eigen::Index i = 0; i < step.size(); ++i) {
      const FreeParameter& parameter = state.free[static_cast<size_t>(i)];
      double& value = valueOf(tried.model, parameter.path);
      const double old = value;
      value = std::clamp(old + step[i], parameter.min, parameter.max);
      taken[i] = value - old;
    }
    tried.predicted = predict(tried.model);
    tried.loss = lossOf(tried);
    gained = state.loss - tried.loss;
    if (std::isfinite(tried.loss) && gained > 0.0) {
      // Broyden: the derivative along the step is known at no cost.
      const Eigen::VectorXd seen = tried.predicted - state.predicted;
      const Eigen::VectorXd metric = normal.matrix.diagonal().cwiseProduct(taken);
      const double size = metric.dot(taken);
      if (size > 0.0) tried.jacobian += (seen - state.jacobian * taken) * metric.transpose() / size;
      state = std::move(tried);
      damping = std::max(1e-6, damping / 10.0);
      return true;
    }
    damping *= 10.0;
  }
  return false;
}

void Fitter::fitRoughly(FitState& state) const {
  if (state.free.empty()) return;
  if (state.jacobian.cols() != static_cast<Eigen::Index>(state.free.size())) renewJacobian(state);
  state.loss = lossOf(state);
  double damping = 1e-3;
  double gained = 0.0;
  for (int i = 0; i < kMostSteps; ++i)
    if (!stepOnce(state, damping, gained) || gained < kRoughlyEnough) return;
}

void Fitter::fit(FitState& state) const {
  if (state.free.empty()) return;
  fitRoughly(state);
  for (int round = 0; round < kMostRounds; ++round) {
    // With a Jacobian at these values the remaining effects are found, and covariances are valid.
    renewJacobian(state);
    double damping = 1e-3;
    double gained = 0.0;
    double together = 0.0;
    for (int i = 0; i < kMostSteps && stepOnce(state, damping, gained); ++i) {
      together += gained;
      if (gained < kEnough) break;
    }
    if (together < kEnough * 5.0) return;
  }
}

bool hasChanged(const Effect& effect, const ChangePoint& change, const ModelDocument& model) {
  return std::any_of(change.strengths.begin(), change.strengths.end(),
                     [&](const std::string& strength) {
                       return *findParameter(model, effect.name + "." + strength) != 0.0;
                     });
}

std::vector<std::string> changePointsOn(const ModelDocument& model) {
  std::vector<std::string> paths;
  for (const Effect& effect : effectCatalogue())
    for (const ChangePoint& change : effect.search.change_points)
      if (hasChanged(effect, change, model)) paths.push_back(effect.name + "." + change.time);
  return paths;
}

void refineChangePoint(const Fitter& fitter, FitState& state, const std::string& path) {
  double& time = *findParameter(state.model, path);
  double least = lossAt(fitter, state, path, time);
  for (double step = kFirstStep; step >= kLastStep;) {
    const double later = lossAt(fitter, state, path, time + step);
    const double earlier = time > step ? lossAt(fitter, state, path, time - step) : least;
    // Also rejects a NaN loss; each step reduces the loss, over finitely many times.
    if (!(std::min(later, earlier) < least)) {
      step /= 2.0;
      continue;
    }
    time += later < earlier ? step : -step;
    least = std::min(later, earlier);
  }
  state.predicted = fitter.predict(state.model);
  fitter.renewJacobian(state);
}

namespace {

constexpr double kForever = 1e9;  // [s], later than any drive
constexpr double kSays = 3.0;  // [nats] by which one execution shows whether a change had happened
constexpr double kSayTogether = 20.0;  // the same for several executions, whose noise is correlated

/// Losses of all rows with a change at a given time.
Eigen::VectorXd lossesWith(const Fitter& fitter, const FitState& state, const std::string& path,
                           double time) {
  ModelDocument model = state.model;
  *findParameter(model, path) = time;
  const Eigen::VectorXd residuals = fitter.data().residuals(fitter.predict(model));
  Eigen::VectorXd losses = Eigen::VectorXd::Zero(residuals.size());
  for (Eigen::Index i = 0; i < residuals.size(); ++i)
    if (fitter.mask()[static_cast<size_t>(i)])
      losses[i] = gap::lossOf(residuals[i], state.scales[i]);
  return losses;
}

/// The execution of a drive that contains a time; none in between.
const Execution* executionAt(const Drive& drive, double time) {
  const auto after = std::upper_bound(
      drive.executions.begin(), drive.executions.end(), time,
      [](double moment, const Execution& execution) { return moment < execution.begin; });
  if (after == drive.executions.begin() || std::prev(after)->end < time) return nullptr;
  return &*std::prev(after);
}

/// Evidence of one execution about a change: it had happened (positive), or not [nats].
struct Vote {
  double begin = 0.0;  ///< [s] of the execution
  double end = 0.0;
  double nats = 0.0;
};

/// Evidence of all executions, in order of time.
std::vector<Vote> votesOn(const Fitter& fitter, const FitState& state, const std::string& path) {
  const Eigen::VectorXd gained =
      lossesWith(fitter, state, path, kForever) - lossesWith(fitter, state, path, 0.0);
  std::map<std::pair<double, double>, double> votes;
  for (size_t i = 0; i < fitter.data().all().size(); ++i) {
    const Observation& row = fitter.data().all()[i];
    const Execution* const execution =
        executionAt(fitter.data().drives()[row.drive], 0.5 * (row.begin + row.end));
    if (execution != nullptr)
      votes[{execution->begin, execution->end}] += gained[static_cast<Eigen::Index>(i)];
  }
  std::vector<Vote> in_order;
  for (const auto& [times, nats] : votes) in_order.push_back({times.first, times.second, nats});
  return in_order;
}

/// The end of the last execution before a time that shows that the change had not happened, or up
/// to which all together do; `otherwise` if there is none.
double lastWithout(const std::vector<Vote>& votes, double time, double otherwise) {
  double together = 0.0;
  for (auto vote = votes.rbegin(); vote != votes.rend(); ++vote) {
    if (vote->end > time) continue;
    together += vote->nats;
    if (vote->nats < -kSays || together < -kSayTogether) return std::min(otherwise, vote->end);
  }
  return otherwise;
}

/// The begin of the first execution after a time that shows that it had happened.
double firstWith(const std::vector<Vote>& votes, double time, double otherwise) {
  double together = 0.0;
  for (const Vote& vote : votes) {
    if (vote.begin < time) continue;
    together += vote.nats;
    if (vote.nats > kSays || together > kSayTogether) return std::max(otherwise, vote.begin);
  }
  return otherwise;
}

}  // namespace

std::pair<double, double> changePointInterval(const Fitter& fitter, const FitState& state,
                                              const std::string& path, double allowed) {
  const double time = *findParameter(state.model, path);
  const double least = lossAt(fitter, state, path, time);
  const auto reach = [&](double direction) {
    double inside = 0.0;
    double outside = 0.5;
    while (outside < kFarthest &&
           lossAt(fitter, state, path, time + direction * outside) < least + allowed) {
      inside = outside;
      outside *= 2.0;
    }
    for (int i = 0; i < 4; ++i) {
      const double middle = (inside + outside) / 2.0;
      const bool within = lossAt(fitter, state, path, time + direction * middle) < least + allowed;
      (within ? inside : outside) = middle;
    }
    return outside;
  };
  const std::vector<Vote> votes = votesOn(fitter, state, path);
  return {lastWithout(votes, time, std::max(0.0, time - reach(-1.0))),
          firstWith(votes, time, time + reach(1.0))};
}

}  // namespace tread::gap
