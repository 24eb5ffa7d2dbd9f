// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/roboteq/roboteq_session.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace tread::motor {
namespace {

int perMille(double value, bool invert, double full_scale) {
  const double scaled = std::round(1000.0 * value / full_scale);
  if (!std::isfinite(scaled)) return 0;
  const int magnitude = static_cast<int>(std::clamp(scaled, -1000.0, 1000.0));
  return invert ? -magnitude : magnitude;
}

std::optional<long> parseNumber(const std::string& text) {
  char* end = nullptr;
  const long number = std::strtol(text.c_str(), &end, 10);
  const bool whole = !text.empty() && *end == '\0';
  return whole ? std::optional<long>(number) : std::nullopt;
}

/// Numbers separated by colons; empty if one of them is invalid.
std::vector<long> parseNumbers(const std::string& text) {
  std::vector<long> numbers;
  size_t begin = 0;
  while (begin <= text.size()) {
    const size_t end = std::min(text.find(':', begin), text.size());
    const std::optional<long> number = parseNumber(text.substr(begin, end - begin));
    if (!number) return {};
    numbers.push_back(*number);
    begin = end + 1;
  }
  return numbers;
}

struct FlagName {
  int32_t flag;
  const char* name;
};

constexpr FlagName kFaultNames[] = {{kOverheat, "overheat"},
                                    {kOvervoltage, "overvoltage"},
                                    {kUndervoltage, "undervoltage"},
                                    {kShortCircuit, "short circuit"},
                                    {kEmergencyStop, "emergency stop"},
                                    {kSensorSetup, "sensor or set-up fault"},
                                    {kMosfetFailure, "MOSFET failure"},
                                    {kDefaultConfiguration, "default configuration loaded"}};
constexpr FlagName kStatusNames[] = {{kPowerStageOff, "power stage off"},
                                     {kStallDetected, "stall detected"}};

constexpr FlagName kMotorNames[] = {
    {kMotorStall, "stall"}, {kLoopError, "loop error"}, {kSafetyStop, "safety stop"}};

/// The controller's emergency stop and its release are repeated at this interval, the release for
/// this long [us].
constexpr int64_t kStopRepeat = 100'000;
constexpr int64_t kReleaseSpan = 1'000'000;

/// Values of channels 1 and 2 as left and right.
std::pair<double, double> toSides(const std::vector<long>& values, const RoboteqLayout& layout) {
  const auto one = static_cast<double>(values[0]);
  const auto two = static_cast<double>(values[1]);
  return layout.left_channel == 1 ? std::pair(one, two) : std::pair(two, one);
}

/// Flags have at most 16 bits: larger values are a corrupt line, and truncated they could mean "no
/// fault".
bool areFlags(const std::vector<long>& values) {
  return values.size() == 1 && values[0] >= 0 && values[0] <= 0xffff;
}

/// The same for both motors.
bool areMotorFlags(const std::vector<long>& values) {
  return values.size() >= 2 && areFlags({values[0]}) && areFlags({values[1]});
}

}  // namespace

ChannelCommand toChannels(const TrackCommand& command, const RoboteqLayout& layout) {
  const int left = perMille(command.left, layout.invert_left, layout.full_scale);
  const int right = perMille(command.right, layout.invert_right, layout.full_scale);
  return layout.left_channel == 1 ? ChannelCommand{left, right} : ChannelCommand{right, left};
}

std::vector<std::string> commandLines(const TrackCommand& command, const RoboteqLayout& layout) {
  const ChannelCommand channels = toChannels(command, layout);
  const std::string one = std::to_string(channels.channel_1);
  const std::string two = std::to_string(channels.channel_2);
  if (layout.both_in_one_line) return {"!M " + one + " " + two};
  return {"!G 1 " + one, "!G 2 " + two};
}

bool isEcho(const std::string& line) {
  return line.size() > 1 && std::string_view("!?^~%#").find(line[0]) != std::string_view::npos;
}

