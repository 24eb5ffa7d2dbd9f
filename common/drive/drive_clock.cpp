// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/drive/drive_clock.hpp"

#include <algorithm>

#include "common/drive/drive_clock_limits.hpp"
#include "common/report/text.hpp"

namespace tread {

using namespace drive_clock;

namespace {

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
  dated.restarts = restarts_.size();
  ticks_.pop_front();
  stamps_ -= tick.utime ? 1 : 0;
  return dated;
}

/// Whether both clocks are the same (virtual time, imports): then only the transport delay differs.
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

/// The time of an event that is beyond doubt.
std::optional<int64_t> DriveClock::fitting(const Tick& tick) {
  if (tick.utime && !isNear(tick)) return std::nullopt;
  const int64_t since = timeOf(tick) - last_;
  if (since < (tick.utime ? -kDelay : -kStep) || since > kSilence) return std::nullopt;
  if (tick.utime) take(tick);
  return timeOf(tick);
}

/// Whether a stamp by itself shows that the robot's clock simply continued.
bool DriveClock::goesOn(const Tick& stamp) const {
  return std::abs(*stamp.utime + shift_ - last_) <= kSilence;
}

/// Whether most stamps after this one agree with it about both clocks.
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
    // Events that a recorder writes at once may be of any time, with pauses between them.
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

/// The time of an event between the last one and the next accepted stamp, by the clock of either;
/// nullopt if its time is wrong.
std::optional<int64_t> DriveClock::between(const Tick& tick) {
  const int64_t since = timeOf(tick) - last_;
  if (since >= -kStep && since <= kSilence) return timeOf(tick);
  for (size_t i = 1; stamps_ > 0 && i < ticks_.size(); ++i) {
    const Tick& stamp = ticks_[i];
    if (!stamp.utime) continue;
    const int64_t until = *stamp.utime + shift_;
    const bool near = isNear(stamp) && until >= last_ - kDelay;
    if (!(near && goesOn(stamp)) && !agreesWithNext(i)) {
      // The recorder's clock was set so late that too few stamps follow.
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

/// The same without a following stamp: only the recorder's times can decide.
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
  one_clock_ = isOneClock();
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

/// A delayed recorder writes many events at once, with decreasing delay.
bool DriveClock::isCatchingUp() const {
  return earliest_ - least_ > kStep;
}

/// Accepts the front's stamp with its new offset: one of the clocks was set.
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
    lines.push_back("the robot's clock restarted at " + seconds(restarts_.front() - first_) +
                    moreTimes(restarts_.size()) +
                    " (its host was started again, or this is another robot); times go on there");
  return lines;
}

}  // namespace tread
