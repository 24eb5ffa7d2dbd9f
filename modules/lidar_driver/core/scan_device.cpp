// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/lidar_driver/core/scan_device.hpp"

#include <utility>

namespace tread::lidar {
namespace {

constexpr int kTries = 3;                // of one step
constexpr int kStartsWithoutScan = 2;    // after which the connection is given up
constexpr int64_t kSilence = 1'000'000;  // [us] without a scan
/// Scans kept for a node that does not fetch them; newer ones are dropped and counted.
constexpr size_t kMostScans = 100;

}  // namespace

void StartedDevice::open(int64_t now) {
  open_ = true;
  lost_ = false;
  starts_without_scan_ = 0;
  scans_.clear();
  reasons().note(Rank::kStarting, "starting up", now);
  begin(now);
}

void StartedDevice::close() {
  open_ = false;
  lost_ = false;
  scans_.clear();
  forget();
}

void StartedDevice::begin(int64_t now) {
  forget();
  step_ = 0;
  tries_ = 0;
  last_scan_ = now;
}

void StartedDevice::restart(const std::string& reason, int64_t now, const std::string& remedy) {
  // A known remedy says more than the bytes of a scan that the new start cuts off.
  reasons().note(remedy.empty() ? Rank::kSilent : Rank::kRefused, reason + "; starting it up again",
                 now, 1, remedy);
  count("restarts: " + reason);
  if (++starts_without_scan_ >= kStartsWithoutScan) lost_ = true;
  begin(now);
}

const StartUpStep& StartedDevice::awaited() const {
  static const StartUpStep kNone;
  return open_ && step_ < steps_.size() && tries_ > 0 ? steps_[step_] : kNone;
}

void StartedDevice::answered(int64_t now) {
  ++step_;
  tries_ = 0;
  last_scan_ = now;
}

void StartedDevice::setRequest(const std::string& step, std::string bytes) {
  for (StartUpStep& candidate : steps_)
    if (candidate.name == step) candidate.bytes = std::move(bytes);
}

void StartedDevice::refused(const std::string& words, int64_t now, const std::string& remedy) {
  const std::string what = "refused by the device: " + words;
  if (awaited().optional) {
    count(what);
    return answered(now);
  }
  // It is asked again after the timeout: asking at once could continue endlessly.
  refuse(what, now, remedy);
}

std::string StartedDevice::poll(int64_t now) {
  if (!open_ || lost_) return {};
  if (streaming()) {
    if (now - last_scan_ > kSilence) restart("no good scan for 1 s", now, remedyForSilence(now));
    return {};
  }
  if (tries_ > 0 && now - asked_at_ < patience_us_) return {};
  const StartUpStep& step = steps_[step_];
  if (tries_ > 0 && (step.unanswered || (step.optional && tries_ == kTries))) {
    answered(now);
    return poll(now);
  }
  if (tries_ == kTries) {
    reasons().note(Rank::kSilent, "connected, but no answer to " + step.name, now, 1,
                   "is this the range finder's line?");
    count("start-ups without an answer");
    lost_ = true;
    return {};
  }
  ++tries_;
  asked_at_ = now;
  return tries_ == kTries ? step.bytes + step.otherwise : step.bytes;
}

void StartedDevice::deliver(RangeScan scan, int64_t now) {
  last_scan_ = now;
  starts_without_scan_ = 0;
  reasons().clear();
  if (scans_.size() < kMostScans)
    scans_.push_back(std::move(scan));
  else
    count("scans dropped: not fetched");
}

std::vector<RangeScan> StartedDevice::take(int64_t /*now*/) {
  return std::exchange(scans_, {});
}

}  // namespace tread::lidar
