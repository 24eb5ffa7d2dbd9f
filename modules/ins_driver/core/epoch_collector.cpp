// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/core/epoch_collector.hpp"

namespace tread::ins {
namespace {

/// A larger step back is no late message but a clock that was set.
constexpr int64_t kMaxLateUs = 2'000'000;
/// This many late messages without a timely one mean that the clock was set back slightly.
constexpr int kLateLimit = 10;
/// An epoch whose messages keep arriving with an unchanged time ends after this.
constexpr int64_t kMaxEpochUs = 500'000;
/// Excess of the device's time step over the host's between epochs that means a clock set forward.
constexpr int64_t kClockStepUs = 1'000'000;

}  // namespace

bool EpochCollector::push(const DeviceEpoch& part, size_t kind, std::optional<int64_t> told,
                          int64_t arrival) {
  const bool in_time = !told || pushTimed(part, kind, *told, arrival);
  if (!told) placeUntimed(part, kind, arrival);
  if (in_time && last_kind_ == kind) close();
  return in_time;
}

void EpochCollector::pushDate(int64_t utc, int64_t told, size_t kind) {
  clock_.learnUtc(utc, told);
  if (last_kind_ == kind) close();
}

bool EpochCollector::pushTimed(const DeviceEpoch& part, size_t kind, int64_t told,
                               int64_t arrival) {
  const int64_t device_time = clock_.timeOf(told);
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
  if (!epoch_) open(arrival);
  epoch_->device_time = device_time;
  epoch_->take(part, kind);
  clock_.accept(device_time);
  if (part.device_utc >= 0) clock_.learnUtc(part.device_utc, told);
  return true;
}

EpochCollector::Order EpochCollector::orderOf(int64_t device_time) {
  const std::optional<int64_t>& newest = clock_.newest();
  if (!newest || device_time > *newest) return Order::kNewer;
  if (epoch_ && epoch_->device_time == device_time) return Order::kSame;
  const bool set_back = *newest - device_time > kMaxLateUs || late_in_a_row_ >= kLateLimit;
  return set_back ? Order::kStep : Order::kLate;
}

void EpochCollector::placeUntimed(const DeviceEpoch& part, size_t kind, int64_t arrival) {
  if (epoch_ && epoch_->holds(kind)) close();
  if (!epoch_) open(arrival);
  epoch_->take(part, kind);
}

std::optional<DeviceEpoch> EpochCollector::next(int64_t now) {
  if (epoch_ && (now - last_bytes_ >= quiet_us_ || now - epoch_->arrival >= kMaxEpochUs)) close();
  if (finished_.empty()) return std::nullopt;
  const DeviceEpoch epoch = finished_.front();
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
