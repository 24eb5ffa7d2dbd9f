// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/kangaroo/kangaroo_connection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tread::motor {
namespace {

constexpr std::array<char, 2> kChannels{'1', '2'};
constexpr int64_t kAskInterval = 50'000;      // [us]
constexpr int64_t kSetUpRepeat = 500'000;     // [us]
constexpr int64_t kTimeoutStep = 62'500;      // [us] 1/16 s
constexpr int64_t kStatusMaxAge = 1'000'000;  // [us]

/// Errors cleared by a start: the channel is at rest before and after it.
bool isCleared(int32_t error) {
  const auto kind = static_cast<KangarooError>(error);
  return kind == KangarooError::kNotStarted || kind == KangarooError::kSerialTimeout;
}

std::string keyOf(char channel) {
  return {channel};
}

}  // namespace

KangarooConfig readKangarooConfig(ConfigReader& reader, const DriveDescription& drive) {
  KangarooConfig config;
  config.full_speed = drive.full_speed;
  config.left_channel = drive.left_channel;
  config.invert_left = drive.invert_left;
  config.invert_right = drive.invert_right;
  int64_t address = config.address;
  reader.integer("address", address, {128.0, 135.0}, "");
  config.address = static_cast<int>(address);
  reader.number("units_per_metre", config.units_per_metre, {1.0, 1e6}, "1/m", true);
  config.times.watchdog_us = 3 * kTimeoutStep;
  reader.seconds("watchdog", config.times.watchdog_us, {0.1875, 0.5});
  if (config.times.watchdog_us % kTimeoutStep != 0)
    throw reader.error("watchdog", "must be a multiple of 1/16 s: 0.1875, 0.25, ...");
  return config;
}

std::string KangarooConnection::commandBytes(const TrackCommand& command) const {
  // NaN becomes zero: this is the last check.
  const auto unitsOf = [&](double speed, bool invert) {
    if (!std::isfinite(speed)) return int64_t{0};
    const double held = std::clamp(speed, -config_.full_speed, config_.full_speed);
    const int64_t units = std::lround(held * config_.units_per_metre);
    return invert ? -units : units;
  };
  int64_t first = unitsOf(command.left, config_.invert_left);
  int64_t second = unitsOf(command.right, config_.invert_right);
  if (config_.left_channel == 2) std::swap(first, second);
  return kangarooSpeed(config_.address, kChannels[0], first) +
         kangarooSpeed(config_.address, kChannels[1], second);
}

std::string KangarooConnection::setUp() const {
  return kangarooTimeout(config_.address, static_cast<int>(times().watchdog_us / kTimeoutStep));
}

std::string KangarooConnection::startupName(int step) const {
  switch (step) {
    case kFirst:
      return "the start of channel 1";
    case kSecond:
      return "the start of channel 2";
    default:
      return "start-up";
  }
}

std::string KangarooConnection::startupRequest(int step) const {
  if (step == kZero) return zero();
  const char channel = kChannels[step == kFirst ? 0 : 1];
  return setUp() + kangarooStart(config_.address, channel) +
         kangarooSpeed(config_.address, channel, 0) + kangarooGetSpeed(config_.address, channel);
}

void KangarooConnection::forget() {
  packets_.clear();
  pending_.clear();
  output_.clear();
}

void KangarooConnection::begin(int64_t now) {
  stopped_ = false;
  asked_at_ = set_up_at_ = now;
  for (Channel& channel : channels_) channel.heard_at = now;
}

void KangarooConnection::receive(std::string_view bytes, int64_t now) {
  for (const KangarooPackets::Packet& packet : packets_.push(bytes)) {
    KangarooStatus status;
    if (readKangarooStatus(packet, status))
      take(status, now);
    else
      count("unexpected packets");
  }
}

void KangarooConnection::take(const KangarooStatus& status, int64_t now) {
  const auto known = std::find(kChannels.begin(), kChannels.end(), status.channel);
  if (known == kChannels.end()) return count("unexpected packets");
  const auto index = static_cast<size_t>(known - kChannels.begin());
  if (ready()) {
    if (!pending_.answered(keyOf(status.channel))) return;
    channels_[index] = {now, status};
    stopped_ = stopped_ || (status.error && isCleared(status.value));
  } else if (waitingStep() == kFirst + static_cast<int>(index)) {
    channels_[index] = {now, status};
    if (!status.error) return stepDone(now);
    const auto error = static_cast<KangarooError>(status.value);
    if (isCleared(status.value) || error == KangarooError::kControl) return stepRefused(now);
    fail("channel " + keyOf(status.channel) + " " + describe(error), now);
  }
}

void KangarooConnection::give(const Command& command, int64_t /*now*/) {
  output_ += commandBytes(command.tracks());
  ++commands_;
}

void KangarooConnection::releaseStop(int64_t /*now*/) {
  if (!ready()) return;
  for (const Channel& channel : channels_) {
    if (!channel.told.error) continue;
    output_ += kangarooStart(config_.address, channel.told.channel) +
               kangarooSpeed(config_.address, channel.told.channel, 0);
  }
}

std::string KangarooConnection::talk(int64_t now) {
  pending_.expire(now, times().reply_timeout_us);
  if (now - set_up_at_ >= kSetUpRepeat) {
    set_up_at_ = now;
    output_ += setUp();
  }
  if (now - asked_at_ >= kAskInterval) {
    asked_at_ = now;
    output_ += kangarooGetSpeed(config_.address, kChannels[next_]);
    pending_.querySent(keyOf(kChannels[next_]), now);
    next_ = 1 - next_;
  }
  return std::exchange(output_, {});
}

std::string KangarooConnection::lost(int64_t now) const {
  if (stopped_) return "a channel is not started any more: it was restarted, or timed out";
  const int64_t heard = std::max(channels_[0].heard_at, channels_[1].heard_at);
  return now - heard > times().silence_limit_us ? "it does not answer" : "";
}

DeviceReport KangarooConnection::reported(int64_t now) const {
  DeviceReport report;
  for (size_t i = 0; i < channels_.size(); ++i) {
    if (now - channels_[i].heard_at > kStatusMaxAge)
      report.link_fault = "channel " + keyOf(kChannels[i]) + " does not answer";
    if (!channels_[i].told.error) continue;
    report.device_fault += (report.device_fault.empty() ? "channel " : "; channel ") +
                           keyOf(kChannels[i]) + " " +
                           describe(static_cast<KangarooError>(channels_[i].told.value));
  }
  return report;
}

double KangarooConnection::speedOf(bool left) const {
  const bool first = left == (config_.left_channel == 1);
  const KangarooStatus& told = channels_[first ? 0 : 1].told;
  if (!ready() || told.channel == 0 || told.error) return std::numeric_limits<double>::quiet_NaN();
  const double speed = told.value / config_.units_per_metre;
  return (left ? config_.invert_left : config_.invert_right) ? -speed : speed;
}

MotorTelemetry KangarooConnection::telemetry() const {
  MotorTelemetry telemetry;
  telemetry.measured = {speedOf(true), speedOf(false)};
  return telemetry;
}

std::string KangarooConnection::notice() const {
  return "a Kangaroo does not report its serial timeout, and any packet restarts it; test it with "
         "the tracks off the ground";
}

std::map<std::string, int64_t> KangarooConnection::counted() const {
  std::map<std::string, int64_t> counters = pending_.counters();
  counters["commands given"] += commands_;
  counters["bad checksums"] += packets_.badChecksums();
  counters["garbage bytes"] += packets_.garbageBytes();
  return counters;
}

}  // namespace tread::motor
