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

/// Commands one after the other, and what was commanded long before them.
struct Manoeuvre {
  std::string name;
  TrackCommand before;                 ///< held until the motion is steady
  std::vector<TrackCommand> commands;  ///< each held for kManoeuvrePeriod
};

inline constexpr double kManoeuvrePeriod = 0.05;  ///< [s]

/// What else is the case while it drives.
struct Circumstances {
  double session_time = 0.0;  ///< [s] since the session began
  double battery_drop = 0.0;  ///< [1] relative fall of the voltage
  double roll = 0.0;          ///< [rad]
  double pitch = 0.0;         ///< [rad]
  double worked = 0.0;        ///< [1] mean square of the drive's duty until now, for its heat
};

/// The largest command that a model is asked for: power 1, or a track speed: a quarter more than
/// its envelope's, so that limits at its end are met, or 1 m/s.
double fullCommand(const ModelDocument& model);

/// What is driven to see a model: straights, arcs and turns of two seconds, both ways, at speed and
/// from standing.
std::vector<Manoeuvre> standardManoeuvres(double full_command);

/// Poses and yaw rates as the INS says them, from the begin of the manoeuvre to its end, one per
/// command and one before; poses relative to the first, times from 0 on.
std::vector<MotionSample> drivenByModel(const ModelDocument& model, const Manoeuvre& manoeuvre,
                                        const Circumstances& circumstances = {},
                                        const ExecutionNoise& noise = {});

/// What a plan chooses from: two seconds of straights, arcs and turns, each from standing to
/// standing, so that any may follow any; commands up to `full`.
std::vector<Manoeuvre> planManoeuvres(const ModelDocument& model, double full);

/// Scales down what would take a model's vehicle out of an envelope, less a hundredth for rounding.
void keepWithin(const Envelope& envelope, const VehicleModel& vehicle,
                std::vector<Manoeuvre>& manoeuvres);

/// The patterns of a set, each entered in its class. Throws std::runtime_error if its commands are
/// not the model's or its period is not kManoeuvrePeriod.
std::vector<Manoeuvre> manoeuvresOf(const PatternSet& set, const ModelDocument& model);

/// The chosen manoeuvres as a pattern set that `tread-patterns record` drives, each of its patterns
/// once: a manoeuvre that is wanted twice is there twice.
/** From a set, patterns keep their classes; those that lead there from standing and back go along.
 * Predictions are the model's. Throws std::runtime_error with one line if that is no set. */
PatternSet planSet(const ModelDocument& model, const std::vector<Manoeuvre>& manoeuvres,
                   const std::vector<size_t>& counts);
PatternSet planSet(const PatternSet& from, const std::vector<size_t>& counts);

/// What shall be otherwise in a model.
struct ModelChange {
  std::vector<std::string> remove;  ///< effects
  std::vector<std::string> add;     ///< effects; at their typical size unless set
  /// parameter=value: effect.parameter, a parameter of the last effect added, or a number of the
  /// nominal model; limits by their natural names, too.
  std::vector<std::string> set;
};

/// Turns an effect off.
void turnOff(ModelDocument& model, const Effect& effect);

/// Gives an effect's first strength its typical value, and its shapes theirs.
void turnOn(ModelDocument& model, const Effect& effect);

/// The model after the change; throws std::runtime_error with one line for what is not possible:
/// unknown names, values beyond what is plausible, removing what is off, adding what is on.
ModelDocument changed(const ModelDocument& model, const ModelChange& change);

/// One manoeuvre driven by two models, as the INS would say it.
struct ManoeuvreComparison {
  std::string name;
  std::vector<Pose2> first;  ///< relative to the begin
  std::vector<Pose2> second;
  double position = 0.0;  ///< [m] between the two ends
  double yaw = 0.0;       ///< [rad] second less first, at the end
};

/// The largest command of manoeuvres that show two models: see fullCommand().
double fullCommand(const ModelDocument& first, const ModelDocument& second);

/// In what the answer holds: model, commands, log if there is one, and which of the two is before.
std::string settingOf(const ModelDocument& first, const ModelDocument& second,
                      const std::string& model_file, const std::string& log_file);

/// All standard manoeuvres with both models.
std::vector<ManoeuvreComparison> compareModels(const ModelDocument& first,
                                               const ModelDocument& second,
                                               const Circumstances& circumstances);

/// What two models err on the executions of a log.
struct LogComparison {
  EndErrors first;
  EndErrors second;
  std::vector<Overlay> overlays;  ///< where they differ most, in order of that
};

/// Simulates a log's driving with both models.
LogComparison compareOnLog(const Drive& drive, const ModelDocument& first,
                           const ModelDocument& second);

/// The answer as a table in text, as a page, and its pictures in one SVG.
std::string textOf(const std::vector<ManoeuvreComparison>& comparisons);
std::string textOf(const LogComparison& comparison);
report::Page pageOf(const std::string& question, const std::string& setting,
                    const std::vector<ManoeuvreComparison>& comparisons,
                    const std::vector<LogComparison>& on_log);
std::string svgOf(const std::vector<ManoeuvreComparison>& comparisons,
                  const std::vector<LogComparison>& on_log);

