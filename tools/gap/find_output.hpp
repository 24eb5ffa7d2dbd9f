// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "modules/identification/core/finding.hpp"
#include "tools/gap/verdict_json.hpp"

namespace tread::gap {

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
