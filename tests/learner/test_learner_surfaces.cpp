// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The remembered surfaces of the learner node: on disk, across restarts, damaged.
#include <catch2/catch.hpp>

#include <cmath>

#include "modules/learner/core/learner.hpp"
#include "tests/learner/bench.hpp"

using namespace tread;
using namespace tread::learner;
using namespace tread::learner::samples;
using Catch::Contains;

namespace {

constexpr const char* kBankFile = "surface_bank";

/// A learner with the rule bank that has driven long enough to remember its ground.
struct SettledBench : Bench {
  SettledBench() : Bench({}, "bank") { run(16.0); }

  size_t surfaces() { return node().rememberedSurfaces(); }
  void forgetStates() {
    store.remove("learner_state_1");
    store.remove("learner_state_2");
  }
};

std::vector<std::string> entriesLike(const Store& store, const std::string& beginning) {
  std::vector<std::string> found;
  for (const std::string& name : store.names())
    if (name.compare(0, beginning.size(), beginning) == 0) found.push_back(name);
  return found;
}

}  // namespace

TEST_CASE("the bank begins empty, and LEARNING says when a surface is remembered and known again") {
  Bench bench({}, "bank");
  bench.run(6.0);
  REQUIRE(bench.node().rememberedSurfaces() == 0);
  REQUIRE(bench.learned.front().surface == 0);
  REQUIRE_THAT(bench.learned.front().change_reason, Contains("unknown ground"));
  bench.run(14.0);
  REQUIRE(bench.node().rememberedSurfaces() == 1);
  REQUIRE(bench.counter("surfaces remembered") == 1);
  size_t stored = 0;
  for (const learning_t& learned : bench.learned)
    if (learned.change_reason == "remembered as surface 1 from now on") ++stored;
  REQUIRE(stored == 1);
  REQUIRE(bench.learned.back().surface == 1);
  REQUIRE(bench.learned.back().surface_probability > 0.9);
  REQUIRE(bench.learned.back().ground_changed < 0.5);
  REQUIRE_THAT(bench.learned.back().change_reason, Contains("as surface 1"));
}

TEST_CASE("LEARNING of a rule that remembers nothing says so") {
  Bench bench;
  bench.run(5.0);
  REQUIRE(std::isnan(bench.learned.front().surface_probability));
  REQUIRE(std::isnan(bench.learned.front().ground_changed));
  REQUIRE_THAT(bench.learned.front().change_reason, Contains("the others scaled"));
  REQUIRE_FALSE(bench.store.read(kBankFile));
}

TEST_CASE("a restarted learner goes on with filter and bank to the bit") {
  SettledBench bench;
  const PatternSet before = bench.node().set();
  const std::string bank = *bench.store.read(kBankFile);
  bench.bus.restart("learner");
  REQUIRE(samePredictions(bench.node().set(), before));
  REQUIRE(bench.surfaces() == 1);
  REQUIRE(*bench.store.read(kBankFile) == bank);
  bench.run(5.0);
  REQUIRE(bench.health.health_reason.empty());
  REQUIRE(bench.learned.back().surface == 1);
}

TEST_CASE("surfaces outlive the learner's states") {
  SettledBench bench;
  bench.bus.kill("learner");
  bench.forgetStates();
  bench.bus.restart("learner");
  REQUIRE(bench.surfaces() == 1);
  // On which of them it stands it must find out again: nothing is predicted from memory alone.
  REQUIRE(bench.node().set().find(kLeft)->end().yaw ==
          Approx(smallSet().find(kLeft)->end().yaw).epsilon(1e-12));
  bench.run(4.5);
  REQUIRE(bench.learned.back().surface == 1);
}

TEST_CASE("a damaged bank is set aside under another name and never overwritten") {
  SettledBench bench;
  for (int time = 1; time <= 2; ++time) {
    bench.bus.kill("learner");
    bench.forgetStates();
    std::string damaged = *bench.store.read(kBankFile);
    damaged[damaged.size() / 2] = '#';
    bench.store.write(kBankFile, damaged);
    bench.bus.restart("learner");
    const std::string aside = std::string(kBankFile) + ".aside_" + std::to_string(time);
    REQUIRE(*bench.store.read(aside) == damaged);
    REQUIRE(bench.surfaces() == 0);
    bench.run(0.1);
    REQUIRE_THAT(bench.health.health_reason,
                 Contains("surface_bank is damaged: set aside as " + aside));
    bench.run(16.0);
    REQUIRE(bench.surfaces() == 1);
    REQUIRE(*bench.store.read(aside) == damaged);
  }
  REQUIRE(entriesLike(bench.store, kBankFile).size() == 3);
}

TEST_CASE("a cut off bank and one of another shipped set are set aside, too") {
  SettledBench bench;
  const std::string whole = *bench.store.read(kBankFile);
  PatternSetContent content = smallContent();
  content.name = "other";
  const PatternSet other = checked(content);
  SurfaceBank empty(std::make_shared<GroundModel>(FilterConfig{}, other));
  for (const std::string& wrong : {whole.substr(0, whole.size() / 2), std::string(),
                                   formatBank(empty, other), std::string("no bank at all\n")}) {
    bench.bus.kill("learner");
    bench.store.write(kBankFile, wrong);
    bench.bus.restart("learner");
    // The states still hold the surfaces.
    REQUIRE(bench.surfaces() == 1);
    REQUIRE(*bench.store.read(kBankFile) == whole);
  }
  REQUIRE(entriesLike(bench.store, kBankFile).size() == 5);
}

TEST_CASE("a damaged bank that cannot be set aside is left as it is") {
  SettledBench bench;
  bench.bus.kill("learner");
  bench.forgetStates();
  const std::string damaged = "tread-surface-bank 1\nshipped ";
  bench.store.write(kBankFile, damaged);
  bench.store.failWith("disk full");
  bench.bus.restart("learner");
  bench.run(8.0);
  bench.store.failWith("");
  bench.run(10.0);
  REQUIRE(*bench.store.read(kBankFile) == damaged);
  REQUIRE(bench.surfaces() == 1);
  REQUIRE_THAT(bench.health.health_reason, Contains("could not be set aside"));
}

TEST_CASE("a bank restores from its text to the bit, and no changed byte is believed") {
  SettledBench bench;
  const std::string text = *bench.store.read(kBankFile);
  const PatternSet shipped = smallSet();
  SurfaceBank bank(std::make_shared<GroundModel>(FilterConfig{}, shipped));
  REQUIRE_FALSE(parseBank(text, shipped, bank));
  REQUIRE(bank.size() == 1);
  REQUIRE(formatBank(bank, shipped) == text);
  for (size_t at = 0; at < text.size(); at += 7) {
    std::string changed = text;
    changed[at] = static_cast<char>(changed[at] ^ 1);
    SurfaceBank untouched(std::make_shared<GroundModel>(FilterConfig{}, shipped));
    REQUIRE(parseBank(changed, shipped, untouched));
    REQUIRE(untouched.size() == 0);
  }
}
