// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/nmea/epoch_collector.hpp"

#include <tuple>

namespace tread::ins {
namespace {

/// The place of a type of sentence in an epoch, const or not.
template <class Sentence, class EpochRef>
auto& placeIn(EpochRef& epoch) {
  using Place = std::conditional_t<std::is_const_v<EpochRef>, const std::optional<Sentence>&,
                                   std::optional<Sentence>&>;
  return std::get<Place>(
      std::tie(epoch.gga, epoch.rmc, epoch.vtg, epoch.hdt, epoch.pashr, epoch.rot, epoch.zda));
}

/// Further back than this is no late sentence but a clock that was set.
constexpr int64_t kMaxLateUs = 2'000'000;
/// So many late sentences without one in time mean that the clock was set back a little.
constexpr int kLateLimit = 10;
/// An epoch whose sentences keep coming with an unchanged time ends after this.
constexpr int64_t kMaxEpochUs = 500'000;
/// The device's time went on by so much more than the host's from one epoch to the next: it was set
/// forward.
constexpr int64_t kClockStepUs = 1'000'000;

}  // namespace

bool Epoch::holds(const NmeaSentence& sentence) const {
  const auto held = [this](const auto& s) {
    return placeIn<std::decay_t<decltype(s)>>(*this).has_value();
  };
  return std::visit(held, sentence);
}

void Epoch::take(const NmeaSentence& sentence) {
  std::visit([this](const auto& s) { placeIn<std::decay_t<decltype(s)>>(*this) = s; }, sentence);
}

int64_t DeviceClock::timeOf(int64_t time_of_day) const {
  if (!newest_) return time_of_day;
  int64_t ahead = (time_of_day - *newest_) % kDayUs;
  if (ahead > kDayUs / 2) ahead -= kDayUs;
  if (ahead <= -kDayUs / 2) ahead += kDayUs;
  return *newest_ + ahead;
}

void DeviceClock::setDate(const CivilDate& date, int64_t time_of_day, int64_t device_time) {
  utc_minus_device_ = daysSinceEpoch(date) * kDayUs + time_of_day - device_time;
}

int64_t DeviceClock::utc(int64_t device_time) const {
  return utc_minus_device_ ? *utc_minus_device_ + device_time : -1;
}

bool EpochCollector::push(const NmeaSentence& sentence, int64_t arrival) {
  const std::optional<int64_t> time_of_day = timeOfDay(sentence);
  const bool in_time = !time_of_day || pushTimed(sentence, arrival, *time_of_day);
  if (!time_of_day) placeUntimed(sentence, arrival);
  if (in_time && last_type_ == sentence.index()) close();
  return in_time;
}

bool EpochCollector::pushTimed(const NmeaSentence& sentence, int64_t arrival, int64_t time_of_day) {
  const int64_t device_time = clock_.timeOf(time_of_day);
  switch (orderOf(device_time)) {
    case Order::kLate:
      ++late_in_a_row_;
      return false;
    case Order::kStep:
      close();
      clock_was_set_ = true;
      break;
    case Order::kNewer:
      if (epoch_ && epoch_->device_time) close();
      break;
    case Order::kSame:
      break;
  }
  late_in_a_row_ = 0;
  place(sentence, arrival, device_time);
  return true;
}

EpochCollector::Order EpochCollector::orderOf(int64_t device_time) {
  const std::optional<int64_t>& newest = clock_.newest();
  if (!newest || device_time > *newest) return Order::kNewer;
  if (epoch_ && epoch_->device_time == device_time) return Order::kSame;
  const bool set_back = *newest - device_time > kMaxLateUs || late_in_a_row_ >= kLateLimit;
  return set_back ? Order::kStep : Order::kLate;
}

void EpochCollector::place(const NmeaSentence& sentence, int64_t arrival, int64_t device_time) {
  if (!epoch_) open(arrival);
  epoch_->device_time = device_time;
  epoch_->take(sentence);
  clock_.accept(device_time);
  learnDate(sentence, device_time);
}

void EpochCollector::placeUntimed(const NmeaSentence& sentence, int64_t arrival) {
  if (epoch_ && epoch_->holds(sentence)) close();
  if (!epoch_) open(arrival);
  epoch_->take(sentence);
}

void EpochCollector::learnDate(const NmeaSentence& sentence, int64_t device_time) {
  const auto* zda = std::get_if<Zda>(&sentence);
  const auto* rmc = std::get_if<Rmc>(&sentence);
  const std::optional<CivilDate> date = zda ? zda->date : rmc ? rmc->date : std::nullopt;
  const std::optional<int64_t> time_of_day = timeOfDay(sentence);
  if (date && time_of_day) clock_.setDate(*date, *time_of_day, device_time);
}

std::optional<Epoch> EpochCollector::next(int64_t now) {
  if (epoch_ && (now - last_bytes_ >= quiet_us_ || now - epoch_->arrival >= kMaxEpochUs)) close();
  if (finished_.empty()) return std::nullopt;
  const Epoch epoch = finished_.front();
  finished_.pop_front();
  return epoch;
}

void EpochCollector::open(int64_t arrival) {
  epoch_.emplace();
  epoch_->arrival = arrival;
  epoch_->clock_was_set = clock_was_set_;
  clock_was_set_ = false;
}

void EpochCollector::close() {
  if (!epoch_) return;
  if (epoch_->device_time) {
    epoch_->device_utc = clock_.utc(*epoch_->device_time);
    const int64_t ahead = *epoch_->device_time - last_device_time_.value_or(*epoch_->device_time);
    if (ahead - (epoch_->arrival - last_arrival_) > kClockStepUs && last_device_time_)
      epoch_->clock_was_set = true;
    last_device_time_ = epoch_->device_time;
    last_arrival_ = epoch_->arrival;
  }
  finished_.push_back(*epoch_);
  epoch_.reset();
}

}  // namespace tread::ins
