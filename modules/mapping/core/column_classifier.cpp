// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/mapping/core/column_classifier.hpp"

#include <algorithm>
#include <cmath>

namespace tread::mapping {
namespace {

/// Bits 0 to count - 1.
uint64_t lowBits(double count) {
  if (!(count > 0.0)) return 0;
  if (count >= kColumnHeight) return ~uint64_t{0};
  return (uint64_t{1} << static_cast<int>(count)) - 1;
}

/// All bits above the highest set one.
uint64_t above(uint64_t bits) {
  for (int shift = 1; shift < kColumnHeight; shift *= 2) bits |= bits >> shift;
  return ~bits;
}

/// Index of the highest set bit, or -1.
int highestBit(uint64_t bits) {
  return bits == 0 ? -1 : kColumnHeight - 1 - __builtin_clzll(bits);
}

}  // namespace

/// Voxels whose centre lies above `from` and below `to` [m].
uint64_t ColumnClassifier::band(double from, double to, int lower_z) const {
  const double first = std::floor(from / cell_size_ - lower_z - 0.5) + 1.0;
  const double end = std::ceil(to / cell_size_ - lower_z - 0.5);
  return lowBits(end) & ~lowBits(first);
}

Cell ColumnClassifier::classify(const Column& column, int lower_z,
                                const GroundHeight& ground) const {
  if (column.known == 0) return kUnknown;
  const double lowest_seen = (lower_z + lowestBit(column.known) + 1) * cell_size_;
  const double z = std::max(std::min(ground.z, lowest_seen), ground.z - ground.doubt - cell_size_);
  const double top = z + config_.robot_height;
  const double step = z + config_.step;
  const uint64_t in_band = band(step, top, lower_z);
  const uint64_t occupied = column.occupied & in_band;
  if ((occupied & band(step + ground.doubt, top, lower_z)) != 0) return kObstacle;
  if (occupied != 0) return (column.free() & in_band & above(occupied)) != 0 ? kFree : kUnknown;
  const uint64_t seen = band(step - ground.doubt, top + ground.doubt, lower_z);
  return (column.free() & seen) != 0 ? kFree : kUnknown;
}

int ColumnClassifier::surface(const Column& column, int lower_z, const GroundHeight& ground) const {
  const double step = ground.z + config_.step + ground.doubt;
  return highestBit(column.occupied & lowBits(std::ceil(step / cell_size_ - lower_z - 0.5)));
}

}  // namespace tread::mapping
