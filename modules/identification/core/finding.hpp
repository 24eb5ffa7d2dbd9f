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

/// The overall result; see exitStatus().
enum class GapVerdict {
  kNoDiscrepancy = 0,
  kNothingNew = 1,  ///< only the model's known rest is present
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

/// The exit status of `tread-gap find`: 0 if nothing needs to be done.
inline int exitStatus(GapVerdict verdict) {
  return verdict == GapVerdict::kNothingNew ? 0 : static_cast<int>(verdict);
}

/// An estimated parameter.
struct ParameterEstimate {
  std::string parameter;  ///< path for findParameter(): effect.parameter or a nominal number
  std::string unit;
  double value = 0.0;
  /// Of the 95 % interval, over blocks and, for found effects without test drives, over halves of
  /// the driving; includes the possible error of the equation.
  double low = 0.0;
  double high = 0.0;  ///< infinite bounds if the drive does not determine it
  double before = 0.0;
  /// For a term of the model: its value has changed, beyond chance and the model's own covariance.
  bool moved = false;
};

/// An alternative effect that explains the data as well or nearly so.
struct RunnerUp {
  std::string effect;
  double behind = 0.0;  ///< [nats] cross-validated log likelihood behind the winner
  double error = 0.0;   ///< [nats] standard error of that difference; twice it in a brief drive
};

/// A quantity that is measured beside the INS and predicted by the model of the drive.
enum class EvidenceSource { kWheels, kCurrents, kVoltage };

/// How strongly such a quantity shows an effect, with its 95 % interval.
/** Wheels: share of the effect in their speeds, 1 = all. Voltage: the same for an intermittent
 * effect in the battery's voltage. Currents: percentage by which they rise per percent of speed
 * that the effect takes, relative to the currents at the reduced speed, 0 = not at all: a load
 * reduces the speed by drawing current, more than in proportion, as otherwise it would stop the
 * motor; a weak drive draws the current of the lower speed, and so do slipping tracks. Values in
 * between suggest currents that were computed from the command. */
struct MeasuredEvidence {
  EvidenceSource source = EvidenceSource::kWheels;
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;
  bool of_lags = false;  ///< for all lags of the vehicle together

  /// The effect is in the drive (wheels), a load (currents), of the battery (voltage).
  bool confirms() const { return low > (source == EvidenceSource::kCurrents ? 1.5 : 0.5); }
  /// It certainly is not.
  bool refutes() const { return high < 0.5; }
};

/// An effect that was found.
struct FoundEffect {
  std::string name;
  std::vector<ParameterEstimate> parameters;
  std::vector<std::string> group;  ///< members from which it is indistinguishable (without itself)
  std::vector<RunnerUp> runner_ups;
  double score = 0.0;    ///< T of the score test in the presence of all others
  double p_value = 1.0;  ///< of the largest T over the whole catalogue
  double gain = 0.0;     ///< [nats] on blocks that were not fitted
  double gain_error = 0.0;
  bool accepted = false;  ///< accepted by a person: it stays whatever the numbers above are
  std::vector<MeasuredEvidence>
      evidence{};  ///< other evidence in the log, at most one of each source

