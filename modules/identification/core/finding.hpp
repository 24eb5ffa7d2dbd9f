// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/soundness/core/drive.hpp"
#include "common/vehicle/model_document.hpp"

namespace tread::gap {

/// The headline; see exitStatus().
enum class GapVerdict {
  kNoDiscrepancy = 0,
  kNothingNew = 1,  ///< only the model's known rest is there
  kFound = 10,
  kAmbiguous = 11,
  kPartial = 12,
  kNotInCatalogue = 13,
  kMeasurement = 14,
  kCannotTell = 15
};

/// Name as in verdict.json.
inline const char* verdictName(GapVerdict verdict) {
  if (verdict == GapVerdict::kNoDiscrepancy) return "NO_DISCREPANCY";
  if (verdict == GapVerdict::kNothingNew) return "NOTHING_NEW";
  static constexpr const char* kNames[] = {
      "FOUND", "AMBIGUOUS", "PARTIAL", "NOT_IN_CATALOGUE", "MEASUREMENT", "CANNOT_TELL"};
  return kNames[static_cast<int>(verdict) - static_cast<int>(GapVerdict::kFound)];
}

/// The exit status of `tread-gap find`: 0 where nothing is to be done.
inline int exitStatus(GapVerdict verdict) {
  return verdict == GapVerdict::kNothingNew ? 0 : static_cast<int>(verdict);
}

/// A parameter as it was estimated.
struct ParameterEstimate {
  std::string parameter;  ///< path as in findParameter(): effect.parameter or a nominal number
  std::string unit;
  double value = 0.0;
  /// Of the 95 % interval, over blocks and, of found effects, over halves of the driving if no test
  /// drives were given; with what the equation may be off by.
  double low = 0.0;
  double high = 0.0;  ///< infinite bounds where the drive does not say
  double before = 0.0;
  /// Of a term that the model has: its value has changed, beyond chance and what the model's own
  /// covariance allows.
  bool moved = false;
};

/// Another effect that explains the data as well or nearly so.
struct RunnerUp {
  std::string effect;
  double behind = 0.0;  ///< [nats] cross-validated log likelihood behind the winner
  double error = 0.0;   ///< [nats] standard error of that difference
};

/// Share of an effect that the wheel speeds show, with its 95 % interval: 1 = all of it, 0 = none.
struct WheelWitness {
  double share = 0.0;
  double low = 0.0;
  double high = 0.0;
  bool of_lags = false;  ///< of all lags of the vehicle together

  bool saysDrive() const { return low > 0.5; }
  bool saysGround() const { return high < 0.5; }
};

/// By how many percent the motor currents rise per percent of speed that an effect takes, beyond
/// what they are at the speed that is left; with its 95 % interval. 0 = not at all.
/** A load takes speed by the current that it draws: more than in proportion, or it would take all.
 * A drive that gives less draws what is drawn at the lower speed; so do tracks that slip. Between
 * them lie currents that are made up from the command. */
struct CurrentWitness {
  double rise = 0.0;
  double low = 0.0;
  double high = 0.0;

  bool saysLoad() const { return low > 1.5; }
  bool saysNoLoad() const { return high < 0.5; }
};

/// Share of an effect that comes and goes with time which the battery voltage falls by, too; with
/// its 95 % interval.
struct VoltageWitness {
  double share = 0.0;
  double low = 0.0;
  double high = 0.0;

