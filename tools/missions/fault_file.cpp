// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/missions/fault_file.hpp"

#include <cmath>

#include "common/bus/channels.hpp"
#include "common/config/config_reader.hpp"
#include "tools/missions/robot_system.hpp"

namespace tread::missions {
namespace {

constexpr Range kShare{0.0, 1.0};
constexpr Range kTime{0.0, 1e6};

int64_t toMicroseconds(double seconds) {
  return std::llround(seconds * 1e6);
}

MessageFault readMessageFault(ConfigReader& reader) {
  MessageFault fault;
  double reorder_s = 0.1, delay_s = 0.0, from_s = 0.0, until_s = 1e6;
  std::vector<std::string> channels{"*"};
  for (const ChannelSpec& channel : kChannels) channels.push_back(channel.name);
  reader.choice("channel", fault.channel, channels);
  std::vector<std::string> receivers = robotNodes();
  receivers.push_back("*");
  reader.choice("receiver", fault.receiver, receivers);
  reader.number("drop", fault.drop, kShare, "1");
  reader.number("duplicate", fault.duplicate, kShare, "1");
  reader.number("corrupt", fault.corrupt, kShare, "1");
  reader.number("reorder", fault.reorder, kShare, "1");
  reader.number("reorder_s", reorder_s, {0.0, 10.0}, "s");
  reader.number("delay_s", delay_s, {0.0, 10.0}, "s");
  reader.number("from_s", from_s, kTime, "s");
  reader.number("until_s", until_s, kTime, "s");
  fault.reorder_us = toMicroseconds(reorder_s);
  fault.delay_us = toMicroseconds(delay_s);
  fault.from = toMicroseconds(from_s);
  fault.until = toMicroseconds(until_s);
  return fault;
}

NodeFault readNodeFault(ConfigReader& reader) {
  NodeFault fault;
  double kill_at_s = 0.0, restart_after_s = -1.0;
  reader.choice("node", fault.node, robotNodes(), true);
  reader.number("kill_at_s", kill_at_s, kTime, "s", true);
  reader.number("restart_after_s", restart_after_s, {-1.0, 1e6}, "s, negative = never");
  fault.kill_at = toMicroseconds(kill_at_s);
  fault.restart_after = restart_after_s < 0.0 ? -1 : toMicroseconds(restart_after_s);
  return fault;
}

}  // namespace

FaultPlan readFaultFile(const std::string& path) {
  ConfigReader reader = ConfigReader::fromFile(path);
  FaultPlan plan;
  for (ConfigReader& entry : reader.sections("messages"))
    plan.messages.push_back(readMessageFault(entry));
  for (ConfigReader& entry : reader.sections("nodes")) plan.nodes.push_back(readNodeFault(entry));
  reader.finish();
  return plan;
}

}  // namespace tread::missions
