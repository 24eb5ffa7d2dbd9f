// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/log/event_log.hpp"
#include "tests/study/hide/programme.hpp"

namespace tread::blind {

/// What kind of question a log asks.
enum class CaseKind { kNull, kSingle, kPair, kUnknown, kDegenerate, kBad };

/// The name in files: null, single, pair, out_of_catalogue, degenerate, bad.
std::string kindName(CaseKind kind);

/// All that makes one case; nothing else decides its bytes.
struct CasePlan {
  std::string name = "0001";  ///< of the log; says nothing about the case
  CaseKind kind = CaseKind::kNull;
  std::vector<std::string> effects;  ///< names of effectList()
  std::vector<std::string> group;  ///< right answers beside the effects, where a drive cannot tell
  std::string defect;              ///< of a bad log; one of defectNames()
  double size = 2.0;
  std::string noise = "mid";
  double minutes = 10.0;
  Choice choice = Choice::kFull;
  uint64_t seed = 1;
};

/// A case made: the log and the truth about it.
struct MadeCase {
  std::vector<LogEvent> events;  ///< in order of time of recording
  double keep = 1.0;             ///< share of the file's bytes that are left, for a truncated log
  std::string truth;             ///< JSON; see truth_text.hpp
};

/// Drives, measures and writes down. Throws std::invalid_argument for an unknown name.
MadeCase makeCase(const CasePlan& plan);

}  // namespace tread::blind
