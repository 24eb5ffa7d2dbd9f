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

/// Errors of 2 s end poses; NaN if not measured.
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

/// A hidden effect.
struct HiddenEffect {
  std::string name;
  std::string kind;                ///< vehicle, measurement, out_of_catalogue
  std::string form;                ///< physical, kinematic
  std::string shape;               ///< same, other: the catalogue's equation, or similar to it
  std::string place;               ///< drive, ground; empty = neither
  std::vector<std::string> group;  ///< each equivalent alone
  std::vector<std::vector<std::string>> together;  ///< equivalent combinations
  std::vector<std::string> depends_on;
  std::vector<HiddenNumber> numbers;
};

/// The file written by tread-hide.
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
  EndErrors floor;  ///< of the noise-free truth relative to the log
  EndErrors gap;    ///< of the plain vehicle relative to the truth
};

/// An estimated parameter.
struct Estimated {
  std::string path;  ///< effect.parameter
  double value = kUnknown;
  double low = kUnknown;  ///< of the 95 % interval
  double high = kUnknown;
  double before = kUnknown;        ///< in the nominal model
  double before_sigma = kUnknown;  ///< its standard deviation there
  /// Whether the workflow reports it as changed; nullopt if it does not say.
  std::optional<bool> moved = {};
};

/// A named effect in an answer.
struct NamedEffect {
  std::string name;
  std::vector<std::string> group;
  std::vector<std::string> runner_ups;
  std::vector<Estimated> parameters;
  /// Whether the motor currents indicate a load; nullopt if undecided.
  std::optional<bool> load = {};
};

/// Answer of tread-gap.
struct Answer {
  std::string verdict;  ///< "error" if it ended without one
  std::string reason;   ///< empty if it crashed
  std::vector<NamedEffect> effects;
  std::vector<Estimated> calibrated;
  EndErrors before;
  EndErrors after;
  std::vector<std::pair<std::string, std::string>> unexplained;  ///< channel, variable
};

/// Truth and answer of a case.
struct CaseRecord {
  Truth truth;
  Answer answer;
};

/// One line of cases.jsonl:
///   case, truth {as written}, answer {exit, message, verdict {as verdict.json}},
///   nominal {path: {value, sigma}}
/** Throws std::runtime_error naming the case if something is missing. */
CaseRecord recordOf(const nlohmann::ordered_json& line);

}  // namespace tread::blindtest
