// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/study/score/study.hpp"

namespace tread::blindtest {

/// Cases that are hidden, run and opened together.
struct Batch {
  std::string folder;
  size_t first = 0;   ///< index in the suite
  size_t stride = 1;  ///< every n-th case
  std::vector<HiddenCase> cases;
};

/// Records of a batch; it exists when the batch is done.
inline constexpr const char* kBatchRecords = "cases.jsonl";

/// Hides the batch, runs tread-gap on each log, writes the records and times.csv.
/** `models`: the nominal model of each noise level. */
void runBatch(const Study& study, const Batch& batch,
              const std::map<std::string, std::string>& models);

}  // namespace tread::blindtest
