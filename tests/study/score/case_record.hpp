// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace tread::blindtest {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Errors of 2 s end poses; NaN where nobody measured.
struct EndError {
  double position = kUnknown;  ///< [m]
  double yaw = kUnknown;       ///< [rad]
};

/// Root mean squares and medians of such errors.
struct EndErrors : EndError {
  EndError median;
  double yaw_rate = kUnknown;  ///< rms of the gyro over 0.25 s [rad/s]
};

/// A number of the truth, in the catalogue's terms.
struct HiddenNumber {
  std::string name;  ///< the symbol in the truth file: s, k_t, T_d, ...
  double value = 0.0;
};

/// One effect that was hidden.
struct HiddenEffect {
  std::string name;
  std::string kind;                ///< vehicle, measurement, out_of_catalogue
  std::string form;                ///< physical, kinematic
  std::string shape;               ///< same, other: as the catalogue's equation or only like it
  std::string place;               ///< drive, ground; empty = neither
  std::vector<std::string> group;  ///< each of these alone is the same
  std::vector<std::vector<std::string>> together;  ///< these are, where they are all there
  std::vector<std::string> depends_on;
  std::vector<HiddenNumber> numbers;
};

/// What tread-hide wrote.
struct Truth {
  std::string name;  ///< of the case
  std::string kind;  ///< null, single, pair, out_of_catalogue, degenerate, bad, semi
  std::string noise;
  std::string programme;
  std::string defect;
  double size = 0.0;
  double minutes = 0.0;
  double duration = 0.0;  ///< [s]
  std::vector<HiddenEffect> effects;
  std::vector<std::string> right_verdicts;
  std::vector<std::string> right_names;
  EndErrors floor;  ///< of the truth without noise against the log
  EndErrors gap;    ///< of the plain vehicle against the truth
};

/// An estimated parameter.
struct Estimated {
  std::string path;  ///< effect.parameter
  double value = kUnknown;
  double low = kUnknown;  ///< of the 95 % interval
  double high = kUnknown;
  double before = kUnknown;        ///< in the nominal model
  double before_sigma = kUnknown;  ///< its standard deviation there
  /// Whether the workflow says that it is another one now; nothing where it did not say.
  std::optional<bool> moved = {};
};

/// An effect that the workflow named.
struct NamedEffect {
  std::string name;
  std::vector<std::string> group;
  std::vector<std::string> runner_ups;
  std::vector<Estimated> parameters;
  /// Whether the motor currents call it a load; nothing where they do not tell.
  std::optional<bool> load = {};
};

/// What tread-gap answered.
struct Answer {
  std::string verdict;  ///< "error" where it ended without
  std::string reason;   ///< empty where it broke down
  std::vector<NamedEffect> effects;
  std::vector<Estimated> calibrated;
  EndErrors before;
  EndErrors after;
  std::vector<std::pair<std::string, std::string>> unexplained;  ///< channel, variable
};

/// Truth and answer side by side.
struct CaseRecord {
  Truth truth;
  Answer answer;
};

/// A record as it is written, one line of cases.jsonl:
///   case, truth {as written}, answer {exit, message, verdict {as verdict.json}},
///   nominal {path: {value, sigma}}
/** Throws std::runtime_error naming the case where something is missing. */
CaseRecord recordOf(const nlohmann::ordered_json& line);

}  // namespace tread::blindtest
