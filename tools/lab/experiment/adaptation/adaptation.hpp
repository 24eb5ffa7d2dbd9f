// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "common/statistics/statistics.hpp"
#include "modules/learner/core/rules/learning_rule.hpp"
#include "tools/lab/experiment/adaptation/driving.hpp"

// Error of open-loop predictions on a ground, in a session or with a vehicle that is new to the
// learner, after a few executions there.
//   1. One session, all sessions of one surface, or all of one vehicle are left out. A reference
//   and
//      the rivals' priors are fitted to the other sessions (of the same vehicle, except in the last
//      case).
//   2. A left-out session is traversed from many starts: a new learner with the reference executes
//      one piece after another. After k executions it predicts a chain of the next pieces from the
//      true pose, with known commands and without measurements.
//   3. A session's error is the mean over its starts; its ratio is relative to the error of no
//      learning at the same places. Intervals are over sessions, as starts in one are dependent.
namespace tread::adaptation {

inline constexpr std::array<size_t, 5> kExecutions{0, 1, 3, 10, 30};
inline constexpr std::array<size_t, 3> kHorizons{2, 5, 10};  ///< [s]
/// Least number of predictions of a session that counts.
inline constexpr size_t kLeastStarts = 12;

/// The rule that is compared with the others.
inline constexpr const char* kJudged = "multi_model";
/// No learning.
inline constexpr const char* kOff = "off";
/// Slip regression fitted to the whole session: a bound, not a rule.
inline constexpr const char* kHindsight = "hindsight";

/// RULE_home: the rule has first executed 20 pieces of a training session of the same vehicle.
inline constexpr const char* kHome = "_home";

/// All methods: learning rules, the same as RULE_home, rivals, hindsight.
std::vector<std::string> knownRules();
std::vector<std::string> defaultRules();

enum class HeldOut { kSession, kSurface, kVehicle };
inline constexpr std::array<HeldOut, 3> kAllLeftOut{HeldOut::kSession, HeldOut::kSurface,
                                                    HeldOut::kVehicle};
/// "session", "surface", "vehicle".
const char* nameOf(HeldOut what);

/// Settings of the comparison.
struct Settings {
  std::vector<std::string> rules = defaultRules();
  learner::RuleConfig config;  ///< of the learning rules
  size_t starts = 1000;        ///< of each session, at most
  uint64_t seed = 1;
  int threads = 1;  ///< results do not depend on it
};

/// Errors of one rule in one session after k executions at one horizon.
struct Cell {
  size_t starts = 0;
  double position = 0.0;  ///< [m] mean; sum while it is computed
  double yaw = 0.0;       ///< [rad]
  size_t stated = 0;      ///< ends of single pieces with a stated covariance
  size_t inside = 0;      ///< of these inside the stated 90 % region
};

/// Errors in one left-out session.
struct SessionErrors {
  HeldOut kind = HeldOut::kSession;
  std::string session, vehicle, surface;
  /// By rule, executions, horizon.
  std::vector<std::array<std::array<Cell, kHorizons.size()>, kExecutions.size()>> cells;
};

struct AdaptationErrors {
  std::vector<SessionErrors> sessions;  ///< by kind of omission, then in the order of sessions
  std::vector<std::string> notes;       ///< what could not be left out, and why
};

using Progress = std::function<void(size_t done, size_t all)>;

/// Runs everything. Results do not depend on the number of threads.
/** Throws std::runtime_error with one line if nothing can be left out, std::invalid_argument for an
 * unknown rule. */
AdaptationErrors runAdaptation(const std::vector<SampledSession>& sessions,
                               const Settings& settings, const Progress& progress);

/// Comparison of the judged rule with another, by the differences of their ratios per session.
enum class Verdict { kUnknown, kBetter, kLevel, kWorse };

/// One quantity of one rule after k executions at one horizon.
struct Standing {
  double error = std::numeric_limits<double>::quiet_NaN();  ///< [m] or [deg], mean over sessions
  ConfidenceInterval ratio = kNoInterval;                   ///< [1] relative to no learning
  double worst = std::numeric_limits<double>::quiet_NaN();  ///< [1] largest ratio of a session
  std::string worst_session;
  Verdict judged = Verdict::kUnknown;  ///< judged rule compared with this one
  double difference = std::numeric_limits<double>::quiet_NaN();  ///< [1] judged minus this one
  double standard_error = std::numeric_limits<double>::quiet_NaN();
};

/// One line of a summary: a rule in a group of sessions.
struct SummaryLine {
  HeldOut kind = HeldOut::kSession;
  std::string vehicle;
  std::string rule;
  size_t executions = 0;
  size_t horizon = 0;
  size_t sessions = 0;
  Standing position, yaw;
};

}  // namespace tread::adaptation
