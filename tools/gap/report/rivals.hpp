// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "modules/identification/core/finding.hpp"

namespace tread::gap {

/// Whether a drive leaves open which of two it is.
inline bool isAsGood(const RunnerUp& runner_up) {
  return runner_up.behind < runner_up.error;
}

/// Effects that this drive cannot tell from a found one (without itself): twins, then those that
/// are as good.
std::vector<std::string> rivalsOf(const FoundEffect& effect);

/// What another effect is called beside a found one, within a sentence.
std::string rivalTitle(const std::string& found, const std::string& other);

/// What tells an effect from its rivals: of their common group, else of the effect.
std::vector<std::string> waysToTell(const FoundEffect& effect);

/// Two effects that may be taken for each other.
struct RivalPair {
  std::string found;
  std::string other;
  bool twin = false;    ///< of the same group: the residuals cannot decide
  double behind = 0.0;  ///< [nats] of a runner-up
  double error = 0.0;   ///< [nats]
};

/// Whether a drive may tell a pair: members of one group want another measurement.
bool driveMayTell(const RivalPair& pair);

/// All pairs of a finding, each once, whichever of the two was found first.
std::vector<RivalPair> rivalPairs(const Finding& finding);

}  // namespace tread::gap
