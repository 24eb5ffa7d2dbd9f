// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/hand_watch.hpp"

#include <algorithm>
#include <cmath>

namespace tread::learner {
namespace {

constexpr int64_t kSteady = 500'000;   // [us] of the entry class's command before a pattern
constexpr int64_t kEdge = 15'000;      // [us] by which a change may be early or late
constexpr int64_t kSilent = 200'000;   // [us] between two commands: what was given is not known
constexpr int64_t kKept = 70'000'000;  // [us] longer than any series
constexpr double kSameCommand = 2e-3;  // MOTOR is single precision, a Roboteq takes thousandths

}  // namespace

void HandWatch::add(const GivenCommand& given, bool lost) {
  if (!given_.empty() && given.utime <= newest_) return;
  if (lost || given.utime - newest_ > kSilent) {
    given_.clear();
    start_ = given.utime;
  }
  newest_ = given.utime;
  const bool same = !given_.empty() && given_.back().command == given.command &&
                    given_.back().by_hand == given.by_hand;
  if (!same) given_.push_back(given);
  while (given_.size() > 1 && given_[1].utime < std::min(newest_ - kKept, start_ - 2 * kSteady))
    given_.pop_front();
}

const GivenCommand* HandWatch::at(int64_t utime) const {
  const auto after = std::upper_bound(
      given_.begin(), given_.end(), utime,
      [](int64_t time, const GivenCommand& command) { return time < command.utime; });
  return after == given_.begin() ? nullptr : &*std::prev(after);
}

bool HandWatch::given(const TrackCommand& command, int64_t utime) const {
  const GivenCommand* found = at(utime);
  return found != nullptr && std::abs(found->command.left - command.left) <= kSameCommand &&
         std::abs(found->command.right - command.right) <= kSameCommand;
}

bool HandWatch::steadyBefore(const TrackCommand& command, int64_t utime, int64_t period_us) const {
  for (int64_t before = utime - kSteady; before < utime - kEdge; before += period_us)
    if (!given(command, before)) return false;
  return true;
}

HandWatch::Fit HandWatch::fit(const PatternSet& set, const MotionPattern& pattern,
                              int64_t start) const {
  const int64_t period = set.content().period_us;
  if (!steadyBefore(set.classNamed(pattern.entry_class).steady, start, period)) return Fit::kNo;
  int64_t begin = start;
  for (const TrackCommand& command : pattern.commands) {
    for (const int64_t utime : {begin + kEdge, begin + period - kEdge}) {
      if (utime > newest_) return Fit::kNotYet;
      if (!given(command, utime) || !at(utime)->by_hand) return Fit::kNo;
    }
    begin += period;
  }
  return begin <= newest_ ? Fit::kYes : Fit::kNotYet;
}

std::optional<HandDrivenPattern> HandWatch::longestFrom(int64_t start, const PatternSet& set,
                                                        bool& not_yet) const {
  std::optional<HandDrivenPattern> longest;
  not_yet = false;
  for (const MotionPattern& pattern : set.patterns()) {
    const int64_t end =
        start + set.content().period_us * static_cast<int64_t>(pattern.commands.size());
    const Fit found = fit(set, pattern, start);
    not_yet = not_yet || found == Fit::kNotYet;
    if (found == Fit::kYes && (!longest || end > longest->ended))
      longest = HandDrivenPattern{pattern.id, start, end};
  }
  return longest;
}

int64_t HandWatch::nextStart(int64_t start, int64_t period_us) const {
  const auto change = std::upper_bound(
      given_.begin(), given_.end(), start,
      [](int64_t time, const GivenCommand& command) { return time < command.utime; });
  const int64_t next = start + period_us;
  return change == given_.end() ? next : std::min(next, change->utime);
}

std::vector<HandDrivenPattern> HandWatch::take(const PatternSet& set) {
  std::vector<HandDrivenPattern> found;
  while (start_ < newest_) {
    bool not_yet = false;
    const std::optional<HandDrivenPattern> longest = longestFrom(start_, set, not_yet);
    if (not_yet) break;
    if (longest) found.push_back(*longest);
    start_ = longest ? longest->ended : nextStart(start_, set.content().period_us);
  }
  return found;
}

}  // namespace tread::learner
