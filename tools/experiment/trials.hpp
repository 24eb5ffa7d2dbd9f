// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "common/pattern/pattern.hpp"
#include "common/recordings/recordings.hpp"
#include "common/vehicle/model.hpp"
#include "modules/learner/core/rules/learning_rule.hpp"
#include "modules/learner/core/rules/surface_bank.hpp"
#include "modules/learner/core/scaling.hpp"

namespace tread::experiment {

/// Where one execution ended, and what it covered on the way.
struct ExecutionEnd {
  Pose2 pose;            ///< last pose relative to the start, yaw unwrapped
  double metres = 0.0;   ///< length of the path from the start through all poses
  double radians = 0.0;  ///< |net yaw|
};

/// All executions of one pattern on one surface (RP_S), one behind the other in memory.
class Executions {
 public:
  /// All but those in `left_out`, indices in ascending order; the others have `samples` poses.
  Executions(const std::vector<recordings::Execution>& executions, size_t samples,
             const std::vector<size_t>& left_out);

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

/// One surface of an experiment.
struct Ground {
  std::string surface;
  PatternSet averaged;               ///< IP_S
  std::vector<Pose2> averaged_ends;  ///< of it, by pattern
  std::vector<Executions> executions;
};

ExecutionEnd executionEnd(const learner::ConstTrajectory& trajectory);

/// Averages a set of recordings surface by surface and lays its recordings out for the experiment.
/** Throws recordings::RecordingError with one line if a pattern has too few executions or there is
 * one surface only. What is no fair execution is neither averaged nor driven; a line for each goes
 * to `notes`. */
std::vector<Ground> groundsOf(const recordings::PatternRecordings& recorded,
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

/// What the rule `bank` met on one surface of an excitation run.
struct ExcitationSegment {
  std::string surface;
  int executions = 0;
  int stored_after = 0;  ///< executions until it was put into the bank; 0 = it was not
};

/// The drive that fills a bank before a transition, and what the bank holds after it.
struct ExcitationRun {
  std::vector<ExcitationSegment> segments;
  std::vector<learner::RememberedSurface> stored;
  /// By stored surface: the surfaces whose recordings are likelier on it than on any other stored.
  std::vector<std::vector<std::string>> explains;
};

/// Surfaces of an excitation run: all but `home` and `unseen`, then `home` unless it is `unseen`.
struct ExcitationPlan {
  size_t home = 0;
  size_t unseen = 0;         ///< the number of surfaces = none is left out
  int64_t executions = 200;  ///< on each surface
};

/// Drives random patterns of the whole set on each surface, the others in random order.
std::vector<ExcitationSegment> driveExcitation(learner::LearningRule& rule,
                                               const std::vector<Ground>& grounds,
                                               const ExcitationPlan& plan, uint64_t seed);
/// One run of the rule `bank`, which begins with an empty bank and the home surface's set.
ExcitationRun excitationOfBank(const learner::RuleConfig& config,
                               const std::vector<Ground>& grounds, const ExcitationPlan& plan,
                               uint64_t seed);

/// Segments and stored surfaces of runs, with the corrections by name.
std::string textOfExcitation(const std::vector<ExcitationRun>& excitation, const PatternSet& set);

/// The right set from the beginning, learning off: column d of the paper's Table I.
inline constexpr const char* kOmniscient = "omniscient";
/// Rule `bank` on a surface that it has never met; `bank` itself has met it.
inline constexpr const char* kBankUnseen = "bank_unseen";
/// Rule `bank` as it begins: it has met nothing.
inline constexpr const char* kBankEmpty = "bank_empty";

/// All methods: the learner's rules and the three above.
std::vector<std::string> methodNames();

/// The methods that are compared, ready for a transition from surface A to surface B.
/** Each starts with IP_A; `bank` has driven an excitation run before, over all surfaces
 * (`bank_unseen`: all but B) and back to A. A = B is unchanged ground. */
class Methods {
 public:
  Methods(const std::vector<std::string>& names, const learner::RuleConfig& config,
          const std::vector<Ground>& grounds, size_t from, size_t to, int64_t excitation_executions,
          uint64_t excitation_seed);

  size_t size() const { return all_.size(); }
  /// All methods as they were before the transition; allocates nothing.
  void reset();
  Pose2 predictEnd(size_t i, size_t pattern) const {
    const Method& one = all_[i];
    return one.fixed != nullptr ? (*one.fixed)[pattern] : one.state->predictEnd(pattern);
  }
  void learn(size_t i, size_t pattern, const learner::ConstTrajectory& measured) {
    if (all_[i].state) all_[i].state->learn(pattern, measured, note_);
  }

 private:
  struct Method {
    const std::vector<Pose2>* fixed = nullptr;  ///< predictions that never change
    std::unique_ptr<learner::LearningRule> start;
    std::unique_ptr<learner::LearningRule> state;
  };

  std::vector<Method> all_;
  learner::RuleNote note_;
};

/// A value with its 99 % interval.
struct Estimate {
  double value = std::numeric_limits<double>::quiet_NaN();
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();
};

/// Sums of what rules erred and of what was covered meanwhile, over repetitions.
/** All rules see the same recordings, so that products of their errors are kept, too: the interval
 * of a reduction is that of paired trials. */
class RatioMoments {
 public:
  explicit RatioMoments(size_t rules = 0)
      : size_(rules + 1), sums_(size_), products_(size_ * size_) {}

  /// One repetition: metres or radians covered, and the summed error of each rule.
  void add(double covered, const double* errors);
  void add(const RatioMoments& other);

  double repetitions() const { return repetitions_; }
  /// Sum of errors over sum of what was covered; delta method over repetitions.
  Estimate error(size_t rule) const { return quotient(rule + 1, 0); }
  /// Error of a rule over that of another one.
  Estimate ratio(size_t rule, size_t other) const { return quotient(rule + 1, other + 1); }
  /// Standard deviation of a repetition's error, over the mean of what one covers.
  double deviation(size_t rule) const;

 private:
  Estimate quotient(size_t above, size_t below) const;
  double product(size_t i, size_t j) const {
    return products_[i < j ? i * size_ + j : j * size_ + i];
  }

  size_t size_;
  double repetitions_ = 0.0;
  std::vector<double> sums_;      ///< covered, then each rule's errors
  std::vector<double> products_;  ///< upper triangle of their products
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

/// Standard normal and Student's 99.5 % quantile; the second for means of `samples` values.
inline constexpr double kNormal99 = 2.5758293035489;
double student99(size_t samples);

/// Patterns by index, one after the other.
using Sequence = std::vector<size_t>;

/// Errors of all rules: per driven metre and per radian turned.
struct Errors {
  explicit Errors(size_t rules = 0) : position(rules), orientation(rules) {}
  void add(const Errors& other) {
    position.add(other.position);
    orientation.add(other.orientation);
  }
  RatioMoments position;     ///< [1] metres over metres of path
  RatioMoments orientation;  ///< [1] radians over radians of net yaw
};

/// Where trials happen: the surface left behind, the one that is driven on, and how often.
struct TrialSite {
  const Ground& from;
  const Ground& to;
  bool change_inside = false;  ///< the first execution drives its first half on `from`
  int64_t repetitions = 0;
  uint64_t seed = 0;
};

/// Errors over the test sequences and how they are distributed, by rule.
struct SequenceErrors {
  Errors errors;
  std::vector<Histogram> position;     ///< of single executions, per metre of each
  std::vector<Histogram> orientation;  ///< per radian

  void add(const SequenceErrors& other) {
    errors.add(other.errors);
    for (size_t i = 0; i < position.size(); ++i) {
      position[i].add(other.position[i]);
      orientation[i].add(other.orientation[i]);
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
std::vector<Errors> driveAllPatterns(Methods& methods, const TrialSite& site,
                                     const std::vector<Sequence>& sequences,
                                     const std::vector<int>& executions);

/// Errors of each of the first executions of the first sequence continued, without a reset.
std::vector<Errors> driveDevelopment(Methods& methods, const TrialSite& site,
                                     const std::vector<Sequence>& sequences, size_t executions);

/// Errors in the long run: the test sequences again and again, random patterns if there are none,
/// without a reset; the first executions do not count. A repetition is one such drive.
Errors driveLong(Methods& methods, const TrialSite& site, const std::vector<Sequence>& sequences);

/// How wide a pattern that is never executed is predicted, over its shipped width (sideways reach
/// of its end), before and after each execution of the test sequences on unchanged ground; by rule,
/// means over repetitions.
std::vector<std::vector<double>> driveDrift(Methods& methods, const TrialSite& site,
                                            const std::vector<Sequence>& sequences, size_t watched,
                                            size_t executions);

}  // namespace tread::experiment
