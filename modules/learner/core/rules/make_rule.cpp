// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <stdexcept>

#include "modules/learner/core/rules/multi_model.hpp"

namespace tread::learner {
namespace {

/// A box that no vehicle can drive [m, m, rad] must not become a prediction.
constexpr double kLargestBox = 1e6;
/// Of a prediction's end where no covariance is known: [1] of x, y and yaw, and [m, m, rad] added.
constexpr double kRelativeNoise[3] = {0.03, 0.03, 0.08};
constexpr double kAbsoluteNoise[3] = {0.02, 0.02, 0.02};

/// Rules that know nothing but the predictions themselves: all that they learn is in a table.
class StoredPredictions : public LearningRule {
 public:
  StoredPredictions(const RuleConfig& config, const PatternSet& shipped)
      : memory_(config.memory), table_(shipped.patterns()) {}

  void predict(size_t pattern, Trajectory prediction) const override {
    prediction = table_.of(pattern);
  }
  Pose2 predictEnd(size_t pattern) const override { return table_.end(pattern); }
  void assign(const LearningRule& other) override {
    table_.copyNumbers(static_cast<const StoredPredictions&>(other).table_);
  }
  /// Takes the predictions of another rule, not its memory.
  bool restore(const TrajectoryTable& predictions, const std::vector<double>&) override {
    if (!table_.sameShape(predictions)) return false;
    table_.copyNumbers(predictions);
    return true;
  }

 protected:
  double memory_;  ///< w of equation (2)
  TrajectoryTable table_;
};

/// No learning: R stays the shipped prediction whatever is measured (paper, Table I column a).
class Off : public StoredPredictions {
 public:
  using StoredPredictions::StoredPredictions;

  void learn(size_t, const ConstTrajectory&, RuleNote&) override {}
  bool learns() const override { return false; }
  std::unique_ptr<LearningRule> clone() const override { return std::make_unique<Off>(*this); }
};

/// Single pattern learning, the paper's predecessor (its reference [4]; Table I column b).
/** Only the executed pattern p learns, by equation (2), for x, y [m] and yaw [rad] of each sample:
 *    R_p <- (1 - w) M + w R_p,   0 <= w < 1 the weight of the old prediction. */
class Single : public StoredPredictions {
 public:
  using StoredPredictions::StoredPredictions;

  void learn(size_t executed, const ConstTrajectory& measured, RuleNote&) override {
    smooth(measured, memory_, table_.change(executed));  // equation (2)
  }
  std::unique_ptr<LearningRule> clone() const override { return std::make_unique<Single>(*this); }
};

/// What collective and telescoping scaling have in common: the executed pattern is smoothed by
/// equation (2), all others are scaled by one factor an axis.
class ScalingRule : public StoredPredictions {
 public:
  ScalingRule(const RuleConfig& config, const PatternSet& shipped)
      : StoredPredictions(config, shipped),
        limits_(config.scaling),
        sign_sigmas_(config.sign_sigmas) {
    for (const MotionPattern& pattern : shipped.patterns()) {
      roles_.push_back(roleOf(pattern, config.scaling));
      const PoseCovariance& covariance = pattern.end_covariance;
      variances_.emplace_back(covariance[0], covariance[3], covariance[5]);
    }
  }

  void learn(size_t executed, const ConstTrajectory& measured, RuleNote& note) final {
    Boxes boxes;
    boxes.measured = boundingBox(measured);
    if (!(boxes.measured < kLargestBox).all()) return;
    const bool gives = allow(executed, measured, table_.end(executed), note);
    boxes.before = boundingBox(table_.of(executed));
    smooth(measured, memory_, table_.change(executed));  // equation (2)
    if (!gives) return;
    boxes.after = boundingBox(table_.of(executed));
    const Axes scaling = factors(boxes, roles_[executed], note);
    for (size_t p = 0; p < table_.patterns(); ++p)
      if (p != executed) scale(scaling, roles_[p], table_.change(p));
  }
  std::string reason(const RuleNote& note) const override {
    return std::isfinite(note.scaling[0]) ? "own prediction moved, the others scaled"
                                          : "own prediction moved";
  }

 protected:
  /// Boxes of M, and of the executed pattern's prediction before and after the update.
  struct Boxes {
    Axes measured, before, after;
  };
  /// What the others are scaled by; fills `note.scaling`.
  virtual Axes factors(const Boxes& boxes, const PatternRole& role, RuleNote& note) const = 0;

  ScalingLimits limits_;

