// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/pattern/pattern.hpp"
#include "common/report/page.hpp"
#include "common/soundness/core/drive.hpp"
#include "common/vehicle/kernel.hpp"
#include "common/vehicle/model_document.hpp"
#include "modules/identification/core/discovery.hpp"
#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/fit.hpp"

namespace tread::gap {

/// A sequence of commands, and the command before it.
struct Manoeuvre {
  std::string name;
  TrackCommand before;                 ///< held until the motion is steady
  std::vector<TrackCommand> commands;  ///< each held for kManoeuvrePeriod
};

inline constexpr double kManoeuvrePeriod = 0.05;  ///< [s]

/// Circumstances of a drive.
struct Circumstances {
  double session_time = 0.0;  ///< [s] since the session began
  double battery_drop = 0.0;  ///< [1] relative fall of the voltage
  double roll = 0.0;          ///< [rad]
  double pitch = 0.0;         ///< [rad]
  double worked = 0.0;        ///< [1] mean square of the duty so far, which heats the drive
};

/// Largest command for a model: power 1, or a track speed of 1.25 times its envelope, to reach
/// limits at its end; 1 m/s without an envelope.
double fullCommand(const ModelDocument& model);

/// Manoeuvres that show a model: straights, arcs and turns of 2 s in both directions, at speed and
/// from standstill.
std::vector<Manoeuvre> standardManoeuvres(double full_command);

/// Simulates a manoeuvre as measured by the INS: poses relative to the first, and yaw rates, one
/// per command and one before; times from 0 on.
std::vector<MotionSample> drivenByModel(const ModelDocument& model, const Manoeuvre& manoeuvre,
                                        const Circumstances& circumstances = {},
                                        const ExecutionNoise& noise = {});

/// Candidates for a plan: straights, arcs and turns of 2 s with commands up to `full`, from
/// standstill to standstill, so that any order is possible.
std::vector<Manoeuvre> planManoeuvres(const ModelDocument& model, double full);

/// Scales commands down so that the vehicle stays in the envelope, with 1 % margin for rounding.
void keepWithin(const Envelope& envelope, const VehicleModel& vehicle,
                std::vector<Manoeuvre>& manoeuvres);

/// The patterns of a set, each entered in the motion of its class. Throws std::runtime_error if its
/// commands are not the model's or its period is not kManoeuvrePeriod.
std::vector<Manoeuvre> manoeuvresOf(const PatternSet& set, const ModelDocument& model);

/// Converts the chosen manoeuvres to a pattern set for `tread-patterns record`, which drives each
/// pattern once; a repeated manoeuvre appears repeatedly.
/** Patterns from a set keep their classes, and the patterns that connect those with standstill are
 * added. Predictions are the model's. Throws std::runtime_error with one line if the result is no
 * valid set. */
PatternSet planSet(const ModelDocument& model, const std::vector<Manoeuvre>& manoeuvres,
                   const std::vector<size_t>& counts);
PatternSet planSet(const PatternSet& from, const std::vector<size_t>& counts);

/// Changes to a model.
struct ModelChange {
  std::vector<std::string> remove;  ///< effects
  std::vector<std::string> add;     ///< effects, at their typical size unless set
  /// parameter=value: effect.parameter, a parameter of the last added effect, or a number of the
  /// nominal model; also limits by their natural names.
  std::vector<std::string> set;
};

/// Turns an effect off.
void turnOff(ModelDocument& model, const Effect& effect);

/// Sets an effect's first strength and its shapes to typical values.
void turnOn(ModelDocument& model, const Effect& effect);

/// The model after the change; throws std::runtime_error with one line for unknown names,
/// implausible values, removing an effect that is off or adding one that is on.
ModelDocument changed(const ModelDocument& model, const ModelChange& change);

/// One manoeuvre simulated with two models, as measured by the INS.
struct ManoeuvreComparison {
  std::string name;
  std::vector<Pose2> first;  ///< relative to the start
  std::vector<Pose2> second;
  double position = 0.0;  ///< [m] between the two ends
  double yaw = 0.0;       ///< [rad] second minus first, at the end
};

/// Largest command for showing two models: see fullCommand().
double fullCommand(const ModelDocument& first, const ModelDocument& second);

/// Validity of the answer: model, commands, log if there is one, and which of the two comes first.
std::string settingOf(const ModelDocument& first, const ModelDocument& second,
                      const std::string& model_file, const std::string& log_file);

/// Simulates all standard manoeuvres with both models.
std::vector<ManoeuvreComparison> compareModels(const ModelDocument& first,
                                               const ModelDocument& second,
                                               const Circumstances& circumstances);

/// Errors of two models on the executions of a log.
struct LogComparison {
  EndErrors first;
  EndErrors second;
  std::vector<Overlay> overlays;  ///< the largest differences, in that order
};

/// Simulates the drive of a log with both models.
LogComparison compareOnLog(const Drive& drive, const ModelDocument& first,
                           const ModelDocument& second);

/// The answer as a text table, as a page, and its pictures in one SVG.
std::string textOf(const std::vector<ManoeuvreComparison>& comparisons);
std::string textOf(const LogComparison& comparison);
report::Page pageOf(const std::string& question, const std::string& setting,
                    const std::vector<ManoeuvreComparison>& comparisons,
                    const std::vector<LogComparison>& on_log);
std::string svgOf(const std::vector<ManoeuvreComparison>& comparisons,
                  const std::vector<LogComparison>& on_log);

/// Measurement noise of a drive.
struct InsNoise {
  double fix = 0.01;       ///< [m] of a position
  double heading = 0.003;  ///< [rad]
  double gyro = 0.01;      ///< [rad/s] of its mean over half a second
};

/// The question for a design: which of two effects is present.
struct DesignTask {
  ModelDocument model;
  std::string first;   ///< effect: at its size in the model, else at its typical size
  std::string second;  ///< the same; the order of the two does not matter
  std::vector<Manoeuvre> manoeuvres;
  InsNoise noise;
  double enough = 6.0;     ///< [nats] expected difference of the log likelihoods
  double longest = 120.0;  ///< [s] of driving
};

/// Result for one effect being present while the other is refitted.
struct DesignSide {
  std::string truth;  ///< the present effect
  std::string rival;  ///< the refitted effect
  ModelDocument true_model;
  ModelDocument rival_model;  ///< the best imitation on the chosen manoeuvres
  double difference = 0.0;    ///< [nats] remaining difference of the best imitation
  double visible = 0.0;       ///< [nats] of the truth against its absence, on all manoeuvres once
};

/// A drive that separates two effects, or the reason why there is none.
struct Design {
  std::vector<size_t> counts;     ///< repetitions of each manoeuvre
  double duration = 0.0;          ///< [s]
  std::vector<DesignSide> sides;  ///< first or second effect present, in the order of the names
  bool separates = false;         ///< whichever of the two is present

