// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/compare.hpp"

#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>

#include "tools/gap/core/end_errors.hpp"
#include "tools/gap/core/search.hpp"
#include "tools/gap/report/words.hpp"

namespace tread::gap {
namespace {

constexpr int kFewestBlocks = 4;  // errors from fewer have no meaning

struct LogFit {
  ModelDocument model;
  std::vector<double> values;
  std::vector<double> errors;
  int blocks = 0;
};

LogFit fitted(const ModelDocument& model, const std::vector<FreeParameter>& free,
              const std::vector<Drive>& drives, int threads) {
  const Rows rows(drives, RowSettings{});
  if (rows.blocks() < kFewestBlocks)
    throw std::runtime_error(drives.front().name + ": " + std::to_string(rows.blocks()) +
                             " blocks of 20 s of driving; at least " +
                             std::to_string(kFewestBlocks) + " are needed");
  const Fitter fitter(rows, threads);
  const std::vector<char> mask(rows.rows().size(), 1);
  FitState state = fitter.start(model, free, mask);
  fitter.fit(state, mask);
  fitter.renewNoise(state, mask);
  fitter.fit(state, mask);
  fitter.renewJacobian(state);
  const Eigen::MatrixXd covariance = parameterCovariance(rows, state, mask);
  LogFit fit{state.model, {}, {}, rows.blocks()};
  for (size_t i = 0; i < state.free.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    fit.values.push_back(*findParameter(state.model, state.free[i].path));
    fit.errors.push_back(std::sqrt(covariance(at, at)));
  }
  return fit;
}

std::string unitOf(const std::string& path) {
  const EffectParameter* parameter = parameterOfPath(path).parameter;
  if (parameter != nullptr) return parameter->unit;
  if (path == "lag" || path == "delay") return "s";
  if (path == "full_speed") return "m/s";
  return path == "gauge" ? "m" : "1";
}

EndErrors endErrorsOf(const Rows& rows, const ModelDocument& model) {
  return summaryOf(endErrors(rows, model), [](const EndError&) { return true; });
}

/// Limits as their reciprocals are said: errors of first order.
std::string saidWithError(const Movement& movement, double value, double error) {
  const EffectParameter* parameter = parameterOfPath(movement.parameter).parameter;
  if (parameter == nullptr || !parameter->reciprocal() || value <= 0.0)
    return said(value, movement.unit) + " \u00b1 " + said(error, movement.unit);
  const std::string unit = naturalUnit(*parameter);
  return said(1.0 / value, unit) + " \u00b1 " + said(error / (value * value), unit);
}

std::string nameOf(const Movement& movement) {
  const ParameterOfPath path = parameterOfPath(movement.parameter);
  if (path.effect == nullptr) return movement.parameter;
  return path.effect->name + "." +
         (path.parameter->reciprocal() ? path.parameter->natural_name : path.parameter->name);
}

std::string headline(const LogChange& change) {
  std::vector<std::string> moved;
  for (const Movement& movement : change.movements)
    if (std::abs(movement.sigmas()) > kMoved)
      moved.push_back(nameOf(movement) + " (" + threeDigits(std::abs(movement.sigmas())) +
                      " sigma)");
  if (moved.empty()) return "Nothing moved by more than 3 sigma.\n";
  return "Changed: " + joined(moved) + ".\n";
}

}  // namespace

double Movement::sigmas() const {
  const double error = std::hypot(first_error, second_error);
  return std::isfinite(error) && error > 0.0 ? (second - first) / error : 0.0;
}

LogChange compareLogs(const ModelDocument& model, const Drive& first, const Drive& second,
                      int threads) {
  std::vector<FreeParameter> free = givenParameters(model, false);
  if (free.empty()) free = givenParameters(model, true);
  // What is known beforehand would pull both logs to the same value.
  for (FreeParameter& parameter : free)
    parameter.deviation = std::numeric_limits<double>::infinity();
  const std::vector<Drive> later{second};
  const LogFit one = fitted(model, free, {first}, threads);
  const LogFit two = fitted(model, free, later, threads);
  LogChange change;
  change.first_blocks = one.blocks;
  change.second_blocks = two.blocks;
  for (size_t i = 0; i < free.size(); ++i)
    change.movements.push_back({free[i].path, unitOf(free[i].path), one.values[i], one.errors[i],
                                two.values[i], two.errors[i]});
  const Rows rows(later, RowSettings{});
  change.with_first = endErrorsOf(rows, one.model);
  change.with_second = endErrorsOf(rows, two.model);
  return change;
}

std::string textOf(const LogChange& change) {
  std::string text = headline(change) + "\n";
  char line[240];
  std::snprintf(line, sizeof line, "%-34s %-26s %-26s %s\n", "parameter", "first log", "second log",
                "sigma");
  text += line;
  for (const Movement& movement : change.movements) {
    // The sign of plus and minus has two bytes and one place.
    std::snprintf(line, sizeof line, "%-34s %-27s %-27s %+.1f%s\n", nameOf(movement).c_str(),
                  saidWithError(movement, movement.first, movement.first_error).c_str(),
                  saidWithError(movement, movement.second, movement.second_error).c_str(),
                  movement.sigmas(), std::abs(movement.sigmas()) > kMoved ? "  moved" : "");
    text += line;
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
