// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/report/text.hpp"
#include "common/vehicle/effects.hpp"
#include "modules/identification/core/finding.hpp"

namespace tread::gap {

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

}  // namespace tread::gap
