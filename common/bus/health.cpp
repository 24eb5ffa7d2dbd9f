// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/bus/health.hpp"

#include "common/messages/blank.hpp"

namespace tread {
namespace {

constexpr int64_t kHealthPeriodUs = 1'000'000;
constexpr int64_t kConfigPeriodUs = 10'000'000;
/// CONFIG stays within one datagram.
constexpr size_t kMaxConfigBytes = 50'000;

}  // namespace

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

void HealthReporter::setCounter(const std::string& name, int64_t value) {
  counters_[name] = value;
}

void HealthReporter::addToCounter(const std::string& name, int64_t increment) {
  counters_[name] += increment;
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
  health.health_state = state_;
  health.health_reason = reason_;
  health.received = statistics.received;
  health.undecodable = statistics.undecodable;
  health.lost = statistics.lost;
  health.late = statistics.late;
  // A message of another program is no fault of this process, but its line must be seen.
  if (health.health_reason.empty()) health.health_reason = statistics.last_refusal;
  const auto add = [&health](const std::string& name, int64_t value) {
    auto counter = blank<counter_t>();
    counter.counter_name = name;
    counter.counted = value;
    health.counters.push_back(counter);
  };
  for (const auto& [name, value] : counters_) add(name, value);
  if (statistics.jumps > 0) add("time jumps refused", statistics.jumps);
  health.num_counters = static_cast<int32_t>(health.counters.size());
  const CycleTimes cycles = bus_.takeCycleTimes();
  health.cycle_mean = cycles.mean_us;
  health.cycle_max = cycles.max_us;
  bus_.publish(kHealth, health);
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
