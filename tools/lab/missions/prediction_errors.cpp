// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/missions/prediction_errors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace tread::missions {
namespace {

using Executions = std::vector<const ScoredExecution*>;

/// Sums for means.
struct ErrorSums {
  MeanError error;
  double metres = 0.0;
  double radians = 0.0;

  void add(const ScoredExecution& execution, uint64_t seed, const ErrorOf& errorOf) {
    const auto at_end = errorOf(execution, seed);
    if (!at_end) return;
    ++error.count;
    error.position += at_end->position;
    error.yaw += std::abs(at_end->yaw);
    metres += execution.path_length;
    radians += execution.turned;
  }

  /// Executions with index first..last (1-based), clipped to the existing ones.
  void add(const Executions& executions, uint64_t seed, size_t first, size_t last,
           const ErrorOf& errorOf) {
    for (size_t i = first; i <= std::min(last, executions.size()); ++i)
      add(*executions[i - 1], seed, errorOf);
  }

  MeanError mean() const {
    MeanError mean = error;
    if (metres > 0.0) mean.position_per_m = error.position / metres;
    if (radians > 0.0) mean.yaw_per_rad = error.yaw / radians;
    if (error.count > 0) mean.position /= error.count;
    if (error.count > 0) mean.yaw /= error.count;
    return mean;
  }
};

struct SumsAround {
  ErrorSums before, after, first, next, settled;

  void add(const MissionResult& result, size_t change, const ErrorOf& error) {
    const Executions on_old = segmentOf(result, change);
    const Executions on_new = segmentOf(result, change + 1);
    before.add(on_old, result.seed, on_old.size() > 5 ? on_old.size() - 4 : 1, on_old.size(),
               error);
    after.add(on_new, result.seed, 1, 3, error);
    first.add(on_new, result.seed, 1, 1, error);
    next.add(on_new, result.seed, 2, 3, error);
    settled.add(on_new, result.seed, 5, 15, error);
  }
  ErrorsAroundChanges means() const {
    return {before.mean(), after.mean(), first.mean(), next.mean(), settled.mean()};
  }
};

/// Adds a mission's executions whose index since the last change is within [first, last].
void addAfterChanges(const MissionResult& result, int first, int last,
                     std::map<std::pair<std::string, std::string>, ErrorSums>& sums) {
  size_t change = 0;
  std::pair<std::string, std::string> pair{"start", ""};
  int index = 0;
  for (const ScoredExecution& execution : result.executions) {
    while (change < result.crossings.size() && result.crossings[change].time <= execution.time) {
      pair = {result.crossings[change].from, result.crossings[change].to};
      index = 0;
      ++change;
    }
    if (!execution.measured || execution.surface.empty()) continue;
    if (pair.first == "start") pair.second = execution.surface;
    if (execution.surface != pair.second) continue;
    ++index;
    if (index < first || index > last) continue;
    sums[pair].add(execution, result.seed, errorAsDriven());
  }
}

}  // namespace

std::vector<const ScoredExecution*> segmentOf(const MissionResult& result, size_t index) {
  const auto& changes = result.crossings;
  const double from = index == 0 ? -1.0 : changes[index - 1].time;
  const double to =
      index < changes.size() ? changes[index].time : std::numeric_limits<double>::infinity();
  Executions executions;
  for (const ScoredExecution& execution : result.executions)
    if (execution.measured && !execution.surface.empty() && execution.time > from &&
        execution.time <= to)
      executions.push_back(&execution);
  return executions;
}

ErrorOf errorAsDriven() {
  return [](const ScoredExecution& execution, uint64_t) -> std::optional<report::PredictionError> {
    if (!execution.measured) return std::nullopt;
    return report::PredictionError{execution.error_position, execution.error_yaw};
  };
}

ErrorOf errorByRule(size_t rule) {
  return
      [rule](const ScoredExecution& execution, uint64_t) -> std::optional<report::PredictionError> {
        if (rule >= execution.by_rule.size()) return std::nullopt;
        return execution.by_rule[rule];
      };
}

