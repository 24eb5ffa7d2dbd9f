// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/lab/gap/report/report.hpp"

namespace tread::gap {

/// A person's decisions on effects before a search.
struct DecisionWords {
  std::vector<std::string> accepted;
  std::vector<std::string> rejected;
  std::string by;
};

/// Throws std::runtime_error, beginning with the request, if vehicles of a layout cannot have an
/// effect.
void requireOf(const std::string& request, const std::string& effect, VehicleLayout layout);

/// Decisions on effects of the catalogue, accepted ones first.
/** Throws std::runtime_error with one clear line if an effect is unknown, is accepted and rejected,
 * or is named twice, if a rejected one is in the model, or if a person is named without decisions.
 */
std::vector<EffectDecision> decisionsOf(const DecisionWords& words, const ModelDocument& model);

/// Content of verdict.json; numbers that are not finite become null.
/** Keys: verdict, reason, cut_short, effects [{name, kind, parameters {name: {value, unit, low,
 * high}}, group, runner_up}], calibrated, gap {horizon_s, before, after, floor: {position_m,
 * yaw_rad: {median, rms}}}, unnamed [{name, channel, condition, times, at, values, deviations,
 * gain, gain_error}], moved_terms [name], unexplained [{channel, variable}], not_excited, seed,
 * inputs {model, train, test}. A limit that is stored as its reciprocal appears as inverse_limit
 * and under its natural name. */
nlohmann::ordered_json verdictJson(const GapFinding& finding, const std::vector<InputFile>& inputs);

/// The new model with its provenance: tool, seed, logs, and the number of runs on them.
/** A run increments the model's count if the model names one of the same logs. Only training logs
 * are named, since test logs do not influence the model. Decisions of people are kept on record,
 * but are not applied again. */
ModelDocument newModel(const GapFinding& finding, const std::vector<InputFile>& inputs);

/// Whether a finding has a new model: a drive that does not decide gives none.
bool hasNewModel(const GapFinding& finding);

/// Writes model.yaml (if there is a new model), report.md, report.html and, last, verdict.json into
/// an existing folder.
/** Throws std::runtime_error with one clear line. */
void writeFinding(const std::string& folder, const GapFinding& finding,
                  const std::vector<InputFile>& inputs);

}  // namespace tread::gap
