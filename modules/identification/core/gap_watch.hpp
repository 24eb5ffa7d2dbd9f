// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <deque>
#include <optional>

#include "modules/identification/core/running_fit.hpp"

namespace tread::gap {

/// What is said to have changed.
enum class ChangedPart { kLeftDrive, kRightDrive, kBothDrives, kTurning, kDelay };
inline constexpr size_t kChangedParts = 5;

/// When a change counts.
struct WatchLimits {
  double gain = 0.03;    ///< [1] less is no change
  double delay = 0.05;   ///< [s] less is no change
  double hours = 100.0;  ///< [h] of driving between two false alarms, at least, on average
  double stretch = 5.0;  ///< [s] of driving in a reading
};

/// Something is new beyond chance.
struct NoticedGap {
  ChangedPart part = ChangedPart::kBothDrives;
  double since = 0.0;        ///< [s]
  double noticed = 0.0;      ///< [s]
  double change = 0.0;       ///< against the model: gain less 1, or delay [s]
  double uncertainty = 0.0;  ///< its standard deviation
  bool as_model = false;     ///< it was said to have changed, and is as the model says again
};

/// Watches readings for a change that lasts.
/** For each part and direction a test martingale against "the change is at most the limit". A share
 * l of the wealth W is staked on each reading, which wins or loses by how far it is beyond the
 * limit: W <- max(1, W) (1 + l clamp((s (g - g_0) - limit) / m, -1, 1)) with s = +-1, g_0 what was
 * said last (0: the model), m the spread of the readings so far. While the clamped excess is not
 * positive on average, W does not grow on average either, and exceeds c no sooner than after c
 * readings on average (Ville's inequality; Shin, Ramdas and Rinaldo 2024: e-detectors). c is chosen
 * for `hours`; `since` is when W began to grow. Readings that follow each other may share some of
 * their ground: that is what the limit is for. */
class GapWatch {
 public:
  explicit GapWatch(const WatchLimits& limits = {});

  /// In order of time; each may be the last that a change needs.
  std::optional<NoticedGap> take(const WatchReading& reading);
  /// The robot's clock begins anew: what was said still holds, what was read does not count.
  void restart();
  /// Whether nothing that was said holds any more.
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
