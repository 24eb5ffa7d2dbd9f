// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// A second learner started by mistake on the same bus.
#include <catch2/catch.hpp>

#include "tests/learner/bench.hpp"

using namespace tread;
using namespace tread::learner;
using namespace tread::learner::samples;

namespace {

/// A bench with a second learner that has learned elsewhere, and starts later.
struct TwoLearners : Bench {
  TwoLearners() {
    bus.outside().subscribe<health_t>(kHealth, [this](const health_t& m) { of[m.boot_id] = m; });
    run(20.0);
    first = health.boot_id;
    LearnerNodeConfig second = config;
    second.listen_us = 1'200'000;
    bus.addNode("second", [this, second](Bus& end) {
      return std::make_unique<LearnerNode>(second, end, other_store);
    });
    second_started = bus.now();
  }
  const health_t& firstHealth() { return of[first]; }
  const health_t& secondHealth() { return of[second_started]; }

  MemoryStore other_store;
  std::map<int64_t, health_t> of;  ///< HEALTH by boot id
  int64_t first = 0;
  int64_t second_started = 0;
};

}  // namespace

TEST_CASE("of two learners the later one is silent, both say so, and versions never go back") {
  TwoLearners bench;
  bench.run(40.0);
  CHECK(bench.versionsNeverWentBack());
  CHECK(bench.firstHealth().health_state == health_t::HEALTH_DEGRADED);
  CHECK(bench.secondHealth().health_state == health_t::HEALTH_DEGRADED);
  CHECK_THAT(bench.firstHealth().health_reason,
             Catch::Contains("two processes learner run, this one since 1.0 s of the host's clock "
                             "and another since 21.0 s; stop one of them"));
  CHECK_THAT(bench.secondHealth().health_reason,
             Catch::Contains("passive") && Catch::Contains("another since 1.0 s"));
  // Only the first one reports learning.
  std::map<std::pair<int64_t, int64_t>, int> reports;
  for (const learning_t& learned : bench.learned)
    CHECK(++reports[{learned.learned_run_id, learned.learned_execution_id}] == 1);
}

TEST_CASE("when the earlier learner ends the later one goes on above its versions") {
  TwoLearners bench;
  bench.run(20.0);
  const int64_t published = bench.versions.back();
  bench.bus.kill("learner");
  const size_t before = bench.versions.size();
  bench.run(20.0);
  REQUIRE(bench.versions.size() > before);
  CHECK(bench.versions.back() > published);
  CHECK(bench.versionsNeverWentBack());
  CHECK(bench.secondHealth().health_state == health_t::HEALTH_OK);
}

TEST_CASE("a learner that restarts is no second one") {
  Bench bench;
  bench.run(10.0);
  bench.bus.restart("learner");
  const size_t before = bench.versions.size();
  bench.run(1.5);
  CHECK(bench.versions.size() > before);
  CHECK(bench.health.health_state == health_t::HEALTH_OK);
}
