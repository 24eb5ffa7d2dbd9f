// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/report/page.hpp"
#include "common/vehicle/model_document.hpp"
#include "modules/identification/core/drive.hpp"
#include "modules/identification/core/finding.hpp"
#include "tools/gap/manoeuvres.hpp"

namespace tread::gap {

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

}  // namespace tread::gap
