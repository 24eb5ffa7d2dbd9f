// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/vehicle/effects.hpp"
#include "modules/identification/core/finding.hpp"

namespace tread::gap {

/// Three digits that count (0.0123, 1.20, 123), whole numbers as such (2); "no limit" for infinity,
/// "-" for what is not known.
std::string threeDigits(double value);

/// A number as people in the field say it: shares in per cent, angles in degrees, else with its
/// unit.
std::string said(double value, const std::string& unit);

/// "1.2 to 1.4 rad/s"; in the words of said().
std::string saidInterval(double low, double high, const std::string& unit);

/// An angle in degrees, a distance in metres.
std::string saidAngle(double angle);
std::string saidDistance(double distance);

/// An effect and its parameter, by path; both nullptr for a number of the nominal model.
struct ParameterOfPath {
  const Effect* effect = nullptr;
  const EffectParameter* parameter = nullptr;
};
ParameterOfPath parameterOfPath(const std::string& path);

/// The parameter's name without its effect.
std::string lastPart(const std::string& path);

/// Unit in which people say a limit; none for a friction, which is no share.
std::string naturalUnit(const EffectParameter& parameter);

/// An estimate of a reciprocal as people say it: the limit itself, its interval turned over.
/** Others come back as they are. */
Estimate naturalEstimate(const Estimate& estimate);

/// Unit in which a natural estimate is said.
std::string saidUnit(const Estimate& natural);

/// "limit 1.18 rad/s (1.15 to 1.21 rad/s)".
std::string saidEstimate(const Estimate& estimate);

/// Titles of effects, "A, B and C"; what is no effect (forward_gain) as it is.
std::string titleOf(const std::string& effect);
std::string titlesOf(const std::vector<std::string>& effects,
                     const std::string& last_joint = "and");
/// The same up to the first comma of each title.
std::string shortTitleOf(const std::string& effect);
std::string shortTitlesOf(const std::vector<std::string>& effects,
                          const std::string& last_joint = "and");

/// The words with commas between them and `joint` before the last.
std::string joined(const std::vector<std::string>& words, const std::string& joint = "and");

/// Sentences one after the other.
std::string joinedSentences(const std::vector<std::string>& sentences);

/// The same sentence without its full stop; with a small first letter; with a large one.
std::string withoutStop(const std::string& sentence);
std::string inSentence(const std::string& words);
std::string asSentence(const std::string& words);

/// p values: "0.003", "below 0.001".
std::string saidChance(double p_value);

}  // namespace tread::gap
