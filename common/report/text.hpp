// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

namespace tread {

// Numbers.

/// printf into a string.
[[gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...);

/// A number with so many decimals.
std::string fixed(double value, int decimals);

/// Three digits that count (0.0123, 1.20, 123), whole numbers as such (2); "no limit" for infinity,
/// "-" for what is not known.
std::string threeDigits(double value);

/// A number as people in the field say it: shares in per cent, angles in degrees, else with its
/// unit.
std::string said(double value, const std::string& unit);

/// "1.2 to 1.4 rad/s"; in the words of said().
std::string saidInterval(double low, double high, const std::string& unit);

/// An angle [rad] in degrees, a distance in metres.
std::string saidAngle(double angle);
std::string saidDistance(double distance);

/// p values: "0.003", "below 0.001".
std::string saidChance(double p_value);

// Axes.

/// A step of 1, 2 or 5 times a power of ten that cuts a range into about so many pieces.
double tickStep(double range, int pieces);

/// Whole multiples of a step within a range.
std::vector<double> ticks(double low, double high, double step);

/// The number beside a tick, with the decimals that its step needs.
std::string tickText(double value, double step);

// Sentences.

/// The words with commas between them and `joint` before the last.
std::string joined(const std::vector<std::string>& words, const std::string& joint = "and");

/// Sentences one after the other.
std::string joinedSentences(const std::vector<std::string>& sentences);

/// The same sentence without its full stop; with a small first letter; with a large one.
std::string withoutStop(const std::string& sentence);
std::string inSentence(const std::string& words);
std::string asSentence(const std::string& words);

// For HTML.

/// Letters that HTML and SVG read as their own are written as entities.
std::string escaped(const std::string& text);

/// Bytes as base64 (RFC 4648), for a picture inside a page.
std::string base64(const std::string& bytes);

}  // namespace tread
