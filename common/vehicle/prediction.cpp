// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/prediction.hpp"

#include <array>

#include <Eigen/Core>

namespace tread {
namespace {

/// Change of the end pose per standard deviation of one noise.
Eigen::Vector3d sensitivity(const VehicleModel& model, const std::vector<TrackCommand>& commands,
                            double period, const EntryState& entry, const ExecutionNoise& low,
                            const ExecutionNoise& high) {
  const Pose2 from = simulate(model, commands, period, entry, low).back();
  const Pose2 to = simulate(model, commands, period, entry, high).back();
  return Eigen::Vector3d(to.x - from.x, to.y - from.y, to.yaw - from.yaw) / 2.0;
}

}  // namespace

PoseCovariance endCovariance(const VehicleModel& model, const std::vector<TrackCommand>& commands,
                             double period, const EntryState& entry) {
  if (commands.empty()) return kUnknownCovariance;
  const ExecutionSpread& spread = model.spread;
  const std::array<ExecutionNoise, 3> low{ExecutionNoise{1.0 - spread.forward, 1.0, 0.0},
                                          ExecutionNoise{1.0, 1.0 - spread.yaw, 0.0},
                                          ExecutionNoise{1.0, 1.0, -spread.crab}};
  const std::array<ExecutionNoise, 3> high{ExecutionNoise{1.0 + spread.forward, 1.0, 0.0},
                                           ExecutionNoise{1.0, 1.0 + spread.yaw, 0.0},
                                           ExecutionNoise{1.0, 1.0, spread.crab}};
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (size_t i = 0; i < low.size(); ++i) {
    const Eigen::Vector3d change = sensitivity(model, commands, period, entry, low[i], high[i]);
    covariance += change * change.transpose();
  }
  return {covariance(0, 0), covariance(0, 1), covariance(0, 2),
          covariance(1, 1), covariance(1, 2), covariance(2, 2)};
}

MotionClass classOf(const VehicleModel& model, const std::string& name,
                    const TrackCommand& steady) {
  return {name, steadyTwist(model, steady), steady};
}

void predict(const VehicleModel& model, double period, const MotionClass& entry,
             MotionPattern& pattern) {
  const EntryState state = steadyEntry(model, entry.steady);
  pattern.trajectory = simulate(model, pattern.commands, period, state);
  pattern.end_covariance = endCovariance(model, pattern.commands, period, state);
}

}  // namespace tread
