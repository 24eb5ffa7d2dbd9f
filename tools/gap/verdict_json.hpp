// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "modules/identification/core/finding.hpp"

namespace tread::gap {

/// A file that `tread-gap find` has read.
struct InputFile {
  enum class Role { kModel, kTrain, kTest };
  Role role = Role::kTrain;
  std::string name;    ///< without its folder
  std::string sha256;  ///< 64 hexadecimal digits
};

/// What verdict.json holds; numbers that are not finite are null.
/** Keys: verdict, reason, effects [{name, kind, parameters {name: {value, unit, low, high}}, group,
 * runner_up}], calibrated, gap {horizon_s, before, after, floor: {position_m, yaw_rad: {median,
 * rms}}}, unexplained [{channel, variable}], not_excited, seed, inputs {model, train, test}. A
 * limit that the model holds as its reciprocal stands there as inverse_limit and under its natural
 * name, too. */
nlohmann::ordered_json verdictJson(const Finding& finding, const std::vector<InputFile>& inputs);

}  // namespace tread::gap
