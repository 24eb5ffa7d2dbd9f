// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tread {

/// A number in decimal notation (12, -0.5, 1e-3); nothing for anything else: hexadecimal, leading
/// zeros, inf, nan, out of a double's reach.
std::optional<double> parseNumber(const std::string& text);

/// A plain decimal integer (12, -3); nothing for 010, 0x1F, 1e3, +1 or what int64 does not hold.
std::optional<int64_t> parseInteger(const std::string& text);

/// The shortest decimal text that parses to the same double.
std::string formatNumber(double value);

/// Text as a YAML scalar on one line, in quotes where YAML would read something else.
std::string formatText(const std::string& text);

/// The candidate that a mistyped word most likely meant; nothing if none is near.
std::optional<std::string> nearestSpelling(const std::string& word,
                                           const std::vector<std::string>& candidates);

/// Words with commas between.
std::string joinWords(const std::vector<std::string>& words);

}  // namespace tread
