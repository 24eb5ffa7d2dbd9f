// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace tread::testing {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInf = std::numeric_limits<double>::infinity();
inline constexpr double kDeg = 3.14159265358979323846 / 180.0;  ///< [rad]
inline constexpr int64_t kSecond = 1'000'000;                   ///< [us]

/// How often a test repeats itself: all of it, or a tenth (at least once) in an instrumented build,
/// where each step is ten times as slow and a few are enough to find what is found there.
constexpr int effort(int repetitions) {
#ifdef TREAD_INSTRUMENTED
  return repetitions >= 10 ? repetitions / 10 : 1;
#else
  return repetitions;
#endif
}

/// All bytes of a file; none where there is no file.
inline std::string contentOf(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Path of a file in the recordings of others, `name` below their folder; empty where it is not.
inline std::string recorded(const std::string& name) {
  const char* folder = std::getenv("TREAD_RECORDINGS");
  const std::string path = std::string(folder == nullptr ? "" : folder) + "/" + name;
  return std::filesystem::exists(path) ? path : "";
}

/// The lines of a text, without their ends.
inline std::vector<std::string> linesOf(const std::string& bytes) {
  std::vector<std::string> lines;
  std::istringstream stream(bytes);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace tread::testing
