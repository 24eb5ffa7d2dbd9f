// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <random>
#include <string>
#include <utility>
#include <vector>

#include "modules/identification/core/fit.hpp"
#include "modules/identification/core/search.hpp"
#include "synthetic_drive.hpp"

namespace tread::gap::samples {

inline const Progress kSilent = [](const std::string&) {};

using Values = std::vector<std::pair<std::string, double>>;

/// The synthetic vehicle with modified numbers.
inline ModelDocument vehicleWith(const Values& changed) {
  ModelDocument model = syntheticVehicle();
  for (const auto& [path, value] : changed)
    *findParameter(model, freeParameter(model, path).path) = value;  // throws for a typing error
  return model;
}

/// Encoder values at 20 Hz for a drive whose tracks follow a model.
inline std::vector<EncoderSample> encodersOf(const ModelDocument& tracks, const Drive& drive,
                                             double late = 0.0) {
  std::vector<EncoderSample> encoders;
  VehicleKernel kernel(tracks.vehicle, EntryState{});
  const std::vector<CommandSample>& commands = drive.segments.front().commands;
  for (size_t i = 0; i < commands.size(); ++i) {
    // Wheels turn faster than the vehicle moves, by the slip that corresponds to the factor.
    const TrackCommand speed = kernel.trackSpeeds();
    encoders.push_back({commands[i].time + late, {1.1 * speed.left, 1.1 * speed.right}});
    kernel.step(commands[i].command.tracks(), 0.05);
  }
  return encoders;
}

/// Rows of one synthetic drive, for testing a single stage of the workflow.
struct Rig {
  Rig(const Values& hidden, double seconds, uint64_t seed, const SyntheticNoise& noise = {})
      : drives{syntheticDrive(vehicleWith(hidden), seconds, seed, noise)},
        data(drives, {}),
        fitter(data) {}

  /// A state of the nominal vehicle with these residuals; no parameter is free.
  FitState stateOf(const Eigen::VectorXd& residuals, double scale) const {
    FitState state;
    state.model = syntheticVehicle();
    state.predicted = data.residuals(residuals);  // measured minus residuals
    state.scales = Eigen::VectorXd::Constant(residuals.size(), scale);
    state.jacobian.resize(residuals.size(), 0);
    return state;
  }

  /// The nominal vehicle with these parameters free, fitted, with its own noise.
  FitState fitted(const Values& begin) const {
    FitState state = fitter.start(syntheticVehicle(), {});
    for (const auto& [path, value] : begin) {
      FreeParameter parameter = freeParameter(state.model, path);
      fitter.add(state, parameter, value);
    }
    fitter.fitRoughly(state);
    fitter.renewNoise(state);
    fitter.fit(state);
    return state;
  }

  Eigen::Index size() const { return static_cast<Eigen::Index>(data.all().size()); }

  std::vector<Drive> drives;
  Observations data;
  Fitter fitter;
};

/// Noise of size 1; a share of its variance is common to all rows of a channel and block.
inline Eigen::VectorXd blockNoise(const Observations& data, uint64_t seed, double share = 0.5) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> gauss(0.0, 1.0);
  Eigen::MatrixXd common(data.blocks(), static_cast<Eigen::Index>(kChannels));
  for (Eigen::Index i = 0; i < common.size(); ++i) common(i) = gauss(random);
  Eigen::VectorXd noise(static_cast<Eigen::Index>(data.all().size()));
  for (Eigen::Index i = 0; i < noise.size(); ++i) {
    const Observation& row = data.all()[static_cast<size_t>(i)];
    noise[i] = std::sqrt(1.0 - share) * gauss(random) +
               std::sqrt(share) * common(row.block, static_cast<Eigen::Index>(row.channel));
  }
  return noise;
}

/// Directions that are waves of different periods in the rows of one channel.
inline Eigen::MatrixXd waves(const Observations& data, int count) {
  Eigen::MatrixXd directions = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(data.all().size()),
                                                     static_cast<Eigen::Index>(count));
  for (Eigen::Index i = 0; i < directions.rows(); ++i) {
    const Observation& row = data.all()[static_cast<size_t>(i)];
    for (int c = static_cast<int>(row.channel); c < count; c += static_cast<int>(kChannels))
      directions(i, c) = std::cos(row.begin / (3.0 + 2.0 * c) + c);
  }
  return directions;
}

}  // namespace tread::gap::samples
