// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/pattern_recorder/core/tour.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace tread::pattern_recorder {
namespace {

constexpr int kMaxDepth = 6;
constexpr int kMaxExpansions = 20'000;  // about two milliseconds
constexpr double kTimeCost = 0.05;      // [1/s]
constexpr double kFarCost = 0.5;        // at the border of the room
constexpr double kLagGain = 0.5;        // for the pattern that lags behind most
constexpr double kLaterShare = 0.9;     // what the next pattern counts of the one before

double distance(const Pose2& T_home_body) {
  return std::hypot(T_home_body.x, T_home_body.y);
}

}  // namespace

/// Depth-first search over chains, deeper and deeper; keeps the first pattern of the best one.
struct Tour::Search {
  const Tour& tour;
  std::vector<int> needed;
  double most_needed;
  double limit;  // [m] for the place where it would stand
  int expansions = 0;
  double best_value = -std::numeric_limits<double>::infinity();
  std::optional<size_t> best_first;

  Search(const Tour& of, const std::vector<int>& still_needed, double stands_within)
      : tour(of),
        needed(still_needed),
        most_needed(*std::max_element(needed.begin(), needed.end())),
        limit(stands_within) {}

  void run(size_t motion_class, const Pose2& T_home_body) {
    std::optional<size_t> found;
    for (int depth = 1; depth <= kMaxDepth && expansions < kMaxExpansions; ++depth) {
      best_value = -std::numeric_limits<double>::infinity();
      best_first.reset();
      extend(motion_class, T_home_body, depth, 0.0, 1.0, std::nullopt);
      // A search that was cut short has not looked at everything: the one before counts.
      if (expansions < kMaxExpansions || !found) found = best_first;
    }
    best_first = found;
  }

  void extend(size_t motion_class, const Pose2& T_home_body, int depth, double value, double share,
              std::optional<size_t> first) {
    for (const Step& step : tour.steps_[motion_class]) {
      if (++expansions >= kMaxExpansions) return;
      const Pose2 T_home_end = T_home_body * step.T_start_end;
      if (distance(T_home_end * tour.ways_[step.to].T_start_end) > limit) continue;
      const double gained = value - kTimeCost * step.duration + share * gain(step.pattern);
      const size_t chain_first = first.value_or(step.pattern);
      note(gained - kFarCost * std::pow(distance(T_home_end) / limit, 2), chain_first);
      if (depth == 1) continue;
      --needed[step.pattern];
      extend(step.to, T_home_end, depth - 1, gained, share * kLaterShare, chain_first);
      ++needed[step.pattern];
    }
  }

  double gain(size_t pattern) const {
    const int times = needed[pattern];
    return times > 0 ? 1.0 + kLagGain * times / most_needed : 0.0;
  }

  void note(double value, size_t first) {
    if (value <= best_value) return;
    best_value = value;
    best_first = first;
  }
};

Tour::Tour(const PatternSet& set, double room) : room_(room) {
  const std::vector<MotionClass>& classes = set.content().classes;
  standing_ = classes.size();
  for (size_t c = 0; c < classes.size(); ++c) {
    class_names_.push_back(classes[c].name);
    if (standing_ == classes.size() && classes[c].steady == TrackCommand{}) standing_ = c;
  }
  if (standing_ == classes.size())
    throw std::runtime_error("no class of set '" + set.content().name +
                             "' stands still (steady command 0, 0): nothing to begin and end with");
  steps_.resize(classes.size());
  for (size_t p = 0; p < set.patterns().size(); ++p) {
    const MotionPattern& pattern = set.patterns()[p];
    steps_[classIndex(pattern.entry_class)].push_back(
        {p, classIndex(pattern.exit_class), pattern.end(),
         static_cast<double>(pattern.commands.size()) * set.periodSeconds()});
  }
  findWays();
  requireConnected(set);
}

size_t Tour::classIndex(const std::string& name) const {
  const auto found = std::find(class_names_.begin(), class_names_.end(), name);
  return static_cast<size_t>(found - class_names_.begin());
}

/// Bellman and Ford: patterns are few.
void Tour::findWays() {
  ways_.assign(class_names_.size(), {});
  ways_[standing_].duration = 0.0;
  for (size_t round = 0; round < class_names_.size(); ++round)
    for (size_t from = 0; from < steps_.size(); ++from)
      for (const Step& step : steps_[from]) {
        const Way& rest = ways_[step.to];
        if (rest.duration < 0.0) continue;
        const double duration = step.duration + rest.duration;
        if (ways_[from].duration >= 0.0 && ways_[from].duration <= duration) continue;
        ways_[from] = {duration, step.T_start_end * rest.T_start_end, step.pattern};
      }
}

void Tour::requireConnected(const PatternSet& set) const {
  const std::set<std::string> reached = connectedClasses(set, {standing()}, false);
  for (size_t c = 0; c < class_names_.size(); ++c) {
    const std::string which =
        "class '" + class_names_[c] + "' of set '" + set.content().name + "' ";
    if (reached.count(class_names_[c]) == 0)
      throw std::runtime_error(which +
                               "cannot be reached from standing: add a pattern that leads "
                               "into it");
    if (ways_[c].duration < 0.0)
      throw std::runtime_error(which + "cannot be left: add a pattern that leads to standing");
  }
}

std::optional<size_t> Tour::next(const std::string& motion_class, const Pose2& T_home_body,
                                 const std::vector<int>& needed) const {
  const size_t from = classIndex(motion_class);
  if (*std::max_element(needed.begin(), needed.end()) <= 0) return ways_[from].first;
  // Where it is too far away already, no pattern may lead farther.
  const double stands_at = distance(T_home_body * ways_[from].T_start_end);
  Search search(*this, needed, std::max(room_, stands_at + 1e-9));
  search.run(from, T_home_body);
  return search.best_first ? search.best_first : ways_[from].first;
}

}  // namespace tread::pattern_recorder
