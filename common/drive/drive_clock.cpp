// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/drive/drive_clock.hpp"

#include <algorithm>

#include "common/report/text.hpp"

namespace tread {
namespace {

constexpr int64_t kSecond = 1'000'000;          // [us]
constexpr int64_t kDay = 86'400 * kSecond;      // a pause that nothing confirms is shorter
constexpr int64_t kUnconfirmed = 10 * kSecond;  // the same beside the robot's own times
constexpr int64_t kSilence = kSecond;           // a running robot publishes at least this often
constexpr int64_t kDelay = kSecond;             // of a recorder that is held up
constexpr int64_t kStep = 250'000;              // [us] by which clocks differ before one was set
constexpr int64_t kAtOnce = 50'000;             // [us] in which a recorder writes what has waited
constexpr int64_t kMuchAtOnce = 20'000;         // [us] of the robot's time within no time
constexpr int64_t kAlone = 3600 * kSecond;      // over which the robot's clock is believed alone
constexpr int64_t kLongestPause = 7 * kDay;     // of a recording
constexpr int64_t kLargestUtime = 10'000'000'000'000'000;  // three centuries
constexpr int64_t kLargestRecorded = 4'000'000'000'000'000'000;
constexpr int64_t kSlowest = 5 * kSecond;  // between messages of a running robot
constexpr size_t kFollowers = 4;           // stamps that are asked about another one
constexpr size_t kStampsAhead = 8;         // with which doubts are settled
constexpr size_t kMostAhead = 4096;        // events
constexpr int kSettled = 100;              // stamps after which a recorder has caught up

bool isPossible(int64_t utime) {
  return utime >= 0 && utime < kLargestUtime;
}

bool isMost(size_t part, size_t whole) {
  return 3 * part >= 2 * whole;
}

std::string seconds(int64_t us) {
  return formatted("%.1f s", 1e-6 * static_cast<double>(us));
}

std::string moreTimes(size_t count) {
  return count > 1 ? ", and " + std::to_string(count - 1) + " more times" : "";
}

}  // namespace

void DriveClock::add(int64_t recorded, std::optional<int64_t> utime) {
  if (utime && !isPossible(*utime)) utime.reset();
  recorded = std::clamp(recorded, -kLargestRecorded, kLargestRecorded) / scale_;
  ticks_.push_back({recorded, utime});
  stamps_ += utime ? 1 : 0;
}

bool DriveClock::knowsEnough() const {
  return closed_ || stamps_ >= kStampsAhead || ticks_.size() >= kMostAhead;
}

std::optional<DriveClock::Dated> DriveClock::next() {
  if (ticks_.empty() || (!begun_ && !knowsEnough())) return std::nullopt;
  if (!begun_) begin();
  const Tick tick = ticks_.front();
  Dated dated;
  if (const auto time = fitting(tick))
    dated.utime = *time;
  else if (knowsEnough())
    dated = judge(tick);
  else
    return std::nullopt;
  dated.utime = last_ = std::max(last_, dated.utime);
  ticks_.pop_front();
  stamps_ -= tick.utime ? 1 : 0;
  return dated;
}

/// Whether both clocks are one (virtual time, imports): messages are still under way for a while.
bool DriveClock::isOneClock() const {
  return offset_ > -20'000 && offset_ < kStep;
}

int64_t DriveClock::timeOf(const Tick& tick) const {
  return tick.recorded - (one_clock_ ? 0 : offset_);
}

bool DriveClock::isNear(const Tick& stamp) const {
  const int64_t later = offsetOf(stamp) - offset_;
  return later > -kStep && later < kDelay;
}

/// Begins with the difference of the clocks on which most of the first stamps agree.
void DriveClock::begin() {
  begun_ = true;
  convertNanoseconds();
  std::vector<int64_t> offsets;
  for (const Tick& tick : ticks_)
    if (tick.utime && offsets.size() < 2 * kStampsAhead) offsets.push_back(offsetOf(tick));
  if (offsets.empty()) return beginWithoutStamps();
  const int64_t heard_first = offsets.front();
  std::sort(offsets.begin(), offsets.end());
  std::ptrdiff_t most = 0;
  for (auto from = offsets.begin(); from != offsets.end(); ++from) {
    const auto agreeing = std::upper_bound(from, offsets.end(), *from + kStep) - from;
    const bool with_first = *from <= heard_first && heard_first <= *from + kStep;
    if (agreeing > most || (agreeing == most && with_first)) offset_ = *from;
    most = std::max(most, agreeing);
  }
  std::vector<const Tick*> agreeing;
  for (const Tick& tick : ticks_)
    if (tick.utime && offsetOf(tick) >= offset_ && offsetOf(tick) <= offset_ + kStep)
      agreeing.push_back(&tick);
  const bool burst = beginWithBurst(agreeing);
  one_clock_ = !burst && isOneClock();
  stamped_ = true;
  // The first event of all may have a wrong time, too: it counts where another one follows soon.
  const auto first =
      std::adjacent_find(ticks_.begin(), ticks_.end(), [&](const Tick& tick, const Tick& next) {
        const int64_t gap = next.recorded - tick.recorded;
        return burst || (gap > -kStep && gap < kUnconfirmed);
      });
  first_ = std::max<int64_t>(0, timeOf(first == ticks_.end() ? ticks_.front() : *first));
  last_ = last_stamp_ = first_;
}

/// Where a recorder that was not listened to wrote the first stamps at once, each is as old as it
/// says: begins with the first one. True if so.
/** The events before it were recorded until nobody listened any more: right before it. */
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

/// The same without the recorder's longest pause: a recorder that was not listened to for a minute
/// has no pace of a thousand.
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

/// Recorders of other projects count nanoseconds: their seconds last a thousand of the robot's.
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
  // Where the robot's times are nanoseconds, too, only its rates tell it.
  slow_ = paces >= kFollowers && isMost(slow, paces);
  const bool one_step = !stamps.empty() && !isThousandfoldWithoutLargestStep(stamps);
  if (!too_large && (paces == 0 || !isMost(thousandfold, paces) || one_step)) return;
  scale_ = 1000;
  for (Tick& tick : ticks_) tick.recorded /= scale_;
}

