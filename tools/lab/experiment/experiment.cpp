// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/experiment/experiment.hpp"

#include "tools/lab/experiment/tables.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "common/parallel/parallel_for.hpp"
#include "tools/lab/experiment/rival_rule.hpp"

namespace tread::experiment {
namespace {

constexpr int64_t kSideRepetitions = 240;  // for results outside Tables I and II
constexpr int64_t kLongDrives = 16;        // minimum on each surface; fewer in a quick run
constexpr size_t kBins = 50;
constexpr double kBinsReach = 2.5;  // relative to the mean error without learning

enum class Trial : uint64_t {
  kSequences,
  kAllPatterns,
  kDevelopment,
  kLong,
  kLongSequences,
  kDrift,
  kFirst
};

/// Share of the i-th of `runs`.
int64_t share(int64_t repetitions, int64_t i, int64_t runs) {
  return repetitions * (i + 1) / runs - repetitions * i / runs;
}

/// Repetitions on each surface.
int64_t longDrives(int64_t repetitions) {
  constexpr int64_t kFewest = 2;
  return std::max(std::clamp(repetitions / 4, kFewest, kLongDrives), repetitions / 300);
}

/// Bins for single errors, from those without learning.
std::pair<Histogram, Histogram> binsFor(const TrialGround& from, const TrialGround& to,
                                        const std::vector<Sequence>& sequences) {
  double position = 0.0, orientation = 0.0, metres = 0.0, radians = 0.0;
  for (const Sequence& sequence : sequences)
    for (const size_t pattern : sequence) {
      const Executions& executions = to.tests[pattern];
      for (size_t i = 0; i < executions.size(); ++i) {
        const ExecutionEnd& end = executions.endOf(i);
        const Pose2& predicted = from.averaged_ends[pattern];
        position += (predicted.position() - end.pose.position()).norm();
        orientation += std::abs(wrapAngle(predicted.yaw - end.pose.yaw));
        metres += end.metres;
        radians += end.radians;
      }
    }
  const auto bins = [](double error, double covered) {
    const double mean = covered > 0.0 && error > 0.0 ? error / covered : 1.0;
    return Histogram{kBinsReach * mean / static_cast<double>(kBins),
                     std::vector<double>(kBins, 0.0)};
  };
  return {bins(position, metres), bins(orientation, radians)};
}

/// Results after one excitation run from a surface to another.
struct RunErrors {
  SequenceErrors sequences;
  std::vector<MethodErrors> all_patterns;
  std::vector<MethodErrors> development;
  FirstExecutions first;
  std::vector<int> remembered;
};

using Drift = std::vector<std::vector<double>>;  // [method][execution]

/// Results after one excitation run on unchanged ground.
struct UnchangedErrors {
  MethodErrors random;
  MethodErrors sequences;
  FirstExecutions first;
  Drift drift;  ///< empty if no pattern is watched
};

/// All trials as tasks whose results are stored separately and merged in order. Each excitation run
/// is a task with its own seeds, so results do not depend on threads.
class Schedule {
 public:
  Schedule(const std::vector<TrialGround>& grounds, const ExperimentSettings& settings)
      : grounds_(grounds),
        settings_(settings),
        runs_(std::min(settings.excitations, settings.repetitions)),
        long_drives_(longDrives(settings.repetitions)),
        long_runs_(std::min({settings.excitations, kLongDrives, long_drives_})) {
    for (size_t from = 0; from < grounds.size(); ++from)
      for (size_t to = 0; to < grounds.size(); ++to)
        if (from != to) transitions_.push_back({from, to, {}});
    for (Transition& transition : transitions_) addTransition(transition);
    unchanged_.resize(grounds.size());
    for (size_t s = 0; s < grounds.size(); ++s) addUnchanged(s);
    rivals_.resize(grounds.size() * grounds.size());
    // Tuned first, because all excitation runs of a transition share them.
    onThreads(settings.threads)(rivals_.size(), [&](size_t i) {
      rivals_[i] = tunedRivals(settings.rules, grounds, i / grounds.size(), i % grounds.size());
    });
  }

