// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>

#include "common/bus/bus.hpp"
#include "common/pattern/pattern.hpp"
#include "modules/learner/set_publisher.hpp"
#include "modules/simulator/core/robot.hpp"

namespace tread::missions {

/// What an omniscient robot would know: the patterns as each surface truly makes them.
/** The simulator's ground truth executes every pattern on level ground of the surface, entered in
 * the steady motion of its entry class, without the ground's chance. That chance is in the
 * covariances: those of so many disturbed executions. Classes get the steady twists of the surface.
 * What even this robot does not know: slopes, and where within a pattern the surface changes. */
class TruePatterns {
 public:
  /// For all built-in surfaces.
  TruePatterns(const PatternSet& shipped, const sim::VehicleParameters& vehicle);

  /// The set of a surface under a version; throws std::out_of_range for a surface that is not
  /// built in.
  PatternSet on(const std::string& surface, int64_t version) const;

 private:
  std::map<std::string, PatternSetContent> by_surface_;
};

/// In the learner's place: publishes the true set of the ground that the body stands on.
/** A new version whenever that becomes another one; repeated as the learner repeats its own. */
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
  int64_t version_;  ///< begins with the seconds, so that a restarted node counts on
  int64_t next_repeat_ = 0;
};

}  // namespace tread::missions
