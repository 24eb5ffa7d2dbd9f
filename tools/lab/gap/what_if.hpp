// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/lab/gap/questions.hpp"

namespace tread::gap {

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

}  // namespace tread::gap
