// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "common/pattern/pattern.hpp"
#include "common/recordings/recordings.hpp"
#include "common/vehicle/model.hpp"
#include "modules/learner/core/rules/learning_rule.hpp"
#include "modules/learner/core/scaling.hpp"

namespace tread::adaptation {
class Rival;
}

namespace tread::experiment {

/// Rivals by name, as they begin.
using Rivals = std::map<std::string, std::unique_ptr<adaptation::Rival>>;

/// Where one execution ended, and what it covered on the way.
struct ExecutionEnd {
  Pose2 pose;            ///< last pose relative to the start, yaw unwrapped
  double metres = 0.0;   ///< length of the path from the start through all poses
  double radians = 0.0;  ///< |net yaw|
};

/// All executions of one pattern on one surface (RP_S), one behind the other in memory.
class Executions {
 public:
  /// Each has `samples` poses.
  Executions(const std::vector<recordings::Execution>& executions, size_t samples);

  size_t size() const { return ends_.size(); }
  size_t samples() const { return samples_; }
  learner::ConstTrajectory of(size_t i) const {
    return {numbers_.data() + 3 * samples_ * i, static_cast<Eigen::Index>(samples_), 3};
  }
  const ExecutionEnd& endOf(size_t i) const { return ends_[i]; }

 private:
  size_t samples_;
  std::vector<double> numbers_;
  std::vector<ExecutionEnd> ends_;
};

/// One surface of an experiment. What is tested was never averaged nor driven before.
struct TrialGround {
  std::string surface;
  PatternSet averaged;               ///< IP_S, of one half of the recordings
  std::vector<Pose2> averaged_ends;  ///< of it, by pattern
  std::vector<Executions> known;     ///< the same half: excitation runs drive these
  std::vector<Executions> tests;     ///< the other half
};

ExecutionEnd executionEnd(const learner::ConstTrajectory& trajectory);

/// Splits the recordings of each pattern in two halves, averages one surface by surface, and lays
/// both out for the experiment.
/** Neighbours stay together: recordings made of drives come in pairs, two of one step. Such pairs
 * have one local mean, so both halves know it. Throws recordings::RecordingError with one line if a
 * pattern has fewer than eight fair executions or there is one surface only. What is no fair
 * execution is left out; a line for each goes to `notes`, and one if recordings are few. */
std::vector<TrialGround> groundsOf(const recordings::PatternRecordings& recorded,
                                   std::vector<std::string>& notes);

/// One surface of a world: the vehicle on it.
struct WorldSurface {
  std::string name;
  VehicleModel model;
};

/// A pattern to execute: commands sample by sample.
struct WorldPattern {
  std::string name;
  std::vector<TrackCommand> commands;
};

/// A simulated vehicle on several surfaces, of which recordings can be made (config/worlds, kind:
/// transitions).
struct TransitionWorld {
  std::string name;
  bool paper_reference = false;  ///< the paper's numbers stand beside where surfaces are its own
  TrackCommand entry{1.0, 1.0};  ///< [1] each pattern begins in the steady motion of this command
  double period = 0.05;          ///< [s] a sample
  int64_t recordings = 300;      ///< executions of each pattern on each surface
  double position_noise = 0.0;  ///< [m] of the INS, standard deviation of x and of y of each sample
  double yaw_noise = 0.0;       ///< [rad]
  std::vector<WorldPattern> patterns;
  std::vector<std::vector<std::string>> sequences;  ///< names of patterns
  std::vector<WorldSurface> surfaces;
};

/// Throws ConfigError with one line "file:line: what is wrong; what is allowed".
TransitionWorld readTransitionWorld(const std::string& path);
/// The same from text; `name` stands for the file in messages.
TransitionWorld parseTransitionWorld(const std::string& text, const std::string& name);

/// Executes each pattern on each surface and measures it. Each command is held `length` times as
/// long. Same seed, same recordings.
recordings::PatternRecordings record(const TransitionWorld& world, uint64_t seed, int length = 1);

/// One of `count` things, drawn by chance; the same on every machine.
inline size_t drawIndex(std::mt19937_64& random, size_t count) {
  return static_cast<size_t>(((random() >> 32) * static_cast<uint64_t>(count)) >> 32);
}

/// A seed of its own for each combination of numbers (splitmix64 over all of them).
inline uint64_t seedOf(std::initializer_list<uint64_t> numbers) {
  uint64_t state = 0;
  for (const uint64_t number : numbers) {
    state += number + 0x9E3779B97F4A7C15ULL;
    state = (state ^ (state >> 30)) * 0xBF58476D1CE4E5B9ULL;
    state = (state ^ (state >> 27)) * 0x94D049BB133111EBULL;
    state ^= state >> 31;
  }
  return state;
}

/// What a method has driven before a transition from surface A to surface B.
enum class TrialHistory {
  kNone,        ///< nothing: the rule as it begins, with IP_A (the paper's protocol)
  kHome,        ///< A
  kUnmet,       ///< all surfaces but B, A last; on unchanged ground (A = B) all others
  kRemembered,  ///< all surfaces, A last
};

/// What is compared: a rule of the learner or a rival (adaptation/rivals.hpp) with a history.
/// Without a rule it is the omniscient one.
struct Method {
  std::string rule;
  TrialHistory history = TrialHistory::kNone;
};

/// The right set from the beginning, learning off: column d of the paper's Table I.
inline constexpr const char* kOmniscient = "omniscient";

/// RULE, RULE_home, RULE_unmet or RULE_remembered, or kOmniscient; `off` learns nothing, so it has
/// no history. Nothing for other names.
std::optional<Method> methodOf(const std::string& name);
/// Names of all methods.
std::vector<std::string> methodNames();
/// Those that are compared if nothing else is asked for.
std::vector<std::string> defaultMethods();

/// Surfaces of an excitation run from A to B, in the order in which it drives them; the others are
/// shuffled, A is the last one.
std::vector<size_t> excitationOrder(TrialHistory history, size_t surfaces, size_t from, size_t to,
                                    std::mt19937_64& random);

/// An excitation run: so many executions of random patterns on each of its surfaces.
struct ExcitationRun {
  int64_t executions = 200;
  uint64_t seed = 1;
};

/// Names of all that can learn: rules of the learner, then rivals.
std::vector<std::string> learnerNames();

/// The methods that are compared, ready for a transition from surface A to surface B.
/** Each starts with IP_A and drives an excitation run of its history. A = B is unchanged ground. */
class Methods {
 public:
  Methods(const std::vector<std::string>& names, const learner::RuleConfig& config,
          const std::vector<TrialGround>& grounds, size_t from, size_t to,
          const ExcitationRun& excitation);
  /// The same with rivals that were tuned for this transition before.
  Methods(const std::vector<std::string>& names, const learner::RuleConfig& config,
          const std::vector<TrialGround>& grounds, size_t from, size_t to,
          const ExcitationRun& excitation, const Rivals& rivals);