 private:
  /// Fills the guards of `note`; true if a V may be computed from this measurement.
  bool allow(size_t executed, const ConstTrajectory& measured, const Pose2& predicted_end,
             RuleNote& note) const {
    const PatternRole& role = roles_[executed];
    const Eigen::Index last = measured.rows() - 1;
    note.one_dimensional = !role.gives_scaling;
    if (note.one_dimensional) return false;
    note.moved_back = opposite(executed, 0, measured(last, 0), predicted_end.x);
    note.turned_back = opposite(executed, 2, measured(last, 2), predicted_end.yaw);
    if (note.moved_back || note.turned_back) return false;
    for (size_t axis = 0; axis < 3; ++axis) note.held[axis] = !role.scalable[axis];
    return true;
  }
  bool opposite(size_t executed, int axis, double measured, double predicted) const {
    if (!roles_[executed].scalable[static_cast<size_t>(axis)] || measured * predicted >= 0.0)
      return false;
    const double variance = variances_[executed][axis];
    const double assumed = kRelativeNoise[axis] * std::abs(predicted) + kAbsoluteNoise[axis];
    const double sigma = variance > 0.0 ? std::sqrt(variance) : assumed;
    return std::abs(measured - predicted) > sign_sigmas_ * sigma;
  }

  std::vector<PatternRole> roles_;
  std::vector<Axes> variances_;  ///< of the shipped ends; NaN = unknown
  double sign_sigmas_;
};

/// Collective Motion Pattern Scaling, the paper's algorithm (section IV, Algorithm 1; Table I
/// column c).
/** From the measured trajectory M of the executed pattern MP* and its prediction R* before the
 * update, boxes with the start pose in them, x and y [m], yaw interval [rad]:
 *    V = (x_s, y_s, phi_s) = box(M) / box(R*)                                     equation (1)
 *    R* <- (1 - w) M + w R*                                                       equation (2)
 *    R_p <- (1 - w) V R_p + w R_p   for every other pattern p                     equation (2)
 * with w the weight of the old prediction (equation (2); line 13 of Algorithm 1 swaps the roles).
 * Guards, see scaling.hpp: an axis whose shipped box is noise keeps the factor 1 for good; a
 * pattern of one dimension gives no V; nor does a measurement that went the other way; V is kept
 * within limits. Known faults: on unchanged ground the patterns that are never driven drift,
 * because the mean of a quotient of noisy boxes is not 1 (Telescoping does not have it); and as
 * every pattern gets the same factor, the ratios between patterns stay those of the shipped set for
 * ever, also where all are measured exactly (telescoping has that, too). */
class Collective : public ScalingRule {
 public:
  using ScalingRule::ScalingRule;

  std::unique_ptr<LearningRule> clone() const override {
    return std::make_unique<Collective>(*this);
  }

 protected:
  Axes factors(const Boxes& boxes, const PatternRole& role, RuleNote& note) const override {
    note.scaling = scalingVector(boxes.measured, boxes.before, role, limits_);  // equation (1)
    return (1.0 - memory_) * note.scaling + memory_;  // equation (2) with M = V R
  }
};

/// Collective scaling without its drift: the others follow the change of the executed pattern.
/** Own work after the paper's idea. With the guards of Collective:
 *    R*_new = (1 - w) M + w R*_old                                                equation (2)
 *    R_p <- R_p box(R*_new) / box(R*_old)   for every other pattern p, axis by axis
 * Over many executions the quotients telescope to box(R*_now) / box(R*_first): what the others got
 * is never more than what the executed pattern itself learned. */
class Telescoping : public ScalingRule {
 public:
  using ScalingRule::ScalingRule;

  std::unique_ptr<LearningRule> clone() const override {
    return std::make_unique<Telescoping>(*this);
  }

 protected:
  Axes factors(const Boxes& boxes, const PatternRole& role, RuleNote& note) const override {
    note.scaling = scalingVector(boxes.after, boxes.before, role, limits_);
    return note.scaling;
  }
};

template <class Made>
std::unique_ptr<LearningRule> make(const RuleConfig& config, const PatternSet& shipped) {
  return std::make_unique<Made>(config, shipped);
}

struct NamedRule {
  const char* name;
  std::unique_ptr<LearningRule> (*make)(const RuleConfig& config, const PatternSet& shipped);
};

/// All rules, in the order in which reports list them. A new rule is one line here.
const NamedRule kRules[] = {
    {"off", &make<Off>},
    {"single", &make<Single>},
    {"collective", &make<Collective>},
    {"telescoping", &make<Telescoping>},
    {"multi_model", &make<MultiModel>},
};

}  // namespace

std::vector<std::string> ruleNames() {
  std::vector<std::string> names;
  for (const NamedRule& rule : kRules) names.emplace_back(rule.name);
  return names;
}

std::unique_ptr<LearningRule> makeRule(const RuleConfig& config, const PatternSet& shipped) {
  if (!(config.memory >= 0.0 && config.memory < 1.0))
    throw std::invalid_argument("learner: memory must be in 0 <= memory < 1");
  if (config.ground.settled_after < 1 || config.ground.capacity < 1 || config.ground.moments < 3)
    throw std::invalid_argument(
        "learner: settled_after and capacity must be 1 or more, moments 3 or more");
  for (const NamedRule& rule : kRules)
    if (config.rule == rule.name) return rule.make(config, shipped);
  throw std::invalid_argument("learner: unknown rule '" + config.rule + "'");
}

}  // namespace tread::learner
