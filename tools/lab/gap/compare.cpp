// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/gap/compare.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "modules/identification/core/discovery.hpp"
#include "modules/identification/core/end_errors.hpp"
#include "modules/identification/core/observations.hpp"
#include "modules/identification/core/search.hpp"
#include "tools/lab/gap/repeat.hpp"
#include "tools/lab/gap/report/report.hpp"
#include "tools/lab/gap/report/words.hpp"
#include "tools/lab/gap/what_if.hpp"

namespace tread::gap {
namespace {

/// Throws unless there are enough rows.
void requireEnough(const Observations& data) {
  const std::string problem = tooLittleDriving(data);
  if (!problem.empty()) throw std::runtime_error(data.drives().front().name + ": " + problem);
}

/// The parameters that the model has on, without their priors: those would pull all logs to one
/// value.
std::vector<FreeParameter> comparedParameters(const ModelDocument& model) {
  std::vector<FreeParameter> free = givenParameters(model, false);
  if (free.empty()) free = givenParameters(model, true);
  for (FreeParameter& parameter : free)
    parameter.deviation = std::numeric_limits<double>::infinity();
  return free;
}

EndErrors endErrorsOf(const Observations& data, const ModelDocument& model) {
  return summaryOf(endErrors(data, model));
}

/// A value with its standard error; limits, which are fitted as reciprocals, to first order.
std::string saidWithError(const Movement& movement, double value, double error) {
  const EffectParameter* parameter = findEffectParameter(movement.parameter);
  if (parameter == nullptr || !parameter->reciprocal() || value <= 0.0)
    return said(value, movement.unit) + " \u00b1 " + said(error, movement.unit);
  const std::string unit = naturalUnit(*parameter);
  return said(1.0 / value, unit) + " \u00b1 " + said(error / (value * value), unit);
}

std::string nameOf(const Movement& movement) {
  const EffectParameter* parameter = findEffectParameter(movement.parameter);
  if (parameter == nullptr || !parameter->reciprocal()) return movement.parameter;
  return effectOf(movement.parameter) + "." + parameter->natural_name;
}

/// The significance limit and its justification.
std::string limitLine(const LogChange& change) {
  return "From " + threeDigits(change.needed) + " sigma on it is significant, with " +
         std::to_string(change.movements.size()) + " parameters and " +
         std::to_string(std::min(change.first_blocks, change.second_blocks)) +
         " blocks of driving.\n";
}

std::string headline(const LogChange& change) {
  std::vector<std::string> moved;
  for (const Movement& movement : change.movements)
    if (change.moved(movement))
      moved.push_back(nameOf(movement) + " (" + threeDigits(std::abs(movement.sigmas())) +
                      " sigma)");
  const std::string first =
      moved.empty() ? "Nothing moved beyond chance" : "Changed: " + joined(moved);
  return first + ".\n" + limitLine(change);
}

}  // namespace

double Movement::sigmas() const {
  const double error = std::hypot(first_error, second_error);
  return std::isfinite(error) && error > 0.0 ? (second - first) / error : 0.0;
}

bool LogChange::moved(const Movement& movement) const {
  return std::abs(movement.sigmas()) > needed;
}

bool LogChange::anyMoved() const {
  return std::any_of(movements.begin(), movements.end(),
                     [this](const Movement& movement) { return moved(movement); });
}

double neededSigmas(int fewest_blocks, size_t parameters) {
  const double chance =
      chanceBeyond(kSigmaLevel) / static_cast<double>(std::max<size_t>(1, parameters));
  return studentQuantile(fewest_blocks - 1.0, normalQuantileOf(chance));
}

LogFit fitLog(const ModelDocument& model, const Drive& drive, const ParallelFor& parallel) {
  const std::vector<Drive> drives{drive};
  const Observations data(drives, ObservationSettings{});
  requireEnough(data);
  const Fitter fitter(data, parallel);
  FitState state = fitter.start(model, comparedParameters(model));
  fitter.fit(state);
  fitter.renewNoise(state);
  fitter.fit(state);
  fitter.renewJacobian(state);
  const Eigen::MatrixXd covariance = parameterCovariance(fitter, state);
  LogFit fit{state.model, {}, {}, {}, data.measuredBlocks()};
  for (size_t i = 0; i < state.free.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    fit.parameters.push_back(state.free[i].path);
    fit.values.push_back(*findParameter(state.model, state.free[i].path));
    fit.errors.push_back(std::sqrt(covariance(at, at)));
  }
  return fit;
}

LogChange changeBetween(const LogFit& first, const LogFit& second) {
  LogChange change;
  change.first_blocks = first.blocks;
  change.second_blocks = second.blocks;
  change.needed = neededSigmas(std::min(first.blocks, second.blocks), first.parameters.size());
  for (size_t i = 0; i < first.parameters.size(); ++i)
    change.movements.push_back({first.parameters[i], unitOf(first.parameters[i]), first.values[i],
                                first.errors[i], second.values[i], second.errors[i]});
  return change;
}

LogChange compareLogs(const ModelDocument& model, const Drive& first, const Drive& second,
                      const ParallelFor& parallel) {
  const LogFit one = fitLog(model, first, parallel);
  const LogFit two = fitLog(model, second, parallel);
  LogChange change = changeBetween(one, two);
  const std::vector<Drive> later{second};
  const Observations data(later, ObservationSettings{});
  change.with_first = endErrorsOf(data, one.model);
  change.with_second = endErrorsOf(data, two.model);
  return change;
}

std::string textOf(const LogChange& change) {
  std::string text = headline(change) + "\n";
  text += formatted("%-34s %-26s %-26s %s\n", "parameter", "first log", "second log", "sigma");
  for (const Movement& movement : change.movements) {
    // "±" has two bytes and one column.
    text += formatted("%-34s %-27s %-27s %+.1f%s\n", nameOf(movement).c_str(),
                      saidWithError(movement, movement.first, movement.first_error).c_str(),
                      saidWithError(movement, movement.second, movement.second_error).c_str(),
                      movement.sigmas(), change.moved(movement) ? "  moved" : "");
  }
  const auto errors = [](const EndErrors& of) {
    return saidDistance(of.position.median) + " and " + saidAngle(of.yaw.median);
  };
  return text + "\nSecond log, median error after 2 s: " + errors(change.with_first) +
         " with the first log's parameters, " + errors(change.with_second) +
         " with its own.\nBlocks of driving: " + std::to_string(change.first_blocks) + " and " +
         std::to_string(change.second_blocks) + ".\n";
}

}  // namespace tread::gap
