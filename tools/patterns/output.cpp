// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/patterns/output.hpp"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "common/recordings/text_file.hpp"

namespace tread::patterns {

void refuseToReplace(const std::string& output, const std::vector<std::string>& inputs) {
  for (const std::string& input : inputs) {
    std::error_code failure;
    if (std::filesystem::equivalent(output, input, failure))
      throw std::runtime_error(output + ": this is the input " + input +
                               "; give another file to write");
  }
}

void checkOutputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs) {
  std::vector<std::filesystem::path> named;
  for (const std::string& output : outputs) {
    if (output.empty()) continue;
    refuseToReplace(output, inputs);
    recordings::requireWritable(output);
    std::error_code failure;
    const bool is_device = std::filesystem::exists(output, failure) &&
                           !std::filesystem::is_regular_file(output, failure);
    if (is_device) continue;
    const std::filesystem::path target =
        std::filesystem::weakly_canonical(std::filesystem::absolute(output), failure);
    if (!failure && std::find(named.begin(), named.end(), target) != named.end())
      throw std::runtime_error(output + ": two results cannot be written to one file");
    named.push_back(target);
  }
}

void writeOutput(const std::string& path, const std::string& text,
                 const std::vector<std::string>& inputs) {
  refuseToReplace(path, inputs);
  recordings::writeText(path, text);
}

}  // namespace tread::patterns
