// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/execution/measurement.hpp"
#include "common/pattern/pattern.hpp"
#include "modules/learner/core/scaling.hpp"

namespace tread::learner {

/// Noise of one execution on unchanged ground: standard deviations of its mean body twist.
struct TwistNoise {
  double forward = 0.03;  ///< [1] of |v_x|
  double lateral = 0.03;  ///< [1] of v_y over |v_x|
  double yaw = 0.08;      ///< [1] of |omega|
  /// [m] of |omega|, added to the first two: scatter of the centre of rotation
  double turning = 0.05;
  double wander = 0.005;  ///< [rad/m] of |v_x|, added to the third: scatter of the course
  double lag = 0.15;      ///< [s] by which a vehicle may respond later than in its set
  /// [1] of the path length: deviation of its end from that of its mean twist
  double shape = 0.02;
  double position = 0.01;  ///< [m] of a measured end, added to the first two over its duration
  double heading = 0.01;   ///< [rad] the same, added to the third
};

/// Prior knowledge of grounds for the multiple-model filter; the headers of the rule have the
/// equations.
struct GroundConfig {
  static constexpr int64_t kMostSurfaces = 64;

  TwistNoise noise;             ///< expected without recordings
  double lever = 0.3;           ///< [m] half the gauge: scales turning relative to driving
  double noise_prior = 5.0;     ///< [1] weight of the expected noise, in executions
  double most_freedom = 12.0;   ///< [1] of Student's t: even a known surface has tails
  double change_prior = 10.0;   ///< [1] weight of the expected distance between changes, in changes
  double change_metres = 10.0;  ///< [m] mean distance to the next change of ground
  double fresh = 0.5;           ///< [1] probability that a change leads to new ground
  double slope_effect = 1.0;    ///< [1] deviation of a velocity over |v|, per slope
  double voltage_effect = 1.0;  ///< [1] the same, relative, per relative change of voltage
  /// [nat] evidence from which slope or voltage is used; 1000: never
  double context_evidence = 5.0;
  double sure = 0.9;              ///< [1] probability from which a surface is recognized
  int64_t settled_after = 10;     ///< executions on new ground until it is remembered
  double longest_memory = 100.0;  ///< executions after which the oldest ones on a surface fade
  int64_t moments = 8;            ///< number of hypotheses that the ground has changed recently
  int64_t capacity = 16;          ///< remembered surfaces; the least recently met one is dropped
};

/// Name of a learning rule: one of ruleNames().
using Rule = std::string;

/// The learning rule and its guards.
struct RuleConfig {
  Rule rule = "multi_model";
  double memory = 0.5;  ///< w of equation (2): weight of the OLD prediction, 0 <= w < 1
  ScalingLimits scaling;
  double sign_sigmas = 3.0;  ///< factor on the noise beyond which M and R must disagree in sign
  GroundConfig ground;
};

// The keys of learner.yaml, a section for each kind of rule. The reader is a ConfigReader, whose
// name a core must not know.

/// Obsolete keys of earlier versions' files and logged configurations. The learner accepts them
/// without effect; readRules() leaves them unknown.
inline constexpr const char* kRetiredScalingKeys[] = {"min_turn", "min_length"};
inline constexpr const char* kRetiredGroundKeys[] = {
    "recorded", "common", "vehicle", "residual", "shared", "shipped_spread", "far", "ahead"};

template <class Reader>
void readScaling(Reader& reader, RuleConfig& rule) {
  Reader section = reader.section("scaling");
  ScalingLimits& limits = rule.scaling;
  std::vector<double> box{limits.min_box[0], limits.min_box[1], limits.min_box[2]};
  section.numbers("min_box", box, 3, {0.001, 1.0}, "m, m, rad");
  limits.min_box = {box[0], box[1], box[2]};
  section.number("min_box_sigmas", limits.min_box_sigmas, {0.0, 10.0}, "1");
  section.number("min_factor", limits.min_factor, {0.1, 1.0}, "1");
  section.number("max_factor", limits.max_factor, {1.0, 10.0}, "1");
  section.number("sign_sigmas", rule.sign_sigmas, {0.0, 10.0}, "1");
}

template <class Reader>
void readGround(Reader& reader, GroundConfig& ground) {
  Reader section = reader.section("ground");
  section.number("forward_noise", ground.noise.forward, {0.001, 1.0}, "1");
  section.number("lateral_noise", ground.noise.lateral, {0.001, 1.0}, "1");
  section.number("yaw_noise", ground.noise.yaw, {0.001, 1.0}, "1");
  section.number("turning_noise", ground.noise.turning, {0.0, 1.0}, "m");
  section.number("wander_noise", ground.noise.wander, {0.0, 1.0}, "rad/m");
  section.number("lag_noise", ground.noise.lag, {0.0, 2.0}, "s");
  section.number("shape_noise", ground.noise.shape, {1e-4, 1.0}, "1");
  section.number("position_noise", ground.noise.position, {1e-4, 1.0}, "m");
  section.number("heading_noise", ground.noise.heading, {1e-4, 1.0}, "rad");
  section.number("lever", ground.lever, {0.01, 10.0}, "m");
  section.number("noise_prior", ground.noise_prior, {3.0, 100.0}, "1");
  section.number("most_freedom", ground.most_freedom, {4.0, 1000.0}, "1");
  section.number("change_prior", ground.change_prior, {0.1, 1e9}, "1");
  section.number("change_metres", ground.change_metres, {0.1, 1e5}, "m");
  section.number("fresh", ground.fresh, {0.01, 0.99}, "1");
  section.number("slope_effect", ground.slope_effect, {1e-3, 10.0}, "1");
  section.number("voltage_effect", ground.voltage_effect, {1e-3, 10.0}, "1");
  section.number("context_evidence", ground.context_evidence, {1.0, 1000.0}, "nat");
  section.number("sure", ground.sure, {0.6, 0.999}, "1");
  section.integer("settled_after", ground.settled_after, {2, 1000}, "1");
  section.number("longest_memory", ground.longest_memory, {10.0, 1e6}, "1");
  section.integer("moments", ground.moments, {3, 64}, "1");
  section.integer("capacity", ground.capacity, {1, GroundConfig::kMostSurfaces}, "1");
}

template <class Reader>
void readRules(Reader& reader, RuleConfig& rule) {
  readScaling(reader, rule);
  readGround(reader, rule.ground);
}

/// A rule's result for one measurement. Plain numbers, so that learning allocates nothing.
struct RuleNote {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  Axes scaling = Axes::Constant(kUnknown);  ///< V of equation (1), or the change of the executed
                                            ///< pattern's box (telescoping); NaN = not computed
  bool one_dimensional = false;             ///< guard: the pattern cannot give a V
  bool moved_back = false;                  ///< guard: net x of M against the prediction's
  bool turned_back = false;                 ///< guard: net yaw of M against the prediction's
  std::array<bool, 3> held{};  ///< guard: axes of the executed pattern that are only noise
  double change_probability = kUnknown;   ///< [1] that the ground changed
  bool no_change = false;                 ///< a change detected earlier turns out to be none
  int surface = 0;                        ///< most probable remembered surface, from 1; 0 = unknown
  double surface_probability = kUnknown;  ///< [1] of that surface, or of "unknown"
  bool surface_stored = false;            ///< a new surface should be stored
};

/// A measured mean body twist minus the expected one [m/s, m/s, rad/s], and its covariance on
/// unchanged ground.
struct TwistDeparture {
  Eigen::Vector3d mean;
  Eigen::Matrix3d covariance;
};

/// A learning rule: predictions of all patterns of a set, corrected by measurements.
/** Patterns are identified by their index in the shipped set. Same input, same bits; predictions
 * allocate nothing. Trajectories hold T x 3 numbers: x, y [m], yaw [rad, unwrapped] in the start
 * frame, one row per sample. */
class LearningRule {
 public:
  virtual ~LearningRule() = default;

