// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "common/pattern/pattern_file.hpp"
#include "tests/tools/called_program.hpp"

namespace tread::patterns::kit {

using Run = tread::samples::CalledProgram;
using Folder = tread::samples::OwnFolder;

/// Runs tread-patterns with a command line.
inline Run run(const std::string& arguments) {
  return tread::samples::called("tread-patterns " + arguments);
}

inline const std::string kConfigFolder = std::string(TREAD_SOURCE_DIR) + "/config/";
inline const std::string kSet = kConfigFolder + "patterns/teodor.yaml";
inline const std::string kGrass = kConfigFolder + "models/teodor_grass.yaml";

inline const PatternSet& shipped() {
  static const PatternSet set = readPatternFile(kSet);
  return set;
}

}  // namespace tread::patterns::kit
