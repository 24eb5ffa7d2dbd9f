// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/common/pattern/pattern_samples.hpp"

using namespace tread;
using tread::testing::goodContent;

namespace {

int64_t checksumOf(const PatternSetContent& content) {
  std::string why;
  const auto set = PatternSet::make(content, why);
  INFO(why);
  REQUIRE(set.has_value());
  return set->checksum();
}

}  // namespace

TEST_CASE("Every field but utime changes the checksum") {
  const std::vector<std::function<void(PatternSetContent&)>> changes{
      [](auto&) {},
      [](auto& c) { c.name = "other"; },
      [](auto& c) { c.version = 8; },
      [](auto& c) { c.parent_version = 5; },
      [](auto& c) { c.channels = trackChannels(CommandKind::kTrackSpeed); },
      [](auto& c) { c.period_us = 40'000; },
      [](auto& c) { c.classes[1].twist.v_x = std::nextafter(1.0, 2.0); },
      [](auto& c) { c.classes[1].twist.v_y = 0.1; },
      [](auto& c) { c.classes[1].twist.omega = 0.1; },
      [](auto& c) { c.classes[1].steady[0] = 0.9; },
      [](auto& c) { c.classes[1].steady[1] = 0.9; },
      [](auto& c) { c.patterns[0].id = 11; },
      [](auto& c) { c.patterns[0].name = "go"; },
      [](auto& c) { c.patterns[1].entry_class = "rest"; },
      [](auto& c) { c.patterns[1].exit_class = "rest"; },
      [](auto& c) { c.patterns[1].commands[0][0] = 0.81; },
      [](auto& c) { c.patterns[1].commands[0][1] = 0.81; },
      [](auto& c) { c.patterns[1].trajectory[1].x = 0.101; },
      [](auto& c) { c.patterns[1].trajectory[1].y = 0.101; },
      [](auto& c) { c.patterns[1].trajectory[1].yaw = 0.101; },
      [](auto& c) { c.patterns[1].end_covariance[0] = 2e-4; },
      [](auto& c) { c.patterns[1].end_covariance[5] = 2e-4; },
      [](auto& c) { c.patterns[1].end_covariance = kUnknownCovariance; },
      [](auto& c) { c.patterns[1].times_learned = 4; },
      [](auto& c) { std::swap(c.patterns[0], c.patterns[1]); },
      [](auto& c) { c.patterns.pop_back(); },
  };
  std::set<int64_t> checksums;
  for (const auto& change : changes) {
    PatternSetContent content = goodContent();
    change(content);
    checksums.insert(checksumOf(content));
  }
  CHECK(checksums.size() == changes.size());
  CHECK(*checksums.begin() >= 0);
}

TEST_CASE("Order of the classes, kind of NaN and the time stamp do not change the checksum") {
  const int64_t plain = checksumOf(goodContent());
  PatternSetContent content = goodContent();
  std::swap(content.classes[0], content.classes[1]);
  content.utime = 5;
  for (double& value : content.patterns[0].end_covariance)
    value = -std::numeric_limits<double>::quiet_NaN();
  CHECK(checksumOf(content) == plain);
}

TEST_CASE("The checksum is the same on every machine") {
  CHECK(checksumOf(goodContent()) == 1690195404365221817);
}
