// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/top/monitor.hpp"

#include <algorithm>
#include <optional>
#include <sstream>
#include <utility>

#include "common/bus/bus.hpp"
#include "common/log/event_log.hpp"
#include "common/report/text.hpp"
#include "lcmtypes/enums.hpp"

namespace tread::top {
namespace {

constexpr double kSilentProcess = 2.5;     // [s]; HEALTH comes every second
constexpr double kSlow = 0.7;              // [1] of the nominal rate
constexpr int64_t kMostMissing = 100'000;  // a larger gap is a restarted counter

const ChannelSpec* specOf(const std::string& channel) {
  const auto found = std::find_if(kChannels.begin(), kChannels.end(),
                                  [&](const ChannelSpec& spec) { return channel == spec.name; });
  return found == kChannels.end() ? nullptr : &*found;
}

int64_t bigEndian(const uint8_t* bytes) {
  uint64_t value = 0;
  for (int i = 0; i < 8; ++i) value = value << 8 | bytes[i];
  return static_cast<int64_t>(value);
}

/// Some channels have several senders, each with its own counter.
uint64_t senderOf(const std::string& channel, const std::vector<uint8_t>& bytes) {
  const LogEvent event{0, channel, bytes};
  health_t health;
  config_t config;
  operator_t person;
  fences_t fences;
  if (decode(event, kHealth, health))
    return std::hash<std::string>()(health.process) ^ static_cast<uint64_t>(health.boot_id);
  if (decode(event, kConfig, config))
    return std::hash<std::string>()(config.config_process) ^
           static_cast<uint64_t>(config.config_boot_id);
  if (decode(event, kFences, fences)) return std::hash<std::string>()(fences.keeper);
  if (decode(event, kOperator, person)) return static_cast<uint64_t>(person.station);
  return 0;
}

/// Counts only channels whose senders can be distinguished.
bool counts(const std::string& channel) {
  return channel != kArm.name && channel != kEstop.name && channel != kFence.name &&
         channel != kMark.name && channel != kGoal.name && channel != kManual.name;
}

std::string ageWords(double seconds) {
  return seconds < 100.0 ? formatted("%6.2f s", seconds) : formatted("%6.0f s", seconds);
}

/// The bridge's state in a word, and how bad it is.
std::pair<const char*, Mood> wordOf(std::optional<BridgeState> state) {
  if (!state) return {"unknown", Mood::kDoubt};
  switch (*state) {
    case BridgeState::kArmed:
      return {"armed", Mood::kGood};
    case BridgeState::kDriving:
      return {"driving", Mood::kGood};
    case BridgeState::kManual:
      return {"by hand", Mood::kGood};
    case BridgeState::kStopping:
      return {"stopping", Mood::kDoubt};
    case BridgeState::kFault:
      return {"FAULT", Mood::kBad};
    case BridgeState::kEstop:
      return {"E-STOP", Mood::kBad};
    case BridgeState::kDisarmed:
      break;
  }
  return {"disarmed", Mood::kDoubt};
}

}  // namespace

std::optional<KernelCounters> kernelCounters(const std::string& snmp) {
  std::istringstream lines(snmp);
  std::vector<std::string> names;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string head;
    words >> head;
    if (head != "Udp:") continue;
    std::vector<std::string> fields;
    for (std::string word; words >> word;) fields.push_back(word);
    if (names.empty()) {
      names = fields;
      continue;
    }
    KernelCounters counters;
    for (size_t i = 0; i < std::min(names.size(), fields.size()); ++i) {
      if (names[i] == "RcvbufErrors") counters.buffer_errors = std::atoll(fields[i].c_str());
    }
    return counters;
  }
  return std::nullopt;
}

void Monitor::take(const KernelCounters& counters) {
  if (!kernel_begun_) kernel_begun_ = counters;
  kernel_ = counters;
}

void Monitor::take(const std::string& channel, const uint8_t* bytes, size_t size, int64_t now) {
  if (begun_ == 0) begun_ = now;
  if (specOf(channel) == nullptr && streams_.size() >= kMostNames && streams_.count(channel) == 0)
    return;
  Stream& stream = streams_[channel];
  stream.recent.emplace_back(now, size);
  while (now - stream.recent.front().first > kWindow) stream.recent.pop_front();
  stream.last = now;
  stream.largest = std::max(stream.largest, size);
  ++stream.messages;
  const LogEvent event{now, channel, {bytes, bytes + size}};
  count(stream, channel, event.bytes);
  health_t health;
  motor_t motor;
  plan_t plan;
  if (decode(event, kHealth, health) &&
      (processes_.size() < kMostNames || processes_.count(health.process) > 0))
    processes_[health.process] = {now, health};
  if (decode(event, kMotor, motor)) motor_ = motor;
  if (decode(event, kPlan, plan)) plan_ = plan;
}

void Monitor::count(Stream& stream, const std::string& channel, const std::vector<uint8_t>& bytes) {
  constexpr size_t kSeqAt = 16;  // after the fingerprint and utime
  if (specOf(channel) == nullptr || !counts(channel)) return;
  if (bytes.size() < kSeqAt + 8) {
    ++stream.broken;
    return;
  }
  const int64_t seq = bigEndian(bytes.data() + kSeqAt);
  if (stream.numbers.size() >= kMostNames) stream.numbers.clear();
  const auto [newest, first] = stream.numbers.try_emplace(senderOf(channel, bytes), seq);
  const int64_t missing = seq - newest->second - 1;
  if (!first && missing > 0 && missing < kMostMissing) stream.lost += missing;
  newest->second = seq;
}

