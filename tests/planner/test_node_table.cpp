// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <random>
#include <unordered_map>
#include <utility>

#include "modules/planner/core/search/search_containers.hpp"
#include "tests/helpers.hpp"

using namespace tread::planner;

namespace {

constexpr uint64_t kKeyBits = (uint64_t{1} << 56U) - 1;

using KnownNodes = std::unordered_map<uint64_t, std::pair<float, int>>;

/// Queries a key and compares with the known values; then stores a new value.
void visit(NodeTable& table, KnownNodes& known, uint64_t key, int number) {
  NodeTable::Entry& slot = table[key];
  const auto found = known.find(key);
  if (found == known.end()) {
    REQUIRE(slot.node == -1);
    REQUIRE(slot.cost == 0.0F);
  } else {
    REQUIRE(slot.node == found->second.second);
    REQUIRE(slot.cost == found->second.first);
  }
  slot.node = number;
  slot.cost = 0.25F * static_cast<float>(number);
  known[key] = {slot.cost, slot.node};
}

/// Keys as in a search: neighbours in x, y, heading and class.
uint64_t cellKey(std::mt19937_64& random, int spread) {
  const auto draw = [&random](int count) {
    return static_cast<uint64_t>(std::uniform_int_distribution<int>(0, count - 1)(random));
  };
  const auto around = [&](int count) {  // negative cells wrap to 20 bits
    return (draw(count) - static_cast<uint64_t>(count / 2)) & 0xFFFFFU;
  };
  return around(spread) | around(spread) << 20U | draw(72) << 40U | draw(3) << 48U;
}

}  // namespace

TEST_CASE("a table holds what was put in, however large it has to grow") {
  std::mt19937_64 random(1);
  NodeTable table;
  KnownNodes known;
  const size_t small = table.bytes();
  const int count = tread::testing::effort(200'000);
  for (int i = 0; i < count; ++i) {
    const uint64_t key = i % 2 == 0 ? cellKey(random, 200) : random() & kKeyBits;
    if (i % 7 == 0) table.prefetch(key);
    visit(table, known, key, i);
  }
  for (const auto& [key, value] : known) {
    REQUIRE(table[key].node == value.second);
    REQUIRE(table[key].cost == value.first);
  }
  CHECK(table.bytes() > small);
  CHECK(table.bytes() >= known.size() * sizeof(NodeTable::Entry));
  CHECK(table.bytes() <= 8 * known.size() * sizeof(NodeTable::Entry));
}

TEST_CASE("what was cleared never comes back, also after many more clears than a byte counts") {
  std::mt19937_64 random(2);
  NodeTable table;
  for (int round = 0; round < 600; ++round) {
    KnownNodes known;
    // In most rounds few repeated keys: slots keep the content of earlier rounds.
    const int count = round % 50 == 0 ? 3000 : 30;
    for (int i = 0; i < count; ++i) visit(table, known, cellKey(random, 6), round * 10'000 + i);
    for (const auto& [key, value] : known) REQUIRE(table[key].node == value.second);
    table.clear();
  }
}

TEST_CASE("the least and the greatest key are keys like any other") {
  NodeTable table;
  for (int round = 0; round < 300; ++round) {
    KnownNodes known;
    for (const uint64_t key : {uint64_t{0}, kKeyBits, uint64_t{1}, kKeyBits, uint64_t{0}})
      visit(table, known, key, round);
    table.clear();
  }
}

TEST_CASE("a cleared table needs no more room than it had") {
  std::mt19937_64 random(3);
  NodeTable table;
  for (int i = 0; i < 5000; ++i) table[random() & kKeyBits].node = i;
  const size_t before = table.bytes();
  for (int round = 0; round < 20; ++round) {
    table.clear();
    for (int i = 0; i < 5000; ++i) table[random() & kKeyBits].node = i;
  }
  CHECK(table.bytes() == before);
}
