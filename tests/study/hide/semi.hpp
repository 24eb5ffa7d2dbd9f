// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/log/event_log.hpp"
#include "tests/study/hide/hider.hpp"

// Effects hidden in a recorded log by an exact transformation: of the poses for instrument effects,
// of the commands for drive effects. A command transformation replaces the command by the one that
// the vehicle with the effect would have needed for the recorded motion.
namespace tread::blind {

/// One effect that can be hidden in a recording.
struct SemiEffect {
  const char* name;       ///< as in effectList()
  const char* parameter;  ///< symbol, as in the truth file
  const char* unit;
  double small;  ///< value at size 1
  double large;  ///< value at size 2
  bool either_sign;
};

const std::vector<SemiEffect>& semiEffects();

/// Effects hidden in a recording.
struct SemiTruth {
  std::string effect;
  std::vector<Quantity> parameters;
  double duration = 0.0;  ///< from the first command to the last [s]
};

/// Hides an effect in the events of a log, size 1 or 2; the seed determines the sign and the time
/// of a change. Throws std::invalid_argument for an unknown effect or size.
SemiTruth hideInLog(const std::string& effect, int size, uint64_t seed,
                    std::vector<LogEvent>& events);

/// The events of a log; throws std::runtime_error if it is empty or damaged.
std::vector<LogEvent> readLog(const std::string& path);

/// The truth as JSON with the keys of truth_text.hpp, and source_sha256, the hash of the
/// recording's log. Noise and programme are called "recording"; values that only a generator has
/// are null.
std::string semiTruthText(const std::string& name, const SemiTruth& truth, int size, uint64_t seed,
                          const std::string& source_hash);

}  // namespace tread::blind