  size_t size() const { return all_.size(); }
  /// All methods as they were before the transition; rules of the learner allocate nothing.
  void reset();
  Pose2 predictEnd(size_t i, size_t pattern) const {
    const State& one = all_[i];
    return one.fixed != nullptr ? (*one.fixed)[pattern] : one.now->predictEnd(pattern);
  }
  /// Of predictEnd(); nothing if the method does not state it.
  std::optional<PoseCovariance> endCovariance(size_t i, size_t pattern) const {
    return all_[i].now ? all_[i].now->endCovariance(pattern) : std::nullopt;
  }
  void learn(size_t i, size_t pattern, const learner::ConstTrajectory& measured) {
    if (all_[i].now) all_[i].now->learn(pattern, measured, note_);
  }
  /// Surfaces that it remembers before the transition; negative = none by nature.
  int remembered(size_t i) const { return all_[i].start ? all_[i].start->remembered() : -1; }

 private:
  struct State {
    const std::vector<Pose2>* fixed = nullptr;  ///< predictions that never change
    std::unique_ptr<learner::LearningRule> start;
    std::unique_ptr<learner::LearningRule> now;
  };

  std::vector<State> all_;
  learner::RuleNote note_;
};

/// A value with its 99 % interval.
struct Estimate {
  double value = std::numeric_limits<double>::quiet_NaN();
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();
};

/// Sums of what methods erred and of what was covered meanwhile, over repetitions.
/** Repetitions that share an excitation run are not independent, so intervals are over runs: what
 * the repetitions of one run sum up to is one sample, and Student's quantile belongs to the number
 * of runs [cluster-robust delta method]. They are about new runs on the same recordings. All
 * methods see the same recordings, so that products of their errors are kept, too: the interval of
 * a reduction is that of paired trials. */
class RatioMoments {
 public:
  explicit RatioMoments(size_t methods = 0)
      : size_(methods + 1), sums_(size_), squares_(size_), products_(size_ * size_) {}

  /// One repetition: metres or radians covered, and the summed error of each method.
  void add(double covered, const double* errors);
  /// All repetitions of a further excitation run.
  void addRun(const RatioMoments& run);

