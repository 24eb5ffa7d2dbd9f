// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

namespace tread::replay {

/// What a log's planner and learner do today with what they heard then.
struct CorpusEntry {
  std::string name;
  bool equal = false;              ///< both published what the log holds
  bool compared = false;           ///< at least one of the two could be compared
  std::vector<std::string> lines;  ///< of the report: what differs, first where and when
};

/// All logs of a folder: *.lcmlog and *.mcap (of tread-export), sorted by name.
/** Throws std::runtime_error with one clear line if there is none. */
std::vector<std::string> corpusOf(const std::string& folder);

/// Replays logs through planner and learner, so many at a time.
/** `overrides`: "planner.KEY=VALUE" or "learner.KEY=VALUE" in the place of what the logs'
 * configurations say. A log that cannot be read or compared says why. */
std::vector<CorpusEntry> replayCorpus(const std::vector<std::string>& logs,
                                      const std::vector<std::string>& overrides,
                                      const std::string& patterns_folder, int threads);

/// A few lines a log, and one of result.
std::string reportOf(const std::vector<CorpusEntry>& corpus);

}  // namespace tread::replay
