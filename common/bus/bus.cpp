// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/bus/bus.hpp"

#include <algorithm>
#include <cstdlib>
#include <iomanip>
#include <sstream>

#include "common/config/problem_words.hpp"
#include "common/messages/blank.hpp"

namespace tread {
namespace {

/// No publisher sends this many; a higher seq comes from a broken message.
constexpr int64_t kLargestSeq = 1'000'000'000'000;

constexpr int64_t kHealthPeriodUs = 1'000'000;
constexpr int64_t kConfigPeriodUs = 10'000'000;
/// A process that is silent for this long is gone.
constexpr int64_t kNamesakeLife = 3 * kHealthPeriodUs;
constexpr size_t kMostNamesakes = 8;
constexpr size_t kMostOfStop = 65'507;  // [bytes] of a datagram
/// Counters named after numbers or foreign messages could make HEALTH too large to send.
constexpr size_t kMostCounters = 50;
constexpr size_t kLongestCounter = 120;  // [bytes]
constexpr size_t kLongestReason = 1000;  // [bytes]
/// CONFIG stays within one datagram.
constexpr size_t kMaxConfigBytes = 50'000;

/// Why a message is refused, and the remedy.
std::string remedyFor(SealVerdict verdict) {
  switch (verdict) {
    case SealVerdict::kUnsealed:
      return "start its sender with --key FILE";
    case SealVerdict::kWrongTag:
      return "its sender has another key, or somebody changed it";
    case SealVerdict::kOtherSession:
      return "it was sent from another host, or recorded before the robot's last start";
    case SealVerdict::kTooManySenders:
      return "stop the program that keeps restarting senders";
    default:
      return "it was recorded, or delayed in transit";
  }
}

}  // namespace

void Bus::setSealer(std::optional<Sealer> sealer) {
  sealer_.reset();
  if (sealer) sealer_.emplace(std::move(*sealer), sealClock());
}

std::vector<std::string> Bus::heard() const {
  std::vector<std::string> channels;
  for (const auto& [channel, subscribed] : subscribed_) channels.push_back(channel);
  return channels;
}

void Bus::receive(const std::string& channel, const uint8_t* bytes, size_t size) {
  const auto found = subscribed_.find(channel);
  if (found == subscribed_.end()) return receiveBeside(channel, bytes, size);
  const std::optional<size_t> message = unseal(channel, found->second, bytes, size);
  if (!message) return;
  // Index loop: a handler may subscribe.
  for (size_t i = 0; i < found->second.handlers.size(); ++i)
    deliver(found->second.handlers[i], channel, bytes, *message);
}

/// No node both subscribes to a channel and overhears it.
void Bus::receiveBeside(const std::string& channel, const uint8_t* bytes, size_t size) {
  const auto found = overheard_.find(channel);
  if (found == overheard_.end() || !hasCompany() || size > found->second.most) return;
  size_t message = sizeWithoutSeal(bytes, size);
  if (sealer_) {
    const OpenedSeal opened = sealer_->open(channel, bytes, size, sealClock());
    if (opened.verdict != SealVerdict::kGood) return;
    message = opened.size;
  }
  for (const RawHandler& handler : found->second.handlers)
    deliver(handler, channel, bytes, message);
}

bool Bus::hearsTwoSessions() const {
  return sealer_ && sealer_->hearsTwoSessions(sealClock());
}

std::optional<size_t> Bus::unseal(const std::string& channel, const Subscribed& subscribed,
                                  const uint8_t* bytes, size_t size) {
  trusted_ = true;
  if (size > subscribed.most) {
    // A stop is accepted from everybody, however long its reason is.
    const size_t without = sizeWithoutSeal(bytes, size);
    trusted_ = false;
    if (size <= kMostOfStop && subscribed.stops != nullptr && subscribed.stops(bytes, without))
      return without;
    refuse(channel, "too large",
           std::to_string(size) + " bytes; no program of Tread sends that many");
    return std::nullopt;
  }
  if (!sealer_) {
    const size_t without = sizeWithoutSeal(bytes, size);
    statistics_.sealed_unread |= without != size;
    return without;
  }
  const OpenedSeal opened = sealer_->open(channel, bytes, size, sealClock());
  if (opened.verdict == SealVerdict::kGood) return opened.size;
  trusted_ = false;
  if (subscribed.stops != nullptr && subscribed.stops(bytes, opened.size)) return opened.size;
  refuse(channel, toWords(opened.verdict), remedyFor(opened.verdict));
  return std::nullopt;
}

void Bus::refuse(const std::string& channel, const std::string& why, const std::string& remedy) {
  ++statistics_.refused[why];
  statistics_.last_refusal = channel + ": a message refused: " + why + "; " + remedy;
}

void Bus::deliver(const RawHandler& handler, const std::string& channel, const uint8_t* bytes,
                  size_t size) {
  try {
    handler(bytes, size);
  } catch (const std::exception& error) {
    ++statistics_.failed;
    statistics_.last_refusal = channel + ": handler failed: " + wordsOf(error);
  }
}

void Bus::noteReceipt(const ChannelSpec& spec, int64_t utime, int64_t seq) {
  ++statistics_.received;
  statistics_.newest = {spec.name, utime, seq};
  // A message that may be old (a map tile) does not give the time, nor does a stranger's.
  if (spec.max_age_ms > 0 && trusted_ && !onReceipt(utime)) {
    ++statistics_.jumps;
    statistics_.last_refusal = std::string(spec.name) + ": utime " + std::to_string(utime) +
                               " is not of the present; is its publisher's clock CLOCK_MONOTONIC?";
  }
  // Computed as a difference, so that the numbers of a broken message cannot overflow.
  if (spec.max_age_ms > 0 && utime < now() - spec.max_age_ms * int64_t{1000}) ++statistics_.late;
  // HEALTH, CONFIG, ESTOP, FENCE, FENCES and MARK have several publishers, so gaps are normal
  // there.
  const bool one_publisher = std::string(spec.publisher).find("every") == std::string::npos &&
                             std::string(spec.publisher) != "anyone";
  if (one_publisher && seq >= 0 && seq <= kLargestSeq) noteLoss(spec, utime, seq);
}

void Bus::noteLoss(const ChannelSpec& spec, int64_t utime, int64_t seq) {
  const auto [known, first] = newest_.try_emplace(spec.name, Newest{seq, utime});
  Newest& newest = known->second;
  if (first || seq == newest.seq) return;
  // For messages that may be old, a late message and a restarted publisher look alike.
  if (spec.max_age_ms > 0 && seq < newest.seq && utime < newest.utime) {
    // It arrived out of order and was counted as lost before.
    if (statistics_.lost > 0) --statistics_.lost;
    return;
  }
  // A restarted publisher counts from the beginning: no loss.
  if (seq > newest.seq + 1) statistics_.lost += seq - newest.seq - 1;
  newest = {seq, utime};
}

void Bus::noteUndecodable(const ChannelSpec& spec, size_t size) {
  ++statistics_.undecodable;
  std::ostringstream line;
  line << spec.name << ": a message of " << size << " bytes is not a " << spec.type
       << "; another program publishes on this channel, or was built with other message types";
  statistics_.last_refusal = line.str();
}

bool Bus::refuseOversized(const ChannelSpec& spec, int size) {
  ++statistics_.oversized;
  std::ostringstream line;
  line << spec.name << ": a message of " << size << " bytes was not sent; allowed "
       << spec.max_bytes;
  statistics_.last_refusal = line.str();
  return false;
}

std::string inWords(const health_t& health) {
  const std::string state = health.health_state == health_t::HEALTH_OK         ? "OK"
                            : health.health_state == health_t::HEALTH_DEGRADED ? "DEGRADED"
                                                                               : "FAILED";
  return health.health_reason.empty() ? state : state + ": " + health.health_reason;
}

HealthReporter::HealthReporter(Bus& bus, std::string process, std::string effective_config)
    : bus_(bus),
      process_(std::move(process)),
      config_text_(std::move(effective_config)),
      boot_id_(bus.bootId()) {
  if (config_text_.size() > kMaxConfigBytes) config_text_.resize(kMaxConfigBytes);
}

void HealthReporter::setState(int16_t state, const std::string& reason) {
  state_ = state;
  reason_ = reason;
}

void HealthReporter::fail(const std::string& reason) {
  if (state_ != health_t::HEALTH_FAILED) next_health_ = 0;
  setState(health_t::HEALTH_FAILED, reason);
}

void HealthReporter::watchNamesakes() {
  bus_.overhear<health_t>(kHealth, [this](const health_t& health) {
    if (health.process != process_ || health.boot_id == boot_id_) return;
    const int64_t now = bus_.now();
    // Broken messages may contain any number.
    if (namesakes_.size() >= kMostNamesakes && namesakes_.count(health.boot_id) == 0)
      namesakes_.clear();
    Namesake& other = namesakes_[health.boot_id];
    if (std::abs(now - other.heard) > kNamesakeLife) other.count = 0;
    other = {health.boot_id, now, other.count + 1};
  });
}

std::optional<Namesake> HealthReporter::namesake(int64_t now, int heard_at_least) const {
  for (const auto& [boot_id, other] : namesakes_)
    if (other.count >= heard_at_least && std::abs(now - other.heard) <= kNamesakeLife) return other;
  return std::nullopt;
}

std::string HealthReporter::describe(int64_t utime) const {
  // A foreign message is no fault of this process, but its line must be visible.
  std::string words = reason_.empty() ? bus_.statistics().last_refusal : reason_;
  const std::optional<Namesake> other = namesake(utime);
  if (!other) return words;
  std::ostringstream line;
  line << std::fixed << std::setprecision(1) << "two processes " << process_
       << " run, this one since " << static_cast<double>(boot_id_) * 1e-6
       << " s of the host's clock and another since " << static_cast<double>(other->boot_id) * 1e-6
       << " s; stop one of them";
  return words.empty() ? line.str() : words + "; " + line.str();
}

void HealthReporter::setCounter(const std::string& name, int64_t value) {
  counters_[name] = value;
}

void HealthReporter::addToCounter(const std::string& name, int64_t increment) {
  const std::string known = name.substr(0, kLongestCounter);
  const bool room = counters_.size() < kMostCounters || counters_.count(known) > 0;
  counters_[room ? known : "others"] += increment;
}

void HealthReporter::step(int64_t utime) {
  if (utime >= next_config_) {
    publishConfig(utime);
    next_config_ = utime + kConfigPeriodUs;
  }
  if (utime >= next_health_) {
    publishHealth(utime);
    next_health_ = utime + kHealthPeriodUs;
  }
}

void HealthReporter::publishHealth(int64_t utime) {
  const BusStatistics& statistics = bus_.statistics();
  auto health = blank<health_t>();
  health.utime = utime;
  health.seq = seq_health_++;
  health.utc = bus_.utc();
  health.process = process_;
  health.boot_id = boot_id_;
  health.health_state =
      namesake(utime) ? std::max<int16_t>(state_, health_t::HEALTH_DEGRADED) : state_;
  health.health_reason = describe(utime).substr(0, kLongestReason);
  health.received = statistics.received;
  health.undecodable = statistics.undecodable;
  health.lost = statistics.lost;
  health.late = statistics.late;
  const auto add = [&health](const std::string& name, int64_t value) {
    auto counter = blank<counter_t>();
    counter.counter_name = name;
    counter.counted = value;
    health.counters.push_back(counter);
  };
  for (const auto& [name, value] : counters_) add(name, value);
  for (const auto& [why, count] : statistics.refused) add("refused: " + why, count);
  if (statistics.jumps > 0) add("time jumps refused", statistics.jumps);
  health.num_counters = static_cast<int32_t>(health.counters.size());
  const CycleTimes cycles = bus_.takeCycleTimes();
  health.cycle_mean = cycles.mean_us;
  health.cycle_max = cycles.max_us;
  bus_.publish(kHealth, health);
  bus_.tellStarter(inWords(health));
}

void HealthReporter::publishConfig(int64_t utime) {
  auto config = blank<config_t>();
  config.utime = utime;
  config.seq = seq_config_++;
  config.config_process = process_;
  config.config_boot_id = boot_id_;
  config.config_text = config_text_;
  bus_.publish(kConfig, config);
}

}  // namespace tread
