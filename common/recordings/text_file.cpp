// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/recordings/text_file.hpp"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <system_error>

namespace tread::recordings {
namespace {

namespace fs = std::filesystem;

bool writePlainly(const fs::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file << text;
  file.close();
  return static_cast<bool>(file);
}

/// Where a link leads, so that the link itself stays.
fs::path targetOf(const std::string& path) {
  std::error_code failure;
  const fs::path target = fs::weakly_canonical(path, failure);
  return failure ? fs::path(path) : target;
}

[[noreturn]] void refuse(const std::string& path) {
  throw std::runtime_error(path + ": cannot be written; check folder and rights");
}

}  // namespace

std::string readText(const std::string& path) {
  std::error_code failure;
  std::ifstream file(path, std::ios::binary);
  if (!file || fs::is_directory(path, failure))
    throw std::runtime_error(path + ": cannot be read; check name and rights");
  return {std::istreambuf_iterator<char>(file), {}};
}

void writeText(const std::string& path, const std::string& text) {
  std::error_code failure;
  bool written = false;
  if (fs::exists(path, failure) && !fs::is_regular_file(path, failure)) {
    written = !fs::is_directory(path, failure) && writePlainly(path, text);
  } else {
    const fs::path target = targetOf(path);
    const fs::path fresh = target.parent_path() / ("." + target.filename().string() + "." +
                                                   std::to_string(::getpid()) + ".tmp");
    written = writePlainly(fresh, text);
    failure.clear();
    if (written) fs::rename(fresh, target, failure);
    written = written && !failure;
    if (!written) fs::remove(fresh, failure);
  }
  if (!written) refuse(path);
}

void requireWritable(const std::string& path) {
  std::error_code failure;
  const fs::path target = targetOf(path);
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  const bool there = fs::exists(path, failure);
  const bool may =
      there ? ::access(path.c_str(), W_OK) == 0
            : fs::is_directory(folder, failure) && ::access(folder.c_str(), W_OK | X_OK) == 0;
  if (!may || fs::is_directory(path, failure)) refuse(path);
}

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
    requireWritable(output);
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
  writeText(path, text);
}

}  // namespace tread::recordings