RoboteqReply parseReply(const std::string& line) {
  RoboteqReply reply;
  if (line == "+") {
    reply.kind = RoboteqReply::Kind::kAck;
    return reply;
  }
  if (line == "-") {
    reply.kind = RoboteqReply::Kind::kRefused;
    return reply;
  }
  const size_t equals = line.find('=');
  const bool keyed = equals != std::string::npos && equals > 0 && equals <= 8;
  const bool upper = keyed && std::all_of(line.begin(), line.begin() + static_cast<long>(equals),
                                          [](char c) { return c >= 'A' && c <= 'Z'; });
  if (upper) {
    reply.kind = RoboteqReply::Kind::kValue;
    reply.key = line.substr(0, equals);
    reply.text = line.substr(equals + 1);
    reply.values = parseNumbers(reply.text);
  }
  return reply;
}

std::string describeFaults(int32_t fault_flags, int32_t status_flags) {
  std::string words;
  const auto add = [&words](const char* name) {
    words += words.empty() ? "controller: " : ", ";
    words += name;
  };
  for (const FlagName& fault : kFaultNames) {
    if ((fault_flags & fault.flag) != 0) add(fault.name);
  }
  if ((fault_flags & ~0xff) != 0) add("unknown fault flag");
  for (const FlagName& status : kStatusNames) {
    if ((status_flags & status.flag) != 0) add(status.name);
  }
  return words;
}

std::string describeMotorFaults(const std::string& side, int32_t motor_flags) {
  std::string words;
  for (const FlagName& fault : kMotorNames) {
    if ((motor_flags & fault.flag) == 0) continue;
    words += (words.empty() ? side + " motor: " : ", ") + std::string(fault.name);
  }
  return words;
}

bool RoboteqTelemetry::take(const RoboteqReply& reply, const RoboteqLayout& layout, int64_t now) {
  const std::vector<long>& values = reply.values;
  if (reply.key == "A" && values.size() >= 2) {
    const auto [left, right] = toSides(values, layout);
    current[0] = left / 10.0;
    current[1] = right / 10.0;
  } else if (reply.key == "V" && values.size() >= 2) {
    battery_voltage = static_cast<double>(values[1]) / 10.0;
  } else if (reply.key == "S" && values.size() >= 2 && layout.rpm_per_mps > 0.0) {
    const auto [left, right] = toSides(values, layout);
    measured[0] = (layout.invert_left ? -left : left) / layout.rpm_per_mps;
    measured[1] = (layout.invert_right ? -right : right) / layout.rpm_per_mps;
  } else if (reply.key == "T" && !values.empty()) {
    temperature = static_cast<double>(*std::max_element(values.begin(), values.end()));
  } else if (reply.key == "FM" && areMotorFlags(values)) {
    const auto [left, right] = toSides(values, layout);
    motor_flags_left = static_cast<int32_t>(left);
    motor_flags_right = static_cast<int32_t>(right);
  } else if (reply.key == "FF" && areFlags(values)) {
    fault_flags = static_cast<int32_t>(values[0]);
    faults_read_at = now;
  } else if (reply.key == "FS" && areFlags(values)) {
    status_flags = static_cast<int32_t>(values[0]);
    status_read_at = now;
  } else {
    return false;
  }
  device_flags = (fault_flags & 0xff) | (status_flags & 0xff) << 8;
  return true;
}

RoboteqSession::RoboteqSession(const RoboteqConfig& config)
    : config_(config), queries_{"FS", "A", "FS", "V", "FS", "A", "FS", "T", "FS", "V", "FS", "FM"} {
  if (config_.layout.rpm_per_mps > 0.0) queries_.insert(queries_.end(), {"FS", "S"});
}

void RoboteqSession::begin(int64_t now) {
  output_.clear();
  problem_.clear();
  telemetry_ = RoboteqTelemetry{};
  pending_.clear();
  acked_at_ = now;
  queried_at_ = now;
  checked_at_ = now;
  watchdog_mismatches_ = 0;
  given_ = TrackCommand{};
  repeat_ = false;
}

void RoboteqSession::give(const TrackCommand& command, int64_t now) {
  given_ = command;
  repeat_ = false;
  for (const std::string& line : commandLines(command, config_.layout)) sendCommand(line, now);
}

