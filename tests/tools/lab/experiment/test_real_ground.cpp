// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The default learning rule on recordings of a real vehicle, on unknown ground.
#include <catch2/catch.hpp>

#include "modules/learner/core/rules/learning_rule.hpp"
#include "tests/helpers.hpp"
#include "tools/lab/experiment/batch.hpp"

using namespace tread::experiment;

TEST_CASE("on real ground not met before the default rule beats no learning, and never does harm") {
  const std::string drive = tread::testing::recorded("drive");
  if (drive.empty()) {
    WARN("skipped: the recorded drives are not here (TREAD_RECORDINGS)");
    return;
  }
  Request request;
  request.recordings = drive;
  request.robot = "warthog";
  request.rules = {"off", "single", "multi_model", "omniscient"};
  request.repetitions = 600;
  request.threads = 2;
  const Batch batch = runBatch(request, nullptr);
  for (const char* quantity : kQuantities) {
    double off = 0.0, learned = 0.0;
    for (const Row& row : batch.tables.all_patterns) {
      if (row.quantity != quantity || row.k != 10 || row.rule != "multi_model") continue;
      const Row* other = find(batch.tables.all_patterns, row.from, row.to, quantity, "off", "", 10);
      REQUIRE(other != nullptr);
      off += other->estimate.value;
      learned += row.estimate.value;
      CAPTURE(row.from, row.to, quantity);
      CHECK(row.estimate.value < 1.04 * other->estimate.value);
    }
    CAPTURE(quantity, off, learned);
    CHECK(learned < 0.97 * off);
  }
}
