// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/hand_watch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tread::learner {
namespace {

constexpr int64_t kSteady = 500'000;    // [us] of the entry class's command before a pattern
constexpr int64_t kShortest = 400'000;  // [us] of a beginning: shorter ones are mostly INS noise
constexpr int64_t kEdge = 15'000;       // [us] by which a change may be early or late
constexpr int64_t kSilent = 200'000;    // [us] between two commands: longer gaps are unknown
constexpr int64_t kKept = 70'000'000;   // [us] longer than any series
constexpr double kSameCommand = 2e-3;   // MOTOR is single precision, a Roboteq resolves thousandths

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

bool HandWatch::given(const Command& command, int64_t utime) const {
  const GivenCommand* found = at(utime);
  if (found == nullptr) return false;
  for (size_t i = 0; i < Command::kMaxChannels; ++i)
    if (!(std::abs(found->command[i] - command[i]) <= kSameCommand)) return false;
  return true;
}

bool HandWatch::steadyBefore(const Command& command, int64_t utime, int64_t period_us) const {
  for (int64_t before = utime - kSteady; before < utime - kEdge; before += period_us)
    if (!given(command, before)) return false;
  return true;
}

std::optional<size_t> HandWatch::driven(const PatternSet& set, const MotionPattern& pattern,
                                        int64_t start) const {
  const int64_t period = set.content().period_us;
  if (!steadyBefore(set.classNamed(pattern.entry_class).steady, start, period)) return 0;
  int64_t begin = start;
  for (size_t i = 0; i < pattern.commands.size(); ++i, begin += period) {
    for (const int64_t utime : {begin + kEdge, begin + period - kEdge}) {
      if (utime > newest_) return std::nullopt;
      // After a takeover by the bridge the robot may have been held: that is not the ground's
      // influence.
      if (!at(utime)->by_hand) return 0;
      if (!given(pattern.commands[i], utime)) return i;
    }
  }
  if (begin > newest_) return std::nullopt;
  return pattern.commands.size();
}

std::optional<HandDrivenPattern> HandWatch::longestFrom(int64_t start, const PatternSet& set,
                                                        bool beginnings, bool& not_yet) const {
  std::optional<HandDrivenPattern> longest;
  not_yet = false;
  for (const MotionPattern& pattern : set.patterns()) {
    const std::optional<size_t> commands = driven(set, pattern, start);
    not_yet = not_yet || !commands;
    const int64_t length = set.content().period_us * static_cast<int64_t>(commands.value_or(0));
    if (length == 0) continue;
    const bool completed = *commands == pattern.commands.size();
    if (!completed && (!beginnings || length < kShortest)) continue;
    const HandDrivenPattern found{pattern.id, start, start + length, completed};
    if (!longest ||
        std::pair(found.completed, found.ended) > std::pair(longest->completed, longest->ended))
      longest = found;
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

std::vector<HandDrivenPattern> HandWatch::take(const PatternSet& set, bool beginnings) {
  std::vector<HandDrivenPattern> found;
  while (start_ < newest_) {
    bool not_yet = false;
    const std::optional<HandDrivenPattern> longest = longestFrom(start_, set, beginnings, not_yet);
    if (not_yet) break;
    if (longest) found.push_back(*longest);
    start_ = longest ? longest->ended : nextStart(start_, set.content().period_us);
  }
  return found;
}

}  // namespace tread::learner