ErrorsAroundChanges errorsAroundChange(const MissionResult& result, size_t change) {
  SumsAround sums;
  sums.add(result, change, errorAsDriven());
  return sums.means();
}

ErrorsAroundChanges errorsAroundChanges(const std::vector<MissionResult>& results,
                                        const ErrorOf& error) {
  SumsAround sums;
  for (const MissionResult& result : results)
    for (size_t change = 0; change < result.crossings.size(); ++change)
      sums.add(result, change, error);
  return sums.means();
}

MeanError meanErrorOf(const std::vector<MissionResult>& results, const ErrorOf& error) {
  ErrorSums all;
  for (const MissionResult& result : results)
    for (size_t index = 0; index <= result.crossings.size(); ++index) {
      const Executions executions = segmentOf(result, index);
      all.add(executions, result.seed, 1, executions.size(), error);
    }
  return all.mean();
}

std::vector<ErrorAfterChange> errorsAfterChange(const std::vector<MissionResult>& results,
                                                int first, int last) {
  std::map<std::pair<std::string, std::string>, ErrorSums> sums;
  for (const MissionResult& result : results) addAfterChanges(result, first, last, sums);
  std::vector<ErrorAfterChange> errors;
  for (const auto& [pair, sum] : sums) errors.push_back({sum.mean(), pair.first, pair.second});
  return errors;
}

namespace {

constexpr size_t kKnownAfter = 10;     ///< executions on a surface after which it counts as known
constexpr size_t kFewestChanges = 10;  ///< changes needed for a pooled ratio

/// Errors of a rule and of the oracle in one execution.
struct Pair {
  double position, yaw;
  double best_position, best_yaw;

  void add(const Pair& other) {
    position += other.position;
    yaw += other.yaw;
    best_position += other.best_position;
    best_yaw += other.best_yaw;
  }
};

using Segment = std::vector<Pair>;

Pair window(const Segment& segment, size_t from) {
  Pair sum{0.0, 0.0, 0.0, 0.0};
  for (size_t i = from; i < from + Settling::kWindow; ++i) sum.add(segment[i]);
  return sum;
}

size_t windowsIn(const Segment& segment) {
  return segment.size() < Settling::kWindow ? 0 : segment.size() - Settling::kWindow + 1;
}

bool within(double error, double best) {
  return error <= Settling::kWithin * best;
}

/// Index of the first window that meets a condition, or of the last one if none does (censored).
template <class Condition>
std::pair<int, bool> timeOf(const Segment& segment, Condition condition) {
  const size_t windows = windowsIn(segment);
  for (size_t n = 0; n < windows; ++n)
    if (condition(window(segment, n))) return {static_cast<int>(n), true};
  return {static_cast<int>(windows) - 1, false};
}

bool counts(const MissionResult& result, size_t change, Met met) {
  if (met == Met::kAny) return true;
  size_t before = 0;
  bool met_before = false;
  for (size_t i = 0; i <= change; ++i) {
    if (result.crossings[i].from != result.crossings[change].to) continue;
    met_before = true;
    before += segmentOf(result, i).size();
  }
  return met == Met::kFirst ? !met_before : before >= kKnownAfter;
}

Segment segmentAfter(const MissionResult& result, size_t change, const ErrorOf& errorOf,
                     const Omniscient& omniscient) {
  Segment segment;
  for (const ScoredExecution* execution : segmentOf(result, change + 1)) {
    if (execution->surface != result.crossings[change].to) continue;
    const auto error = errorOf(*execution, result.seed);
    const auto best = omniscient.errorOf(*execution, result.seed);
    if (error && best)
      segment.push_back(
          {error->position, std::abs(error->yaw), best->position, std::abs(best->yaw)});
  }
  return segment;
}

void fillRatios(const std::vector<Segment>& segments, Settling& settling) {
  for (size_t n = 0;; ++n) {
    Pair sum{0.0, 0.0, 0.0, 0.0};
    size_t changes = 0;
    for (const Segment& segment : segments) {
      if (n >= windowsIn(segment)) continue;
      sum.add(window(segment, n));
      ++changes;
    }
    if (changes < kFewestChanges) return;
    settling.position_ratio.push_back(sum.position / sum.best_position);
    settling.yaw_ratio.push_back(sum.yaw / sum.best_yaw);
  }
}

}  // namespace

