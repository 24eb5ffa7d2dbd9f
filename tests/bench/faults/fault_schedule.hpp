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

/// Draws in the same way on every machine.
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
  kTilt,  ///< the INS tells a roll; not drawn by drawSchedule(), as the next
  kScanFreeze,
  kScanLag,  ///< old scans under new times
  kScanMirror,
  kScanTurn,
  kScanFar,
  kScanZero,
  kInsMirror,    ///< as if left were right
  kDriveMirror,  ///< the motors' cables are swapped
  kCount
};

/// In words.
const char* nameOf(FaultKind kind);

struct Fault {
  FaultKind kind = FaultKind::kDrop;
  int64_t from = 0;       ///< [us] since the start
  int64_t until = 0;      ///< [us] since the start
  std::string channel;    ///< of messages; * = all
  std::string node;       ///< the node, or the receiver of messages; * = all
  double strength = 0.0;  ///< 0..1
};

/// For how long a person drives by hand; all times in [us] since the start.
struct HandStretch {
  int64_t from = 0;
  int64_t until = 0;         ///< given back
  int64_t silent_from = 0;   ///< the person's program is halted
  int64_t silent_until = 0;  ///< ... and goes on
  double released = 0.0;     ///< [1] share of the time after which the button is let go for a fifth
  double forward = 0.0;      ///< [1] of the stick
};

/// Something to drive by hand with that never tells a rest; all times in [us] since the start.
struct HandLie {
  enum class Kind { kPad, kKeyboard, kPage };
  Kind kind = Kind::kPad;
  uint64_t seed = 0;  ///< of what it tells
  int64_t from = 0;
  int64_t until = 0;
  int64_t silent_from = 0;
  int64_t silent_until = 0;
};

/// What a mission has beside its faults. Fences are in the frame of the way: the start is its
/// origin, the goal lies on its x axis.
struct Scenario {
  std::vector<Fence> own_fences;    ///< of the robot's file
  bool planner_knows = true;        ///< else only the bridge has them
  std::optional<int64_t> fence_at;  ///< [us] the operator puts a fence before the driving robot
  double fence_ahead = 0.0;         ///< [m] from the body's origin to its near side
  double fence_width = 0.0;         ///< [m]
  std::optional<HandStretch> hand;
  std::optional<HandLie> lie;
  bool go_back = false;  ///< `lost: go_back` in the robot's file
};

/// What goes wrong in one mission.
struct FaultSchedule {
  uint64_t seed = 0;
  bool keyed = false;  ///< the robot and its operator have a key
  std::vector<Fault> faults;
  Scenario scenario;
  int64_t end() const;  ///< [us] of the last fault
  /// Nobody tells of a stick at rest: nothing may move by hand.
  bool onlyLies() const;
};

/// One to four faults between `first` and `last` [us], the same for the same seed.
FaultSchedule drawSchedule(uint64_t seed, int64_t first, int64_t last);
/// Adds fences, a hand, a return, and faults of them, from draws of their own: what
/// drawSchedule() drew stays as it is.
void addScenario(FaultSchedule& schedule, int64_t first, int64_t last);
/// In place of a hand one that lies.
void addLie(FaultSchedule& schedule, int64_t first, int64_t last);
/// One fault of the range finder alone, at a drawn moment, mostly for good.
FaultSchedule drawScanFault(uint64_t seed, int64_t first, int64_t last);
/// Those of messages, as the bus makes them.
FaultPlan planOf(const FaultSchedule& schedule);
/// "4.20 to 6.31 s: drop on MAP to planner, strength 0.52".
std::string describe(const Fault& fault);
/// "fences in the file, by hand from 6.20 to 9.81 s"; empty if there is nothing.
std::string describe(const Scenario& scenario);

}  // namespace tread::faults
