// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "modules/ins_driver/core/epoch_collector.hpp"
#include "modules/ins_driver/core/ins_assembler.hpp"

namespace tread::ins {

/// What was counted, by its name in words.
using NamedCounts = std::vector<std::pair<std::string, int64_t>>;

/// How often each reason applied, by words such as "GGA: field count".
using ReasonCounts = std::map<std::string, int64_t>;

/// "GGA: field count 3, wrong checksum 12"; empty if there are none.
std::string listed(const ReasonCounts& reasons);

/// What every device's reader ends in: parts of epochs in, estimates out.
class InsPipeline {
 public:
  /// `cycle_us`: of the device's times, as in DeviceClock.
  InsPipeline(const InsConfig& config, int64_t cycle_us)
      : collector_(config.quiet_us, config.last_type, cycle_us), assembler_(config) {}

  EpochCollector& collector() { return collector_; }
  InsAssembler& assembler() { return assembler_; }
  const InsAssembler& assembler() const { return assembler_; }

  /// As in InsSource.
  std::optional<InsEstimate> next(int64_t now);
  /// Adds what became of the epochs, in the order of HEALTH.
  void addCounters(NamedCounts& counters) const;

 private:
  void observePending();

  EpochCollector collector_;
  InsAssembler assembler_;
  std::deque<DeviceEpoch> pending_;
  size_t observed_ = 0;  ///< how many of them the assembler has observed
};

}  // namespace tread::ins
