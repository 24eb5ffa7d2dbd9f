// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "common/execution/measurement.hpp"
#include "modules/learner/core/rules/make_rule.hpp"
#include "modules/learner/core/state_text.hpp"
#include "tests/fuzz/reading.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/helpers.hpp"

using namespace tread;

namespace {

const std::string kCorpus = std::string(TREAD_SOURCE_DIR) + "/tests/data/fuzz/";

/// Executions of one pattern after another, each turned in proportion to its path; every fourth is
/// incomplete.
void drive(learner::Learner& learner, int executions, double bend) {
  const auto& patterns = fuzz::shippedSet().patterns();
  for (int i = 0; i < executions; ++i) {
    const MotionPattern& pattern = patterns[static_cast<size_t>(i) % patterns.size()];
    Measurement measured;
    for (const Pose2& pose : pattern.trajectory) {
      const double turned = bend * std::hypot(pose.x, pose.y) + 0.01 * std::sin(i);
      measured.trajectory.push_back({pose.x * std::cos(turned) - pose.y * std::sin(turned),
                                     pose.x * std::sin(turned) + pose.y * std::cos(turned),
                                     pose.yaw + 2.0 * turned});
    }
    if (i % 4 == 3) measured.trajectory.resize((measured.trajectory.size() + 1) / 2);
    measured.covered = measured.trajectory.size();
    learner.learn(pattern.id, measured, std::nullopt, 1000 + i);
  }
}

void writeMemory(const learner::Learner& learner, const std::string& name) {
  std::ofstream file(kCorpus + "rule_memory/" + name);
  file.precision(17);
  for (const double number : learner.rule().memory()) file << number << '\n';
}

}  // namespace

TEST_CASE("every input that a fuzzer has found is read or refused, and ends nothing") {
  for (const auto& [name, target] : tread::fuzz::targets()) {
    CAPTURE(name);
    int played = 0;
    for (const auto& file : std::filesystem::directory_iterator(kCorpus + name)) {
      const std::string bytes = tread::testing::contentOf(file.path());
      target(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
      // Also truncated input.
      for (const size_t part : {bytes.size() / 2, bytes.size() / 3, size_t{0}})
        target(reinterpret_cast<const uint8_t*>(bytes.data()), part);
      ++played;
    }
    CHECK(played > 0);
  }
}

TEST_CASE("what the learner has written into the corpus it takes back today") {
  for (const std::string name : {"fresh", "begun", "two_surfaces"}) {
    CAPTURE(name);
    std::istringstream words(testing::contentOf(kCorpus + "rule_memory/" + name));
    std::vector<double> memory;
    for (double number = 0.0; words >> number;) memory.push_back(number);
    const auto rule = learner::makeRule(learner::RuleConfig{}, fuzz::shippedSet());
    CHECK(rule->restore(learner::TrajectoryTable(fuzz::shippedSet().patterns()), memory));
    CHECK(rule->remembered() == (name == "two_surfaces" ? 2 : 1));
  }
  std::string why;
  const std::string text = testing::contentOf(kCorpus + "learner_state/state");
  const auto state =
      learner::parseState(fuzz::sealed(reinterpret_cast<const uint8_t*>(text.data()), text.size()),
                          fuzz::shippedSet(), why);
  CHECK(why.empty());
  REQUIRE(state);
  learner::Learner learner(learner::RuleConfig{}, fuzz::shippedSet());
  CHECK(learner.restore(state->set, state->residuals, state->memory));
  CHECK(learner.memory() == state->memory);
}

// Run test_fuzz_corpus "[.write]" after a change of the rule's memory format.
TEST_CASE("the learner writes its part of the corpus anew", "[.write]") {
  const PatternSet& shipped = fuzz::shippedSet();
  const learner::RuleConfig config;
  learner::Learner learner(config, shipped);
  writeMemory(learner, "fresh");
  drive(learner, 4, 0.3);
  writeMemory(learner, "begun");
  learner::LearnerState state{
      learner.set(), learner.residuals(), learner.memory(), config.rule, {{7, 1}, {7, 2}}};
  const std::string text = learner::formatState(state, shipped, config);
  std::ofstream(kCorpus + "learner_state/state")
      << text.substr(0, text.rfind('\n', text.size() - 2) + 1);
  drive(learner, 12, 0.3);
  REQUIRE(learner.rule().remembered() == 2);
  writeMemory(learner, "two_surfaces");
}
