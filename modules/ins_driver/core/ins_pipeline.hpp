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
#include "modules/ins_driver/core/input_rates.hpp"
#include "modules/ins_driver/core/ins_assembler.hpp"

namespace tread::ins {

/// Counters by name, in words.
using NamedCounts = std::vector<std::pair<std::string, int64_t>>;

/// "GGA: field count 3, wrong checksum 12"; empty if there are none.
std::string listed(const ReasonCounts& reasons);

/// Common last stage of all devices' readers: parts of epochs in, estimates out.
class InsPipeline {
 public:
  /// `cycle_us`: of the device's times, as in DeviceClock.
  InsPipeline(const InsConfig& config, int64_t cycle_us)
      : collector_(config.quiet_us, config.last_type, cycle_us), assembler_(config) {}

  EpochCollector& collector() { return collector_; }
  const EpochCollector& collector() const { return collector_; }
  InsAssembler& assembler() { return assembler_; }
  const InsAssembler& assembler() const { return assembler_; }

  /// As in InsSource.
  std::optional<InsEstimate> next(int64_t now);
  /// Adds the results of the epochs, in the order of HEALTH.
  void addCounters(NamedCounts& counters) const;

 private:
  void observePending();

  EpochCollector collector_;
  InsAssembler assembler_;
  std::deque<DeviceEpoch> pending_;
  size_t observed_ = 0;  ///< how many of them the assembler has observed
};

/// Common part of all devices' readers: whatever follows from the pipeline.
class PipelineIns : public InsSource {
 public:
  std::optional<InsEstimate> next(int64_t now) override { return pipeline_.next(now); }
  std::optional<GeoOrigin> origin() const override { return assembler().origin(); }
  std::pair<int64_t, double> tooFar() const override {
    return {epochs().too_far, assembler().farDistance()};
  }
  std::optional<int64_t> deviceTime() const override { return pipeline_.collector().newest(); }
  const AssemblerCounts& epochs() const override { return assembler().counts(); }
  std::string refusals() const override;
  std::string slowInput(int64_t now) override {
    return rates_.slowInput(now, epochs(), [this] { return tally().decoded; });
  }

  const InsAssembler& assembler() const { return pipeline_.assembler(); }

 protected:
  PipelineIns(const InsConfig& config, int64_t cycle_us)
      : config_(config), pipeline_(config, cycle_us), rates_(config) {}

  const InsConfig config_;
  InsPipeline pipeline_;

 private:
  InputRates rates_;
};

}  // namespace tread::ins
