// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/recordings/imported_log.hpp"

namespace tread::import {

/// What should have been taken from a recording and could not be.
struct Loss {
  std::string what;
  double lost = 0.0;
  double of = 0.0;   ///< all that there were; 0 = not known
  std::string unit;  ///< of both: "rows of a.csv", "poses", "bytes", "s"
};

/// Commands in an order of no meaning, for maps.
struct CommandOrder {
  bool operator()(const Command& a, const Command& b) const;
};

/// The largest share that was lost: the losses of a unit together.
double largestShare(const std::vector<Loss>& losses);
/// "1234 of 5678 rows (22 %): the same time as the one before".
std::string lineOf(const Loss& loss);

/// What was found in a recording of another robot.
struct ForeignDrive {
  recordings::RecordedDrive drive;
  std::string poses;                       ///< whose poses were taken, in words
  std::map<std::string, size_t> left_out;  ///< what is no part of a drive, and why
  std::vector<Loss> losses;
  std::vector<std::string> notes;  ///< what else is unusual about it, a line each

  void lose(const std::string& what, size_t lost, size_t of, const std::string& unit) {
    if (lost > 0) losses.push_back({what, double(lost), double(of), unit});
  }
};

/// No pose of these robots is farther out [m].
inline constexpr double kFarthest = 100'000.0;
/// Recordings last no longer [s].
inline constexpr double kLongest = 7.0 * 86'400.0;
/// A command is gone if none came for so long, whatever its period [s].
inline constexpr double kCommandAge = 0.5;
/// Messages and rows may overtake each other by so much [s].
inline constexpr double kOvertaking = 0.2;

/// Sorts what came by its time, each of which comes once.
/** What is older than overtaking allows belongs to a clock that went back; what has the time of the
 * one before and says something else contradicts it: both are lost. What repeats it is not. */
template <class Item, class Same>
void sortByTime(std::vector<Item>& items, const std::string& unit, const Same& same,
                ForeignDrive& result) {
  double newest = -1e300;
  std::vector<Item> kept;
  size_t back = 0, other = 0;
  for (Item& item : items) {
    if (item.time < newest - kOvertaking) {
      ++back;
      continue;
    }
    newest = std::max(newest, item.time);
    kept.push_back(std::move(item));
  }
  std::stable_sort(kept.begin(), kept.end(),
                   [](const Item& a, const Item& b) { return a.time < b.time; });
  const size_t all = items.size();
  items.clear();
  for (Item& item : kept) {
    const bool again = !items.empty() && items.back().time == item.time;
    if (!again)
      items.push_back(std::move(item));
    else if (same(items.back(), item))
      ++result.left_out[unit + " that come twice"];
    else
      ++other;
  }
  result.lose("their clock goes back", back, all, unit);
  result.lose("the same time as the one before", other, all, unit);
}

/// Leaves out each pose to which no ground vehicle can have gone and come back, and begins a new
/// track at both ends of what lies apart for longer; both are counted and told.
/** `place` says where the i-th of the poses stands. Where more than a tenth of them are so far from
 * each other, units or times are wrong: they stay as they are, and that is told. */
void takeJumpsOut(std::vector<recordings::Fix>& poses,
                  const std::function<std::string(size_t)>& place, ForeignDrive& result);

/// The usual time between two of these times, which are in order; 0 of fewer than two.
double usualPeriod(const std::vector<double>& times);

/// Whether a clock that counts from 1970 shows this in one of the years 2008 to 2039 [s].
constexpr bool isCalendar(double seconds) {
  return seconds > 1.2e9 && seconds < 2.2e9;
}

/// Why times cannot be in a unit [s], and in which they are instead; nothing where they can.
/** Measurements of vehicles are .1 ms to 20 s apart, and no clock shows a later century. */
std::optional<std::string> timeUnitProblem(std::vector<double> times, double unit);

/// How long a command is known to hold where none follows: three of its periods, but .3 s at least
/// and kCommandAge at most.
double holdOf(double period);

/// Commands as they came, in order of time, become a sample every 50 ms: the newest command.
/** Between two that are further apart than `hold` [s] nothing is known, so that there are no
 * samples from one `period` after the first on. */
void holdCommands(const std::vector<recordings::DriveSample>& commands, double period, double hold,
                  recordings::RecordedDrive& drive);

/// Runs of one command other than zero; equal commands have equal numbers.
void findRuns(recordings::RecordedDrive& drive);

}  // namespace tread::import
