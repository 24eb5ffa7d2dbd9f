// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <random>
#include <set>

#include "modules/learner/core/state_text.hpp"
#include "tests/learner/bench.hpp"

using namespace tread;
using namespace tread::learner;
using namespace tread::learner::samples;

namespace {

/// Damages an entry like a bad sector.
void damage(Store& store, const std::string& name) {
  std::string content = *store.read(name);
  content[content.size() / 2] = '#';
  store.write(name, content);
}

int64_t versionIn(const Store& store, const std::string& name) {
  std::string why;
  return parseState(*store.read(name), smallSet(), why)->set.version();
}

/// The entry with the newer state.
std::string newest(const Store& store) {
  return versionIn(store, "learner_state_1") > versionIn(store, "learner_state_2")
             ? "learner_state_1"
             : "learner_state_2";
}

}  // namespace

TEST_CASE("after a kill the learner goes on with what it knew, under a higher version") {
  Bench bench;
  bench.run(10.0);
  const PatternSet before = bench.node().set();
  bench.bus.restart("learner");
  REQUIRE(samePredictions(bench.node().set(), before));
  REQUIRE(bench.node().set().version() > before.version());
  REQUIRE(bench.node().set().content().parent_version == before.version());
  REQUIRE(bench.node().set().find(kLeft)->times_learned == before.find(kLeft)->times_learned);
  bench.run(10.0);
  REQUIRE(bench.health.health_reason.empty());
  REQUIRE(bench.versionsNeverWentBack());
}

TEST_CASE("an execution is reported once, also across a restart") {
  Driving driving;
  driving.executions = 12;
  Bench bench(driving);
  bench.run(6.8);
  bench.bus.restart("learner");
  bench.run(10.0);
  std::set<int64_t> ids;
  for (const learning_t& learned : bench.learned)
    REQUIRE(ids.insert(learned.learned_execution_id).second);
  // Executions that ended while it was down, or began before it received the INS again, cannot be
  // measured.
  REQUIRE(ids.size() >= 11);
}

TEST_CASE("versions never go back, however often and whenever the learner is killed") {
  for (uint64_t seed = 1; seed <= 5; ++seed) {
    Bench bench({}, "collective", {}, seed);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> wait(0.01, 5.0);
    for (int kill = 0; kill < 25; ++kill) {
      bench.run(wait(random));
      bench.bus.kill("learner");
      bench.run(0.3 * wait(random));
      if (kill % 7 == 3) damage(bench.store, newest(bench.store));
      bench.bus.restart("learner");
    }
    REQUIRE(bench.versionsNeverWentBack());
    REQUIRE(bench.published(kLeft).times_learned >= 3);
  }
}

TEST_CASE("off stays off across restarts") {
  Bench bench({}, "off");
  for (int i = 0; i < 4; ++i) {
    bench.run(3.0);
    bench.bus.restart("learner");
    REQUIRE(samePredictions(bench.node().set(), smallSet()));
  }
  REQUIRE(bench.versionsNeverWentBack());
}

TEST_CASE("a damaged state is one clear line, and the one before it is used") {
  Bench bench;
  bench.run(10.0);
  const std::string damaged = newest(bench.store);
  const std::string other = damaged == "learner_state_1" ? "learner_state_2" : "learner_state_1";
  const int64_t older = versionIn(bench.store, other);
  const int64_t published = bench.node().set().version();
  bench.bus.kill("learner");
  damage(bench.store, damaged);
  bench.bus.restart("learner");
  REQUIRE(bench.node().set().content().parent_version == older);
  REQUIRE(bench.node().set().version() > published);
  bench.run(0.1);
  REQUIRE(bench.health.health_state == health_t::HEALTH_DEGRADED);
  REQUIRE(bench.health.health_reason ==
          damaged + " is damaged: going on from version " + std::to_string(older));
}

