// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <map>

#include <Eigen/Core>

#include "modules/identification/core/likelihood.hpp"

namespace tread::gap {

/// Products of columns over rows, by kind: speed, yaw rate.
using Grams = std::array<Eigen::MatrixXd, 2>;
/// Those of each block of driving.
using BlockGrams = std::map<int, Grams>;

/// The Gram matrices of a block, zero (columns x columns) at first.
inline Grams& gramsAt(BlockGrams& blocks, int block, Eigen::Index columns) {
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(columns, columns);
  return blocks.try_emplace(block, Grams{none, none}).first->second;
}

/// Sum over all blocks, at least one.
inline Grams sumOf(const BlockGrams& blocks) {
  Grams all = blocks.begin()->second;
  for (auto block = std::next(blocks.begin()); block != blocks.end(); ++block)
    for (size_t kind = 0; kind < all.size(); ++kind) all[kind] += block->second[kind];
  return all;
}

/// Estimate from all blocks together.
struct BlockEstimate {
  Grams all;
  Eigen::VectorXd values;
  Eigen::VectorXd errors;  ///< standard errors, by the jackknife over blocks
  double quantile = 0.0;   ///< of the 95 % interval, in standard errors
};

/// Estimates from sums, with errors; needs two blocks or more.
inline BlockEstimate estimateOver(const BlockGrams& blocks,
                                  const std::function<Eigen::VectorXd(const Grams&)>& estimate) {
  BlockEstimate result;
  result.all = sumOf(blocks);
  result.values = estimate(result.all);
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(result.values.size());
  for (const auto& [number, block] : blocks) {
    const Grams others{result.all[0] - block[0], result.all[1] - block[1]};
    sums += (estimate(others) - result.values).cwiseAbs2();
  }
  const auto count = static_cast<double>(blocks.size());
  result.errors = (sums * (count - 1.0) / count).cwiseSqrt();
  result.quantile = studentQuantile(count - 1.0);
  return result;
}

}  // namespace tread::gap