/// The time of an event about which there is no doubt.
std::optional<int64_t> DriveClock::fitting(const Tick& tick) {
  if (tick.utime && !isNear(tick)) return std::nullopt;
  const int64_t since = timeOf(tick) - last_;
  if (since < (tick.utime ? -kDelay : -kStep) || since > kSilence) return std::nullopt;
  if (tick.utime) take(tick);
  return timeOf(tick);
}

/// Whether a stamp by itself says that the robot's clock simply goes on.
bool DriveClock::goesOn(const Tick& stamp) const {
  return std::abs(*stamp.utime + shift_ - last_) <= kSilence;
}

/// Whether most of the stamps behind one say the same of both clocks.
bool DriveClock::agreesWithNext(size_t index) const {
  const Tick& stamp = ticks_[index];
  const auto isBack = [&](const Tick& tick) { return *tick.utime + shift_ < last_ - kDelay; };
  size_t asked = 0, agreeing = 0;
  for (size_t i = index + 1; i < ticks_.size() && asked < kFollowers; ++i) {
    if (!ticks_[i].utime) continue;
    ++asked;
    const int64_t offset_change = offsetOf(ticks_[i]) - offsetOf(stamp);
    const int64_t passed = *ticks_[i].utime - *stamp.utime;
    const bool both_back = isBack(ticks_[i]) || !isBack(stamp);
    // What a recorder writes at once may be of any time, pauses among it.
    const bool at_once = std::abs(ticks_[i].recorded - stamp.recorded) < kAtOnce && passed >= 0 &&
                         passed < kUnconfirmed;
    if ((std::abs(offset_change) < kStep || at_once) && passed > -kStep && both_back) ++agreeing;
  }
  if (asked > 0) return isMost(agreeing, asked);
  const int64_t since = timeOf(stamp) - last_;
  return isNear(stamp) && since > 0 && since < kUnconfirmed;
}

DriveClock::Dated DriveClock::judge(const Tick& tick) {
  if (tick.utime && agreesWithNext(0)) {
    const int64_t since = timeOf(tick) - last_;
    const bool goes_on = isNear(tick) && since > -kDelay && since < kLongestPause;
    goes_on ? take(tick) : step(offsetOf(tick));
    return {timeOf(tick), false};
  }
  if (tick.utime && goesOn(tick)) return {*tick.utime + shift_, true};
  const auto time = between(tick);
  return {time.value_or(last_), !time || tick.utime};
}

/// The time of an event between the last one and the next stamp that is believed, by the clocks of
/// the one or the other; nothing if its time is wrong.
std::optional<int64_t> DriveClock::between(const Tick& tick) {
  const int64_t since = timeOf(tick) - last_;
  if (since >= -kStep && since <= kSilence) return timeOf(tick);
  for (size_t i = 1; stamps_ > 0 && i < ticks_.size(); ++i) {
    const Tick& stamp = ticks_[i];
    if (!stamp.utime) continue;
    const int64_t until = *stamp.utime + shift_;
    const bool near = isNear(stamp) && until >= last_ - kDelay;
    if (!(near && goesOn(stamp)) && !agreesWithNext(i)) {
      // The recorder's clock was set so late that too few follow.
      if (goesOn(stamp)) return std::nullopt;
      continue;
    }
    if (since > 0 && near && timeOf(tick) <= timeOf(stamp)) return timeOf(tick);
    const int64_t time = tick.recorded - offsetOf(stamp);
    if (!near && time >= last_ - kStep && time <= until + kStep) return time;
    if (!near && until < last_ && tick.recorded <= stamp.recorded) return last_;
    return std::nullopt;
  }
  return byRecorder(tick);
}

