// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/roboteq/roboteq_codec.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

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

/// Numbers separated by colons; empty if one of them is none.
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

std::vector<std::string> RoboteqLines::push(std::string_view bytes) {
  std::vector<std::string> lines;
  for (const char byte : bytes) {
    if (byte == '\r') {
      if (!line_.empty() && !discarding_) lines.push_back(line_);
      line_.clear();
      discarding_ = false;
    } else if (byte < ' ' || byte > '~') {
      garbage_ += byte != '\n';
    } else if (line_.size() == kMaxLine) {
      overlong_ += !discarding_;
      discarding_ = true;
    } else {
      line_ += byte;
    }
  }
  return lines;
}

void RoboteqLines::clear() {
  line_.clear();
  discarding_ = false;
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

}  // namespace tread::motor
