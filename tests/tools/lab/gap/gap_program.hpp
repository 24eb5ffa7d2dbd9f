// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "tests/tools/called_program.hpp"

namespace tread::gap::samples {

using Run = tread::samples::CalledProgram;
using Folder = tread::samples::OwnFolder;

/// A program of the build, run by a command line.
inline Run runProgram(const std::string& program, const std::string& arguments) {
  return tread::samples::called(program + " " + arguments);
}

inline Run run(const std::string& arguments) {
  return runProgram("tread-gap", arguments);
}

inline const std::string kModels = std::string(TREAD_SOURCE_DIR) + "/config/models/";

}  // namespace tread::gap::samples
