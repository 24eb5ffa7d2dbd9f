// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/bus/virtual_bus.hpp"

namespace tread::faults {

enum class FaultKind {
  kDrop,
  kDelay,
  kDuplicate,
  kReorder,
  kCorrupt,
  kForge,
  kReplay,
  kKill,
  kHang,
  kInsOutage,
  kInsGarbage,
  kInsJump,
  kInsFreeze,
  kInsDrift,
  kPhantom,
  kVanish,
  kBattery,
  kMotorLine,
  kWrongSet,
  kOperatorLost,
  kEstop,
  kDisarm,
  kCount
};

struct Fault {
  FaultKind kind = FaultKind::kDrop;
  int64_t from = 0;       ///< [us] since the start
  int64_t until = 0;      ///< [us] since the start
  std::string channel;    ///< of messages; * = all
  std::string node;       ///< the node, or the receiver of messages; * = all
  double strength = 0.0;  ///< 0..1
};

/// What goes wrong in one mission.
struct FaultSchedule {
  uint64_t seed = 0;
  bool keyed = false;  ///< the robot and its operator have a key
  std::vector<Fault> faults;
  int64_t end() const;  ///< [us] of the last fault
};

/// One to four faults between `first` and `last` [us], the same for the same seed.
FaultSchedule drawSchedule(uint64_t seed, int64_t first, int64_t last);
/// Those of messages, as the bus makes them.
FaultPlan planOf(const FaultSchedule& schedule);
/// "4.20 to 6.31 s: drop on MAP to planner, strength 0.52".
std::string describe(const Fault& fault);

}  // namespace tread::faults
