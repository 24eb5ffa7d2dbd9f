// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "common/bus/virtual_bus.hpp"
#include "common/fence/fence.hpp"

namespace tread::faults {

/// Random draws, the same on every platform.
class Draw {
 public:
  explicit Draw(uint64_t seed) : engine_(seed * 0x9e3779b97f4a7c15ULL + 77) {}
  uint64_t below(uint64_t count) { return engine_() % count; }
  double share() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }
  template <class List>
  const auto& oneOf(const List& list) {
    return list[below(std::size(list))];
  }

 private:
  std::mt19937_64 engine_;
};

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
  kTilt,  ///< the INS reports a roll; not drawn by drawSchedule(), like the following ones
  kScanFreeze,
  kScanLag,  ///< old scans with new times
  kScanMirror,
  kScanTurn,
  kScanFar,
  kScanZero,
  kInsMirror,    ///< left and right exchanged
  kDriveMirror,  ///< the motors' cables are exchanged
  kCount
};

/// Text for a kind.
const char* nameOf(FaultKind kind);

struct Fault {
  FaultKind kind = FaultKind::kDrop;
  int64_t from = 0;       ///< [us] since the start
  int64_t until = 0;      ///< [us] since the start
  std::string channel;    ///< of messages; * = all
  std::string node;       ///< the node, or the receiver of messages; * = all
  double strength = 0.0;  ///< 0..1
};

/// A period of manual driving; all times in [us] since the start.
struct HandStretch {
  int64_t from = 0;
  int64_t until = 0;         ///< time of giving back
  int64_t silent_from = 0;   ///< the person's program is halted
  int64_t silent_until = 0;  ///< ... and continues
  /// [1] share of the time after which the button is released for a fifth of it
  double released = 0.0;
  double forward = 0.0;  ///< [1] of the stick
};

/// A stick or program that never reports rest; all times in [us] since the start.
struct HandLie {
  enum class Kind { kPad, kKeyboard, kPage };
  Kind kind = Kind::kPad;
  uint64_t seed = 0;  ///< of its values
  int64_t from = 0;
  int64_t until = 0;
  int64_t silent_from = 0;
  int64_t silent_until = 0;
};

/// Further parts of a mission. Fences are in the frame of the way: origin at the start, x axis
/// towards the goal.
struct Scenario {
  std::vector<Fence> own_fences;    ///< of the robot's file
  bool planner_knows = true;        ///< otherwise only the bridge has them
  std::optional<int64_t> fence_at;  ///< [us] the operator adds a fence ahead of the driving robot
  double fence_ahead = 0.0;         ///< [m] from the body's origin to its near side
  double fence_width = 0.0;         ///< [m]
  std::optional<HandStretch> hand;
  std::optional<HandLie> lie;
  bool go_back = false;  ///< `lost: go_back` in the robot's file
};

/// The faults of one mission.
struct FaultSchedule {
  uint64_t seed = 0;
  bool keyed = false;  ///< the robot and its operator have a key
  std::vector<Fault> faults;
  Scenario scenario;
  int64_t end() const;  ///< [us] of the last fault
  /// No stick at rest is ever reported: manual control must not move the robot.
  bool onlyLies() const;
};

/// One to four faults between `first` and `last` [us], a function of the seed.
FaultSchedule drawSchedule(uint64_t seed, int64_t first, int64_t last);
/// Adds fences, manual driving, a return, and their faults from separate draws, which leaves the
/// draws of drawSchedule() unchanged.
void addScenario(FaultSchedule& schedule, int64_t first, int64_t last);
/// Replaces manual driving by a lying stick.
void addLie(FaultSchedule& schedule, int64_t first, int64_t last);
/// One fault of the range finder at a random time, usually permanent.
FaultSchedule drawScanFault(uint64_t seed, int64_t first, int64_t last);
/// The message faults, for the bus.
FaultPlan planOf(const FaultSchedule& schedule);
/// For instance "4.20 to 6.31 s: drop on MAP to planner, strength 0.52".
std::string describe(const Fault& fault);
/// For instance "fences in the file, by hand from 6.20 to 9.81 s"; empty if there is nothing.
std::string describe(const Scenario& scenario);

}  // namespace tread::faults