  double repetitions() const { return repetitions_; }
  /// Sum of errors over sum of what was covered.
  Estimate error(size_t method) const { return quotient(method + 1, 0); }
  /// Error of a method over that of another one.
  Estimate ratio(size_t method, size_t other) const { return quotient(method + 1, other + 1); }
  /// Standard deviation of a repetition's error, over the mean of what one covers.
  double deviation(size_t method) const;

 private:
  Estimate quotient(size_t above, size_t below) const;
  double product(size_t i, size_t j) const {
    return products_[i < j ? i * size_ + j : j * size_ + i];
  }

  size_t size_;
  double repetitions_ = 0.0;
  size_t runs_ = 0;
  std::vector<double> sums_;      ///< covered, then each method's errors
  std::vector<double> squares_;   ///< of repetitions
  std::vector<double> products_;  ///< of sums of runs, upper triangle
};

/// How often errors fell into each of some bins of equal width.
struct Histogram {
  double width = 1.0;
  std::vector<double> counts;

  void add(double value) {
    const double bin = value / width;
    if (bin < static_cast<double>(counts.size())) counts[static_cast<size_t>(bin)] += 1.0;
  }
  /// Of equal bins.
  void add(const Histogram& other) {
    for (size_t bin = 0; bin < counts.size(); ++bin) counts[bin] += other.counts[bin];
  }
};

/// Student's 99.5 % quantile for means of `samples` values.
double student99(size_t samples);

/// Patterns by index, one after the other.
using Sequence = std::vector<size_t>;

/// Test sequences where none is given: the two patterns whose ends are most apart, one twice and
/// then the other, and mirrored.
/** Patterns that move in one dimension only are no choice while two others are left. An angle
 * counts as its arc at the mean distance of all ends. Empty if there is one pattern only. */
std::vector<Sequence> sequencesFor(const PatternSet& set);

/// Errors of all rules: per driven metre and per radian turned.
struct MethodErrors {
  explicit MethodErrors(size_t rules = 0) : position(rules), orientation(rules) {}
  void addRun(const MethodErrors& run) {
    position.addRun(run.position);
    orientation.addRun(run.orientation);
  }
  RatioMoments position;     ///< [1] metres over metres of path
  RatioMoments orientation;  ///< [1] radians over radians of net yaw
};

/// Where trials happen: the surface left behind, the one that is driven on, and how often.
struct TrialSite {
  const TrialGround& from;
  const TrialGround& to;
  bool change_inside = false;  ///< the first execution drives its first half on `from`
  int64_t repetitions = 0;
  uint64_t seed = 0;
};

/// Errors over the test sequences and how they are distributed, by rule.
struct SequenceErrors {
  MethodErrors errors;
  std::vector<Histogram> position;     ///< of single executions, per metre of each
  std::vector<Histogram> orientation;  ///< per radian

  void addRun(const SequenceErrors& run) {
    errors.addRun(run.errors);
    for (size_t i = 0; i < position.size(); ++i) {
      position[i].add(run.position[i]);
      orientation[i].add(run.orientation[i]);
    }
  }
};

/// Section V: every sequence from the same beginning, prediction before learning. Each repetition
/// drives all sequences once; all rules see the same recordings.
SequenceErrors driveSequences(Methods& methods, const TrialSite& site,
                              const std::vector<Sequence>& sequences, Histogram position_bins,
                              Histogram orientation_bins);

/// Errors over ALL patterns on fresh recordings, after each of some numbers of executions of a
/// sequence continued (ascending).
std::vector<MethodErrors> driveAllPatterns(Methods& methods, const TrialSite& site,
                                           const std::vector<Sequence>& sequences,
                                           const std::vector<int>& executions);

/// Errors of each of the first executions of the first sequence continued, without a reset.
std::vector<MethodErrors> driveDevelopment(Methods& methods, const TrialSite& site,
                                           const std::vector<Sequence>& sequences,
                                           size_t executions);

/// Errors in the long run: the test sequences again and again, random patterns if there are none,
/// without a reset; the first executions do not count. A repetition is one such drive.
MethodErrors driveLong(Methods& methods, const TrialSite& site,
                       const std::vector<Sequence>& sequences);

/// How wide a pattern that is never executed is predicted, over its shipped width (sideways reach
/// of its end), before and after each execution of the test sequences on unchanged ground; by rule,
/// means over repetitions.
std::vector<std::vector<double>> driveDrift(Methods& methods, const TrialSite& site,
                                            const std::vector<Sequence>& sequences, size_t watched,
                                            size_t executions);

}  // namespace tread::experiment