  /// nullptr if the log has none of this source.
  const MeasuredEvidence* evidenceBy(EvidenceSource source) const {
    for (const MeasuredEvidence& one : evidence)
      if (one.source == source) return &one;
    return nullptr;
  }
};

/// p-value from which the drive itself does not confirm an accepted effect.
inline constexpr double kShownBelow = 0.05;

/// Whether tests confirm an effect, and not a person alone.
inline bool isShown(const FoundEffect& effect) {
  return !effect.accepted || effect.p_value <= kShownBelow;
}

/// Median and root mean square over executions.
struct ErrorFigure {
  double median = 0.0;
  double rms = 0.0;
};

/// Errors at the horizon, from the start of an execution.
struct EndErrors {
  ErrorFigure position;  ///< [m]
  ErrorFigure yaw;       ///< [rad]
  size_t executions = 0;
};

/// Standard errors of the difference between two models' medians over the same executions.
struct MedianChance {
  double position = 0.0;  ///< [m]
  double yaw = 0.0;       ///< [rad]
};

/// One execution predicted by two models, for pictures; poses relative to its beginning.
struct Overlay {
  size_t drive = 0;
  double begin = 0.0;           ///< [s]
  double duration = 2.0;        ///< [s]
  std::vector<Pose2> measured;  ///< at equally spaced times over the horizon
  std::vector<Pose2> before;
  std::vector<Pose2> after;
  double error_before = 0.0;  ///< [m] at the end
  double error_after = 0.0;   ///< [m]
  /// Radius about each point of `after` that contains nine of ten executions [m]; may be empty.
  std::vector<double> band;
};

/// Errors of two models at the end of an execution, and its place.
struct PlaceError {
  size_t drive = 0;
  double x = 0.0;  ///< [m] halfway, in the frame of the log
  double y = 0.0;
  double before = 0.0;  ///< [m]
  double after = 0.0;   ///< [m]
};

/// Difference between simulation and measurement after 2 s, on executions not used for the fit.
struct Gap {
  double horizon = 2.0;  ///< [s]
  EndErrors before;
  EndErrors after;
  EndErrors apart;                 ///< difference between the two models
  std::optional<EndErrors> floor;  ///< dead reckoning with encoders and gyro, if they exist
  bool structure_nested = true;    ///< the choice of effects did not use these executions either
  MedianChance by_chance{};        ///< of the change of the medians from before to after
  double way = 0.0;                ///< [m] from beginning to end of an execution, median
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

/// An unnamed term that was added to the model; the model has its numbers under this name.
struct UnnamedFinding {
  std::string name;
  double gain = 0.0;  ///< [nats] on blocks that were not fitted
  double gain_error = 0.0;
  std::vector<double> deviations{};  ///< of its values, in their units
  /// Data behind the term, for a picture: residuals of the model without the term, divided by its
  /// factor, over its condition.
  std::vector<AtlasCell> data{};
};

/// Residuals of one channel over one variable.
struct AtlasCurve {
  std::string channel;   ///< along, lateral, yaw rate
  std::string unit;      ///< of the residual: m/s or rad/s
  std::string variable;  ///< speed, yaw rate, speed x yaw rate, ...
  std::string variable_unit;
  std::vector<AtlasCell> before;
  std::vector<AtlasCell> after;
  bool unexplained = false;  ///< the new model's residuals depend on it significantly
};

/// Mean residual of one channel over speed and yaw rate, for a picture.
struct AtlasMap {
  std::string channel;
  std::string unit;                 ///< of the residual
  std::vector<double> v_edges;      ///< [m/s] ascending
  std::vector<double> omega_edges;  ///< [rad/s] ascending
  /// One value per cell, rows of equal omega; NaN = never driven.
  std::vector<double> before;
  std::vector<double> after;
};

/// A remaining dependence of the residuals.
struct Unexplained {
  std::string channel;
  std::string variable;
  double score = 0.0;
  double p_value = 1.0;
  /// The effect that it resembles most, without being attributed to it; may be empty
  std::string like{};
};

/// One candidate of the first test.
struct CandidateTest {
  std::string effect;
  std::string parameter;
  double score = 0.0;
  double p_value = 1.0;     ///< family-wise
  double uniqueness = 1.0;  ///< share of its signature that the active terms cannot imitate
  /// Smallest size that would be found with 80 % power, in the parameter's unit (of a limit, the
  /// weakest one tried); infinite = not excited.
  double detectable = 0.0;
};

/// One step of the search: an effect that was added or removed, and the gain.
struct SearchStep {
  std::string effect;  ///< added, or removed
  bool removed = false;
  double score = 0.0;
  double p_value = 1.0;
  double gain = 0.0;  ///< [nats] cross-validated
  double gain_error = 0.0;
  std::vector<RunnerUp> runner_ups;
  std::string remark;  ///< why it was removed or refused; otherwise empty
};

/// The course of a search, beside the effects that are in the model now.
struct SearchRecord {
  std::vector<SearchStep> steps;
  /// For the calibrated model, each effect's best direction
  std::vector<CandidateTest> candidates;
  std::vector<std::string> negligible;  ///< real but below 1 % of the end error: not added
  std::vector<std::string> at_bound;  ///< detected, but their sizes ran to the ends of their ranges
  bool cut_short = false;             ///< it ran out of time: these are the best terms so far
};

/// Remaining dependences of a model's residuals.
struct Adequacy {
  double p_value = 1.0;                  ///< of the largest dependence over all
  std::vector<Unexplained> unexplained;  ///< those below the requested level, strongest first
};

/// Residuals of the old and the new model.
struct ResidualAtlas {
  std::vector<AtlasCurve> curves;  ///< the unexplained ones first, strongest first
  std::vector<AtlasMap> maps;      ///< may be empty
};

/// Executions for pictures, from driving that was not used for the fit.
struct ShownExecutions {
  std::vector<Overlay> overlays;   ///< six typical, then the three worst
  std::vector<PlaceError> places;  ///< of all
};

/// Inputs of a finding.
struct FindingSource {
  uint64_t seed = 0;
  std::vector<LogNote> log_notes;
  std::vector<EffectDecision> decisions;  ///< of persons, in the given order
  size_t blocks = 0;                      ///< of measured driving
  double block_length = 0.0;              ///< [s]
  /// Less driving than usual: judges the effects that it excites; whether anything else remains was
  /// not tested.
  bool brief = false;
};

/// The new model: each number with its interval.
struct IdentifiedModel {
  ModelDocument model;
  std::vector<FoundEffect> effects;
  std::vector<ParameterEstimate> calibrated;  ///< of terms that were already on
  std::vector<UnnamedFinding> unnamed{};      ///< terms without a name that were added
  /// Unnamed terms of the model whose values have changed significantly.
  std::vector<std::string> moved_terms{};
  std::vector<std::string> not_excited;  ///< effects that this drive could not have shown
};

/// The complete result of `tread-gap find`: the output of each stage, and the verdict.
struct GapFinding {
  GapVerdict verdict = GapVerdict::kCannotTell;
  std::string reason;  ///< of CANNOT_TELL; otherwise empty
  FindingSource source;
  ModelDocument before;  ///< including its known rest; without one if it was calibrated
  IdentifiedModel identified;
  SearchRecord search;
  Adequacy adequacy;
  std::optional<Gap> gap;
  ResidualAtlas atlas;
  ShownExecutions shown;
};

}  // namespace tread::gap