  bool saysBattery() const { return low > 0.5; }
  bool saysOther() const { return high < 0.5; }
};

/// An effect that was found.
struct FoundEffect {
  std::string name;
  std::vector<ParameterEstimate> parameters;
  std::vector<std::string> group;  ///< members it cannot be told from (without itself)
  std::vector<RunnerUp> runner_ups;
  double score = 0.0;    ///< T of the score test in the presence of all others
  double p_value = 1.0;  ///< of the largest T over the whole catalogue
  double gain = 0.0;     ///< [nats] on blocks that were not fitted
  double gain_error = 0.0;
  bool accepted = false;  ///< by a person: it stands whatever the numbers above say
  // What else the log says of it; nothing where that does not speak of it.
  std::optional<WheelWitness> wheels{};
  std::optional<CurrentWitness> currents{};
  std::optional<VoltageWitness> voltage{};
};

/// Probability of chance from which on an accepted effect is not shown by the drive itself.
inline constexpr double kShownBelow = 0.05;

/// Whether tests speak for an effect, and not a person alone.
inline bool isShown(const FoundEffect& effect) {
  return !effect.accepted || effect.p_value <= kShownBelow;
}

/// Median and root mean square over executions.
struct ErrorFigure {
  double median = 0.0;
  double rms = 0.0;
};

/// End errors after the horizon, from where the execution begins.
struct EndErrors {
  ErrorFigure position;  ///< [m]
  ErrorFigure yaw;       ///< [rad]
  size_t executions = 0;
};

/// By how much the medians of two models over the same executions differ by chance: standard
/// errors.
struct MedianChance {
  double position = 0.0;  ///< [m]
  double yaw = 0.0;       ///< [rad]
};

/// One execution predicted by two models, for pictures; poses relative to its beginning.
struct Overlay {
  size_t drive = 0;
  double begin = 0.0;           ///< [s]
  double duration = 2.0;        ///< [s]
  std::vector<Pose2> measured;  ///< at equal times over the horizon
  std::vector<Pose2> before;
  std::vector<Pose2> after;
  double error_before = 0.0;  ///< [m] at the end
  double error_after = 0.0;   ///< [m]
  /// Radius about each point of `after` within which nine of ten executions are [m]; may be empty.
  std::vector<double> band;
};

/// What two models err at the end of an execution, and where that was.
struct PlaceError {
  size_t drive = 0;
  double x = 0.0;  ///< [m] halfway, in the frame of the log
  double y = 0.0;
  double before = 0.0;  ///< [m]
  double after = 0.0;   ///< [m]
};

/// How far simulation and measurement are apart after 2 s, on executions not used for the fit.
struct Gap {
  double horizon = 2.0;  ///< [s]
  EndErrors before;
  EndErrors after;
  EndErrors apart;                 ///< of the two models from one another
  std::optional<EndErrors> floor;  ///< dead reckoning with encoders and gyro, where those exist
  bool structure_nested = true;    ///< the effects, too, were chosen without these executions
  MedianChance by_chance{};        ///< of the medians' change from before to after
  double way = 0.0;                ///< [m] that an execution leads away, median
};

/// One cell of the residual atlas.
struct AtlasCell {
  double from = 0.0;  ///< of the variable
  double to = 0.0;
  double mean = 0.0;  ///< of the residual (measured - predicted), per second
  double low = 0.0;   ///< 95 % interval over blocks
  double high = 0.0;
  size_t rows = 0;
  bool marked = false;  ///< the interval excludes 0 after correction for the number of cells
};

/// An unnamed term that was added to the model, which has its numbers by this name.
struct UnnamedFinding {
  std::string name;
  double gain = 0.0;  ///< [nats] on blocks that were not fitted
  double gain_error = 0.0;
  std::vector<double> deviations{};  ///< of its values, in their unit
  /// What the term was made from: residuals with the term in them over its factor, by its
  /// condition; for a picture.
  std::vector<AtlasCell> data{};
};

/// Residual of one channel over one variable.
struct AtlasCurve {
  std::string channel;   ///< along, lateral, yaw rate
  std::string unit;      ///< of the residual: m/s or rad/s
  std::string variable;  ///< speed, yaw rate, speed x yaw rate, ...
  std::string variable_unit;
  std::vector<AtlasCell> before;
  std::vector<AtlasCell> after;
  bool unexplained = false;  ///< the new model's residuals depend on it beyond chance
};

/// Mean residual of one channel over speed and yaw rate, for a picture.
struct AtlasMap {
  std::string channel;
  std::string unit;                 ///< of the residual
  std::vector<double> v_edges;      ///< [m/s] ascending
  std::vector<double> omega_edges;  ///< [rad/s] ascending
  /// One value per field, rows of equal omega; NaN = never driven.
  std::vector<double> before;
  std::vector<double> after;
};

/// What the residuals still depend on.
struct Unexplained {
  std::string channel;
  std::string variable;
  double score = 0.0;
  double p_value = 1.0;
  std::string like{};  ///< the effect that it resembles most, but is not taken for; may be empty
};

/// One candidate of the first test.
struct CandidateTest {
  std::string effect;
  std::string parameter;
  double score = 0.0;
  double p_value = 1.0;     ///< family-wise
  double uniqueness = 1.0;  ///< share of its signature that no active term has
  /// Smallest size found with 80 % power, in the parameter's unit, of a limit the gentlest one that
  /// was tried; infinite = not excited.
  double detectable = 0.0;
};

/// One step of the search: an effect that was added or removed, and what that brought.
struct SearchStep {
  std::string effect;  ///< added, or removed
  bool removed = false;
  double score = 0.0;
  double p_value = 1.0;
  double gain = 0.0;  ///< [nats] cross-validated
  double gain_error = 0.0;
  std::vector<RunnerUp> runner_ups;
  std::string remark;  ///< why it was removed or refused; empty else
};

/// What happened in a search, beside the effects that are in the model now.
struct SearchRecord {
  std::vector<SearchStep> steps;
  std::vector<CandidateTest> candidates;  ///< of the calibrated model, each effect's best direction
  std::vector<std::string> negligible;    ///< real but below 1 % of the end error: not added
  std::vector<std::string> at_bound;      ///< seen, but their sizes ran to the ends of their ranges
  bool cut_short = false;  ///< its time was over before its end: these are the best terms so far
};

/// What the residuals of a model still depend on.
struct Adequacy {
  double p_value = 1.0;                  ///< of the largest dependence over all
  std::vector<Unexplained> unexplained;  ///< those below the level asked for, strongest first
};

/// Where the residuals of the old and the new model are.
struct ResidualAtlas {
  std::vector<AtlasCurve> curves;  ///< those of what is unexplained first, strongest first
  std::vector<AtlasMap> maps;      ///< may be empty
};

/// Executions for pictures, of driving that was not used for the fit.
struct ShownExecutions {
  std::vector<Overlay> overlays;   ///< six typical, then the three worst
  std::vector<PlaceError> places;  ///< of all
};

/// What a finding was made from.
struct FindingSource {
  uint64_t seed = 0;
  std::vector<LogNote> log_notes;
  std::vector<EffectDecision> decisions;  ///< of people, in the order given
  size_t blocks = 0;                      ///< of measured driving
  double block_length = 0.0;              ///< [s]
};

/// What the model is now: each number with its interval.
struct IdentifiedModel {
  ModelDocument model;
  std::vector<FoundEffect> effects;
  std::vector<ParameterEstimate> calibrated;  ///< of terms that were already on
  std::vector<UnnamedFinding> unnamed{};      ///< terms without a name that were added
  /// Terms without a name that the model had, whose values are other ones now, beyond chance.
  std::vector<std::string> moved_terms{};
  std::vector<std::string> not_excited;  ///< effects that this drive could not have shown
};

/// Everything that `tread-gap find` says: what each stage returned, and the verdict.
struct GapFinding {
  GapVerdict verdict = GapVerdict::kCannotTell;
  std::string reason;  ///< of CANNOT_TELL; empty else
  FindingSource source;
  ModelDocument before;  ///< with the rest that was known; none where it was calibrated
  IdentifiedModel identified;
  SearchRecord search;
  Adequacy adequacy;
  std::optional<Gap> gap;
  ResidualAtlas atlas;
  ShownExecutions shown;
};

}  // namespace tread::gap
