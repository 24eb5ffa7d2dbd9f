// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Start of DriveClock: both clocks as shown by the first events of a log.
#include <algorithm>

#include "common/drive/drive_clock.hpp"
#include "common/drive/drive_clock_limits.hpp"

namespace tread {

using namespace drive_clock;

namespace {

/// The least of the offsets on which most agree; of several such groups, of the first one.
int64_t offsetOfMost(std::vector<int64_t> offsets) {
  const int64_t heard_first = offsets.front();
  std::sort(offsets.begin(), offsets.end());
  std::ptrdiff_t most = 0;
  int64_t offset = heard_first;
  for (auto from = offsets.begin(); from != offsets.end(); ++from) {
    const auto agreeing = std::upper_bound(from, offsets.end(), *from + kStep) - from;
    const bool with_first = *from <= heard_first && heard_first <= *from + kStep;
    if (agreeing > most || (agreeing == most && with_first)) offset = *from;
    most = std::max(most, agreeing);
  }
  return offset;
}

}  // namespace

/// Starts with the clock difference on which most of the first stamps agree.
void DriveClock::begin() {
  begun_ = true;
  convertNanoseconds();
  std::vector<int64_t> offsets;
  for (const Tick& tick : ticks_)
    if (tick.utime && offsets.size() < 2 * kStampsAhead) offsets.push_back(offsetOf(tick));
  if (offsets.empty()) return beginWithoutStamps();
  offset_ = offsetOfMost(offsets);
  std::vector<const Tick*> agreeing;
  for (const Tick& tick : ticks_)
    if (tick.utime && offsetOf(tick) >= offset_ && offsetOf(tick) <= offset_ + kStep)
      agreeing.push_back(&tick);
  const bool burst = beginWithBurst(agreeing);
  one_clock_ = !burst && isOneClock();
  stamped_ = true;
  // The very first event may have a wrong time, too: it counts if another one follows soon.
  const auto first =
      std::adjacent_find(ticks_.begin(), ticks_.end(), [&](const Tick& tick, const Tick& next) {
        const int64_t gap = next.recorded - tick.recorded;
        return burst || (gap > -kStep && gap < kUnconfirmed);
      });
  first_ = std::max<int64_t>(0, timeOf(first == ticks_.end() ? ticks_.front() : *first));
  last_ = last_stamp_ = first_;
}

/// Handles a backlog at the start: if a stalled recorder wrote the first stamps at once, each is as
/// old as it states, so the time begins with the first one. True if so.
/** The events before it were recorded until the recorder stalled: right before it. */
bool DriveClock::beginWithBurst(const std::vector<const Tick*>& agreeing) {
  int64_t from = agreeing.front()->recorded, to = from;
  int64_t oldest = *agreeing.front()->utime, newest = oldest;
  for (const Tick* tick : agreeing) {
    from = std::min(from, tick->recorded);
    to = std::max(to, tick->recorded);
    oldest = std::min(oldest, *tick->utime);
    newest = std::max(newest, *tick->utime);
  }
  if (newest - oldest < 2 * (to - from) + kMuchAtOnce) return false;
  const auto first = std::find_if(ticks_.begin(), ticks_.end(),
                                  [](const Tick& tick) { return tick.utime.has_value(); });
  const int64_t before = oldest - *first->utime;
  if (first->recorded > from || before < -kStep || before > kUnconfirmed) return false;
  offset_ = offsetOf(*first);
  int64_t waited = 0;
  for (auto tick = first; tick != ticks_.begin();) {
    const int64_t later = tick->recorded;
    --tick;
    if (waited == 0 && later - tick->recorded > kDelay) waited = later - tick->recorded;
    tick->recorded += waited;
  }
  return true;
}

void DriveClock::beginWithoutStamps() {
  const auto believed = std::find_if(ticks_.begin(), ticks_.end(), [&](const Tick& tick) {
    const auto after =
        static_cast<size_t>(std::count_if(ticks_.begin(), ticks_.end(), [&](const Tick& other) {
          return std::abs(other.recorded - tick.recorded) < kDay;
        }));
    return 2 * after >= std::min(ticks_.size(), 2 * kFollowers);
  });
  const int64_t begin = believed == ticks_.end() ? ticks_.front().recorded : believed->recorded;
  if (!isPossible(begin)) offset_ = begin;
  first_ = last_ = begin - offset_;
}

bool DriveClock::isThousandfold(int64_t recorded, int64_t passed) {
  const double pace =
      static_cast<double>(recorded) / static_cast<double>(std::max<int64_t>(1, passed));
  return pace > 200.0 && pace < 5000.0;
}

/// The same without the recorder's longest pause: a recorder that stalled for a minute does not
/// run a thousand times too fast.
bool DriveClock::isThousandfoldWithoutLargestStep(const std::vector<const Tick*>& stamps) {
  int64_t largest = 0, passed_then = 0;
  for (size_t i = 1; i < stamps.size(); ++i) {
    const int64_t step = stamps[i]->recorded - stamps[i - 1]->recorded;
    if (step <= largest) continue;
    largest = step;
    passed_then = *stamps[i]->utime - *stamps[i - 1]->utime;
  }
  return isThousandfold(stamps.back()->recorded - stamps.front()->recorded - largest,
                        *stamps.back()->utime - *stamps.front()->utime - passed_then);
}

/// Recorders of other projects count nanoseconds: their seconds appear as a thousand of the
/// robot's.
void DriveClock::convertNanoseconds() {
  std::vector<const Tick*> stamps;
  for (const Tick& tick : ticks_)
    if (tick.utime && stamps.size() < 2 * kStampsAhead) stamps.push_back(&tick);
  size_t paces = 0, thousandfold = 0, slow = 0;
  for (size_t i = kFollowers; i < stamps.size(); ++i) {
    const Tick &from = *stamps[i - kFollowers], &to = *stamps[i];
    const int64_t passed = *to.utime - *from.utime;
    ++paces;
    slow += passed > static_cast<int64_t>(kFollowers) * kSlowest;
    thousandfold += isThousandfold(to.recorded - from.recorded, passed);
  }
  const bool too_large =
      stamps.empty() && std::all_of(ticks_.begin(), ticks_.end(),
                                    [](const Tick& tick) { return tick.recorded > kLargestUtime; });
  // Where the robot's times are nanoseconds, too, only its message rates show it.
  slow_ = paces >= kFollowers && isMost(slow, paces);
  const bool one_step = !stamps.empty() && !isThousandfoldWithoutLargestStep(stamps);
  if (!too_large && (paces == 0 || !isMost(thousandfold, paces) || one_step)) return;
  scale_ = 1000;
  for (Tick& tick : ticks_) tick.recorded /= scale_;
}

}  // namespace tread
