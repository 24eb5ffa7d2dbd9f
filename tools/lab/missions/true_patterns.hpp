// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/bus/bus.hpp"
#include "common/pattern/pattern.hpp"
#include "modules/learner/learner_memory.hpp"
#include "modules/simulator/core/robot.hpp"
#include "modules/simulator/core/terrain.hpp"
#include "modules/simulator/core/vehicle.hpp"

namespace tread::missions {

/// Part of the true patterns that the planner gets in an experiment.
enum class TrueShare {
  kAll,         ///< means and covariances; there is no learner
  kMeans,       ///< trajectories and classes; covariances from a learning rule
  kCovariances  ///< covariances of the ends; trajectories from that rule
};

/// Knowledge of an omniscient robot: each pattern as each surface really executes it.
/** The simulator executes every pattern on level ground of the surface, entered in the steady
 * motion of its entry class, without random disturbances. Covariances come from kDisturbed
 * disturbed executions. Classes get the surface's steady twists. Slopes, and the position of a
 * surface change within a pattern, are unknown even to this robot. */
class TruePatterns {
 public:
  /// For all built-in surfaces and some more; for a vehicle with speed loops if the set commands
  /// speeds.
  TruePatterns(const PatternSet& shipped, const sim::VehicleParameters& vehicle,
               const std::vector<sim::SurfaceParameters>& more = {});

  /// The set of a surface under a version; throws std::out_of_range for an unknown surface.
  PatternSet on(const std::string& surface, int64_t version) const;
  /// A learned set with its means or covariances replaced by the surface's true ones.
  PatternSet mixedInto(const PatternSet& learned, const std::string& surface,
                       TrueShare share) const;

 private:
  std::map<std::string, PatternSetContent> by_surface_;
};

/// Replaces the learner: publishes the true set of the ground under the body.
/** A new version at each change of ground; repeated as the learner repeats its own. */
class TruePatternsNode : public Node {
 public:
  TruePatternsNode(const TruePatterns& patterns, const sim::SimulatedRobot& robot, Bus& bus)
      : patterns_(patterns), robot_(robot), publisher_(bus), version_(bus.now() / 1'000'000) {}

  int64_t period() const override { return 20'000; }
  void step(int64_t utime) override;

 private:
  static constexpr int64_t kRepeat = 2'000'000;  ///< [us]

  const TruePatterns& patterns_;
  const sim::SimulatedRobot& robot_;
  learner::SetPublisher publisher_;
  std::string surface_;
  /// starts with the time in seconds, so that a restarted node continues upwards
  int64_t version_;
  int64_t next_repeat_ = 0;
};

}  // namespace tread::missions
