// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/pattern/pattern.hpp"
#include "modules/learner/core/scaling.hpp"

namespace tread::learner {

/// Noise of one execution on unchanged ground: standard deviations of its mean body twist.
struct TwistNoise {
  double forward = 0.03;      ///< [1] of |v_x|
  double lateral = 0.03;      ///< [1] of v_y over |v_x|
  double yaw = 0.08;          ///< [1] of |omega|
  double floor_speed = 0.01;  ///< [m/s] added to the first two
  double floor_yaw = 0.01;    ///< [rad/s] added to the third
};

/// Parameters of the local filter; the header of the rule has the equations.
struct FilterConfig {
  TwistNoise noise;           ///< expected where nothing was recorded
  double recorded = 0.3;      ///< [1] share of the recorded spread of ends in the noise
  double noise_factor = 1.2;  ///< [1] on the noise's standard deviations
  double caution = 2.1;       ///< [1] the same once more on unknown ground: tails are heavy
  double hazard = 0.05;       ///< [1] probability of a change of ground before an execution
  /// Standard deviations of one change: forward gain [1], yaw gain [1], sideslip [s], turn loss
  /// [s], yaw by speed [s/m], yaw bias [rad/m], crab [1].
  std::array<double, 7> common{0.10, 0.20, 0.15, 0.15, 0.08, 0.02, 0.02};
  /// Of a pattern's own residual: of v_x, of v_y over v_x, of omega [1].
  std::array<double, 3> residual{0.08, 0.06, 0.12};
  double common_factor = 0.7;  ///< [1] on `common`
  double steady = 1.7;  ///< [1] covariance at the start, and in the long run unobserved, over Q
  double drift = 0.01;  ///< [1] share by which P tends there before each execution
};

/// Parameters of the bank of remembered surfaces.
struct BankConfig {
  double hazard = 0.32;        ///< [1] probability that the surface changes before an execution
  double unknown_prior = 0.5;  ///< [1] that the next one is not in the bank
  int64_t settled_after = 10;  ///< executions without a change that make a block
  double new_margin = 3.0;     ///< [1] of log density, by which a block must be likelier as new
  int64_t capacity = 16;       ///< surfaces; the one that was met longest ago makes room
};

/// Name of a rule of learning: one of ruleNames().
using Rule = std::string;

/// The rule of learning and its guards.
struct RuleConfig {
  Rule rule = "bank";
  double memory = 0.5;  ///< w of equation (2): weight of the OLD prediction, 0 <= w < 1
  ScalingLimits scaling;
  double sign_sigmas = 3.0;  ///< how far beyond the noise M and R must disagree in sign
  FilterConfig filter;
  BankConfig bank;
};

// The keys of learner.yaml, a section for each kind of rule. The reader is a ConfigReader; a core
// does not know it by name.

template <class Reader>
void readScaling(Reader& reader, RuleConfig& rule) {
  Reader section = reader.section("scaling");
  ScalingLimits& limits = rule.scaling;
  std::vector<double> box{limits.min_box[0], limits.min_box[1], limits.min_box[2]};
  section.numbers("min_box", box, 3, {0.001, 1.0}, "m, m, rad");
  limits.min_box = {box[0], box[1], box[2]};
  section.number("min_box_sigmas", limits.min_box_sigmas, {0.0, 10.0}, "1");
  section.number("min_turn", limits.min_turn, {0.0, 1.0}, "rad");
  section.number("min_length", limits.min_length, {0.0, 1.0}, "m");
  section.number("min_factor", limits.min_factor, {0.1, 1.0}, "1");
  section.number("max_factor", limits.max_factor, {1.0, 10.0}, "1");
  section.number("sign_sigmas", rule.sign_sigmas, {0.0, 10.0}, "1");
}

template <class Reader>
void readFilter(Reader& reader, FilterConfig& filter) {
  Reader section = reader.section("filter");
  section.number("forward_noise", filter.noise.forward, {0.001, 1.0}, "1");
  section.number("lateral_noise", filter.noise.lateral, {0.001, 1.0}, "1");
  section.number("yaw_noise", filter.noise.yaw, {0.001, 1.0}, "1");
  section.number("recorded", filter.recorded, {0.0, 1.0}, "1");
  section.number("caution", filter.caution, {1.0, 10.0}, "1");
  section.number("hazard", filter.hazard, {0.0, 0.9}, "1");
  section.number("steady", filter.steady, {0.01, 10.0}, "1");
  section.number("drift", filter.drift, {0.0, 0.5}, "1");
}

template <class Reader>
void readBank(Reader& reader, BankConfig& bank) {
  Reader section = reader.section("bank");
  section.number("hazard", bank.hazard, {0.001, 0.9}, "1");
  section.number("unknown_prior", bank.unknown_prior, {0.001, 1.0}, "1");
  section.integer("settled_after", bank.settled_after, {3, 100}, "1");
  section.number("new_margin", bank.new_margin, {0.0, 100.0}, "1");
  section.integer("capacity", bank.capacity, {1, 64}, "1");
}

template <class Reader>
void readRules(Reader& reader, RuleConfig& rule) {
  readScaling(reader, rule);
  readFilter(reader, rule.filter);
  readBank(reader, rule.bank);
}

class SurfaceBank;

/// What a rule made of one measurement. Plain numbers, so that learning allocates nothing.
struct RuleNote {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  Axes scaling = Axes::Constant(kUnknown);  ///< V of equation (1), or the change of the executed
                                            ///< pattern's box (telescoping); NaN = not computed
  bool one_dimensional = false;             ///< guard: the pattern cannot give a V
  bool moved_back = false;                  ///< guard: net x of M against the prediction's
  bool turned_back = false;                 ///< guard: net yaw of M against the prediction's
  std::array<bool, 3> held{};               ///< guard: axes of the executed pattern that are noise
  double change_probability = kUnknown;     ///< [1] that the ground changed (filters)
  int surface = 0;                          ///< likeliest remembered surface, from 1; 0 = unknown
  double surface_probability = kUnknown;    ///< [1] of that, or of "unknown"
  bool surface_stored = false;              ///< the bank has a new surface
};

/// A rule of learning: predictions of all patterns of a set, corrected by measurements.
/** Patterns are named by their index in the shipped set. Same input, same bits; learn() and the
 * predictions allocate nothing, except that the bank does when it classifies a block of executions.
 * Trajectories hold T x 3 numbers: x, y [m], yaw [rad, unwrapped] in the start frame, one row a
 * sample. */
class LearningRule {
 public:
  virtual ~LearningRule() = default;

