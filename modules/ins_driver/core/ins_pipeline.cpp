// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/core/ins_pipeline.hpp"

#include <sstream>

namespace tread::ins {

std::string listed(const ReasonCounts& reasons) {
  std::ostringstream text;
  for (const auto& [reason, count] : reasons)
    text << (text.tellp() > 0 ? ", " : "") << reason << " " << count;
  return text.str();
}

void InsPipeline::observePending() {
  while (observed_ < pending_.size()) {
    if (observed_ > 0 && pending_[observed_].clock_was_set) return;
    assembler_.observe(pending_[observed_++]);
  }
}

std::optional<InsEstimate> InsPipeline::next(int64_t now) {
  while (std::optional<DeviceEpoch> epoch = collector_.next(now)) pending_.push_back(*epoch);
  while (!pending_.empty()) {
    observePending();
    std::optional<InsEstimate> estimate = assembler_.solve(pending_.front());
    pending_.pop_front();
    --observed_;
    if (estimate) return estimate;
  }
  return std::nullopt;
}

void InsPipeline::addCounters(NamedCounts& counters) const {
  const AssemblerCounts& epochs = assembler_.counts();
  const HeadingCounts& headings = assembler_.headings().counts();
  counters.insert(counters.end(), {{"epochs", epochs.epochs},
                                   {"published", epochs.published},
                                   {"positions carried", epochs.positions_carried},
                                   {"gaps", epochs.gaps},
                                   {"jumps", epochs.jumps},
                                   {"refused: far from the one before", epochs.doubted},
                                   {"device clock set", epochs.clock_steps},
                                   {"refused: time not after the last", epochs.not_newer},
                                   {"refused: far from the origin", epochs.too_far}});
  const NamedCounts seldom{
      {"heading of two antennas", headings.used[1]},
      {"heading from the course", headings.used[2]},
      {"refused: heading, a better one came lately", headings.outranked},
      {"refused: course, nose or tail not known", assembler_.headings().coursesRefused()}};
  for (const auto& count : seldom) {
    if (count.second > 0) counters.push_back(count);
  }
}

std::string PipelineIns::refusals() const {
  const InsTally line = tally();
  return "stray bytes " + std::to_string(line.stray_bytes) +
         ", refused: " + (line.refused.empty() ? "none" : listed(line.refused));
}

}  // namespace tread::ins
