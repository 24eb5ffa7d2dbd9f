// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include <benchmark/benchmark.h>

#include "common/grid/clearance.hpp"

namespace tread::bench {

/// Wall time since construction.
class StopWatch {
 public:
  double ms() const {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begin_ = Clock::now();
};

/// The smallest value that at least a share of the values does not exceed; NaN if empty.
inline double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  const double rank = std::ceil(share * static_cast<double>(values.size()));
  return values[static_cast<size_t>(std::max(1.0, rank)) - 1];
}

/// Reports p50, p95, p99 and the maximum of times [ms].
inline void countQuantiles(benchmark::State& state, const std::string& name,
                           const std::vector<double>& times) {
  state.counters[name + "_p50_ms"] = quantile(times, 0.50);
  state.counters[name + "_p95_ms"] = quantile(times, 0.95);
  state.counters[name + "_p99_ms"] = quantile(times, 0.99);
  state.counters[name + "_max_ms"] = quantile(times, 1.0);
}

/// Time of the plain clearance transform of a grid, the reference for all figures [ms].
inline double transformTime(const Grid& grid) {
  const StopWatch watch;
  const ClearanceField field(grid, true);
  benchmark::DoNotOptimize(field);
  return watch.ms();
}

inline double medianTransform(const Grid& grid, int times = 21) {
  std::vector<double> taken;
  for (int i = 0; i < times; ++i) taken.push_back(transformTime(grid));
  return quantile(taken, 0.5);
}

}  // namespace tread::bench
