// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <map>

#include "tests/study/models/ladder.hpp"

namespace tread::gap {
namespace {

MeanDifference meanOf(const std::vector<double>& values, const std::vector<ExecutionError>& where) {
  MeanDifference difference;
  if (values.empty()) return difference;
  const auto count = static_cast<double>(values.size());
  for (double value : values) difference.mean += value / count;
  std::map<int, double> of_block;
  for (size_t i = 0; i < values.size(); ++i)
    of_block[where[i].block] += values[i] - difference.mean;
  const auto blocks = static_cast<double>(of_block.size());
  if (blocks < 2.0) return {difference.mean, kNotMeasured};
  double squares = 0.0;
  for (const auto& [block, sum] : of_block) squares += sum * sum;
  difference.error = std::sqrt(squares * blocks / (blocks - 1.0)) / count;
  return difference;
}

}  // namespace

RungDifference differenceOf(const std::vector<ExecutionError>& first,
                            const std::vector<ExecutionError>& second) {
  std::vector<double> yaw;
  std::vector<double> position;
  for (size_t i = 0; i < first.size(); ++i) {
    yaw.push_back(second[i].yaw - first[i].yaw);
    position.push_back(second[i].position - first[i].position);
  }
  return {meanOf(yaw, first), meanOf(position, first)};
}

}  // namespace tread::gap
