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

/// What a measurement did to the set.
struct Correction {
  bool changed = false;
  RuleNote note;
  std::string guards;  ///< which guards held it back, in words; empty = none
  std::string reason;  ///< what the rule took it for, in words; empty if nothing changed
  /// The ground changed while it ran, so many samples after its start; what came before taught
  /// nothing.
  std::optional<int> changed_after;
};

/// Running mean of squared prediction errors of one pattern's end pose: about zero, because a bias
/// misleads the planner as much as noise does.
struct EndResiduals {
  int64_t count = 0;
  PoseCovariance mean{};  ///< [m2, m rad, rad2]; meaningless while count is 0
};

/// The beginning for a pattern, from its shipped covariance if that is known.
EndResiduals residualsOf(const MotionPattern& shipped);

/// Takes one error of the end pose, measured relative to predicted, in the pattern's start frame,
/// yaw wrapped.
void addResidual(EndResiduals& residuals, const Pose2& error);

/// What may be told to the planner: NaN until enough was seen.
PoseCovariance covarianceOf(const EndResiduals& residuals);

/// What has been learned, beside the set itself.
using ResidualTable = std::map<int, EndResiduals>;

/// Learns a pattern set from measured executions. Every change makes a new version with its parent.
/** Where the rule learns from parts, an execution has kVersions: its k-th part makes the k-th of
 * them and its end the last, so that a version is the same whichever parts were in time. */
class Learner {
 public:
  Learner(const RuleConfig& config, PatternSet shipped);

  /// The newest set.
  const PatternSet& set() const { return set_; }
  const PatternSet& shipped() const { return shipped_; }
  const ResidualTable& residuals() const { return residuals_; }

  static constexpr int64_t kVersions = 16;  ///< of an execution whose parts are learned, too

  // Pointers to rules are its own.
  Learner(const Learner&) = delete;
  Learner& operator=(const Learner&) = delete;

  /// Whether the rule learns from the beginning of a pattern, too.
  bool learnsParts() const { return rule_->learnsParts(); }

  /// Learns from a fair measurement of the pattern with this id, which must be in the set.
  /** `end_error`: measured relative to the prediction that the planner used, nothing if the end was
   * not measured. `utime` [us] is that of the execution's end. */
  Correction learn(int pattern_id, const Measurement& measurement,
                   const std::optional<Pose2>& end_error, int64_t utime);

  /// Follows an execution that still runs: a new set as if it had ended here.
  /** The next call of either replaces what was learned, so that an execution counts once. Fair
   * measurements only, of rules that learn from parts. `part` counts up from 1 within an execution.
   * True if there is a new set. */
  bool follow(int pattern_id, const Measurement& beginning, int64_t part, int64_t utime);
  /// Forgets what was followed, should its execution prove to be no fair one. True if there is a
  /// new set.
  bool unfollow(int64_t utime);

  /// Goes on from a restored set, its residuals and the rule's memory; all of the same shipped set.
  /** A rule that cannot go on from them (they are another rule's) begins anew: the version stays,
   * the predictions are the shipped ones. Returns false then. */
  bool restore(PatternSet set, ResidualTable residuals, const std::vector<double>& memory);

  /// What the rule knows beside the set, for the state file; without what still runs.
  std::vector<double> memory() const;
  const LearningRule& rule() const { return *rule_; }
  /// The same content under a higher version number, with `parent`.
  void renumber(int64_t version, int64_t parent);

 private:
  /// The end of an execution that the next may follow without a pause.
  struct Ended {
    int64_t utime = 0;                                 ///< [us]; 0 = there is none
    Eigen::Vector2d beside = Eigen::Vector2d::Zero();  ///< d of Coasting
  };
  /// What an execution that still runs says of the next one.
  struct Coming {
    std::string entry_class;  ///< of the patterns that may follow
    Eigen::Vector2d beside;   ///< d of Coasting
  };
  /// The newest set with what the rule predicts now, not yet checked; patterns that may follow,
  /// with the way that the vehicle coasts.
  PatternSetContent predicted(const std::optional<Coming>& coming = std::nullopt) const;
  std::optional<Coming> comingAfter(const MotionPattern& running,
                                    const Measurement& beginning) const;
  bool restoreMemory(std::vector<double> memory);
  void watchEnd(size_t executed, const Measurement& measurement, int64_t utime);
  void learnCoasting(size_t executed, const Measurement& measurement, int64_t utime);
  /// What the rule predicts of a pattern.
  std::vector<Pose2> predictionOf(const LearningRule& rule, size_t pattern, size_t samples) const;
  RuleNote update(size_t executed, const Measurement& measurement, int64_t begun);
  Eigen::ArrayX3d measuredRows(const Measurement& measurement);
  /// The predictions as a version; one clear line in `why` if they are no set.
  bool adopt(PatternSetContent content, int64_t version, int64_t utime, std::string& why);
  int64_t nextVersion() const { return settled_version_ + (rule_->learnsParts() ? kVersions : 1); }

  PatternSet shipped_;
  PatternSet set_;
  std::map<int, size_t> index_;  ///< by pattern id
  std::unique_ptr<LearningRule> rule_;
  int64_t settled_version_ = 0;            ///< of the last execution that has ended
  bool following_ = false;                 ///< the set holds what still runs
  std::unique_ptr<LearningRule> settled_;  ///< without what is learned from a running execution
  ResidualTable residuals_;
  ChangeWatch watch_;
  int64_t watched_until_ = 0;         ///< [us] end of the execution that the watch has followed
  std::optional<int> changed_after_;  ///< in the execution that was learned from last
  Coasting coasting_;
  Ended ended_;
  std::vector<double> measured_;
};

/// End pose of M seen from the end of a prediction, in the start frame of both; yaw wrapped.
Pose2 endError(const Measurement& measurement, const MotionPattern& predicted);

// The text files of the learner: words and numbers that read back to the bit, and a last line that
// tells a damaged text from a whole one.

/// Everything that the learner needs to go on after a restart, apart from the shipped set.
struct LearnerState {
  PatternSet set;                     ///< newest version
  ResidualTable residuals;            ///< by pattern id
  std::vector<double> memory;         ///< of the rule, beside the set
  Rule rule = "off";                  ///< whose memory it is
  std::vector<ExecutionKey> handled;  ///< the executions handled last, oldest first
};

/// The state as text, a line each; restores bit for bit. Names the rule for people who read it.
/** Commands, classes and names are not in it: they are those of the shipped set, which it names by
 * checksum. */
std::string formatState(const LearnerState& state, const PatternSet& shipped,
                        const RuleConfig& config);

/// The state from its text; nothing and one clear line in `why` if it is damaged or of another
/// shipped set.
std::optional<LearnerState> parseState(const std::string& text, const PatternSet& shipped,
                                       std::string& why);

}  // namespace tread::learner
