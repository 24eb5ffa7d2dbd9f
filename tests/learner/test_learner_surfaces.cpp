// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The learner node's remembered surfaces: in LEARNING, in its states, and after restarts.
#include <catch2/catch.hpp>

#include <cmath>

#include "modules/learner/core/state_text.hpp"
#include "tests/learner/bench.hpp"

using namespace tread;
using namespace tread::learner;
using namespace tread::learner::samples;
using Catch::Contains;

namespace {

/// A learner that has driven long enough to remember its ground.
struct SettledBench : Bench {
  SettledBench() : Bench({}, "multi_model") { run(20.0); }
};

std::vector<double> memoryIn(const std::string& state_text) {
  std::string why;
  return parseState(state_text, smallSet(), why)->memory;
}

}  // namespace

TEST_CASE(
    "LEARNING says when a surface is remembered and known again, the shipped one is from the "
    "start") {
  Bench bench({}, "multi_model");
  bench.run(6.0);
  REQUIRE(bench.node().rememberedSurfaces() == 1);
  REQUIRE(bench.counter("surfaces remembered") == 1);
  REQUIRE(bench.learned.back().surface == 0);
  REQUIRE_THAT(bench.learned.back().change_reason, Contains("unknown ground"));
  bench.run(14.0);
  REQUIRE(bench.node().rememberedSurfaces() == 2);
  REQUIRE(bench.counter("surfaces remembered") == 2);
  size_t stored = 0;
  for (const learning_t& learned : bench.learned)
    if (learned.change_reason == "remembered as surface 2 from now on") ++stored;
  REQUIRE(stored == 1);
  REQUIRE(bench.learned.back().surface == 2);
  REQUIRE(bench.learned.back().surface_probability > 0.9);
  REQUIRE(bench.learned.back().ground_changed < 0.5);
  REQUIRE_THAT(bench.learned.back().change_reason, Contains("as surface 2"));
}

TEST_CASE("a vehicle that drives as shipped is on the shipped ground") {
  Driving driving;
  driving.truth = {
      {kStraight, {1.0, 0.0, 0.0}}, {kLeft, {0.9, 0.0, 0.5}}, {kRight, {0.9, 0.0, -0.5}}};
  Bench bench(driving, "multi_model");
  bench.run(20.0);
  REQUIRE(bench.node().rememberedSurfaces() == 1);
  REQUIRE(bench.learned.back().surface == 1);
  REQUIRE_THAT(bench.learned.back().change_reason, Contains("as shipped"));
}

TEST_CASE("LEARNING of a rule that remembers nothing says so") {
  Bench bench;
  bench.run(5.0);
  REQUIRE(std::isnan(bench.learned.front().surface_probability));
  REQUIRE(std::isnan(bench.learned.front().ground_changed));
  REQUIRE_THAT(bench.learned.front().change_reason, Contains("the others scaled"));
  REQUIRE(bench.node().rememberedSurfaces() == 0);
}

TEST_CASE("a restarted learner goes on with all surfaces to the bit, from its states alone") {
  SettledBench bench;
  const PatternSet before = bench.node().set();
  const std::vector<double> memory = memoryIn(bench.node().stateText());
  REQUIRE(memory.size() > 100);
  bench.bus.restart("learner");
  REQUIRE(samePredictions(bench.node().set(), before));
  REQUIRE(memoryIn(bench.node().stateText()) == memory);
  REQUIRE(bench.node().rememberedSurfaces() == 2);
  for (const std::string& name : bench.store.names()) REQUIRE_THAT(name, Contains("learner_"));
  bench.run(5.0);
  REQUIRE(bench.health.health_reason.empty());
  REQUIRE(bench.learned.back().surface == 2);
}

TEST_CASE("with the newest state damaged the surfaces of the one before are there") {
  SettledBench bench;
  std::string why;
  const auto version = [&](const std::string& name) {
    return parseState(*bench.store.read(name), smallSet(), why)->set.version();
  };
  const std::string newest = version("learner_state_1") > version("learner_state_2")
                                 ? "learner_state_1"
                                 : "learner_state_2";
  bench.bus.kill("learner");
  std::string damaged = *bench.store.read(newest);
  damaged[damaged.size() - 40] = '#';
  bench.store.write(newest, damaged);
  bench.bus.restart("learner");
  REQUIRE(bench.node().rememberedSurfaces() == 2);
  bench.run(4.5);
  REQUIRE(bench.learned.back().surface == 2);
}

TEST_CASE(
    "with all states lost nothing is remembered but the shipped set, and it is learned anew") {
  SettledBench bench;
  bench.bus.kill("learner");
  bench.store.remove("learner_state_1");
  bench.store.remove("learner_state_2");
  bench.bus.restart("learner");
  REQUIRE(bench.node().rememberedSurfaces() == 1);
  REQUIRE(bench.node().set().find(kLeft)->end().yaw ==
          Approx(smallSet().find(kLeft)->end().yaw).epsilon(1e-12));
  bench.run(16.0);
  REQUIRE(bench.node().rememberedSurfaces() == 2);
}

TEST_CASE("a state whose memory is no surfaces' starts anew under the same versions") {
  // A sum of squares of the rule, and one of coasting: five numbers follow those of the rule.
  const size_t from_end = GENERATE(size_t{6}, size_t{4});
  SettledBench bench;
  std::string why;
  auto state = parseState(bench.node().stateText(), smallSet(), why);
  REQUIRE(state);
  state->memory[state->memory.size() - from_end] = -1.0;
  const int64_t version = state->set.version();
  bench.bus.kill("learner");
  for (const std::string name : {"learner_state_1", "learner_state_2"})
    bench.store.write(name, formatState(*state, smallSet(), bench.config.rule));
  bench.bus.restart("learner");
  REQUIRE(bench.node().rememberedSurfaces() == 1);
  REQUIRE(bench.node().set().version() > version);
  REQUIRE(bench.node().set().find(kLeft)->end().yaw ==
          Approx(smallSet().find(kLeft)->end().yaw).epsilon(1e-12));
}
