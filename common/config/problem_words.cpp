// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/config/problem_words.hpp"

#include <filesystem>
#include <new>
#include <stdexcept>
#include <system_error>

namespace tread {
namespace {

constexpr const char* kUnusable =
    "an input is damaged, incomplete or of another kind than expected; check the files and values "
    "of this call";

/// Names that libraries give their exceptions, and fragments of their messages that ours never
/// contain.
bool isForeign(const std::string& words) {
  for (const char* name :
       {"std::", "basic_", "vector::", "deque::", "map::", "array::", "_M_", "bad_",
        "bad optional access", "bad variant access", "yaml-cpp", "filesystem error",
        "json.exception", "iostream error", "boost::", "mrpt::", "CLI::"})
    if (words.find(name) != std::string::npos) return true;
  for (const char* name : {"stoi", "stol", "stoll", "stoul", "stoull", "stof", "stod", "stold"})
    if (words == name) return true;
  return words.empty();
}

}  // namespace

std::string wordsOf(const std::exception& problem) {
  if (const auto* file = dynamic_cast<const std::filesystem::filesystem_error*>(&problem)) {
    const std::string path = file->path1().string();
    return (path.empty() ? "a path is empty" : path) + ": " + file->code().message();
  }
  if (dynamic_cast<const std::bad_alloc*>(&problem) != nullptr ||
      dynamic_cast<const std::length_error*>(&problem) != nullptr)
    return "more memory is needed than there is; is a number or a size in the input far too large?";
  const std::string words = problem.what();
  const auto* system = dynamic_cast<const std::system_error*>(&problem);
  if (system != nullptr && isForeign(words)) return system->code().message();
  return isForeign(words) ? kUnusable : words;
}

}  // namespace tread