void Omniscient::Ends::add(const Pose2& end) {
  ++count;
  x += end.x;
  y += end.y;
  yaw += end.yaw;
}

void Omniscient::Ends::remove(const Ends& other) {
  count -= other.count;
  x -= other.x;
  y -= other.y;
  yaw -= other.yaw;
}

void Omniscient::add(const MissionResult& result) {
  for (const ScoredExecution& execution : result.executions) {
    if (!execution.measured || execution.surface.empty()) continue;
    const Key key{execution.surface, execution.pattern};
    all_[key].add(execution.measured_end);
    by_seed_[result.seed][key].add(execution.measured_end);
  }
}

std::optional<report::PredictionError> Omniscient::errorOf(const ScoredExecution& execution,
                                                           uint64_t seed) const {
  const Key key{execution.surface, execution.pattern};
  const auto known = all_.find(key);
  if (known == all_.end()) return std::nullopt;
  Ends ends = known->second;
  const auto own = by_seed_.find(seed);
  if (own != by_seed_.end() && own->second.count(key) > 0) ends.remove(own->second.at(key));
  if (ends.count < kFewest) return std::nullopt;
  const Pose2& end = execution.measured_end;
  return report::PredictionError{
      std::hypot(end.x - ends.x / ends.count, end.y - ends.y / ends.count),
      wrapAngle(end.yaw - ends.yaw / ends.count)};
}

double medianTime(std::vector<std::pair<int, bool>> times) {
  std::sort(times.begin(), times.end());
  double waiting = 1.0;
  for (size_t i = 0; i < times.size();) {
    const auto at_risk = static_cast<double>(times.size() - i);
    const int time = times[i].first;
    int reached = 0;
    for (; i < times.size() && times[i].first == time; ++i) reached += times[i].second ? 1 : 0;
    waiting *= 1.0 - reached / at_risk;
    if (waiting <= 0.5 + 1e-12) return time;
  }
  return std::numeric_limits<double>::infinity();
}

Settling settlingOf(const std::vector<MissionResult>& results, const ErrorOf& error,
                    const Omniscient& omniscient, Met met) {
  Settling settling;
  std::vector<Segment> segments;
  std::set<uint64_t> missions;
  std::vector<std::pair<int, bool>> position, yaw, both;
  for (const MissionResult& result : results)
    for (size_t change = 0; change < result.crossings.size(); ++change) {
      if (!counts(result, change, met)) continue;
      Segment segment = segmentAfter(result, change, error, omniscient);
      if (windowsIn(segment) == 0) continue;
      const auto in_position = [](const Pair& w) { return within(w.position, w.best_position); };
      const auto in_yaw = [](const Pair& w) { return within(w.yaw, w.best_yaw); };
      position.push_back(timeOf(segment, in_position));
      yaw.push_back(timeOf(segment, in_yaw));
      both.push_back(timeOf(segment, [&](const Pair& w) { return in_position(w) && in_yaw(w); }));
      segments.push_back(std::move(segment));
      missions.insert(result.seed);
    }
  settling.missions = static_cast<int>(missions.size());
  settling.changes = static_cast<int>(segments.size());
  settling.position = medianTime(std::move(position));
  settling.yaw = medianTime(std::move(yaw));
  settling.both = medianTime(std::move(both));
  fillRatios(segments, settling);
  return settling;
}

}  // namespace tread::missions
