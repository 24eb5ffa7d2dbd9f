// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cstring>
#include <random>

#include "modules/learner/core/state_text.hpp"
#include "tests/fuzz/reading.hpp"
#include "tests/learner/samples.hpp"

using namespace tread;
using namespace tread::learner;
using namespace tread::learner::samples;

namespace {

LearnerState learnedState() {
  Learner learner({}, smallSet());
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> any(0.5, 1.3);
  for (int i = 0; i < 12; ++i)
    learner.learn(i % 2 == 0 ? kLeft : kStraight, fair(arc({any(random), 0.01, 0.4 * any(random)})),
                  Pose2{0.1 * any(random), -0.02, 0.3}, 1000 + i);
  return {learner.set(),
          learner.residuals(),
          {0.1, -2.5e-300, 1.0 / 3.0},
          RuleConfig{}.rule,
          {{7, 1}, {7, 2}, {-9'000'000'000, 3}}};
}

bool sameBits(double a, double b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

}  // namespace

TEST_CASE("a state restores bit for bit") {
  const LearnerState state = learnedState();
  const std::string text = formatState(state, smallSet(), {});
  std::string why;
  const auto restored = parseState(text, smallSet(), why);
  REQUIRE(why.empty());
  REQUIRE(restored);
  REQUIRE(restored->set.checksum() == state.set.checksum());
  REQUIRE(restored->set.version() == state.set.version());
  REQUIRE(restored->handled == state.handled);
  REQUIRE(restored->memory == state.memory);
  REQUIRE(restored->rule == state.rule);
  for (const MotionPattern& pattern : state.set.patterns()) {
    const MotionPattern& again = *restored->set.find(pattern.id);
    REQUIRE(again.times_learned == pattern.times_learned);
    for (size_t t = 0; t < pattern.trajectory.size(); ++t) {
      REQUIRE(sameBits(again.trajectory[t].x, pattern.trajectory[t].x));
      REQUIRE(sameBits(again.trajectory[t].y, pattern.trajectory[t].y));
      REQUIRE(sameBits(again.trajectory[t].yaw, pattern.trajectory[t].yaw));
    }
    const EndResiduals& residuals = state.residuals.at(pattern.id);
    REQUIRE(restored->residuals.at(pattern.id).count == residuals.count);
    for (size_t i = 0; i < 6; ++i)
      REQUIRE(sameBits(restored->residuals.at(pattern.id).mean[i], residuals.mean[i]));
  }
  REQUIRE(formatState(*restored, smallSet(), {}) == text);
}

TEST_CASE("a state with any byte changed or cut off is refused as damaged") {
  const std::string text = formatState(learnedState(), smallSet(), {});
  std::string why;
  for (size_t i = 0; i < text.size() - 1; i += 7) {
    std::string changed = text;
    changed[i] = static_cast<char>(changed[i] == '5' ? '6' : '5');
    if (changed == text) continue;
    REQUIRE_FALSE(parseState(changed, smallSet(), why));
    REQUIRE(why == "is damaged");
    REQUIRE_FALSE(parseState(text.substr(0, i), smallSet(), why));
  }
  REQUIRE_FALSE(parseState("", smallSet(), why));
  REQUIRE_FALSE(parseState("end 0\n", smallSet(), why));
  REQUIRE_FALSE(parseState(std::string(1000, '\0'), smallSet(), why));
}

TEST_CASE("a state of another shipped set is refused with that reason") {
  const std::string text = formatState(learnedState(), smallSet(), {});
  PatternSetContent other = smallContent();
  other.patterns[0].trajectory.back().x += 0.001;
  std::string why;
  REQUIRE_FALSE(parseState(text, checked(other), why));
  REQUIRE(why == "belongs to another shipped pattern set");
}

TEST_CASE("a state that another release wrote is refused with that reason, not as damaged") {
  std::string text = formatState(learnedState(), smallSet(), {});
  text.replace(text.find("state 4"), 7, "state 3");
  text.resize(text.rfind("end "));
  std::string why;
  const auto* bytes = reinterpret_cast<const uint8_t*>(text.data());
  REQUIRE_FALSE(parseState(fuzz::sealed(bytes, text.size()), smallSet(), why));
  REQUIRE(why == "was written by another release");
}
