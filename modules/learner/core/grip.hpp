// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "common/execution/measurement.hpp"
#include "common/pattern/pattern.hpp"

namespace tread::learner {

/// Evidence of one execution about the friction between vehicle and ground.
struct GripSign {
  double acceleration = 0.0;  ///< [m/s2] that the ground gave
  double asked = 0.0;         ///< [m/s2] that the pattern asked for
  bool gave_way = false;      ///< the ground cannot give more than that
};

/// Detects a start, a stop or a slide in an execution; nullopt if there is none.
/** Accelerations are differences of mean velocities over kSpeedWindow, compared with those of the
 * shipped trajectory, which is the motion on firm ground.
 *  1. A start or a stop with less than half of the requested acceleration has lost grip if the
 *     speed still changes when it should have settled, or if the acceleration is below three
 *     tenths. A speed that settles lower is drag, not lack of grip.
 *  2. A vehicle that moves sideways over kSlideWindow, unlike the shipped trajectory, slides: the
 *     remaining centripetal acceleration is the ground's limit.
 *  3. Otherwise the ground holds at least the measured acceleration.
 * `measured` is valid, or refused only for its entry; a slope of more than .05 rad gives no
 * evidence. */
std::optional<GripSign> gripSign(const Measurement& measured, const MotionPattern& shipped,
                                 const MotionClass& entry_class, double period);

/// The deceleration that can be relied on.
struct Grip {
  double deceleration = 0.0;  ///< [m/s2]
  bool gave_way = false;      ///< the ground gave less than requested
};

/// Estimates the ground's available deceleration, from the evidence of recent executions and the
/// distance since then.
/** Without evidence the estimate is kUnseen. If the ground held, it is the mean of that and of the
 * last kLast values that held. If it gave way, it is the largest of the last kLast values that
 * gave way, because one execution may be disturbed. A slow vehicle requests too little to notice
 * that grip has returned, so the estimate grows by a factor of e per kForget, up to the requested
 * value. It counts as holding again as soon as it gives seven tenths of that. */
class GripEstimator {
 public:
  static constexpr double kUnseen = 1.0;   ///< [m/s2] wet grass gives three times as much, ice less
  static constexpr double kForget = 20.0;  ///< [m] of way
  static constexpr size_t kLast = 3;

  /// Takes the evidence of an execution that started at this time [us]; it replaces earlier
  /// evidence of the same execution.
  void take(const GripSign& sign, int64_t started);
  void drive(double metres) { metres_ += metres; }
  Grip grip() const;
  /// Number of executions with evidence.
  int64_t signs() const { return count_; }

 private:
  struct Felt {
    GripSign sign;
    int64_t started = 0;  ///< [us]
    double metres = 0.0;  ///< driven before
  };
  struct Belief {
    std::deque<double> gave, held;  ///< the last values that gave way, and that held [m/s2]
    double base = 0.0;              ///< [m/s2] estimate where it gave way,
    double base_metres = 0.0;       ///< [m] there
    double asked = 0.0;             ///< [m/s2] largest request since it gave way
  };
  static double believed(const Belief& belief, double metres);
  static Belief after(Belief belief, const Felt& felt);

  Belief settled_;              ///< without the newest execution
  std::optional<Felt> newest_;  ///< may be replaced while the execution runs
  double metres_ = 0.0;
  int64_t count_ = 0;
};

}  // namespace tread::learner
