// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tests/study/score/study.hpp"

namespace tread::blindtest {

/// Twelve cases that are hidden one by one: what must be right whenever the tests run.
std::vector<HiddenCase> quickSuite(double minutes, uint64_t seed);

/// 400 logs of the plain vehicle, half of each noise, each with a model whose numbers are wrong.
std::vector<HiddenCase> wrongStartSuite(double minutes, uint64_t seed);

/// The model that calibration begins with: a vehicle of the generator's size, all effects off.
extern const char* const kBaseModel;

/// A log of a real drive, and the model file that its calibration begins with.
struct Recording {
  std::string nominal;  ///< name of its nominal model: recording-NAME
  std::string log;      ///< FOLDER/NAME.lcmlog, absolute
  std::string model;    ///< FOLDER/NAME.yaml, absolute
};

/// The recordings of a folder, by name: each NAME.lcmlog that has a NAME.yaml beside it.
std::vector<Recording> recordingsIn(const std::string& folder);

/// The recording whose nominal model has this name; nothing for that of a noise level.
std::optional<Recording> recordingNamed(const Study& study, const std::string& nominal);

/// Effects hidden in the study's recordings by exact transformations.
/** Small: none; medium: each effect once in each recording; full: in two sizes. Where there is no
 * recording, or one of which nothing can be said, a line tells that it is left out. */
std::vector<HiddenCase> recordingSuite(const Study& study);

}  // namespace tread::blindtest