void RoboteqSession::sendCommand(const std::string& line, int64_t now) {
  output_ += line + "\r";
  pending_.commandSent(now);
}

void RoboteqSession::ask(const std::string& query, const std::string& key, int64_t now) {
  output_ += query + "\r";
  pending_.querySent(key, now);
  queried_at_ = now;
}

void RoboteqSession::holdStop(bool hold) {
  hold_stop_ = hold;
  if (hold) {
    release_now_ = false;
    release_until_ = 0;
  }
}

void RoboteqSession::releaseStop(int64_t now) {
  hold_stop_ = false;
  release_now_ = true;
  release_until_ = now + kReleaseSpan;
}

std::string RoboteqSession::poll(int64_t now) {
  pending_.expire(now, config_.times.reply_timeout_us);
  if (now - acked_at_ > config_.times.silence_limit_us)
    problem_ = "it does not acknowledge commands";
  if (repeat_) give(given_, now);
  pollStop(now);
  pollQuery(now);
  std::string output;
  output.swap(output_);
  return output;
}

void RoboteqSession::pollStop(int64_t now) {
  if (!release_now_ && now - stop_sent_at_ < kStopRepeat) return;
  if (hold_stop_ && !stopLatched()) {
    sendCommand("!EX", now);
    stop_sent_at_ = now;
  } else if (!hold_stop_ && (release_now_ || (now < release_until_ && stopLatched()))) {
    sendCommand("!MG", now);
    give({}, now);
    stop_sent_at_ = now;
    release_now_ = false;
  }
}

void RoboteqSession::pollQuery(int64_t now) {
  // A lost query must not delay the check of the faults until its timeout.
  const bool waiting = pending_.waitsForQuery(now, config_.query_patience_us);
  if (waiting || now - queried_at_ < config_.query_interval_us) return;
  ask("?FF", "FF", now);  // faults stop the robot
  if (now - checked_at_ >= config_.check_interval_us || watchdog_mismatches_ > 0) {
    checked_at_ = now;
    ask("~RWD", "RWD", now);
    return;
  }
  const std::string& key = queries_[next_query_];
  next_query_ = (next_query_ + 1) % queries_.size();
  ask("?" + key, key, now);
}

void RoboteqSession::take(const RoboteqReply& reply, int64_t now) {
  switch (reply.kind) {
    case RoboteqReply::Kind::kAck:
      return takeAck(now);
    case RoboteqReply::Kind::kRefused:
      return takeRefusal(now);
    case RoboteqReply::Kind::kValue:
      return takeValue(reply, now);
    case RoboteqReply::Kind::kOther:
      return;
  }
}

void RoboteqSession::takeAck(int64_t now) {
  if (pending_.acknowledged()) acked_at_ = now;
}

void RoboteqSession::takeRefusal(int64_t now) {
  if (pending_.refused() != PendingReplies::Refused::kCommand) return;
  repeat_ = true;
  // A controller in emergency stop may refuse to move: that is no fault of the link.
  if (stopLatched()) acked_at_ = now;
}

void RoboteqSession::takeValue(const RoboteqReply& reply, int64_t now) {
  pending_.answered(reply.key);
  if (reply.key == "RWD") {
    checkWatchdog(reply);
  } else if (!telemetry_.take(reply, config_.layout, now)) {
    ++unreadable_;
  }
}

std::map<std::string, int64_t> RoboteqSession::counters() const {
  std::map<std::string, int64_t> counters = pending_.counters();
  counters["unreadable replies"] += unreadable_;
  return counters;
}

void RoboteqSession::checkWatchdog(const RoboteqReply& reply) {
  const bool good = reply.values == std::vector<long>{static_cast<long>(config_.watchdog_ms)};
  // A single line may be corrupt; two in a row mean that the controller lost its setting.
  watchdog_mismatches_ = good ? 0 : watchdog_mismatches_ + 1;
  if (watchdog_mismatches_ >= 2) problem_ = "its watchdog setting was lost";
}

}  // namespace tread::motor
