// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/words/words.hpp"

namespace tread {

// Numbers.

/// printf into a string.
[[gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...);

/// Three significant digits (0.0123, 1.20, 123), whole numbers as such (2); "no limit" for
/// infinity, "-" for unknown values.
std::string threeDigits(double value);

/// A number in everyday units: shares in per cent, angles in degrees, else with its unit.
std::string said(double value, const std::string& unit);

/// "1.2 to 1.4 rad/s"; formatted as by said().
std::string saidInterval(double low, double high, const std::string& unit);

/// An angle [rad] in degrees, a distance in metres.
std::string saidAngle(double angle);
std::string saidDistance(double distance);

/// p values: "0.003", "below 0.001".
std::string saidChance(double p_value);

// Axes.

/// A step of 1, 2 or 5 times a power of ten that divides a range into about `pieces` parts.
double tickStep(double range, int pieces);

/// Whole multiples of a step within a range.
std::vector<double> ticks(double low, double high, double step);

/// The label of a tick, with as many decimals as its step needs.
std::string tickText(double value, double step);

// Sentences.

/// The words joined by commas, with `joint` before the last.
std::string joined(const std::vector<std::string>& words, const std::string& joint = "and");

/// Sentences joined by spaces.
std::string joinedSentences(const std::vector<std::string>& sentences);

/// The same sentence without its full stop; with a lower-case first letter; with an upper-case one.
std::string withoutStop(const std::string& sentence);
std::string inSentence(const std::string& words);
std::string asSentence(const std::string& words);

// For HTML.

/// Replaces characters that are special in HTML and SVG by entities.
std::string escaped(const std::string& text);

/// Bytes as base64 (RFC 4648), for a picture inside a page.
std::string base64(const std::string& bytes);

}  // namespace tread