  const std::vector<std::function<void()>>& tasks() const { return tasks_; }
  ExperimentErrors errors() const;

 private:
  struct Transition {
    size_t from, to;
    std::vector<RunErrors> runs;
  };

  Methods methods(size_t from, size_t to, int64_t run) const {
    return Methods(
        settings_.rules, settings_.config, grounds_, from, to,
        {settings_.excitation, seedOf({settings_.seed, 1, from, to, static_cast<uint64_t>(run)})},
        rivals_[from * grounds_.size() + to]);
  }
  TrialSite site(size_t from, size_t to, Trial trial, int64_t run, int64_t repetitions) const {
    return {grounds_[from], grounds_[to], settings_.change_inside && from != to, repetitions,
            seedOf({settings_.seed, 2, from, to, static_cast<uint64_t>(trial),
                    static_cast<uint64_t>(run)})};
  }
  /// Repetitions for results outside Tables I and II.
  int64_t side() const {
    return std::max(std::min(settings_.repetitions, kSideRepetitions), settings_.repetitions / 10);
  }
  void addTransition(Transition& transition);
  RunErrors driveTransition(size_t from, size_t to, int64_t run) const;
  void addUnchanged(size_t surface);

  const std::vector<TrialGround>& grounds_;
  const ExperimentSettings& settings_;
  int64_t runs_, long_drives_, long_runs_;
  std::vector<Rivals> rivals_;  ///< [from * surfaces + to]
  std::vector<Transition> transitions_;
  std::vector<std::vector<UnchangedErrors>> unchanged_;  ///< [surface][run]
  std::vector<std::function<void()>> tasks_;
};

void Schedule::addTransition(Transition& transition) {
  transition.runs.resize(static_cast<size_t>(runs_));
  for (int64_t run = 0; run < runs_; ++run)
    tasks_.push_back([this, &transition, run] {
      transition.runs[static_cast<size_t>(run)] =
          driveTransition(transition.from, transition.to, run);
    });
}

RunErrors Schedule::driveTransition(size_t from, size_t to, int64_t run) const {
  Methods all = methods(from, to, run);
  const auto siteOf = [&](Trial trial, int64_t repetitions) {
    return site(from, to, trial, run, share(repetitions, run, runs_));
  };
  const auto bins = binsFor(grounds_[from], grounds_[to], settings_.sequences);
  RunErrors errors;
  errors.sequences = driveSequences(all, siteOf(Trial::kSequences, settings_.repetitions),
                                    settings_.sequences, bins.first, bins.second);
  errors.all_patterns = driveAllPatterns(all, siteOf(Trial::kAllPatterns, side()),
                                         settings_.sequences, settings_.all_patterns_after);
  errors.development = driveDevelopment(all, siteOf(Trial::kDevelopment, side()),
                                        settings_.sequences, settings_.development);
  errors.first = driveFirstExecutions(all, siteOf(Trial::kFirst, side()));
  for (size_t i = 0; i < all.size(); ++i) errors.remembered.push_back(all.remembered(i));
  return errors;
}

void Schedule::addUnchanged(size_t surface) {
  unchanged_[surface].resize(static_cast<size_t>(long_runs_));
  for (int64_t run = 0; run < long_runs_; ++run)
    tasks_.push_back([this, surface, run] {
      Methods all = methods(surface, surface, run);
      const int64_t drives = share(long_drives_, run, long_runs_);
      const auto siteOf = [&](Trial trial) { return site(surface, surface, trial, run, drives); };
      UnchangedErrors& errors = unchanged_[surface][static_cast<size_t>(run)];
      errors.random = driveLong(all, siteOf(Trial::kLong), {});
      errors.sequences = driveLong(all, siteOf(Trial::kLongSequences), settings_.sequences);
      errors.first = driveFirstExecutions(
          all, site(surface, surface, Trial::kFirst, run, share(side(), run, long_runs_)));
      if (const auto watched = neverExecuted(grounds_[surface], settings_.sequences))
        errors.drift =
            driveDrift(all, siteOf(Trial::kDrift), settings_.sequences, *watched, settings_.drift);
    });
}

/// Adds a run's errors element by element.
void addRun(const std::vector<MethodErrors>& run, std::vector<MethodErrors>& sums, size_t methods) {
  sums.resize(run.size(), MethodErrors(methods));
  for (size_t i = 0; i < run.size(); ++i) sums[i].addRun(run[i]);
}

/// Element-wise mean.
Drift meanDrift(const std::vector<const Drift*>& drifts) {
  Drift mean;
  for (const Drift* one : drifts) {
    if (mean.empty()) mean.assign(one->size(), std::vector<double>(one->front().size(), 0.0));
    for (size_t i = 0; i < one->size(); ++i)
      for (size_t j = 0; j < (*one)[i].size(); ++j)
        mean[i][j] += (*one)[i][j] / static_cast<double>(drifts.size());
  }
  return mean;
}

ExperimentErrors Schedule::errors() const {
  const size_t methods = settings_.rules.size();
  ExperimentErrors all;
  for (const Transition& transition : transitions_) {
    const auto bins =
        binsFor(grounds_[transition.from], grounds_[transition.to], settings_.sequences);
    TransitionErrors sums{transition.from,
                          transition.to,
                          {MethodErrors(methods), std::vector<Histogram>(methods, bins.first),
                           std::vector<Histogram>(methods, bins.second)},
                          {},
                          {},
                          FirstExecutions(methods),
                          std::vector<double>(methods, 0.0)};
    for (const RunErrors& run : transition.runs) {
      sums.sequences.addRun(run.sequences);
      addRun(run.all_patterns, sums.all_patterns, methods);
      addRun(run.development, sums.development, methods);
      sums.first.addRun(run.first);
      for (size_t i = 0; i < methods; ++i)
        sums.remembered[i] += run.remembered[i] / static_cast<double>(transition.runs.size());
    }
    all.transitions.push_back(std::move(sums));
  }
  std::vector<const Drift*> drifts;
  for (const std::vector<UnchangedErrors>& runs : unchanged_) {
    MethodErrors random(methods), sequences(methods);
    FirstExecutions first(methods);
    for (const UnchangedErrors& run : runs) {
      random.addRun(run.random);
      sequences.addRun(run.sequences);
      first.addRun(run.first);
      if (!run.drift.empty()) drifts.push_back(&run.drift);
    }
    all.unchanged.push_back(std::move(random));
    all.unchanged_sequences.push_back(std::move(sequences));
    all.unchanged_first.push_back(std::move(first));
  }
  all.drift = meanDrift(drifts);
  return all;
}

}  // namespace

size_t ExperimentSettings::ruleIndex(const std::string& name) const {
  return static_cast<size_t>(std::find(rules.begin(), rules.end(), name) - rules.begin());
}

std::optional<size_t> neverExecuted(const TrialGround& ground,
                                    const std::vector<Sequence>& sequences) {
  constexpr double kLeastWidth = 0.02;  // [m]
  std::optional<size_t> widest;
  for (size_t p = 0; p < ground.averaged_ends.size(); ++p) {
    const double width = std::abs(ground.averaged_ends[p].y);
    if (width < kLeastWidth) continue;
    if (widest && width <= std::abs(ground.averaged_ends[*widest].y)) continue;
    const bool executed =
        std::any_of(sequences.begin(), sequences.end(), [&](const Sequence& sequence) {
          return std::find(sequence.begin(), sequence.end(), p) != sequence.end();
        });
    if (!executed) widest = p;
  }
  return widest;
}

ExperimentErrors runExperiment(const std::vector<TrialGround>& grounds,
                               const ExperimentSettings& settings, const Progress& progress) {
  const Schedule schedule(grounds, settings);
  const auto& tasks = schedule.tasks();
  std::mutex mutex;  // guards what follows
  size_t done = 0;
  onThreads(settings.threads)(tasks.size(), [&](size_t i) {
    tasks[i]();
    const std::lock_guard<std::mutex> lock(mutex);
    ++done;
    if (progress) progress(done, tasks.size());
  });
  return schedule.errors();
}

}  // namespace tread::experiment