TEST_CASE("with both states damaged the learner starts from the shipped set, above all versions") {
  Bench bench;
  bench.run(10.0);
  const int64_t published = bench.node().set().version();
  bench.bus.kill("learner");
  damage(bench.store, "learner_state_1");
  damage(bench.store, "learner_state_2");
  bench.bus.restart("learner");
  REQUIRE(samePredictions(bench.node().set(), smallSet()));
  REQUIRE(bench.node().set().version() > published);
  bench.run(0.1);
  REQUIRE(bench.health.health_reason ==
          "learner_state_1 is damaged; learner_state_2 is damaged: starting from the shipped set");
  bench.run(10.0);
  REQUIRE(bench.health.health_reason.empty());
}

TEST_CASE("a damaged reserve of versions is one clear line, and versions still go up") {
  for (const std::string content : {"9223372036854775807\n", "1#1\n", "", "-5\n"}) {
    CAPTURE(content);
    Bench bench;
    bench.run(10.0);
    const int64_t published = bench.node().set().version();
    bench.bus.kill("learner");
    bench.store.write("learner_versions", content);
    bench.bus.restart("learner");
    REQUIRE(bench.node().set().version() > published + 100);
    bench.run(0.1);
    REQUIRE(bench.health.health_reason == "learner_versions is damaged: versions go on far above");
  }
}

TEST_CASE("a state of another shipped set is not used") {
  Bench bench;
  bench.run(10.0);
  const int64_t published = bench.node().set().version();
  PatternSetContent edited = smallContent();
  edited.patterns[0].trajectory.back().x += 0.01;
  bench.bus.kill("learner");
  bench.config.shipped = checked(edited);
  bench.bus.restart("learner");
  REQUIRE(samePredictions(bench.node().set(), bench.config.shipped));
  REQUIRE(bench.node().set().version() > published);
}

TEST_CASE("when all memory is lost the version still goes up") {
  Bench bench;
  bench.run(60.0);
  const int64_t published = bench.node().set().version();
  bench.bus.kill("learner");
  for (const std::string& name : bench.store.names()) bench.store.remove(name);
  bench.bus.restart("learner");
  // Ten versions per second of robot time exceed what can be learned.
  REQUIRE(bench.node().set().version() > published);
  bench.run(5.0);
  REQUIRE(bench.versionsNeverWentBack());
}

TEST_CASE("a version that was lost but is still named by the robot is gone above") {
  Driving driving;
  driving.set_version = 5000;
  Bench bench(driving);
  bench.run(2.0);
  REQUIRE(bench.node().set().version() > 5000);
  REQUIRE(bench.counter("versions lost and gone above") == 1);
  REQUIRE(bench.versionsNeverWentBack());
}

TEST_CASE("on a full disk learning goes on in memory and HEALTH says so") {
  Bench bench;
  bench.run(5.0);
  const int64_t version = bench.node().set().version();
  bench.store.failWith("no space left on device");
  bench.run(10.0);
  REQUIRE(bench.node().set().version() > version + 5);
  REQUIRE(bench.health.health_state == health_t::HEALTH_DEGRADED);
  REQUIRE(bench.health.health_reason == "learning in memory only: no space left on device");
  const int64_t published = bench.node().set().version();
  bench.bus.restart("learner");
  REQUIRE(bench.node().set().version() > published);
  bench.run(5.0);
  REQUIRE(bench.versionsNeverWentBack());
  bench.store.failWith("");
  bench.run(5.0);
  REQUIRE(bench.health.health_state == health_t::HEALTH_OK);
}

TEST_CASE("the state before the newest is kept") {
  Bench bench;
  bench.run(10.0);
  const int64_t first = versionIn(bench.store, "learner_state_1");
  const int64_t second = versionIn(bench.store, "learner_state_2");
  REQUIRE(std::abs(first - second) == 1);
  REQUIRE(std::max(first, second) == bench.node().set().version());
}

TEST_CASE("broken messages on all channels do not stop the learner or turn its versions back") {
  FaultPlan faults;
  MessageFault broken;
  broken.receiver = "learner";
  broken.corrupt = 0.2;
  faults.messages = {broken};
  Bench bench({}, "collective", faults, 11);
  bench.run(60.0);
  REQUIRE(bench.versionsNeverWentBack());
  REQUIRE(bench.learned.size() >= 50);
}
