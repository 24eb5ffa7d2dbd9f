// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tools/gap/report/report.hpp"

namespace tread::gap {

/// What a person says of effects before a search.
struct DecisionWords {
  std::vector<std::string> accepted;
  std::vector<std::string> rejected;
  std::string by;
};

/// Decisions on effects of the catalogue, accepted ones first.
/** Throws std::runtime_error with one clear line for a name that the catalogue does not know, for
 * an effect that is accepted and rejected or named twice, for a rejected one that the model has,
 * and for a person who decides nothing. */
std::vector<Decision> decisionsOf(const DecisionWords& words, const ModelDocument& model);

/// What verdict.json holds; numbers that are not finite are null.
/** Keys: verdict, reason, effects [{name, kind, parameters {name: {value, unit, low, high}}, group,
 * runner_up}], calibrated, gap {horizon_s, before, after, floor: {position_m, yaw_rad: {median,
 * rms}}}, unexplained [{channel, variable}], not_excited, seed, inputs {model, train, test}. A
 * limit that the model holds as its reciprocal stands there as inverse_limit and under its natural
 * name, too. */
nlohmann::ordered_json verdictJson(const Finding& finding, const std::vector<InputFile>& inputs);

/// The new model with where it comes from: tool, seed, logs, and how often it was worked on them.
/** A run counts on from the model's own count if it names one of the same logs. Only training logs
 * are named: nothing of the model comes from the others. What people decided stays on record from
 * model to model, but decides nothing by itself. */
ModelDocument newModel(const Finding& finding, const std::vector<InputFile>& inputs);

/// Whether a finding has a new model: a drive that cannot tell gives none.
bool hasNewModel(const Finding& finding);

/// Writes model.yaml (if there is a new model), report.md, report.html and, last, verdict.json into
/// a folder.
/** Each file is there whole or not at all; without a new model a model.yaml that is there stays as
 * it is. The folder is made if needed. Throws std::runtime_error with one clear line. */
void writeFinding(const std::string& folder, const Finding& finding,
                  const std::vector<InputFile>& inputs);

/// Tries whether files can be written into a folder that is there or could be made; leaves nothing
/// behind. Throws std::runtime_error with one line if not.
void tryFolder(const std::string& folder);

/// Makes a folder if needed; throws std::runtime_error if it cannot be made or written.
void makeFolder(const std::string& folder);

}  // namespace tread::gap
