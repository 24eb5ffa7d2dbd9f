// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

namespace tread::replay {

/// Result of replaying a log's planner and learner with their recorded inputs.
struct CorpusEntry {
  std::string name;
  bool equal = false;              ///< both published the messages of the log
  bool compared = false;           ///< at least one of the two was comparable
  std::vector<std::string> lines;  ///< for the report: first difference and its time
};

/// All logs of a folder: *.lcmlog and *.mcap (of tread-export), sorted by name.
/** Throws std::runtime_error with one clear line if there is none. */
std::vector<std::string> corpusOf(const std::string& folder);

/// Replays logs through planner and learner, several in parallel.
/** `overrides`: "planner.KEY=VALUE" or "learner.KEY=VALUE", replacing values of the logs'
 * configurations. For a log that cannot be read or compared the entry has the reason. */
std::vector<CorpusEntry> replayCorpus(const std::vector<std::string>& logs,
                                      const std::vector<std::string>& overrides,
                                      const std::string& patterns_folder, int threads);

/// A few lines per log, and one with the result.
std::string reportOf(const std::vector<CorpusEntry>& corpus);

}  // namespace tread::replay
