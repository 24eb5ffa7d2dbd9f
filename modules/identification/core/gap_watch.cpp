// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/gap_watch.hpp"

#include <algorithm>
#include <cmath>

namespace tread::gap {
namespace {

constexpr double kTellsNothing = 0.5;  // [1] of a limit's tenfold; readings less sure are no stake
constexpr double kSpreadMemory = 0.02;  // [1] of each new reading in the spread
constexpr double kOneSide = 0.5;        // [1] the other drive changed by less than that of this one
constexpr size_t kMostRecent = 2000;    // readings, some three hours

/// A reading's change of a part and how sure it is.
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
  // Each game may say one false word in so many readings.
  const double games = 2.0 * kChangedParts * kStakes.size();
  enough_ = games * limits.hours * 3600.0 / limits.stretch;
  for (size_t p = 0; p < kChangedParts; ++p)
    parts_[p].spread = limitOf(static_cast<ChangedPart>(p));
}

double GapWatch::limitOf(ChangedPart part) const {
  return part == ChangedPart::kDelay ? limits_.delay : limits_.gain;
}

/// Since when it changed, if that is sure now.
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

/// Its size since then, by all readings.
NoticedGap GapWatch::noticed(ChangedPart part, double since, double now) const {
  double weight = 0.0, sum = 0.0;
  for (const WatchReading& reading : recent_) {
    if (reading.begin < since) continue;
    const Said said = saidOf(reading, part);
    const double precision = 1.0 / (said.uncertainty * said.uncertainty);
    weight += precision;
    sum += precision * said.change;
  }
  NoticedGap gap{part, since, now, 0.0, 0.0, false};
  if (weight > 0.0) {
    gap.change = sum / weight;
    gap.uncertainty = 1.0 / std::sqrt(weight);
  }
  return gap;
}

/// From now on that is what holds.
void GapWatch::say(const NoticedGap& gap) {
  const auto set = [this](ChangedPart part, double change) {
    parts_[static_cast<size_t>(part)].said = change;
  };
  const auto saidOfPart = [this](ChangedPart part) { return parts_[static_cast<size_t>(part)].said; };
  const double change = gap.as_model ? 0.0 : gap.change;
  set(gap.part, change);
  if (gap.part == ChangedPart::kBothDrives) {
    set(ChangedPart::kLeftDrive, change);
    set(ChangedPart::kRightDrive, change);
  } else {
    set(ChangedPart::kBothDrives,
        0.5 * (saidOfPart(ChangedPart::kLeftDrive) + saidOfPart(ChangedPart::kRightDrive)));
  }
  // One change moves several readings a little: all begin anew.
  for (Part& part : parts_) part.games = {};
}

std::optional<NoticedGap> GapWatch::take(const WatchReading& reading) {
  recent_.push_back(reading);
  if (recent_.size() > kMostRecent) recent_.pop_front();
  std::optional<NoticedGap> most;
  double largest = 0.0;
  for (size_t p = 0; p < kChangedParts; ++p) {
    const auto part = static_cast<ChangedPart>(p);
    const Said said = saidOf(reading, part);
    if (said.uncertainty > 10.0 * kTellsNothing * limitOf(part)) continue;
    const auto since = play(parts_[p], part, said.change, reading.begin);
    if (!since) continue;
    const NoticedGap gap = noticed(part, *since, reading.end);
    const double size = std::abs(gap.change - parts_[p].said) / limitOf(part);
    if (size <= largest) continue;
    largest = size;
    most = gap;
  }
  if (!most) return std::nullopt;
  const bool a_drive =
      most->part == ChangedPart::kLeftDrive || most->part == ChangedPart::kRightDrive;
  if (a_drive) {
    const ChangedPart other = most->part == ChangedPart::kLeftDrive ? ChangedPart::kRightDrive
                                                                    : ChangedPart::kLeftDrive;
    const double here = most->change - parts_[static_cast<size_t>(most->part)].said;
    const double there = noticed(other, most->since, reading.end).change -
                         parts_[static_cast<size_t>(other)].said;
    if (there / here > kOneSide) most = noticed(ChangedPart::kBothDrives, most->since, reading.end);
  }
  const double said = parts_[static_cast<size_t>(most->part)].said;
  most->as_model = said != 0.0 && std::abs(most->change) < limitOf(most->part);
  say(*most);
  return most;
}

}  // namespace tread::gap
