// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/experiment/tables.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "common/parallel/parallel_for.hpp"
#include "tools/experiment/trials.hpp"

namespace tread::experiment {
namespace {

// A fixed number of parts, each with seeds of its own: threads have no influence on numbers.
constexpr size_t kSequenceParts = 12;
constexpr size_t kSideParts = 4;
constexpr int64_t kDriftDrives = 20;  // on each surface
constexpr size_t kBins = 50;
constexpr double kBinsReach = 2.5;  // times the mean error without learning

enum class Trial : uint64_t {
  kSequences,
  kAllPatterns,
  kDevelopment,
  kLong,
  kLongSequences,
  kDrift
};

/// Repetitions of what is not in the tables.
int64_t sideRepetitions(const ExperimentSettings& settings) {
  return std::max(std::min<int64_t>(settings.repetitions, 500), settings.repetitions / 10);
}

/// Of the part-th of `parts`.
int64_t share(int64_t repetitions, size_t part, size_t parts) {
  const auto p = static_cast<int64_t>(part), n = static_cast<int64_t>(parts);
  return repetitions * (p + 1) / n - repetitions * p / n;
}

/// Bins for the errors of single executions, from those without learning.
std::pair<Histogram, Histogram> binsFor(const Ground& from, const Ground& to,
                                        const std::vector<Sequence>& sequences) {
  double position = 0.0, orientation = 0.0, metres = 0.0, radians = 0.0;
  for (const Sequence& sequence : sequences)
    for (const size_t pattern : sequence) {
      const Executions& executions = to.executions[pattern];
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

/// All trials as tasks, their results in places of their own, put together in order afterwards.
class Schedule {
 public:
  Schedule(const std::vector<Ground>& grounds, const ExperimentSettings& settings)
      : grounds_(grounds), settings_(settings) {
    for (size_t from = 0; from < grounds.size(); ++from)
      for (size_t to = 0; to < grounds.size(); ++to)
        if (from != to) parts_.push_back({from, to, {}, {}, {}});
    const std::vector<Errors> surfaces(grounds.size());
    long_parts_.assign(kSideParts, surfaces);
    sequence_parts_.assign(kSideParts, surfaces);
    drift_parts_.resize(grounds.size());
    for (TransitionParts& parts : parts_) addTransition(parts);
    for (size_t s = 0; s < grounds.size(); ++s) {
      addLong(s);
      addDrift(s);
    }
  }

  const std::vector<std::function<void()>>& tasks() const { return tasks_; }
  ExperimentErrors errors() const;

 private:
  struct TransitionParts {
    size_t from, to;
    std::vector<std::optional<SequenceErrors>> sequences;
    std::vector<std::vector<Errors>> all_patterns;
    std::vector<std::vector<Errors>> development;
  };

  Methods methods(size_t from, size_t to, size_t part) const {
    return Methods(settings_.rules, settings_.config, grounds_, from, to, settings_.excitation,
                   seedOf({settings_.seed, 1, from, to, part}));
  }
  TrialSite site(size_t from, size_t to, Trial trial, size_t part, int64_t repetitions) const {
    return {grounds_[from], grounds_[to], settings_.change_inside && from != to, repetitions,
            seedOf({settings_.seed, 2, from, to, static_cast<uint64_t>(trial), part})};
  }
  void addTransition(TransitionParts& parts);
  void addSide(TransitionParts& parts, size_t part);
  void addLong(size_t surface);
  void addDrift(size_t surface);

  const std::vector<Ground>& grounds_;
  const ExperimentSettings& settings_;
  std::vector<TransitionParts> parts_;
  std::vector<std::vector<Errors>> long_parts_;                ///< [part][surface]
  std::vector<std::vector<Errors>> sequence_parts_;            ///< [part][surface]
  std::vector<std::vector<std::vector<double>>> drift_parts_;  ///< [surface][method][execution]
  std::vector<std::function<void()>> tasks_;
};

void Schedule::addTransition(TransitionParts& parts) {
  parts.sequences.resize(kSequenceParts);
  parts.all_patterns.resize(kSideParts);
  parts.development.resize(kSideParts);
  for (size_t part = 0; part < kSequenceParts; ++part)
    tasks_.push_back([this, &parts, part] {
      Methods rules = methods(parts.from, parts.to, part);
      const auto bins = binsFor(grounds_[parts.from], grounds_[parts.to], settings_.sequences);
      parts.sequences[part] =
          driveSequences(rules,
                         site(parts.from, parts.to, Trial::kSequences, part,
                              share(settings_.repetitions, part, kSequenceParts)),
                         settings_.sequences, bins.first, bins.second);
    });
  for (size_t part = 0; part < kSideParts; ++part) addSide(parts, part);
}

void Schedule::addSide(TransitionParts& parts, size_t part) {
  tasks_.push_back([this, &parts, part] {
    Methods rules = methods(parts.from, parts.to, part);
    const int64_t repetitions = share(sideRepetitions(settings_), part, kSideParts);
    parts.all_patterns[part] =
        driveAllPatterns(rules, site(parts.from, parts.to, Trial::kAllPatterns, part, repetitions),
                         settings_.sequences, settings_.all_patterns_after);
    parts.development[part] =
        driveDevelopment(rules, site(parts.from, parts.to, Trial::kDevelopment, part, repetitions),
                         settings_.sequences, settings_.development);
  });
}

void Schedule::addLong(size_t surface) {
  for (size_t part = 0; part < kSideParts; ++part)
    tasks_.push_back([this, surface, part] {
      Methods rules = methods(surface, surface, part);
      const int64_t drives = std::max<int64_t>(8, sideRepetitions(settings_) / 30);
      const int64_t of_part = share(drives, part, kSideParts);
      long_parts_[part][surface] =
          driveLong(rules, site(surface, surface, Trial::kLong, part, of_part), {});
      sequence_parts_[part][surface] = driveLong(
          rules, site(surface, surface, Trial::kLongSequences, part, of_part), settings_.sequences);
    });
}

void Schedule::addDrift(size_t surface) {
  tasks_.push_back([this, surface] {
    const std::optional<size_t> watched = neverExecuted(grounds_[surface], settings_.sequences);
    if (!watched) return;
    Methods rules = methods(surface, surface, 0);
    drift_parts_[surface] =
        driveDrift(rules, site(surface, surface, Trial::kDrift, 0, kDriftDrives),
                   settings_.sequences, *watched, settings_.drift);
  });
}

/// Sums over the parts, number by number.
std::vector<Errors> sum(const std::vector<std::vector<Errors>>& parts) {
  std::vector<Errors> sums = parts.front();
  for (size_t part = 1; part < parts.size(); ++part)
    for (size_t i = 0; i < sums.size(); ++i) sums[i].add(parts[part][i]);
  return sums;
}

/// By rule and execution, over those surfaces that have a pattern to watch.
std::vector<std::vector<double>> meanDrift(
    const std::vector<std::vector<std::vector<double>>>& surfaces) {
  std::vector<std::vector<double>> mean;
  double count = 0.0;
  for (const auto& one : surfaces) count += one.empty() ? 0.0 : 1.0;
  for (const auto& one : surfaces) {
    if (one.empty()) continue;
    if (mean.empty()) mean.assign(one.size(), std::vector<double>(one.front().size(), 0.0));
    for (size_t i = 0; i < one.size(); ++i)
      for (size_t j = 0; j < one[i].size(); ++j) mean[i][j] += one[i][j] / count;
  }
  return mean;
}

ExperimentErrors Schedule::errors() const {
  ExperimentErrors all;
  for (const TransitionParts& parts : parts_) {
    SequenceErrors sums = *parts.sequences.front();
    for (size_t part = 1; part < parts.sequences.size(); ++part) sums.add(*parts.sequences[part]);
    all.transitions.push_back(
        {parts.from, parts.to, std::move(sums), sum(parts.all_patterns), sum(parts.development)});
  }
  all.unchanged = sum(long_parts_);
  all.unchanged_sequences = sum(sequence_parts_);
  all.drift = meanDrift(drift_parts_);
  return all;
}

}  // namespace

size_t ExperimentSettings::ruleIndex(const std::string& name) const {
  return static_cast<size_t>(std::find(rules.begin(), rules.end(), name) - rules.begin());
}

std::optional<size_t> neverExecuted(const Ground& ground, const std::vector<Sequence>& sequences) {
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

ExperimentErrors runExperiment(const std::vector<Ground>& grounds,
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