  /// The side with the smaller difference.
  const DesignSide& harder() const;
};

/// Chooses the shortest drive on which the two differ enough, whichever of them is present.
/** T-optimal design, iterated: fit the rival (calibrated parameters free within their uncertainty)
 * to the truth on the manoeuvres chosen so far, then add the manoeuvre with the harder side's
 * largest difference per second. At the end remove superfluous manoeuvres. Half an hour into a
 * session, on level ground. Deterministic. */
Design designDrive(const DesignTask& task);

/// Estimates from one log of the compared parameters.
struct LogFit {
  ModelDocument model;  ///< fitted
  std::vector<std::string> parameters;
  std::vector<double> values;
  std::vector<double> errors;  ///< standard errors over blocks of driving
  int blocks = 0;              ///< of measured driving
};

/// One parameter, fitted on each of two logs.
struct Movement {
  std::string parameter;  ///< path as in findParameter()
  std::string unit;
  double first = 0.0;
  double first_error = 0.0;  ///< standard error over blocks of driving
  double second = 0.0;
  double second_error = 0.0;

  /// Difference in standard errors; 0 if one log does not determine the parameter.
  double sigmas() const;
};

/// Changes from one log to another.
struct LogChange {
  std::vector<Movement> movements;
  int first_blocks = 0;
  int second_blocks = 0;
  double needed = 0.0;    ///< [standard errors] of a significant change
  EndErrors with_first;   ///< of the second log with the first log's parameters
  EndErrors with_second;  ///< and with its own

  bool moved(const Movement& movement) const;
  bool anyMoved() const;
};

/// Significance level of a change over all parameters together [standard deviations of a normal
/// distribution]: 0.3 %. Neighbouring blocks of ground are similar, so up to 1 % of pairs of equal
/// logs are reported as different.
inline constexpr double kSigmaLevel = 3.0;

/// Fits the active terms of a model and its uncertain numbers to a log.
/** For a model without either it fits lag, delay and gains. Throws std::runtime_error with one line
 * if the log has too little driving. */
LogFit fitLog(const ModelDocument& model, const Drive& drive,
              const ParallelFor& parallel = serialFor);

/// Standard errors of a significant difference: corrected for few blocks (Student) and many
/// parameters (Bonferroni).
double neededSigmas(int fewest_blocks, size_t parameters);

/// Changes between two fits of one model.
LogChange changeBetween(const LogFit& first, const LogFit& second);

/// Both fits, the changes, and the second log's errors with the first log's parameters.
LogChange compareLogs(const ModelDocument& model, const Drive& first, const Drive& second,
                      const ParallelFor& parallel = serialFor);

/// The answer in words and as a table.
std::string textOf(const LogChange& change);

/// One parameter of the common model, fitted to each log.
struct RepeatedParameter {
  std::string parameter;  ///< path as in findParameter()
  std::string unit;
  double common = kNotMeasured;  ///< weighted mean of the logs that determine it
  std::vector<double> values;    ///< by log
  std::vector<double> errors;    ///< standard errors over blocks of driving
  std::vector<bool> seen;  ///< by log: its error is below the parameter's value or its typical size
  /// [standard errors] largest difference between two logs that determine it
  double farthest = 0.0;
  bool differs = false;  ///< significantly different between days
};

/// Results for several logs of one vehicle, each alone and all together.
struct Repetition {
  std::vector<std::string> logs;
  std::vector<GapFinding> alone;
  GapFinding together;
  std::vector<RepeatedParameter> parameters;  ///< empty if all together do not determine any
  double needed = 0.0;                        ///< [standard errors] of a significant difference

  bool differs() const;
  /// Effects named in any log or in all together.
  std::vector<std::string> names() const;
  size_t logsThatName(const std::string& effect) const;
  /// The common model with that day's values of ground, battery and INS.
  ModelDocument modelOf(size_t log) const;
};

/// Searches each of the task's training logs, and all together, and fits the common result's sizes
/// in each.
/** Throws std::invalid_argument for fewer than two logs, and for one with too little driving. */
Repetition repeatLogs(const GapTask& task, const Progress& say);

/// The answer as two tables.
std::string textOf(const Repetition& repetition);

}  // namespace tread::gap
