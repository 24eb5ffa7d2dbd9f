// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tread {

/// A number in decimal notation (12, -0.5, 1e-3); nullopt for anything else: hexadecimal, leading
/// zeros, inf, nan, out of a double's range.
std::optional<double> parseNumber(const std::string& text);

/// A plain decimal integer (12, -3); nullopt for 010, 0x1F, 1e3, +1 or values outside of int64.
std::optional<int64_t> parseInteger(const std::string& text);

/// The shortest decimal text that parses to the same double.
std::string formatNumber(double value);

/// Text as a YAML scalar on one line, quoted where YAML would otherwise read another type.
std::string formatText(const std::string& text);

/// The candidate closest to a mistyped word; nullopt if none is close.
std::optional<std::string> nearestSpelling(const std::string& word,
                                           const std::vector<std::string>& candidates);

/// Words with commas between.
std::string joinWords(const std::vector<std::string>& words);

}  // namespace tread
