// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <deque>
#include <optional>

#include "modules/identification/core/running_fit.hpp"

namespace tread::gap {

/// The part that has changed.
enum class ChangedPart { kLeftDrive, kRightDrive, kBothDrives, kTurning, kDelay };
inline constexpr size_t kChangedParts = 5;

/// When a change is reported.
struct WatchLimits {
  double gain = 0.03;    ///< [1] smaller changes are ignored
  double delay = 0.05;   ///< [s] smaller changes are ignored
  double hours = 100.0;  ///< [h] mean driving time between false alarms, at least
  double stretch = 5.0;  ///< [s] of driving per reading
};

/// A significant change.
struct NoticedGap {
  ChangedPart part = ChangedPart::kBothDrives;
  double since = 0.0;        ///< [s]
  double noticed = 0.0;      ///< [s]
  double change = 0.0;       ///< relative to the model: gain minus 1, or delay [s]
  double uncertainty = 0.0;  ///< its standard deviation
  bool as_model = false;     ///< a reported change is gone: the part agrees with the model again
};

/// Monitors readings for a lasting change.
/** For each part and direction a test martingale against "the change is at most the limit". A share
 * l of the wealth W is staked on each reading, which wins or loses by its excess over the limit: W
 * <- max(1, W) (1 + l clamp((s (g - g_0) - limit) / m, -1, 1)) with s = +-1, g_0 the last reported
 * value (0: the model), m the spread of the readings so far. While the clamped excess is not
 * positive on average, W does not grow on average either, and exceeds c no sooner than after c
 * readings on average (Ville's inequality; Shin, Ramdas and Rinaldo 2024: e-detectors). c is
 * chosen for `hours`; `since` is when W began to grow. Consecutive readings may share part of
 * their ground; the limit allows for that. */
class GapWatch {
 public:
  explicit GapWatch(const WatchLimits& limits = {});

  /// In order of time; returns a change as soon as a reading completes the evidence for it.
  std::optional<NoticedGap> take(const WatchReading& reading);
  /// The robot's clock restarted: reported changes remain, readings are discarded.
  void restart();
  /// Whether no reported change remains.
  bool asModel() const;

 private:
  struct Game {
    double wealth = 1.0;
    double since = 0.0;
  };
  static constexpr std::array<double, 3> kStakes{0.2, 0.5, 0.9};
  struct Part {
    std::array<std::array<Game, 3>, 2> games;  ///< by direction, by stake
    double said = 0.0;                         ///< g_0
    double spread = 0.0;                       ///< of the readings
  };

  double limitOf(ChangedPart part) const;
  std::optional<double> play(Part& part, ChangedPart which, double change, double begin);
  NoticedGap noticed(ChangedPart part, double since, double now) const;
  std::optional<NoticedGap> furthest(const WatchReading& reading);
  NoticedGap withOther(const NoticedGap& gap) const;
  void say(const NoticedGap& gap);
  double saidBefore(ChangedPart part) const { return parts_[static_cast<size_t>(part)].said; }

  WatchLimits limits_;
  double enough_;
  std::array<Part, kChangedParts> parts_;
  std::deque<WatchReading> recent_;
};

}  // namespace tread::gap
