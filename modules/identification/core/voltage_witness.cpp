// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Evidence of the battery voltage about found effects.
#include "modules/identification/core/voltage_witness.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Cholesky>

#include "modules/identification/core/motion_bins.hpp"
#include "modules/identification/core/witness.hpp"
#include "modules/identification/core/witness_blocks.hpp"

namespace tread::gap {
namespace {

constexpr double kFactor =
    0.7;  // of an effect, described by one factor on each kind of motion in a block
constexpr double kChanges = 0.05;          // of it, by which the factors of the blocks must differ
constexpr size_t kLeastVoltageBlocks = 8;  // with voltage

/// Sums over one block.
struct BlockMotion {
  size_t drive = 0;
  double bins = 0.0;
  double voltage = 0.0;               ///< [V] summed over bins
  double load = 0.0;                  ///< squared speeds of the tracks
  std::array<double, 2> square{};     ///< of the motion without the effect, by kind
  std::array<double, 2> with_lost{};  ///< that motion times the effect's part
  double lost_square = 0.0;

  double motion() const { return square[0] + square[1]; }
  /// Share of the motion that the effect takes.
  double factor() const { return (with_lost[0] + with_lost[1]) / motion(); }
};

/// The newest voltage at a time; NaN before the first one.
double voltageAt(const std::vector<VoltageSample>& voltage, double time) {
  const auto after =
      std::upper_bound(voltage.begin(), voltage.end(), time,
                       [](double t, const VoltageSample& sample) { return t < sample.time; });
  return after == voltage.begin() ? kNotMeasured : std::prev(after)->voltage;
}

/// Sums of the bins with a voltage, by block.
std::map<int, BlockMotion> blockMotions(const std::vector<MotionBin>& bins,
                                        const std::vector<Drive>& drives, size_t effect) {
  std::map<int, BlockMotion> blocks;
  for (const MotionBin& bin : bins) {
    if (!isMeasured(drives[bin.drive].voltage)) continue;
    const double voltage = voltageAt(drives[bin.drive].voltage, bin.begin + 0.5 * kBin);
    if (!(voltage > 0.0)) continue;
    BlockMotion& block = blocks[bin.block];
    block.drive = bin.drive;
    block.bins += 1.0;
    block.voltage += voltage;
    block.load += bin.tracks[0] * bin.tracks[0] + bin.tracks[1] * bin.tracks[1];
    for (size_t kind = 0; kind < 2; ++kind) {
      const double lost = bin.lost[effect][kind];
      const double without = bin.speed[kind] + lost;
      block.square[kind] += without * without;
      block.with_lost[kind] += without * lost;
      block.lost_square += lost * lost;
    }
  }
  for (auto block = blocks.begin(); block != blocks.end();)
    block = block->second.motion() > 0.0 ? std::next(block) : blocks.erase(block);
  return blocks;
}

/// Whether an effect is one factor on all driving and one on all turning of a block, which changes
/// between blocks.
bool isFactorOverTime(const std::map<int, BlockMotion>& blocks) {
  double all = 0.0, explained = 0.0, weight = 0.0, sum = 0.0;
  for (const auto& [number, block] : blocks) {
    all += block.lost_square;
    for (size_t kind = 0; kind < 2; ++kind)
      if (block.square[kind] > 0.0)
        explained += block.with_lost[kind] * block.with_lost[kind] / block.square[kind];
    weight += block.motion();
    sum += block.with_lost[0] + block.with_lost[1];
  }
  double changes = 0.0;
  for (const auto& [number, block] : blocks)
    changes += block.motion() * std::pow(block.factor() - sum / weight, 2);
  return all > 0.0 && explained > kFactor * all && changes > kChanges * all;
}

/// Gram matrices of the blocks; columns: drop of the voltage, share of the motion that the effect
/// takes, load, and one column of ones for each drive.
BlockGrams voltageGrams(const std::map<int, BlockMotion>& blocks, size_t drives) {
  std::vector<double> full(drives, 0.0);  // [V], of the block with the highest voltage
  for (const auto& [number, block] : blocks)
    full[block.drive] = std::max(full[block.drive], block.voltage / block.bins);
  const auto columns = static_cast<Eigen::Index>(3 + drives);
  BlockGrams grams;
  for (const auto& [number, block] : blocks) {
    Eigen::VectorXd row = Eigen::VectorXd::Zero(columns);
    row[0] = 1.0 - block.voltage / block.bins / full[block.drive];
    row[1] = block.factor();
    row[2] = block.load / block.bins;
    row[static_cast<Eigen::Index>(3 + block.drive)] = 1.0;
    // A block that hardly moves has no information about the factor.
    gramsAt(grams, number, columns)[0] += block.motion() * row * row.transpose();
  }
  return grams;
}

/// Drop of the voltage per share of the motion that the effect takes, at equal load.
double fallOf(const Grams& grams) {
  const Eigen::Index columns = grams[0].cols() - 1;
  Eigen::MatrixXd normal = grams[0].bottomRightCorner(columns, columns);
  for (Eigen::Index i = 0; i < columns; ++i)
    if (!(normal(i, i) > 0.0)) normal(i, i) = 1.0;
  return normal.ldlt().solve(grams[0].col(0).tail(columns))[0];
}

}  // namespace

std::map<std::string, VoltageWitness> voltageWitnesses(const Fitter& fitter, const FitState& state,
                                                       const std::vector<std::string>& effects) {
  const std::vector<Drive>& drives = fitter.data().drives();
  const std::vector<std::string> asked = askedOf(effects);
  if (asked.empty() || std::all_of(drives.begin(), drives.end(),
                                   [](const Drive& drive) { return !isMeasured(drive.voltage); }))
    return {};
  const std::vector<MotionBin> bins = binsOf(fitter, state, asked);
  std::map<std::string, VoltageWitness> witnesses;
  for (size_t e = 0; e < asked.size(); ++e) {
    const auto blocks = blockMotions(bins, drives, e);
    if (blocks.size() < kLeastVoltageBlocks || !isFactorOverTime(blocks)) continue;
    const BlockEstimate fall = estimateOver(
        voltageGrams(blocks, drives.size()),
        [](const Grams& grams) { return Eigen::VectorXd::Constant(1, fallOf(grams)); });
    const double half = fall.quantile * fall.errors[0];
    if (std::isfinite(half))
      witnesses[asked[e]] = {fall.values[0], fall.values[0] - half, fall.values[0] + half};
  }
  return witnesses;
}

}  // namespace tread::gap
