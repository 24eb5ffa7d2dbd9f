// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

namespace tread::patterns {

/// Throws std::runtime_error if an output would replace one of the inputs, by whatever name.
void refuseToReplace(const std::string& output, const std::vector<std::string>& inputs);

/// Before the work: throws with one line if an output, of which empty ones are none, would replace
/// an input or another output, or cannot be written.
void checkOutputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs);

/// Writes a file whole or not at all, over what is there, but never over one of the inputs; throws
/// std::runtime_error with one line.
void writeOutput(const std::string& path, const std::string& text,
                 const std::vector<std::string>& inputs);

}  // namespace tread::patterns