  /// Learns from a measured trajectory M of pattern `executed` (as many rows as its prediction).
  virtual void learn(size_t executed, const ConstTrajectory& measured, RuleNote& note) = 0;
  /// Whether the set may ever change.
  virtual bool learns() const { return true; }
  /// What the rule took an execution for, in words for LEARNING.
  virtual std::string reason(const RuleNote&) const { return "own prediction moved"; }
  /// Writes R of a pattern.
  virtual void predict(size_t pattern, Trajectory prediction) const = 0;
  /// The last pose of R, which is all that a score needs.
  virtual Pose2 predictEnd(size_t pattern) const = 0;
  /// Of predictEnd(), of ground and execution together; nothing if the rule does not know it.
  virtual std::optional<PoseCovariance> endCovariance(size_t /*pattern*/) const {
    return std::nullopt;
  }

  /// Becomes what `other` is, without allocating; both are of the same rule and shipped set.
  virtual void assign(const LearningRule& other) = 0;
  virtual std::unique_ptr<LearningRule> clone() const = 0;

  /// The surfaces that the rule remembers, or nullptr if it remembers none by nature.
  virtual const SurfaceBank* bank() const { return nullptr; }
  /// Takes over surfaces of the same shipped set; on which of them it stands is not known then.
  virtual void adoptBank(const SurfaceBank&) {}

  /// What the rule knows beside the predictions, for the state file; may be empty.
  virtual std::vector<double> memory() const { return {}; }
  /// Goes on from stored predictions (in the order of the set) and memory().
  /** Returns false and changes nothing if they are not this rule's. */
  virtual bool restore(const TrajectoryTable& predictions, const std::vector<double>& memory) = 0;
};

/// Names of all rules, in the order in which reports list them.
std::vector<std::string> ruleNames();

/// The rule that a configuration names, knowing nothing but the shipped set.
std::unique_ptr<LearningRule> makeRule(const RuleConfig& config, const PatternSet& shipped);

}  // namespace tread::learner
