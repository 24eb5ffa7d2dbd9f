// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/report/latency.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tread::report {
namespace {

constexpr size_t kMostWaiting = 1000;

double milliseconds(int64_t from, int64_t to) {
  return static_cast<double>(to - from) * 1e-3;
}

}  // namespace

double Durations::quantile(double share) const {
  if (values_.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> sorted = values_;
  std::sort(sorted.begin(), sorted.end());
  const double rank = std::ceil(share * static_cast<double>(sorted.size())) - 1.0;
  return sorted[static_cast<size_t>(std::max(0.0, rank))];
}

void Latencies::add(const LogEvent& event) {
  ins_t ins;
  scan_t scan;
  map_tile_t tile;
  plan_t plan;
  learning_t learning;
  pattern_set_part_t part;
  if (decode(event, kIns, ins)) {
    ins_.push_back({ins.utime, event.utime});
    if (ins_.size() > kMostWaiting) ins_.pop_front();
  } else if (decode(event, kScan, scan)) {
    scans_.push_back({scan.utime, event.utime});
    if (scans_.size() > kMostWaiting) scans_.pop_front();
  } else if (decode(event, kMap, tile)) {
    for (; !scans_.empty() && scans_.front().utime <= tile.utime; scans_.pop_front())
      scan_to_tile_.add(milliseconds(scans_.front().received, event.utime));
  } else if (decode(event, kPlan, plan)) {
    const auto found = unplanned_.find(plan.set_version);
    if (found == unplanned_.end()) return;
    set_to_plan_.add(milliseconds(found->second, event.utime));
    // Versions that another has overtaken were never planned with.
    unplanned_.erase(unplanned_.begin(), std::next(found));
  } else if (decode(event, kLearning, learning)) {
    hear(learning);
  } else if (decode(event, kPatternSet, part)) {
    hear(part, event.utime);
  }
}

void Latencies::hear(const learning_t& message) {
  if (!message.changed) return;
  const auto passed = std::find_if(ins_.begin(), ins_.end(),
                                   [&](const Received& at) { return at.utime >= message.utime; });
  if (passed == ins_.end()) return;
  const auto published = first_part_.find(message.result_version);
  if (published != first_part_.end())
    ins_to_set_.add(milliseconds(passed->received, published->second));
  else
    awaited_sets_[message.result_version] = passed->received;
}

void Latencies::hear(const pattern_set_part_t& message, int64_t received) {
  const int64_t version = message.set_version;
  if (first_part_.emplace(version, received).second) {
    const auto awaited = awaited_sets_.find(version);
    if (awaited != awaited_sets_.end()) {
      ins_to_set_.add(milliseconds(awaited->second, received));
      awaited_sets_.erase(awaited);
    }
  }
  // A repetition of a version that is known already is nothing new to plan with.
  if (++parts_[version] == message.part_count && version > newest_version_) {
    // The first set of a log may have been planned with long before.
    if (newest_version_ > 0) unplanned_[version] = received;
    newest_version_ = version;
  }
}

}  // namespace tread::report
