// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tests/study/score/study.hpp"

namespace tread::blindtest {

/// Twelve separate cases that must be correct in every test run.
std::vector<HiddenCase> quickSuite(double minutes, uint64_t seed);

/// 400 logs of the plain vehicle, half with each noise, each with a model of wrong numbers.
std::vector<HiddenCase> wrongStartSuite(double minutes, uint64_t seed);

/// Start model of the calibration: a vehicle of the generator's size, all effects off.
extern const char* const kBaseModel;

/// A log of a real drive, and the start model for its calibration.
struct Recording {
  std::string nominal;  ///< name of its nominal model: recording-NAME
  std::string log;      ///< FOLDER/NAME.lcmlog, absolute
  std::string model;    ///< FOLDER/NAME.yaml, absolute
};

/// The recordings of a folder, sorted: each NAME.lcmlog that has a NAME.yaml.
std::vector<Recording> recordingsIn(const std::string& folder);

/// The recording with this nominal model; nullopt for that of a noise level.
std::optional<Recording> recordingNamed(const Study& study, const std::string& nominal);

/// Effects hidden in the study's recordings by exact transformations.
/** Small: none; medium: each effect once in each recording; full: in two sizes. A line reports if
 * there are no recordings, or an unusable one is left out. */
std::vector<HiddenCase> recordingSuite(const Study& study);

}  // namespace tread::blindtest
