// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>

#include "modules/learner/core/rules/bank.hpp"
#include "modules/learner/core/rules/stored_number.hpp"

// What the bank writes into the state file, and what it takes back from there.
namespace tread::learner {
namespace {

/// Whether they are, and of all there is: the sum is one but for rounding.
bool areProbabilities(const std::vector<double>& weights) {
  double total = 0.0;
  for (const double weight : weights) {
    if (!(weight >= 0.0)) return false;
    total += weight;
  }
  return std::abs(total - 1.0) < 1e-6;
}

}  // namespace

std::vector<double> Bank::memory() const {
  std::vector<double> memory;
  filter_.save(memory);
  surfaces_.save(memory);
  memory.insert(memory.end(), weights_.begin(), weights_.end());
  memory.insert(memory.end(), known_.begin(), known_.end());
  memory.insert(memory.end(), {block_log_known_, static_cast<double>(clock_),
                               static_cast<double>(block_.size())});
  for (const Entry& entry : block_)
    memory.insert(memory.end(), {static_cast<double>(entry.sample.pattern),
                                 entry.sample.mean_twist[0], entry.sample.mean_twist[1],
                                 entry.sample.mean_twist[2], static_cast<double>(entry.surface)});
  return memory;
}

bool Bank::restore(const TrajectoryTable&, const std::vector<double>& memory) {
  for (const double number : memory)
    if (!std::isfinite(number)) return false;
  Bank bank = *this;
  size_t at = 0;
  if (!bank.filter_.restore(memory, at) || !bank.surfaces_.restore(memory, at)) return false;
  const size_t known = bank.surfaces_.size();
  if (memory.size() < at + 2 * known + 4) return false;
  bank.weights_.assign(known + 1, 0.0);
  for (double& weight : bank.weights_) weight = memory[at++];
  bank.known_.assign(known, 0.0);
  for (double& weight : bank.known_) weight = memory[at++];
  if (!areProbabilities(bank.weights_) || (known > 0 && !areProbabilities(bank.known_)))
    return false;
  bank.block_log_known_ = memory[at++];
  if (!isCount(memory[at], kMostExecutions)) return false;
  bank.clock_ = static_cast<int64_t>(memory[at++]);
  if (bank.surfaces_.newest() > bank.clock_ || !bank.restoreBlock(memory, at)) return false;
  assign(bank);
  mix();
  return true;
}

bool Bank::restoreBlock(const std::vector<double>& memory, size_t at) {
  constexpr size_t kEach = 5;
  const size_t numbers = memory.size() - at - 1;
  if (memory[at++] * kEach != static_cast<double>(numbers) || numbers % kEach != 0) return false;
  const double patterns = static_cast<double>(model_->patterns()) - 1.0;
  block_.clear();
  for (; at < memory.size(); at += kEach) {
    if (!isCount(memory[at], patterns)) return false;
    if (!isCount(memory[at + 4], static_cast<double>(known_.size()))) return false;
    block_.push_back(
        {{static_cast<size_t>(memory[at]), {memory[at + 1], memory[at + 2], memory[at + 3]}},
         static_cast<size_t>(memory[at + 4])});
  }
  return true;
}

}  // namespace tread::learner
