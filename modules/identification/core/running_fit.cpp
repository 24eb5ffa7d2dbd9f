// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/running_fit.hpp"

#include <cmath>
#include <vector>

#include <Eigen/LU>

#include "modules/identification/core/likelihood.hpp"

namespace tread::gap {
namespace {

constexpr double kPrior = 0.3;  // [1] and [s], standard deviation of the prior
constexpr double kStep = 0.02;  // [1] and [s] of a change, for derivatives
constexpr int kFits = 3;
// Rows of one stretch share its ground: they count a third of their number.
constexpr double kAlike = 3.0;

using Changes = Eigen::Matrix<double, static_cast<int>(kWatched), 1>;
using Derivatives = Eigen::Matrix<double, Eigen::Dynamic, static_cast<int>(kWatched)>;

/// The drive of a vehicle whose commands are scaled on one side.
Drive scaled(const Drive& drive, size_t side, double factor) {
  Drive other = drive;
  for (Segment& segment : other.segments) {
    for (CommandSample& sample : segment.commands) sample.command[side] *= factor;
    segment.command_before[side] *= factor;
  }
  return other;
}

Eigen::VectorXd predictionOf(const Drive& drive, const ModelDocument& model) {
  const std::vector<Drive> drives{drive};
  return Observations(drives, ObservationSettings{}).predict(model);
}

/// Change of the rows per unit of each change.
Derivatives derivatives(const Drive& drive, const ModelDocument& model,
                        const Eigen::VectorXd& predicted) {
  Derivatives all(predicted.size(), kWatched);
  const auto put = [&](Watched what, const Drive& other_drive, const ModelDocument& other_model) {
    all.col(static_cast<Eigen::Index>(what)) =
        (predictionOf(other_drive, other_model) - predicted) / kStep;
  };
  const auto with = [&model](const auto& change) {
    ModelDocument other = model;
    change(other.vehicle);
    return other;
  };
  put(Watched::kLeft, scaled(drive, 0, 1.0 + kStep), model);
  put(Watched::kRight, scaled(drive, 1, 1.0 + kStep), model);
  put(Watched::kTurning, drive, with([](VehicleModel& v) { v.yaw_gain *= 1.0 + kStep; }));
  put(Watched::kDelay, drive, with([](VehicleModel& v) { v.delay += kStep; }));
  return all;
}

}  // namespace

std::optional<WatchReading> readChanges(const Drive& drive, const ModelDocument& model, double from,
                                        double to) {
  const std::vector<Drive> drives{drive};
  const Observations data(drives, ObservationSettings{});
  std::vector<char> mask;
  bool any = false;
  for (const Observation& row : data.all()) {
    mask.push_back(row.begin >= from && row.begin < to ? 1 : 0);
    any = any || mask.back() != 0;
  }
  if (!any) return std::nullopt;
  const Eigen::VectorXd predicted = data.predict(model);
  const Derivatives J = derivatives(drive, model, predicted);
  const Eigen::VectorXd activity = activityOf(data.all(), predicted);
  const Eigen::VectorXd beside = data.residuals(predicted);
  Changes change = Changes::Zero();
  Eigen::Matrix<double, kWatched, kWatched> covariance;
  for (int fit = 0; fit < kFits; ++fit) {
    const Eigen::VectorXd left = beside - J * change;
    const Eigen::VectorXd scales =
        scalesOf(data.all(), estimateNoise(data.all(), left, activity, mask), activity);
    Eigen::Matrix<double, kWatched, kWatched> A = Eigen::Matrix<double, kWatched, kWatched>::Zero();
    Changes b = Changes::Zero();
    for (Eigen::Index i = 0; i < left.size(); ++i) {
      if (mask[static_cast<size_t>(i)] == 0) continue;
      const double weight = weightOf(left[i], scales[i]) / kAlike;
      A += weight * J.row(i).transpose() * J.row(i);
      b += weight * beside[i] * J.row(i).transpose();
    }
    A.diagonal().array() += 1.0 / (kPrior * kPrior);
    covariance = A.inverse();
    change = covariance * b;
  }
  if (!change.allFinite() || !covariance.allFinite()) return std::nullopt;
  WatchReading reading{from, to, {}, {}};
  for (size_t w = 0; w < kWatched; ++w) {
    const auto at = static_cast<Eigen::Index>(w);
    reading.change[w] = change[at];
    reading.uncertainty[w] = std::sqrt(covariance(at, at));
  }
  return reading;
}

}  // namespace tread::gap
