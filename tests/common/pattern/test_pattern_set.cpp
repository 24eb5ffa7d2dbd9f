// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/common/pattern/pattern_samples.hpp"
#include "tests/helpers.hpp"

using namespace tread;
using tread::testing::goodContent;

namespace {

using tread::testing::kNan;
const double kInfinity = std::numeric_limits<double>::infinity();

struct Refusal {
  std::string message_part;
  std::function<void(PatternSetContent&)> spoil;
};

void expectRefusals(const std::vector<Refusal>& refusals) {
  for (const Refusal& refusal : refusals) {
    PatternSetContent content = goodContent();
    refusal.spoil(content);
    std::string why;
    INFO("expected: " << refusal.message_part);
    CHECK_FALSE(PatternSet::make(content, why).has_value());
    INFO("got: " << why);
    CHECK(why.find(refusal.message_part) != std::string::npos);
    CHECK(why.find(';') != std::string::npos);
    CHECK(why.find('\n') == std::string::npos);
  }
}

}  // namespace

TEST_CASE("A good set is accepted and says nothing") {
  std::string why = "old";
  const auto set = PatternSet::make(goodContent(), why);
  REQUIRE(set.has_value());
  CHECK(why.empty());
  CHECK(set->version() == 7);
  CHECK(set->periodSeconds() == Approx(0.05));
  CHECK(set->patterns().size() == 3);
}

