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

/// Where both clocks are one (virtual time, imports), messages are still under way for a while.
int64_t DriveClock::timeOf(const Tick& tick) const {
  const bool one_clock = offset_ > -20'000 && offset_ < kStep;
  return tick.recorded - (one_clock ? 0 : offset_);
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
  stamped_ = true;
  // The first event of all may have a wrong time, too: it counts where another one follows soon.
  const auto first =
      std::adjacent_find(ticks_.begin(), ticks_.end(), [](const Tick& tick, const Tick& next) {
        const int64_t gap = next.recorded - tick.recorded;
        return gap > -kStep && gap < kUnconfirmed;
      });
  first_ = std::max<int64_t>(0, timeOf(first == ticks_.end() ? ticks_.front() : *first));
  last_ = last_stamp_ = first_;
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

/// Recorders of other projects count nanoseconds: their seconds last a thousand of the robot's.
void DriveClock::convertNanoseconds() {
  std::vector<const Tick*> stamps;
  for (const Tick& tick : ticks_)
    if (tick.utime && stamps.size() < 2 * kStampsAhead) stamps.push_back(&tick);
  size_t paces = 0, thousandfold = 0, slow = 0;
  for (size_t i = kFollowers; i < stamps.size(); ++i) {
    const Tick &from = *stamps[i - kFollowers], &to = *stamps[i];
    const int64_t passed = *to.utime - *from.utime;
    const double pace = static_cast<double>(to.recorded - from.recorded) /
                        static_cast<double>(std::max<int64_t>(1, passed));
    ++paces;
    slow += passed > static_cast<int64_t>(kFollowers) * kSlowest;
    thousandfold += pace > 200.0 && pace < 5000.0 ? 1 : 0;
  }
  const bool too_large =
      stamps.empty() && std::all_of(ticks_.begin(), ticks_.end(),
                                    [](const Tick& tick) { return tick.recorded > kLargestUtime; });
  // Where the robot's times are nanoseconds, too, only its rates tell it.
  slow_ = paces >= kFollowers && isMost(slow, paces);
  if (!too_large && (paces == 0 || !isMost(thousandfold, paces))) return;
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
    if (std::abs(offset_change) < kStep && passed > -kStep && both_back) ++agreeing;
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
