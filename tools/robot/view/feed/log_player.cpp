// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/view/feed/log_player.hpp"

#include <algorithm>
#include <functional>
#include <stdexcept>

namespace tread::view {
namespace {

/// Older messages no longer describe the state [us], except for constant data.
constexpr int64_t kLongestAge = 120'000'000;

bool lasts(const std::string& channel) {
  return channel == kConfig.name || channel == kPatternSet.name || channel == kFence.name ||
         channel == kFences.name || channel == kGoal.name;
}

}  // namespace

LogPlayer::LogPlayer(const std::vector<std::string>& logs) : reader_(logs) {
  for (DriveEvent event; reader_.next(event);) {
    parts_[{event.channel, partOf(event)}].push_back(entries_.size());
    entries_.push_back(event.place());
    history_.take(event);
  }
  problem_ = reader_.problem();
  if (entries_.empty())
    throw std::runtime_error((logs.empty() ? std::string("no log") : logs.front()) +
                             ": holds no message; is it a robot's log?");
}

void LogPlayer::tell(size_t entry, const Take& take) {
  LogEvent event;
  if (reader_.again(entries_[entry], event)) take(event);
}

void LogPlayer::seek(int64_t time, const Take& take) {
  now_ = time;
  std::vector<size_t> wanted;
  for (const auto& [part, entries] : parts_) {
    const auto after =
        std::upper_bound(entries.begin(), entries.end(), time,
                         [&](int64_t at, size_t entry) { return at < entries_[entry].utime; });
    if (after == entries.begin()) continue;
    const size_t newest = *std::prev(after);
    if (!lasts(part.first) && time - entries_[newest].utime > kLongestAge) continue;
    const auto [known, first] = told_.try_emplace(part, newest);
    if (!first && known->second == newest) continue;
    known->second = newest;
    wanted.push_back(newest);
  }
  std::sort(wanted.begin(), wanted.end());
  for (const size_t entry : wanted) tell(entry, take);
  next_ = static_cast<size_t>(
      std::upper_bound(entries_.begin(), entries_.end(), time,
                       [](int64_t at, const EventPlace& entry) { return at < entry.utime; }) -
      entries_.begin());
}

void LogPlayer::advance(int64_t time, const Take& take) {
  now_ = std::min(time, end());
  for (; next_ < entries_.size() && entries_[next_].utime <= time; ++next_)
    tell(next_, [&](const LogEvent& event) {
      told_[{event.channel, partOf(event)}] = next_;
      take(event);
    });
}

}  // namespace tread::view