Line Monitor::lineOf(const std::string& channel, const Stream& stream, int64_t now) const {
  const ChannelSpec* const spec = specOf(channel);
  size_t recent = 0, bytes = 0;
  for (const auto& [time, size] : stream.recent)
    if (now - time <= kWindow) {
      ++recent;
      bytes += size;
    }
  const double span =
      static_cast<double>(std::clamp<int64_t>(now - begun_, 500'000, kWindow)) * 1e-6;
  const double rate = static_cast<double>(recent) / span;
  const double age = static_cast<double>(now - stream.last) * 1e-6;
  const double nominal = spec == nullptr ? 0.0 : spec->rate_hz;
  // A channel with several publishers, or of operators, has no nominal rate.
  const bool steady = nominal >= 1.0 && channel != kHealth.name && channel != kOperator.name &&
                      channel != kManual.name && channel != kGoal.name;
  const bool slow = steady && rate < kSlow * nominal;
  const bool stale = steady && age > std::max(1.0, 5.0 / nominal);
  Line line;
  line.mood = stale                                          ? Mood::kBad
              : slow || stream.lost > 0 || stream.broken > 0 ? Mood::kDoubt
              : spec == nullptr                              ? Mood::kDoubt
                                                             : Mood::kPlain;
  line.text =
      formatted("%-14s %7.1f", channel.c_str(), rate) +
      (nominal > 0.0 ? formatted(" %6.1f", nominal) : std::string("      -")) + " " +
      ageWords(age) +
      formatted(" %7zu %8.1f %6lld", stream.largest, static_cast<double>(bytes) / span / 1000.0,
                static_cast<long long>(stream.lost));
  if (stale) line.text += "  silent";
  if (slow && !stale) line.text += "  slow";
  if (stream.broken > 0)
    line.text += formatted("  %lld broken", static_cast<long long>(stream.broken));
  if (spec == nullptr) line.text += "  not of Tread";
  return line;
}

Line Monitor::lineOf(const Process& process, int64_t now) const {
  const double age = static_cast<double>(now - process.heard) * 1e-6;
  const bool silent = age > kSilentProcess;
  const int16_t state = process.health.health_state;
  Line line;
  line.mood = silent || state == health_t::HEALTH_FAILED ? Mood::kBad
              : state == health_t::HEALTH_OK             ? Mood::kGood
                                                         : Mood::kDoubt;
  const char* const word = silent                               ? "silent"
                           : state == health_t::HEALTH_OK       ? "ok"
                           : state == health_t::HEALTH_DEGRADED ? "degraded"
                                                                : "FAILED";
  line.text = formatted("%-14s %-9s", process.health.process.c_str(), word) + ageWords(age);
  if (process.health.cycle_max > 0)
    line.text += formatted("  step %5.1f ms", process.health.cycle_max * 1e-3);
  if (process.health.lost + process.health.undecodable > 0)
    line.text += formatted("  lost %lld broken %lld", static_cast<long long>(process.health.lost),
                           static_cast<long long>(process.health.undecodable));
  if (!process.health.health_reason.empty()) line.text += "  " + process.health.health_reason;
  return line;
}

std::vector<Line> Monitor::lines(int64_t now) const {
  std::vector<Line> lines;
  if (motor_) {
    const auto [word, mood] = wordOf(knownBridgeState(motor_->bridge_state));
    lines.push_back({mood, std::string("motors   ") + word + ": " + motor_->state_reason});
  } else {
    lines.push_back({Mood::kBad, "motors   no MOTOR message: is tread-motor-bridge running?"});
  }
  if (plan_)
    lines.push_back(
        {Mood::kPlain,
         "planner  " + (plan_->reason.empty() ? std::string("no stop reported") : plan_->reason)});
  if (kernel_) {
    const int64_t lost = kernel_->buffer_errors - kernel_begun_->buffer_errors;
    lines.push_back(
        {lost > 0 ? Mood::kBad : Mood::kPlain,
         formatted("kernel   %lld datagrams dropped (full buffer) since tread-top started%s",
                   static_cast<long long>(lost), lost > 0 ? ": config/sysctl/60-tread.conf" : "")});
  }
  if (!doubt_.empty()) lines.push_back({Mood::kBad, "trust    " + doubt_});
  lines.push_back({Mood::kTitle, "CHANNEL           /s  table       age   bytes     kB/s   lost"});
  for (const ChannelSpec& spec : kChannels)
    if (const auto stream = streams_.find(spec.name); stream != streams_.end())
      lines.push_back(lineOf(stream->first, stream->second, now));
  for (const auto& [channel, stream] : streams_)
    if (specOf(channel) == nullptr) lines.push_back(lineOf(channel, stream, now));
  lines.push_back({Mood::kTitle, "PROCESS        state          age"});
  for (const auto& [name, process] : processes_) lines.push_back(lineOf(process, now));
  if (processes_.empty()) lines.push_back({Mood::kBad, "none heard"});
  return lines;
}

}  // namespace tread::top
