// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tread::plan {

/// A grey picture, rows from the top, x fastest.
struct GreyImage {
  int width = 0;
  int height = 0;
  int white = 255;  ///< the greatest value that a pixel may have
  std::vector<uint8_t> pixels;
};

/// Widest and highest that a map may be [cells], and the most cells that it may have.
inline constexpr int kLongestSide = 60'000;
inline constexpr int64_t kMostCells = 64'000'000;

/// Reads a PGM picture, P5 (bytes) or P2 (text), with comments; throws ConfigError "name:line:
/// what" for anything else, 16 bits a pixel, missing pixels and sizes that no map has.
GreyImage readPgm(const std::string& path);

/// The same from the file's bytes; `name` stands for the file in messages.
GreyImage parsePgm(std::string bytes, const std::string& name);

}  // namespace tread::plan
