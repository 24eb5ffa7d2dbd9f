// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "common/execution/measurement.hpp"
#include "common/pattern/pattern.hpp"

namespace tread::learner {

/// What one execution says of the friction between vehicle and ground.
struct GripSign {
  double acceleration = 0.0;  ///< [m/s2] that the ground gave
  double asked = 0.0;         ///< [m/s2] that the pattern asked for
  bool gave_way = false;      ///< the ground gives no more than that
};

/// Looks for a start, a stop or a slide in an execution; nothing if there is none.
/** Accelerations are differences of mean velocities over kSpeedWindow, those of the shipped
 * trajectory beside them: it is what the vehicle does where the ground holds.
 *  1. A start or a stop that gives less than half of what was asked gave way if the speed goes on
 * to change when it should have settled, or if it gave less than three tenths. A speed that settles
 *     lower is drag, not want of grip.
 *  2. A vehicle that moves sideways over kSlideWindow, where the shipped trajectory does not,
 * slides: the ground gives the centripetal acceleration that is left.
 *  3. Else the ground holds at least what it gave.
 * `measured` is fair, or refused for its entry; on a slope of more than .05 rad it says nothing. */
std::optional<GripSign> gripSign(const Measurement& measured, const MotionPattern& shipped,
                                 const MotionClass& entry_class, double period);

/// The deceleration that may be counted on.
struct Grip {
  double deceleration = 0.0;  ///< [m/s2]
  bool gave_way = false;      ///< the ground gave less than was asked of it
};

/// What the ground gives, from the signs of the last executions and the way since.
/** A ground on which nothing was felt yet gives kUnseen. Where it held it gives the mean of that
 * and of the last kLast that held. Where it gave way it gives the most of the last kLast that gave
 * way: one execution may be disturbed. A vehicle that crawls never asks for more, so that it would
 * not feel that the ground holds again: what is believed grows by e in kForget, until the ground is
 * believed to give what was asked. It holds again at once where it gives seven tenths of that. */
class GripEstimator {
 public:
  static constexpr double kUnseen = 1.0;   ///< [m/s2] wet grass gives three times that, ice less
  static constexpr double kForget = 20.0;  ///< [m] of way
  static constexpr size_t kLast = 3;

  /// Takes the sign of an execution that started then [us]; it replaces an earlier one of the same.
  void take(const GripSign& sign, int64_t started);
  void drive(double metres) { metres_ += metres; }
  Grip grip() const;
  /// Executions that told something.
  int64_t signs() const { return count_; }

 private:
  struct Felt {
    GripSign sign;
    int64_t started = 0;  ///< [us]
    double metres = 0.0;  ///< driven before
  };
  struct Belief {
    std::deque<double> gave, held;  ///< the last that gave way, and that held [m/s2]
    double base = 0.0;              ///< [m/s2] believed where it gave way,
    double base_metres = 0.0;       ///< [m] there
    double asked = 0.0;             ///< [m/s2] the most that was asked since it gave way
  };
  static double believed(const Belief& belief, double metres);
  static Belief after(Belief belief, const Felt& felt);

  Belief settled_;              ///< without the newest execution
  std::optional<Felt> newest_;  ///< may be replaced while it runs
  double metres_ = 0.0;
  int64_t count_ = 0;
};

}  // namespace tread::learner
