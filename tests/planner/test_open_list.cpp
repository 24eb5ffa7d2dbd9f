// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <limits>
#include <map>
#include <random>
#include <utility>

#include "modules/planner/core/search/search_containers.hpp"
#include "tests/helpers.hpp"

using namespace tread::planner;

namespace {

using KnownKeys = std::multimap<float, std::pair<int, float>>;

/// Largest ratio of a bucket's estimates to the least one [1].
constexpr float kBucket = 1.0F + 1.0F / 2048.0F;

/// Takes one and looks it up: its estimate must be nearly the least.
void takeOne(OpenList& open, KnownKeys& known, float least) {
  const OpenList::Entry entry = open.take();
  const float limit = std::max(least, known.begin()->first) * kBucket;
  for (auto it = known.begin(); it != known.end() && it->first <= limit; ++it) {
    if (it->second != std::make_pair(entry.node, entry.cost)) continue;
    known.erase(it);
    return;
  }
  FAIL("node " << entry.node << " is unknown, or was taken before its turn");
}

void playAtRandom(std::mt19937_64& random, OpenList& open, float least, double spread) {
  std::lognormal_distribution<float> estimate(0.0F, static_cast<float>(spread));
  std::uniform_int_distribution<int> chance(0, 99);
  KnownKeys known;
  open.clear(least);
  int node = 0;
  for (int i = 0; i < 3000; ++i) {
    const bool more = (i / 500) % 2 == 0;  // it grows and shrinks alternately
    if (known.empty() || chance(random) < (more ? 70 : 30)) {
      const float value = chance(random) == 0 ? 0.0F : estimate(random);
      const auto cost = static_cast<float>(chance(random));
      open.push(value, node, cost);
      known.emplace(value, std::make_pair(node, cost));
      ++node;
    } else {
      REQUIRE_FALSE(open.empty());
      takeOne(open, known, least);
    }
    REQUIRE(open.empty() == known.empty());
  }
  while (!known.empty()) {
    REQUIRE_FALSE(open.empty());
    takeOne(open, known, least);
  }
  REQUIRE(open.empty());
}

}  // namespace

TEST_CASE("of all that waits the least comes first, to a 2048th, and nothing is lost or invented") {
  std::mt19937_64 random(1);
  OpenList open;  // the same object: cleared entries must not return
  for (int i = 0; i < tread::testing::effort(20); ++i) {
    playAtRandom(random, open, 1e-3F, 0.5);
    playAtRandom(random, open, 0.7F, 0.01);
    playAtRandom(random, open, 5.0F, 3.0);
  }
}

TEST_CASE("among equals the newest comes first") {
  OpenList open;
  open.clear(1.0F);
  for (int i = 0; i < 10; ++i) open.push(3.0F, i, 0.0F);
  for (int i = 9; i >= 0; --i) {
    REQUIRE_FALSE(open.empty());
    CHECK(open.take().node == i);
  }
  CHECK(open.empty());
}

TEST_CASE("what is less than a bucket's width apart may share one, what is more never does") {
  for (const float base : {1e-3F, 0.37F, 1.0F, 777.0F}) {
    OpenList open;
    open.clear(base / 2.0F);
    open.push(base, 1, 0.0F);
    open.push(base * (1.0F + 1.1F / 2048.0F), 2, 0.0F);
    CHECK(!open.empty());
    CHECK(open.take().node == 1);
    CHECK(!open.empty());
    CHECK(open.take().node == 2);
  }
}

TEST_CASE("a smaller estimate than was taken before is taken next") {
  OpenList open;
  open.clear(1.0F);
  open.push(9.0F, 1, 0.0F);
  open.push(10.0F, 2, 0.0F);
  REQUIRE_FALSE(open.empty());
  CHECK(open.take().node == 1);
  open.push(2.0F, 3, 0.0F);
  REQUIRE_FALSE(open.empty());
  CHECK(open.take().node == 3);
  REQUIRE_FALSE(open.empty());
  CHECK(open.take().node == 2);
  CHECK(open.empty());
}

TEST_CASE("estimates below the least, none at all and endless ones keep their places") {
  OpenList open;
  open.clear(0.0F);
  open.push(std::numeric_limits<float>::infinity(), 3, 0.0F);
  open.push(1.0F, 2, 0.0F);
  open.push(0.0F, 1, 0.0F);
  for (const int node : {1, 2, 3}) {
    REQUIRE_FALSE(open.empty());
    CHECK(open.take().node == node);
  }
  CHECK(open.empty());
}

TEST_CASE("a list that stays short stays small, however often it is used") {
  OpenList open;
  open.clear(1.0F);
  for (int i = 0; i < 10; ++i) open.push(1.0F + static_cast<float>(i), i, 0.0F);
  const size_t before = open.bytes();
  for (int i = 0; i < 10'000; ++i) {
    REQUIRE_FALSE(open.empty());
    const OpenList::Entry entry = open.take();
    open.push(1.0F + static_cast<float>(i % 10), entry.node, 0.0F);
  }
  CHECK(open.bytes() == before);
}
