// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "common/config/config_reader.hpp"
#include "common/pattern/pattern_file.hpp"
#include "tests/common/pattern/pattern_samples.hpp"

namespace tread {
namespace {

using testing::threeChannels;

PatternSet checkedSet(PatternSetContent content) {
  std::string why;
  auto set = PatternSet::make(std::move(content), why);
  INFO(why);
  REQUIRE(set.has_value());
  return *set;
}

}  // namespace

TEST_CASE("a set with three channels comes back from its file as it was") {
  const PatternSet set = checkedSet(threeChannels());
  const std::string text = formatPatterns(set);
  CHECK(text.find("- {name: steering, kind: steering_angle, lowest: -0.4, highest: 0.4}") !=
        std::string::npos);
  CHECK(text.find("- [0.25, 0.25, -0.2, 1]") != std::string::npos);
  const PatternSet read = parsePatterns(text, "three.yaml");
  CHECK(read.content().channels == set.content().channels);
  CHECK(read.checksum() == set.checksum());
  CHECK(formatPatterns(read) == text);
}

TEST_CASE("a car's rear wheels run ahead of each other by the angle, wheelbase and gauge") {
  const TrackCommand wheels = rearWheels(2.0, std::atan(0.5), 1.0, 0.8);
  CHECK(wheels.left == Approx(1.6));
  CHECK(wheels.right == Approx(2.4));
  CHECK(rearWheels(-1.0, 0.0, 1.0, 0.8) == TrackCommand{-1.0, -1.0});
  CHECK(describe(carChannels(CommandKind::kPower)).find("throttle") == 0);
  CHECK_FALSE(kindOfTracks(carChannels(CommandKind::kPower)));
}

TEST_CASE("a set of two tracks names its kind only, as it always did") {
  const std::string text = formatPatterns(checkedSet(testing::goodContent()));
  CHECK(text.find("kind: power\n") != std::string::npos);
  CHECK(text.find("channels") == std::string::npos);
}

TEST_CASE("each channel has its own range, and beyond the last channel all is 0") {
  const std::vector<std::pair<std::string, std::function<void(PatternSetContent&)>>> changes = {
      {"throttle command -0.6; allowed is -0.5 to 1",
       [](auto& c) { c.patterns[0].commands[0][0] = -0.6; }},
      {"steering command 0.5 rad; allowed is -0.4 to 0.4 rad",
       [](auto& c) { c.patterns[1].commands[2][1] = 0.5; }},
      {"steady rear steering command 0.3 rad", [](auto& c) { c.classes[0].steady[2] = 0.3; }},
      {"beyond the last channel", [](auto& c) { c.patterns[0].commands[0][3] = 0.1; }},
      {"0 command channels; allowed are 1 to 8", [](auto& c) { c.channels.clear(); }},
      {"9 command channels", [](auto& c) { c.channels.resize(9); }},
      {"a name of its own", [](auto& c) { c.channels[2].name = "steering"; }},
      {"a range holds 0", [](auto& c) { c.channels[0].lowest = 0.2; }},
      {"lies within +-1.2 rad", [](auto& c) { c.channels[1].highest = 1.3; }},
      {"667 commands of 3 channels; allowed are 2000 numbers",
       [](auto& c) { c.patterns[2].commands.resize(667); }},
      {"unknown command kind", [](auto& c) { c.channels[1].kind = CommandKind{7}; }}};
  for (const auto& [says, change] : changes) {
    PatternSetContent content = threeChannels();
    change(content);
    std::string why;
    CHECK_FALSE(PatternSet::make(std::move(content), why));
    INFO(why);
    CHECK(why.find(says) != std::string::npos);
  }
}

TEST_CASE("name, kind, range and value of each channel are in the checksum") {
  const int64_t checksum = checkedSet(threeChannels()).checksum();
  const std::vector<std::function<void(PatternSetContent&)>> changes = {
      [](auto& c) { c.channels[2].name = "tail"; },
      [](auto& c) { c.channels[0].kind = CommandKind::kTrackSpeed; },
      [](auto& c) { c.channels[0].highest = 0.9; },
      [](auto& c) { c.channels[1].lowest = -0.41; },
      [](auto& c) { c.patterns[0].commands[1][2] = 0.1; },
      [](auto& c) { c.classes[1].steady[2] = 0.1; }};
  for (const auto& change : changes) {
    PatternSetContent content = threeChannels();
    change(content);
    CHECK(checkedSet(content).checksum() != checksum);
  }
}

TEST_CASE("a file with more than eight channels or a row of another length is refused by line") {
  std::string text = formatPatterns(checkedSet(threeChannels()));
  const std::string row = "[0, 0.375, -0.2, 1]";
  const size_t at = text.find(row);
  REQUIRE(at != std::string::npos);
  std::string shorter = text;
  shorter.replace(at, row.size(), "[0, 0.375, 1]");
  CHECK_THROWS_AS(parsePatterns(shorter, "short.yaml"), ConfigError);
  const size_t list = text.find("channels:\n") + 10;
  for (int i = 0; i < 6; ++i)
    text.insert(list, "  - {name: more" + std::to_string(i) + ", kind: power}\n");
  CHECK_THROWS_WITH(parsePatterns(text, "long.yaml"),
                    Catch::Contains("9 channels; allowed are up to 8"));
}

}  // namespace tread
