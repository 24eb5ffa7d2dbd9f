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

/// Rivals by name, in their initial state.
using Rivals = std::map<std::string, std::unique_ptr<adaptation::Rival>>;

/// End of one execution, with its path length and turn.
struct ExecutionEnd {
  Pose2 pose;            ///< last pose relative to the start, yaw unwrapped
  double metres = 0.0;   ///< length of the path from the start through all poses
  double radians = 0.0;  ///< absolute net yaw
};

/// All executions of one pattern on one surface (RP_S), contiguous in memory.
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

/// One surface of an experiment. Test recordings are never averaged nor driven before.
struct TrialGround {
  std::string surface;
  PatternSet averaged;               ///< IP_S, from one half of the recordings
  std::vector<Pose2> averaged_ends;  ///< its ends, by pattern
  std::vector<Executions> known;     ///< the same half, used by excitation runs
  std::vector<Executions> tests;     ///< the other half
};

ExecutionEnd executionEnd(const learner::ConstTrajectory& trajectory);

/// Splits the recordings of each pattern in two halves, averages one by surface, and arranges both
/// for the experiment.
/** Neighbours stay together: recordings from drives come in pairs from one step, which share a
 * local mean. Throws recordings::RecordingError with one line if a pattern has fewer than eight
 * valid executions or there is only one surface. Invalid executions are left out; `notes` gets a
 * line for each, and one if recordings are few. */
std::vector<TrialGround> groundsOf(const recordings::PatternRecordings& recorded,
                                   std::vector<std::string>& notes);

/// One surface of a world: the vehicle's model on it.
struct WorldSurface {
  std::string name;
  VehicleModel model;
};

/// A pattern to execute: commands per sample.
struct WorldPattern {
  std::string name;
  std::vector<TrackCommand> commands;
};

/// A simulated vehicle on several surfaces, for making recordings (config/worlds, kind:
/// transitions).
struct TransitionWorld {
  std::string name;
  bool paper_reference = false;  ///< print the paper's numbers for surfaces that it has
  TrackCommand entry{1.0, 1.0};  ///< [1] each pattern begins in the steady motion of this command
  double period = 0.05;          ///< [s] a sample
  int64_t recordings = 300;      ///< executions of each pattern on each surface
  double position_noise = 0.0;   ///< [m] standard deviation of the INS for x and y of each sample
  double yaw_noise = 0.0;        ///< [rad]
  std::vector<WorldPattern> patterns;
  std::vector<std::vector<std::string>> sequences;  ///< names of patterns
  std::vector<WorldSurface> surfaces;
};

/// Throws ConfigError with one line "file:line: error; allowed values".
TransitionWorld readTransitionWorld(const std::string& path);
/// The same from text; `name` replaces the file in messages.
TransitionWorld parseTransitionWorld(const std::string& text, const std::string& name);

/// Executes each pattern on each surface and measures it. Each command is held `length` times as
/// long. The same seed gives the same recordings.
recordings::PatternRecordings record(const TransitionWorld& world, uint64_t seed, int length = 1);

/// A random index below `count`, the same on every platform.
inline size_t drawIndex(std::mt19937_64& random, size_t count) {
  return static_cast<size_t>(((random() >> 32) * static_cast<uint64_t>(count)) >> 32);
}

/// A distinct seed for each combination of numbers (splitmix64 over all of them).
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

/// Surfaces that a method has driven on before a transition from surface A to surface B.
enum class TrialHistory {
  kNone,        ///< none: the initial rule with IP_A (the paper's protocol)
  kHome,        ///< A
  kUnmet,       ///< all but B, A last; for unchanged ground (A = B) all others
  kRemembered,  ///< all surfaces, A last
};

/// A compared method: a learning rule or a rival (adaptation/rivals.hpp) with a history. Without a
/// rule it is the omniscient one.
struct Method {
  std::string rule;
  TrialHistory history = TrialHistory::kNone;
};

/// The correct set from the beginning, without learning: column d of the paper's Table I.
inline constexpr const char* kOmniscient = "omniscient";

/// RULE, RULE_home, RULE_unmet or RULE_remembered, or kOmniscient; `off` learns nothing, so it has
/// no history. nullopt for other names.
std::optional<Method> methodOf(const std::string& name);
/// Names of all methods.
std::vector<std::string> methodNames();
/// The methods compared by default.
std::vector<std::string> defaultMethods();

/// Surfaces of an excitation run from A to B, in driving order: A last, the others shuffled.
std::vector<size_t> excitationOrder(TrialHistory history, size_t surfaces, size_t from, size_t to,
                                    std::mt19937_64& random);

/// An excitation run: a number of executions of random patterns on each of its surfaces.
struct ExcitationRun {
  int64_t executions = 200;
  uint64_t seed = 1;
};

/// All methods that learn: learning rules, then rivals.
std::vector<std::string> learnerNames();

/// The compared methods, prepared for a transition from surface A to surface B.
/** Each starts with IP_A and executes the excitation run of its history. A = B is unchanged ground.
 */
class Methods {
 public:
  Methods(const std::vector<std::string>& names, const learner::RuleConfig& config,
          const std::vector<TrialGround>& grounds, size_t from, size_t to,
          const ExcitationRun& excitation);
  /// The same with rivals already tuned for this transition.
  Methods(const std::vector<std::string>& names, const learner::RuleConfig& config,
          const std::vector<TrialGround>& grounds, size_t from, size_t to,
          const ExcitationRun& excitation, const Rivals& rivals);

