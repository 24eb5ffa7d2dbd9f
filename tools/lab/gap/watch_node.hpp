// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>

#include "common/bus/bus.hpp"
#include "tools/lab/gap/watch.hpp"

namespace tread::gap {

/// Reports new differences from the model: on the terminal, in HEALTH of gap_watch, and as a MARK
/// for the log.
/** If the robot's commands are of another kind than the model's, it reports this once, as FAILED,
 * and then stays silent. */
class WatchNode : public Node {
 public:
  WatchNode(Bus& bus, const ModelDocument& model, const WatchLimits& limits);

  int64_t period() const override { return 100'000; }
  void step(int64_t utime) override;
  /// Whether there was a difference.
  bool anything() const { return anything_; }

 private:
  template <class Message>
  void listen(const tread::Channel<Message>& channel);
  void hear(const LogEvent& event);
  void say(const WatchLine& line);

  Bus& bus_;
  HealthReporter health_;
  WatchedDrive drive_;
  int64_t now_ = 0;
  int64_t seq_ = 0;
  bool anything_ = false;
  bool failed_ = false;
};

}  // namespace tread::gap
