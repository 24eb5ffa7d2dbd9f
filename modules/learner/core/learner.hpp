// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/execution/execution_tracker.hpp"
#include "common/execution/measurement.hpp"
#include "common/pattern/pattern.hpp"
#include "modules/learner/core/change_watch.hpp"
#include "modules/learner/core/coasting.hpp"
#include "modules/learner/core/rules/learning_rule.hpp"

namespace tread::learner {

/// Effect of a measurement on the set.
struct Correction {
  bool changed = false;
  RuleNote note;
  std::string guards;  ///< guards that limited it, in words; empty = none
  std::string reason;  ///< the rule's interpretation, in words; empty if nothing changed
  /// The ground changed while it ran, this many samples after its start; nothing was learned from
  /// the part before.
  std::optional<int> changed_after;
};

/// Running mean of the squared prediction errors of one pattern's end pose, about zero, because a
/// bias misleads the planner as much as noise does.
struct EndResiduals {
  int64_t count = 0;
  PoseCovariance mean{};  ///< [m2, m rad, rad2]; meaningless while count is 0
};

/// Initial value for a pattern, from its shipped covariance if known.
EndResiduals residualsOf(const MotionPattern& shipped);

/// Adds one error of the end pose: measured relative to predicted, in the pattern's start frame,
/// yaw wrapped.
void addResidual(EndResiduals& residuals, const Pose2& error);

/// The covariance for the planner: NaN until there are enough errors.
PoseCovariance covarianceOf(const EndResiduals& residuals);

/// Learned state beside the set itself.
using ResidualTable = std::map<int, EndResiduals>;

/// Learns a pattern set from measured executions. Every change makes a new version that names its
/// parent.
/** If the rule learns from parts, each execution has kVersions versions: its k-th part gives the
 * k-th of them and its end the last, so that a version does not depend on which parts arrived in
 * time. */
class Learner {
 public:
  Learner(const RuleConfig& config, PatternSet shipped);

  /// The newest set.
  const PatternSet& set() const { return set_; }
  const PatternSet& shipped() const { return shipped_; }
  const ResidualTable& residuals() const { return residuals_; }

  static constexpr int64_t kVersions = 16;  ///< per execution, if the rule learns from parts

  // Rules hold pointers into it.
  Learner(const Learner&) = delete;
  Learner& operator=(const Learner&) = delete;

  /// Whether the rule also learns from the beginning of a pattern.
  bool learnsParts() const { return rule_->learnsParts(); }

  /// Learns from a valid measurement of the pattern with this id, which must be in the set.
  /** `end_error`: measured relative to the prediction that the planner used; nullopt if the end was
   * not measured. `utime` [us] is that of the execution's end. */
  Correction learn(int pattern_id, const Measurement& measurement,
                   const std::optional<Pose2>& end_error, int64_t utime);

  /// Follows a running execution: makes a new set as if it had ended here.
  /** The next call of either replaces what was learned, so that an execution counts once. Only
   * valid measurements, and only rules that learn from parts. `part` counts from 1 within an
   * execution. True if there is a new set. */
  bool follow(int pattern_id, const Measurement& beginning, int64_t part, int64_t utime);
  /// Forgets the followed execution if it turns out to be invalid. True if there is a new set.
  bool unfollow(int64_t utime);

  /// Continues from a restored set, its residuals and the rule's memory; all of the same shipped
  /// set.
  /** If the rule cannot use them (they are of another rule), it starts again: the version is kept,
   * the predictions are the shipped ones. Returns false then. */
  bool restore(PatternSet set, ResidualTable residuals, const std::vector<double>& memory);

  /// The rule's memory for the state file, without running executions.
  std::vector<double> memory() const;
  const LearningRule& rule() const { return *rule_; }
  /// The same content with a higher version number and this `parent`.
  void renumber(int64_t version, int64_t parent);

 private:
  /// The end of an execution that the next one may follow without a pause.
  struct Ended {
    int64_t utime = 0;                                 ///< [us]; 0 = none
    Eigen::Vector2d beside = Eigen::Vector2d::Zero();  ///< d of Coasting
  };
  /// Influence of a running execution on the next one.
  struct Coming {
    std::string entry_class;  ///< of the patterns that may follow
    Eigen::Vector2d beside;   ///< d of Coasting
  };
  /// The newest set with the rule's current predictions, not yet checked; patterns that may follow
  /// include the coasting.
  PatternSetContent predicted(const std::optional<Coming>& coming = std::nullopt) const;
  std::optional<Coming> comingAfter(const MotionPattern& running,
                                    const Measurement& beginning) const;
  bool restoreMemory(std::vector<double> memory);
  void watchEnd(size_t executed, const Measurement& measurement, int64_t utime);
  void learnCoasting(size_t executed, const Measurement& measurement, int64_t utime);
  /// The rule's prediction of a pattern.
  std::vector<Pose2> predictionOf(const LearningRule& rule, size_t pattern, size_t samples) const;
  RuleNote update(size_t executed, const Measurement& measurement, int64_t begun);
  Eigen::ArrayX3d measuredRows(const Measurement& measurement);
  /// Adopts the predictions as a version; one clear line in `why` if they are no valid set.
  bool adopt(PatternSetContent content, int64_t version, int64_t utime, std::string& why);
  int64_t nextVersion() const { return settled_version_ + (rule_->learnsParts() ? kVersions : 1); }

  PatternSet shipped_;
  PatternSet set_;
  std::map<int, size_t> index_;  ///< by pattern id
  std::unique_ptr<LearningRule> rule_;
  int64_t settled_version_ = 0;            ///< of the last completed execution
  bool following_ = false;                 ///< the set includes a running execution
  std::unique_ptr<LearningRule> settled_;  ///< without the running execution
  ResidualTable residuals_;
  ChangeWatch watch_;
  int64_t watched_until_ = 0;         ///< [us] end of the last execution passed to the watch
  std::optional<int> changed_after_;  ///< in the execution learned from last
  Coasting coasting_;
  Ended ended_;
  std::vector<double> measured_;
};

/// End pose of M relative to the end of a prediction, in the start frame of both; yaw wrapped.
Pose2 endError(const Measurement& measurement, const MotionPattern& predicted);

// The learner's text files: words and numbers that read back bit for bit, and a last line that
// reveals damage.

/// Everything that the learner needs to continue after a restart, except the shipped set.
struct LearnerState {
  PatternSet set;                     ///< newest version
  ResidualTable residuals;            ///< by pattern id
  std::vector<double> memory;         ///< of the rule, in addition to the set
  Rule rule = "off";                  ///< that the memory belongs to
  std::vector<ExecutionKey> handled;  ///< the most recently handled executions, oldest first
};

}  // namespace tread::learner