  size_t size() const { return all_.size(); }
  /// Resets all methods to the state before the transition; learning rules do not allocate.
  void reset();
  Pose2 predictEnd(size_t i, size_t pattern) const {
    const State& one = all_[i];
    return one.fixed != nullptr ? (*one.fixed)[pattern] : one.now->predictEnd(pattern);
  }
  /// Covariance of predictEnd(); nullopt if the method has none.
  std::optional<PoseCovariance> endCovariance(size_t i, size_t pattern) const {
    return all_[i].now ? all_[i].now->endCovariance(pattern) : std::nullopt;
  }
  void learn(size_t i, size_t pattern, const learner::ConstTrajectory& measured) {
    if (all_[i].now) all_[i].now->learn(pattern, measured, note_);
  }
  /// Number of surfaces remembered before the transition; negative = no memory.
  int remembered(size_t i) const { return all_[i].start ? all_[i].start->remembered() : -1; }

 private:
  struct State {
    const std::vector<Pose2>* fixed = nullptr;  ///< constant predictions
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

/// Sums of the errors of methods and of the driven distance, over repetitions.
/** Repetitions that share an excitation run are dependent, so intervals are over runs: the sum over
 * the repetitions of a run is one sample, and Student's quantile is for the number of runs
 * [cluster-robust delta method]. They hold for new runs on the same recordings. All methods use
 * the same recordings, so products of their errors are kept: the interval of a reduction is that
 * of paired trials. */
class RatioMoments {
 public:
  explicit RatioMoments(size_t methods = 0)
      : size_(methods + 1), sums_(size_), squares_(size_), products_(size_ * size_) {}

  /// One repetition: metres or radians covered, and the summed error of each method.
  void add(double covered, const double* errors);
  /// All repetitions of another excitation run.
  void addRun(const RatioMoments& run);

  double repetitions() const { return repetitions_; }
  /// Sum of errors over sum of distance.
  Estimate error(size_t method) const { return quotient(method + 1, 0); }
  /// Ratio of the errors of two methods.
  Estimate ratio(size_t method, size_t other) const { return quotient(method + 1, other + 1); }
  /// Standard deviation of a repetition's error, relative to its mean distance.
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

/// Histogram of errors with bins of equal width.
struct Histogram {
  double width = 1.0;
  std::vector<double> counts;

  void add(double value) {
    const double bin = value / width;
    if (bin < static_cast<double>(counts.size())) counts[static_cast<size_t>(bin)] += 1.0;
  }
  /// `other` has the same bins.
  void add(const Histogram& other) {
    for (size_t bin = 0; bin < counts.size(); ++bin) counts[bin] += other.counts[bin];
  }
};

/// Student's 99.5 % quantile for means of `samples` values.
double student99(size_t samples);

/// Pattern indices in order of execution.
using Sequence = std::vector<size_t>;

/// Default test sequences: for the two patterns with the most distant ends, one twice followed by
/// the other, and the reverse.
/** Patterns that move in one dimension only are avoided if two others exist. An angle counts as its
 * arc at the mean distance of all ends. Empty if there is only one pattern. */
std::vector<Sequence> sequencesFor(const PatternSet& set);

/// Errors of all rules, per driven metre and per turned radian.
struct MethodErrors {
  explicit MethodErrors(size_t rules = 0) : position(rules), orientation(rules) {}
  void addRun(const MethodErrors& run) {
    position.addRun(run.position);
    orientation.addRun(run.orientation);
  }
  RatioMoments position;     ///< [1] metres over metres of path
  RatioMoments orientation;  ///< [1] radians over radians of net yaw
};

/// Conditions of trials: old surface, new surface, number of repetitions.
struct TrialSite {
  const TrialGround& from;
  const TrialGround& to;
  bool change_inside = false;  ///< the first half of the first execution is on `from`
  int64_t repetitions = 0;
  uint64_t seed = 0;
};

/// Errors over the test sequences and their distribution, by rule.
struct SequenceErrors {
  MethodErrors errors;
  std::vector<Histogram> position;     ///< of single executions, per metre
  std::vector<Histogram> orientation;  ///< of single executions, per radian

  void addRun(const SequenceErrors& run) {
    errors.addRun(run.errors);
    for (size_t i = 0; i < position.size(); ++i) {
      position[i].add(run.position[i]);
      orientation[i].add(run.orientation[i]);
    }
  }
};

/// Section V: every sequence from the same initial state, prediction before learning. Each
/// repetition drives all sequences once; all rules use the same recordings.
SequenceErrors driveSequences(Methods& methods, const TrialSite& site,
                              const std::vector<Sequence>& sequences, Histogram position_bins,
                              Histogram orientation_bins);

/// Errors over ALL patterns on unused recordings, after each of some (ascending) numbers of
/// executions of a repeated sequence.
std::vector<MethodErrors> driveAllPatterns(Methods& methods, const TrialSite& site,
                                           const std::vector<Sequence>& sequences,
                                           const std::vector<int>& executions);

/// Errors of each of the first executions of the repeated first sequence, without a reset.
std::vector<MethodErrors> driveDevelopment(Methods& methods, const TrialSite& site,
                                           const std::vector<Sequence>& sequences,
                                           size_t executions);

/// Errors in the long run: repeated test sequences, or random patterns if there are none, without a
/// reset; the first executions do not count. A repetition is one such drive.
MethodErrors driveLong(Methods& methods, const TrialSite& site,
                       const std::vector<Sequence>& sequences);

/// Predicted width of a never executed pattern relative to its shipped width (sideways reach of its
/// end), before and after each execution of the test sequences on unchanged ground; by rule, means
/// over repetitions.
std::vector<std::vector<double>> driveDrift(Methods& methods, const TrialSite& site,
                                            const std::vector<Sequence>& sequences, size_t watched,
                                            size_t executions);

}  // namespace tread::experiment
