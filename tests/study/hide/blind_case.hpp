// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/log/event_log.hpp"
#include "tests/study/hide/programme.hpp"

namespace tread::blind {

/// Kind of question that a log poses.
enum class CaseKind { kNull, kSingle, kPair, kUnknown, kDegenerate, kBad };

/// The name in files: null, single, pair, out_of_catalogue, degenerate, bad.
std::string kindName(CaseKind kind);

/// Complete definition of a case; its bytes depend on nothing else.
struct CasePlan {
  std::string name = "0001";  ///< of the log; it does not reveal the case
  CaseKind kind = CaseKind::kNull;
  std::vector<std::string> effects;  ///< names of effectList()
  std::vector<std::string> group;  ///< further correct answers, if a drive cannot distinguish them
  std::string defect;              ///< of a bad log; one of defectNames()
  double size = 2.0;
  std::string noise = "mid";
  double minutes = 10.0;
  Choice choice = Choice::kFull;
  uint64_t seed = 1;
};

/// A generated case: the log and the truth.
struct MadeCase {
  std::vector<LogEvent> events;  ///< ordered by time of recording
  double keep = 1.0;             ///< share of the file's bytes that is kept, for a truncated log
  std::string truth;             ///< JSON; see truth_text.hpp
};

/// Drives, measures and records. Throws std::invalid_argument for an unknown name.
MadeCase makeCase(const CasePlan& plan);

}  // namespace tread::blind
