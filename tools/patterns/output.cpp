// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/patterns/output.hpp"

#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "tools/recordings/text_file.hpp"

namespace tread::patterns {

void refuseToReplace(const std::string& output, const std::vector<std::string>& inputs) {
  for (const std::string& input : inputs) {
    std::error_code failure;
    if (std::filesystem::equivalent(output, input, failure))
      throw std::runtime_error(output + ": this is the input " + input +
                               "; give another file to write");
  }
}

void writeOutput(const std::string& path, const std::string& text,
                 const std::vector<std::string>& inputs) {
  refuseToReplace(path, inputs);
  recordings::writeText(path, text);
}

}  // namespace tread::patterns
