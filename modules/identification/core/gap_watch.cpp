// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/gap_watch.hpp"

#include <algorithm>
#include <cmath>

namespace tread::gap {
namespace {

constexpr double kTellsNothing = 2.0;   // limits; a less certain reading is not staked on
constexpr double kSpreadMemory = 0.02;  // [1] weight of each new reading in the spread
constexpr double kOneSide = 0.5;        // [1] the other drive changed by less than this share
constexpr size_t kMostRecent = 2000;    // readings, some three hours

/// A reading's change of a part and its certainty.
struct Said {
  double change;
  double uncertainty;
};

Said saidOf(const WatchReading& reading, ChangedPart part) {
  const auto of = [&reading](Watched what) {
    const auto at = static_cast<size_t>(what);
    return Said{reading.change[at], reading.uncertainty[at]};
  };
  const Said left = of(Watched::kLeft), right = of(Watched::kRight);
  switch (part) {
    case ChangedPart::kLeftDrive:
      return left;
    case ChangedPart::kRightDrive:
      return right;
    case ChangedPart::kBothDrives:
      return {0.5 * (left.change + right.change),
              0.5 * std::hypot(left.uncertainty, right.uncertainty)};
    case ChangedPart::kTurning:
      return of(Watched::kTurning);
    case ChangedPart::kDelay:
      break;
  }
  return of(Watched::kDelay);
}

}  // namespace

GapWatch::GapWatch(const WatchLimits& limits) : limits_(limits) {
  // Each game may give one false alarm in this many readings.
  const double games = 2.0 * kChangedParts * kStakes.size();
  enough_ = games * limits.hours * 3600.0 / limits.stretch;
  for (size_t p = 0; p < kChangedParts; ++p)
    parts_[p].spread = limitOf(static_cast<ChangedPart>(p));
}

double GapWatch::limitOf(ChangedPart part) const {
  return part == ChangedPart::kDelay ? limits_.delay : limits_.gain;
}

/// Time of the change, if it is now certain.
std::optional<double> GapWatch::play(Part& part, ChangedPart which, double change, double begin) {
  const double beyond = change - part.said;
  const double unit = std::max(limitOf(which), 2.0 * part.spread);
  std::optional<double> since;
  for (size_t direction = 0; direction < 2; ++direction)
    for (size_t stake = 0; stake < kStakes.size(); ++stake) {
      Game& game = part.games[direction][stake];
      if (game.wealth <= 1.0) game = {1.0, begin};
      const double won = (direction == 0 ? beyond : -beyond) - limitOf(which);
      game.wealth *= 1.0 + kStakes[stake] * std::clamp(won / unit, -1.0, 1.0);
      if (game.wealth > enough_ && (!since || game.since > *since)) since = game.since;
    }
  const double size = std::min(std::abs(beyond), 3.0 * part.spread);
  part.spread += kSpreadMemory * (size - part.spread);
  return since;
}

/// Its size since then, from all readings; its uncertainty comes from their scatter.
NoticedGap GapWatch::noticed(ChangedPart part, double since, double now) const {
  NoticedGap gap{part, since, now, 0.0, 0.0, false};
  double weights = 0.0;
  const auto each = [&](const auto& use) {
    for (const WatchReading& reading : recent_) {
      const Said said = saidOf(reading, part);
      if (reading.begin < since || said.uncertainty > kTellsNothing * limitOf(part)) continue;
      use(said.change, 1.0 / (said.uncertainty * said.uncertainty));
    }
  };
  each([&](double change, double weight) {
    weights += weight;
    gap.change += weight * change;
  });
  if (weights <= 0.0) return gap;
  gap.change /= weights;
  double apart = 0.0;
  each([&](double change, double weight) {
    apart += weight * weight * (change - gap.change) * (change - gap.change);
  });
  gap.uncertainty = std::sqrt(apart) / weights;
  return gap;
}

/// This is the reported state from now on.
void GapWatch::say(const NoticedGap& gap) {
  const double change = gap.as_model ? 0.0 : gap.change;
  const auto set = [this](ChangedPart part, double said) {
    parts_[static_cast<size_t>(part)].said = said;
  };
  set(gap.part, change);
  if (gap.part == ChangedPart::kBothDrives) {
    set(ChangedPart::kLeftDrive, change);
    set(ChangedPart::kRightDrive, change);
  } else {
    set(ChangedPart::kBothDrives,
        0.5 * (saidBefore(ChangedPart::kLeftDrive) + saidBefore(ChangedPart::kRightDrive)));
  }
  // One change affects several readings slightly: all games restart.
  for (Part& part : parts_) part.games = {};
}

/// The largest deviation from the reported state, of those that are certain.
std::optional<NoticedGap> GapWatch::furthest(const WatchReading& reading) {
  std::optional<NoticedGap> most;
  double largest = 0.0;
  for (size_t p = 0; p < kChangedParts; ++p) {
    const auto part = static_cast<ChangedPart>(p);
    const Said said = saidOf(reading, part);
    if (said.uncertainty > kTellsNothing * limitOf(part)) continue;
    const auto since = play(parts_[p], part, said.change, reading.begin);
    if (!since) continue;
    const NoticedGap gap = noticed(part, *since, reading.end);
    const double size = std::abs(gap.change - saidBefore(part)) / limitOf(part);
    if (size <= largest) continue;
    largest = size;
    most = gap;
  }
  return most;
}

/// If the other drive has changed in the same way, both have.
NoticedGap GapWatch::withOther(const NoticedGap& gap) const {
  if (gap.part != ChangedPart::kLeftDrive && gap.part != ChangedPart::kRightDrive) return gap;
  const ChangedPart other =
      gap.part == ChangedPart::kLeftDrive ? ChangedPart::kRightDrive : ChangedPart::kLeftDrive;
  const double here = gap.change - saidBefore(gap.part);
  const double there = noticed(other, gap.since, gap.noticed).change - saidBefore(other);
  if (there / here <= kOneSide) return gap;
  return noticed(ChangedPart::kBothDrives, gap.since, gap.noticed);
}

std::optional<NoticedGap> GapWatch::take(const WatchReading& reading) {
  recent_.push_back(reading);
  if (recent_.size() > kMostRecent) recent_.pop_front();
  const std::optional<NoticedGap> most = furthest(reading);
  if (!most) return std::nullopt;
  NoticedGap gap = withOther(*most);
  gap.as_model = saidBefore(gap.part) != 0.0 && std::abs(gap.change) < limitOf(gap.part);
  say(gap);
  return gap;
}

void GapWatch::restart() {
  recent_.clear();
  for (Part& part : parts_) part.games = {};
}

bool GapWatch::asModel() const {
  return std::all_of(parts_.begin(), parts_.end(),
                     [](const Part& part) { return part.said == 0.0; });
}

}  // namespace tread::gap