  /// Sets the context of the execution that is learned from next.
  virtual void setContext(const Context&) {}
  /// Learns from a measured trajectory M of pattern `executed`: as many rows as its prediction or,
  /// if the rule learns from parts, at least one.
  virtual void learn(size_t executed, const ConstTrajectory& measured, RuleNote& note) = 0;
  /// Whether it also learns from the beginning of a pattern.
  virtual bool learnsParts() const { return false; }
  /// Whether it can change the set at all.
  virtual bool learns() const { return true; }
  /// The rule's interpretation of an execution, in words for LEARNING.
  virtual std::string reason(const RuleNote&) const { return "own prediction moved"; }
  /// Writes R of a pattern.
  virtual void predict(size_t pattern, Trajectory prediction) const = 0;
  /// The last pose of R, sufficient for a score.
  virtual Pose2 predictEnd(size_t pattern) const = 0;
  /// Of predictEnd(), of ground and execution together; nullopt if the rule does not know it.
  virtual std::optional<PoseCovariance> endCovariance(size_t /*pattern*/) const {
    return std::nullopt;
  }

  /// Deviation of the mean twist of some samples of an execution, from `first` on, from its
  /// expectation on the ground that the rule assumes; nullopt if the rule does not know it. Uses
  /// the context of setContext().
  virtual std::optional<TwistDeparture> departure(size_t /*pattern*/,
                                                  const ConstTrajectory& /*measured*/,
                                                  Eigen::Index /*first*/,
                                                  Eigen::Index /*samples*/) const {
    return std::nullopt;
  }

  /// Copies `other`, without allocating; both are of the same rule and shipped set.
  virtual void assign(const LearningRule& other) = 0;
  virtual std::unique_ptr<LearningRule> clone() const = 0;

  /// Number of surfaces that the rule remembers; negative for a rule without surfaces.
  virtual int remembered() const { return -1; }

  /// The rule's knowledge beside the predictions, for the state file; may be empty.
  virtual std::vector<double> memory() const { return {}; }
  /// Continues from stored predictions (in the order of the set) and memory().
  /** Returns false and changes nothing if they are of another rule. */
  virtual bool restore(const TrajectoryTable& predictions, const std::vector<double>& memory) = 0;
};

}  // namespace tread::learner
