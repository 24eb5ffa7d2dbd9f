// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>

#include "common/bus/channels.hpp"
#include "common/bus/virtual_bus.hpp"
#include "common/pattern/pattern.hpp"

namespace tread::faults {

/// A set with turns and speeds that differ from the vehicle's.
std::optional<PatternSet> wrongSet(const PatternSet& shipped, double strength, int64_t version);

/// Messages of an attacker.
class Forger {
 public:
  Forger(VirtualBus& bus, const Pose2& T_map_goal, const PatternSet& shipped)
      : bus_(bus), T_map_goal_(T_map_goal), shipped_(shipped) {}

  /// One message on a channel; the content depends on `strength` 0..1 and on the number of messages
  /// sent.
  void send(const std::string& channel, double strength);

 private:
  template <class Message>
  void inject(const Channel<Message>& channel, Message& message, int64_t utime);
  void arm();
  void goal(double strength);
  void program(double strength);
  void patternSet(double strength);
  void clearing();
  void map(double strength);
  void ins(double strength);
  void notice();
  void manual(double strength);
  void fence(double strength);
  void stopping(double strength);
  /// The operator's name, or a stranger's.
  std::string name() const;

  VirtualBus& bus_;
  Pose2 T_map_goal_;
  const PatternSet& shipped_;
  int64_t count_ = 0;
};

}  // namespace tread::faults
