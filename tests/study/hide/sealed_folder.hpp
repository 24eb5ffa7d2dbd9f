// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "tests/study/hide/blind_case.hpp"

namespace tread::blind {

/// A folder of blind cases:
///   blind/NAME.lcm            what may be read
///   blind/commitments*.txt    SHA-256 of each truth and each log, as `sha256sum -c` reads it
///   sealed/NAME.json          the truth; sealed/ has mode 000 while nobody writes
/** Mode 000 keeps every user but root out, and does nobody harm: unseal() opens it again. Throws
    std::runtime_error with one clear line where a file cannot be written or exists already. */
class SealedFolder {
 public:
  /// `part` names the list of commitments of a shard; empty for a whole.
  explicit SealedFolder(const std::string& path, const std::string& part = "");
  /// Seals.
  ~SealedFolder();
  SealedFolder(const SealedFolder&) = delete;
  SealedFolder& operator=(const SealedFolder&) = delete;

  /// The truth first, then its commitment, then the log.
  void add(const std::string& name, const MadeCase& made);

 private:
  void commit(const std::string& line);

  std::string path_;
  std::string list_;
};

/// Joins the lists of shards to commitments.txt, sorted by name.
void mergeCommitments(const std::string& path);

/// Opens sealed/ and checks all files against the commitments; the lines that do not fit.
std::vector<std::string> unseal(const std::string& path);

}  // namespace tread::blind
