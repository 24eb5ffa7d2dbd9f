// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cstring>
#include <random>

#include <catch2/catch.hpp>

#include "common/config/scalars.hpp"

namespace tread {

TEST_CASE("a formatted number parses to the same bits") {
  std::mt19937_64 random(7);
  for (int i = 0; i < 20000; ++i) {
    const uint64_t bits = random();
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof value);
    if (!(value - value == 0.0)) continue;
    const auto parsed = parseNumber(formatNumber(value));
    REQUIRE(parsed);
    REQUIRE(std::memcmp(&*parsed, &value, sizeof value) == 0);
  }
}

TEST_CASE("decimal notation is a number, anything else is not") {
  for (const char* good : {"0", "-0", "12", "0.5", "-3.25e-4", "1E5", "5.", "1e+3", ".65", "-.5e2"})
    CHECK(parseNumber(good));
  for (const char* bad :
       {"", "-", ".", "-.", ".e1", "e5", "1e", "1e+", "00", "-01", "01.5", "1 ", " 1", "1f"})
    CHECK_FALSE(parseNumber(bad));
}

TEST_CASE("an integer is read up to the ends of int64") {
  CHECK(parseInteger("9223372036854775807") == INT64_MAX);
  CHECK(parseInteger("-9223372036854775808") == INT64_MIN);
  CHECK_FALSE(parseInteger("9223372036854775808"));
}

TEST_CASE("the nearest spelling is found for a slip and not for another word") {
  const std::vector<std::string> known{"lease", "period", "max_gap"};
  CHECK(nearestSpelling("laese", known) == std::string("lease"));
  CHECK(nearestSpelling("maxgap", known) == std::string("max_gap"));
  CHECK(nearestSpelling("periods", known) == std::string("period"));
  CHECK_FALSE(nearestSpelling("velocity", known));
  CHECK_FALSE(nearestSpelling("velocity", {}));
}

}  // namespace tread