TEST_CASE("A set with a bad head is refused with one line") {
  expectRefusals({
      {"pattern set ''", [](auto& c) { c.name = ""; }},
      {"bad name", [](auto& c) { c.name = "two\nlines"; }},
      {"version 0", [](auto& c) { c.version = 0; }},
      {"parent version 7", [](auto& c) { c.parent_version = 7; }},
      {"parent version -1", [](auto& c) { c.parent_version = -1; }},
      {"utime -1", [](auto& c) { c.utime = -1; }},
      {"command kind", [](auto& c) { c.channels[0].kind = static_cast<CommandKind>(9); }},
      {"period 4999 us", [](auto& c) { c.period_us = 4'999; }},
      {"period 1000001 us", [](auto& c) { c.period_us = 1'000'001; }},
      {"0 patterns", [](auto& c) { c.patterns.clear(); }},
      {"1001 patterns", [](auto& c) { c.patterns.resize(1001); }},
  });
}

TEST_CASE("A set with a bad motion class is refused with one line") {
  expectRefusals({
      {"class 'cruise': yaw rate nan", [](auto& c) { c.classes[1].twist.omega = kNan; }},
      {"class 'cruise': speed 21 m/s", [](auto& c) { c.classes[1].twist.v_x = 21.0; }},
      {"class 'rest': steady command 1.1", [](auto& c) { c.classes[0].steady[0] = 1.1; }},
      {"name used twice", [](auto& c) { c.classes.push_back(c.classes[1]); }},
      {"class 'idle': no pattern begins or ends",
       [](auto& c) {
         c.classes.push_back({"idle", {}, {}});
       }},
  });
}

TEST_CASE("A set with a pattern of bad identity is refused with one line") {
  expectRefusals({
      {"pattern 'left': id -1", [](auto& c) { c.patterns[1].id = -1; }},
      {"pattern 'left': id 1 used twice", [](auto& c) { c.patterns[1].id = 1; }},
      {"pattern 'start': name used twice", [](auto& c) { c.patterns[1].name = "start"; }},
      {"bad name", [](auto& c) { c.patterns[1].name = "it's"; }},
      {"bad name", [](auto& c) { c.patterns[1].name = std::string(65, 'a'); }},
      {"class 'fast' is not in the set", [](auto& c) { c.patterns[1].entry_class = "fast"; }},
      {"class '' is not in the set", [](auto& c) { c.patterns[1].exit_class = ""; }},
      {"times learned -1", [](auto& c) { c.patterns[1].times_learned = -1; }},
  });
}

TEST_CASE("A set with bad commands or a bad trajectory is refused with one line") {
  expectRefusals({
      {"pattern 'stop': 0 commands", [](auto& c) { c.patterns[2].commands.clear(); }},
      {"1001 commands", [](auto& c) { c.patterns[2].commands.resize(1001); }},
      {"pattern 'left': 3 commands but 2 poses",
       [](auto& c) { c.patterns[1].trajectory.pop_back(); }},
      {"sample 2: command nan", [](auto& c) { c.patterns[1].commands[1][0] = kNan; }},
      {"sample 1: command -1.5", [](auto& c) { c.patterns[1].commands[0][1] = -1.5; }},
      {"sample 3: pose is not finite", [](auto& c) { c.patterns[1].trajectory[2].yaw = kNan; }},
      {"sample 1: pose is not finite", [](auto& c) { c.patterns[1].trajectory[0].x = kInfinity; }},
      {"sample 1: the trajectory jumps: speed",
       [](auto& c) { c.patterns[2].trajectory[0].y = 1.1; }},
      {"sample 2: the trajectory jumps: yaw",
       [](auto& c) { c.patterns[0].trajectory[1].yaw = -1.1; }},
      {"not finite", [](auto& c) { c.patterns[1].end_covariance[2] = kNan; }},
      {"negative variance", [](auto& c) { c.patterns[1].end_covariance[3] = -1e-9; }},
  });
}

TEST_CASE("Track speeds may be up to 20 m/s where power ends at 1") {
  PatternSetContent content = goodContent();
  content.channels = trackChannels(CommandKind::kTrackSpeed);
  content.patterns[1].commands[0] = {-20.0, 20.0};
  std::string why;
  CHECK(PatternSet::make(content, why).has_value());
  content.patterns[1].commands[0] = {-20.1, 20.0};
  CHECK_FALSE(PatternSet::make(content, why).has_value());
  CHECK(why.find("allowed is -20 to 20 m/s") != std::string::npos);
}

TEST_CASE("Patterns and classes are found by id and name, others are not") {
  std::string why;
  const PatternSet set = *PatternSet::make(goodContent(), why);
  REQUIRE(set.find(2) != nullptr);
  CHECK(set.find(2)->name == "left");
  CHECK(set.find(9) == nullptr);
  REQUIRE(set.findByName("stop") != nullptr);
  CHECK(set.findByName("stop")->id == 3);
  CHECK(set.findByName("Stop") == nullptr);
  CHECK(set.classNamed("cruise").twist.v_x == 1.0);
  CHECK_THROWS_AS(set.classNamed("fast"), std::out_of_range);
}

TEST_CASE("A pattern joins where the class that it needs is the one that is left") {
  std::string why;
  const PatternSet set = *PatternSet::make(goodContent(), why);
  CHECK(set.joinable(*set.find(1), *set.find(2)));
  CHECK(set.joinable(*set.find(2), *set.find(2)));
  CHECK(set.joinable(*set.find(2), *set.find(3)));
  CHECK_FALSE(set.joinable(*set.find(2), *set.find(1)));
  CHECK_FALSE(set.joinable(*set.find(3), *set.find(2)));
  CHECK(set.startingIn("cruise") == std::vector<const MotionPattern*>{set.find(2), set.find(3)});
  CHECK(set.startingIn("fast").empty());
}

TEST_CASE("The length of a pattern is that of its path from the start") {
  MotionPattern pattern;
  pattern.trajectory = {{3.0, 4.0, 0.0}, {3.0, 6.0, 1.0}};
  CHECK(pattern.pathLength() == Approx(7.0));
  CHECK(pattern.end().y == 6.0);
}

TEST_CASE("Copies of a set share their content") {
  std::string why;
  const PatternSet set = *PatternSet::make(goodContent(), why);
  const PatternSet copy = set;
  CHECK(&copy.content() == &set.content());
  CHECK(copy.checksum() == set.checksum());
}

TEST_CASE("the way from standstill to standstill through a pattern is the shortest chain's") {
  PatternSetContent content = goodContent();
  MotionPattern longer = content.patterns[0];
  longer.id = 4;
  longer.name = "longer start";
  longer.trajectory.back().x = 0.9;
  content.patterns.push_back(longer);
  std::string why;
  const std::vector<double> lengths = restToRestLengths(*PatternSet::make(content, why));
  const double left = content.patterns[1].pathLength();
  REQUIRE(lengths.size() == 4);
  CHECK(lengths[0] == Approx(0.05 + 0.02));
  CHECK(lengths[1] == Approx(0.05 + left + 0.02));
  CHECK(lengths[2] == Approx(0.05 + 0.02));
  CHECK(lengths[3] == Approx(0.9 + 0.02));
  content.patterns.erase(content.patterns.begin() + 2);  // no pattern stops any more
  for (const double length : restToRestLengths(*PatternSet::make(content, why)))
    CHECK(length == kInfinity);
}