/// How exactly a drive is measured.
struct InsNoise {
  double fix = 0.01;       ///< [m] of a position
  double heading = 0.003;  ///< [rad]
  double gyro = 0.01;      ///< [rad/s] of its mean over half a second
};

/// What a design is asked: whether one effect or the other is there.
struct DesignTask {
  ModelDocument model;
  std::string first;   ///< effect: at its size in the model, else at its typical one
  std::string second;  ///< the same; which one is first makes no difference
  std::vector<Manoeuvre> manoeuvres;
  InsNoise noise;
  double enough = 6.0;     ///< [nats] expected difference of the log likelihoods
  double longest = 120.0;  ///< [s] of driving
};

/// What is expected if one of the two effects is there and the other one is refitted.
struct DesignSide {
  std::string truth;  ///< the effect that is there
  std::string rival;  ///< the one that is refitted
  ModelDocument true_model;
  ModelDocument rival_model;  ///< that looks most like it on the manoeuvres chosen
  double difference = 0.0;    ///< [nats] that remains, however the rival is refitted
  double visible = 0.0;       ///< [nats] of the truth against its absence, all manoeuvres once
};

/// A drive that tells two effects apart, or the reason why there is none.
struct Design {
  std::vector<size_t> counts;     ///< how often to drive each manoeuvre
  double duration = 0.0;          ///< [s]
  std::vector<DesignSide> sides;  ///< first or second true, in the order of the names
  bool separates = false;         ///< whichever of the two is true

  /// The side on which the two are harder to tell apart.
  const DesignSide& harder() const;
};

/// Chooses the shortest drive on which the two differ enough, whichever of them is true.
/** T-optimal: in turn the rival (with what is calibrated free within its uncertainty) is fitted to
 * what the truth would do on the manoeuvres chosen so far, and the manoeuvre is added on which the
 * harder side's rival is worst per second; then whatever can be left out is. Half an hour into a
 * session, on level ground. Deterministic. */
Design designDrive(const DesignTask& task);

/// What one log says of the parameters that are compared.
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

  /// Difference in standard errors; 0 where one log does not say.
  double sigmas() const;
};

/// What changed from one log to another.
struct LogChange {
  std::vector<Movement> movements;
  int first_blocks = 0;
  int second_blocks = 0;
  double needed = 0.0;    ///< [standard errors] from which a movement is no chance
  EndErrors with_first;   ///< of the second log with what was fitted on the first
  EndErrors with_second;  ///< and with its own

  bool moved(const Movement& movement) const;
  bool anyMoved() const;
};

/// Level at which something is said to have moved, for all parameters together [standard
/// deviations of a normal number]: 0.3 %. As blocks of ground resemble their neighbours, up to 1 %
/// of pairs of equal logs are said to differ.
inline constexpr double kSigmaLevel = 3.0;

/// Fits the terms that a model has on, and the numbers that it is unsure of, on a log.
/** Of a model without either, lag, delay and gains are fitted. Throws std::runtime_error with one
 * line if the log has too little driving. */
LogFit fitLog(const ModelDocument& model, const Drive& drive,
              const ParallelFor& parallel = serialFor);

/// Standard errors that a difference needs: errors of few blocks are themselves uncertain
/// (Student), and of many parameters one is soon far off (Bonferroni).
double neededSigmas(int fewest_blocks, size_t parameters);

/// What moved between two fits of one model.
LogChange changeBetween(const LogFit& first, const LogFit& second);

/// Both fits, what moved, and what the second log says of the first one's parameters.
LogChange compareLogs(const ModelDocument& model, const Drive& first, const Drive& second,
                      const ParallelFor& parallel = serialFor);

/// The answer in words and as a table.
std::string textOf(const LogChange& change);

/// One parameter of the model of all logs together, fitted on each of them.
struct RepeatedParameter {
  std::string parameter;  ///< path as in findParameter()
  std::string unit;
  double common = kNotMeasured;  ///< mean of the logs that see it, with the weights of the errors
  std::vector<double> values;    ///< by log
  std::vector<double> errors;    ///< standard errors over blocks of driving
  std::vector<bool> seen;        ///< by log: its error is below the parameter or what is typical
  double farthest = 0.0;         ///< [standard errors] between two logs that see it, at most
  bool differs = false;          ///< beyond chance: it is the day's
};

/// What several logs of one vehicle say, each alone and all together.
struct Repetition {
  std::vector<std::string> logs;
  std::vector<GapFinding> alone;
  GapFinding together;
  std::vector<RepeatedParameter> parameters;  ///< none if all together cannot tell
  double needed = 0.0;                        ///< [standard errors] that no chance explains

  bool differs() const;
  /// Effects that are named in any log or in all together.
  std::vector<std::string> names() const;
  size_t logsThatName(const std::string& effect) const;
  /// The model of all together with what is that day's: ground, battery, INS.
  ModelDocument modelOf(size_t log) const;
};

/// Looks for the same in each of the task's training logs, in all together, and at the sizes of
/// what all together show.
/** Throws std::invalid_argument for fewer than two logs, and for one with too little driving. */
Repetition repeatLogs(const GapTask& task, const Progress& say);

/// The answer as two tables.
std::string textOf(const Repetition& repetition);

}  // namespace tread::gap
