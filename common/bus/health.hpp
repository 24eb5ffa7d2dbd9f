// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "common/bus/bus.hpp"

namespace tread {

/// Publishes HEALTH at 1 Hz and CONFIG at the start and every 10 s for a node.
class HealthReporter {
 public:
  /// `effective_config` is the whole configuration as YAML with defaults.
  HealthReporter(Bus& bus, std::string process, std::string effective_config);

  /// One clear line: what, where, what to do. Empty reason with kOk.
  void setState(int16_t state, const std::string& reason);
  /// Sets a named counter, for instance {"refused: wrong checksum", 3}.
  void setCounter(const std::string& name, int64_t value);
  void addToCounter(const std::string& name, int64_t increment = 1);
  /// Call in each step.
  void step(int64_t utime);

  int64_t bootId() const { return boot_id_; }

 private:
  void publishHealth(int64_t utime);
  void publishConfig(int64_t utime);

  Bus& bus_;
  std::string process_;
  std::string config_text_;
  int64_t boot_id_;
  int64_t next_health_ = 0;
  int64_t next_config_ = 0;
  int64_t seq_health_ = 0;
  int64_t seq_config_ = 0;
  int16_t state_ = 0;
  std::string reason_;
  std::map<std::string, int64_t> counters_;
};

}  // namespace tread
