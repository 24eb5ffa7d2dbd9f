// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "modules/learner/core/rules/learning_rule.hpp"
#include "tools/lab/experiment/adaptation/driving.hpp"

// How far open-loop predictions are off on a ground, in a session, with a vehicle not met before,
// after a few executions there.
//   1. One session, all of one surface, or all of one vehicle are left out; a reference is fitted
//      to the other sessions (of the same vehicle, except for the last), and so is what rivals
//      expect beforehand.
//   2. A session that was left out is walked from many starts: a fresh learner that knows the
//      reference executes piece after piece. After k executions it predicts the next pieces in a
//      chain from the true pose, their commands known, and nothing measured in between.
//   3. A session's error is the mean over its starts; its ratio is that over the error of no
//      learning at the same places. Intervals are over sessions: starts in one are not independent.
namespace tread::adaptation {

inline constexpr std::array<size_t, 5> kExecutions{0, 1, 3, 10, 30};
inline constexpr std::array<size_t, 3> kHorizons{2, 5, 10};  ///< [s]
/// A session counts where it was predicted at least so often.
inline constexpr size_t kLeastStarts = 12;

/// The rule whose ratio to others is told.
inline constexpr const char* kJudged = "multi_model";
/// No learning.
inline constexpr const char* kOff = "off";
/// Slip regression that has seen the whole session: no rule, a bound.
inline constexpr const char* kHindsight = "hindsight";

/// RULE_home: the rule has executed 20 pieces of a training session of the vehicle before.
inline constexpr const char* kHome = "_home";

/// Whatever may be asked to learn: rules of ours, the same as RULE_home, rivals, hindsight.
std::vector<std::string> knownRules();
std::vector<std::string> defaultRules();

enum class HeldOut { kSession, kSurface, kVehicle };
inline constexpr std::array<HeldOut, 3> kAllLeftOut{HeldOut::kSession, HeldOut::kSurface,
                                                    HeldOut::kVehicle};
/// "session", "surface", "vehicle".
const char* nameOf(HeldOut what);

/// What to compare, and how.
struct Settings {
  std::vector<std::string> rules = defaultRules();
  learner::RuleConfig config;  ///< of our rules
  size_t starts = 1000;        ///< of each session, at most
  uint64_t seed = 1;
  int threads = 1;  ///< no influence on any number
};

/// Errors of one rule in one session after k executions at one horizon.
struct Cell {
  size_t starts = 0;
  double position = 0.0;  ///< [m] mean; sum while it is computed
  double yaw = 0.0;       ///< [rad]
  size_t stated = 0;      ///< ends of single pieces whose covariance the rule states
  size_t inside = 0;      ///< of these within the region that it states for nine in ten
};

/// One session that was left out.
struct SessionErrors {
  HeldOut kind = HeldOut::kSession;
  std::string session, vehicle, surface;
  /// By rule, executions, horizon.
  std::vector<std::array<std::array<Cell, kHorizons.size()>, kExecutions.size()>> cells;
};

struct AdaptationErrors {
  std::vector<SessionErrors> sessions;  ///< by what was left out, then in the order of sessions
  std::vector<std::string> notes;       ///< what could not be left out, and why
};

using Progress = std::function<void(size_t done, size_t all)>;

/// Runs everything. Same sessions and settings, same bytes, for any number of threads.
/** Throws std::runtime_error with one line if nothing can be left out, std::invalid_argument for a
 * rule that is not known. */
AdaptationErrors runAdaptation(const std::vector<SampledSession>& sessions,
                               const Settings& settings, const Progress& progress);

/// A mean over sessions with its 95 % interval (bootstrap of sessions); NaN where there is none.
struct Interval {
  double mean = std::numeric_limits<double>::quiet_NaN();
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();
};

/// Mean and interval of numbers, one a session; of one session no interval.
Interval intervalOf(const std::vector<double>& values, uint64_t seed);

/// How the judged rule stands against another: ratios of the one less the other, by session.
enum class Verdict { kUnknown, kBetter, kLevel, kWorse };
const char* nameOf(Verdict verdict);

/// One quantity of one rule after k executions at one horizon.
struct Standing {
  double error = std::numeric_limits<double>::quiet_NaN();  ///< [m] or [deg], mean over sessions
  Interval ratio;                                           ///< [1] to no learning
  double worst = std::numeric_limits<double>::quiet_NaN();  ///< [1] largest ratio of a session
  std::string worst_session;
  Verdict judged = Verdict::kUnknown;  ///< the judged rule against this one
  double difference = std::numeric_limits<double>::quiet_NaN();  ///< [1] judged less this
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

/// All lines, by what was left out, vehicle, horizon, rule, executions.
std::vector<SummaryLine> summaryOf(const AdaptationErrors& errors,
                                   const std::vector<std::string>& rules, uint64_t seed);

/// What a run was, for texts about it.
struct Report {
  std::string source;
  Settings settings;
  std::vector<std::string> notes;
  AdaptationErrors errors;
  std::vector<SummaryLine> lines;
};

/// Tables for the terminal.
std::string textOf(const Report& report);
/// adaptation.csv: a line for each Line. sessions.csv: one for each session, rule, k and horizon.
std::string csvOfLines(const Report& report);
std::string csvOfSessions(const Report& report);
/// Writes adaptation.html, adaptation.png and the CSV files into a folder that exists.
void writeReport(const std::string& folder, const Report& report);

}  // namespace tread::adaptation