/// The same where no stamp follows: only the recorder's times can tell.
std::optional<int64_t> DriveClock::byRecorder(const Tick& tick) {
  size_t asked = 0, later = 0, back = 0;
  for (size_t i = 1; i < ticks_.size() && asked < kFollowers; ++i, ++asked) {
    later += ticks_[i].recorded >= tick.recorded - kStep;
    back += timeOf(ticks_[i]) < last_ - kStep;
  }
  const int64_t time = timeOf(tick);
  const int64_t longest = stamped_ ? kUnconfirmed : kDay;
  if (!isMost(later, asked) || (asked == 0 && time - last_ > longest)) return std::nullopt;
  if (time >= last_) return isPossible(time) ? std::optional(time) : std::nullopt;
  if (asked == 0 || !isMost(back, asked)) return std::nullopt;
  jumps_.push_back({last_, time - last_});
  offset_ = tick.recorded - last_;
  return last_;
}

void DriveClock::take(const Tick& stamp) {
  last_stamp_ = std::max(last_stamp_, *stamp.utime + shift_);
  follow(offsetOf(stamp));
}

void DriveClock::follow(int64_t offset) {
  stamped_ = true;
  offset_ = std::min(offset_, offset);
  if (counted_ == 0) earliest_ = least_ = offset;
  least_ = std::min(least_, offset);
  if (++counted_ < kSettled) return;
  counted_ = 0;
  if (isCatchingUp()) return;
  if (least_ - offset_ > kStep) {
    if (!step_) step_ = Step{last_, offset_};
    offset_ = least_;
  }
  if (step_ && std::abs(least_ - step_->before) > kStep)
    jumps_.push_back({step_->at, least_ - step_->before});
  step_.reset();
  one_clock_ = isOneClock();
}

/// A recorder that was held up writes many events at once: they come ever less late.
bool DriveClock::isCatchingUp() const {
  return earliest_ - least_ > kStep;
}

/// Believes the front's stamp, whose offset is another one: one of the clocks was set.
void DriveClock::step(int64_t offset) {
  const Tick& stamp = ticks_.front();
  const int64_t by_robot = *stamp.utime + shift_ - last_stamp_;
  const int64_t by_recorder = timeOf(stamp) - last_;
  const bool recorder_knows = by_recorder >= 0 && by_recorder < kDay;
  const bool began_anew = by_robot < -kSilence || !stamped_;
  const bool jumped = by_robot > kAlone && (!recorder_knows || by_recorder < by_robot);
  if (began_anew || jumped) {
    const int64_t now = last_ + (recorder_knows ? by_recorder : 0);
    if (stamped_) restarts_.push_back(now);
    shift_ = now - *stamp.utime;
    offset = offsetOf(stamp);
  } else if (!step_) {
    step_ = Step{last_, offset_};
  }
  offset_ = offset;
  one_clock_ = isOneClock();
  counted_ = 0;
  last_stamp_ = *stamp.utime + shift_;
  follow(offset);
}

std::vector<std::string> DriveClock::notes() const {
  std::vector<std::string> lines;
  std::vector<Jump> jumps = jumps_;
  if (step_ && !isCatchingUp() && std::abs(offset_ - step_->before) > kStep)
    jumps.push_back({step_->at, offset_ - step_->before});
  if (scale_ != 1)
    lines.push_back("its times are nanoseconds, not microseconds as in an LCM log; read as such");
  if (slow_)
    lines.push_back(
        "INS, MOTOR and EXECUTION come many seconds apart: are their times nanoseconds? "
        "utime counts microseconds");
  if (!jumps.empty())
    lines.push_back("the recorder's clock jumped by " + seconds(jumps.front().by) + " at " +
                    seconds(jumps.front().at - first_) + moreTimes(jumps.size()) +
                    "; the robot's own times are used");
  if (!restarts_.empty())
    lines.push_back("the robot's clock began anew at " + seconds(restarts_.front() - first_) +
                    moreTimes(restarts_.size()) +
                    " (its host was started again, or this is another robot); times go on there");
  return lines;
}

}  // namespace tread
