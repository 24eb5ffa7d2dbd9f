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

/// Data that could not be read from a recording.
struct Loss {
  std::string what;
  double lost = 0.0;
  double of = 0.0;   ///< total, in the same unit; 0 = unknown
  std::string unit;  ///< of both: "rows of a.csv", "poses", "bytes", "s"
};

/// Orders commands lexicographically, for use as map keys.
struct CommandOrder {
  bool operator()(const Command& a, const Command& b) const;
};

/// Largest lost share; losses of the same unit are added.
double largestShare(const std::vector<Loss>& losses);
/// One line, for instance "1234 of 5678 rows (22 %): the same time as the one before".
std::string lineOf(const Loss& loss);

/// Contents of another robot's recording.
struct ForeignDrive {
  recordings::RecordedDrive drive;
  std::string poses;                       ///< source of the poses, in words
  std::map<std::string, size_t> left_out;  ///< counts of what is not part of a drive, by reason
  std::vector<Loss> losses;
  std::vector<std::string> notes;  ///< unusual facts, one per line

  void lose(const std::string& what, size_t lost, size_t of, const std::string& unit) {
    if (lost > 0) losses.push_back({what, double(lost), double(of), unit});
  }
};

/// Largest plausible distance of a pose from the origin [m].
inline constexpr double kFarthest = 100'000.0;
/// Longest plausible recording [s].
inline constexpr double kLongest = 7.0 * 86'400.0;
/// A command expires after this age [s], whatever its period.
inline constexpr double kCommandAge = 0.5;
/// Messages and rows may be out of order by this much [s].
inline constexpr double kOvertaking = 0.2;

/// Sorts items by time and removes duplicates.
/** An item that is later than overtaking allows comes from a clock that went back; an item with the
 * time of its predecessor and other content contradicts it. Both count as lost, an exact duplicate
 * does not. */
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

/// Removes single poses that no ground vehicle can have reached, and starts a new track at both
/// ends of a longer outlier. Both are counted and reported.
/** `place` names the position of the i-th pose in the file. If more than a tenth of the poses jump,
 * units or times are wrong: nothing is removed, and that is reported. */
void takeJumpsOut(std::vector<recordings::Fix>& poses,
                  const std::function<std::string(size_t)>& place, ForeignDrive& result);

/// Median difference of sorted times; 0 for fewer than two.
double usualPeriod(const std::vector<double>& times);

/// Whether a time since 1970 [s] lies in the years 2008 to 2039.
constexpr bool isCalendar(double seconds) {
  return seconds > 1.2e9 && seconds < 2.2e9;
}

/// Why the times cannot be in `unit` [s], and their likely unit; nullopt if they can.
/** Vehicle data are sampled every .1 ms to 20 s, and no clock shows a later century. */
std::optional<std::string> timeUnitProblem(std::vector<double> times, double unit);

/// How long a command holds where none follows: three of its periods, at least .3 s and at most
/// kCommandAge.
double holdOf(double period);

/// Resamples commands to every 50 ms: each sample is the newest command.
/** In a gap longer than `hold` [s] there are no samples after one `period`. */
void holdCommands(const std::vector<recordings::DriveSample>& commands, double period, double hold,
                  recordings::RecordedDrive& drive);

/// Finds runs of one non-zero command; equal commands get equal numbers.
void findRuns(recordings::RecordedDrive& drive);

}  // namespace tread::import
