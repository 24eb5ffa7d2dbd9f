// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "common/vehicle/model_document.hpp"
#include "modules/identification/core/drive.hpp"

namespace tread::gap {

/// Reads a log for a model; throws std::runtime_error with one line if it cannot be read, or is of
/// another robot: its commands are of another kind than the model's, or for another gauge.
Drive readDriveFor(const ModelDocument& model, const std::string& path);

/// The same, and throws if the log is not sound or nothing was driven in it.
Drive readSoundDriveFor(const ModelDocument& model, const std::string& path);

}  // namespace tread::gap
