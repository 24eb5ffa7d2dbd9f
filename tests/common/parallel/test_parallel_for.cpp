// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/parallel/parallel_for.hpp"

#include <atomic>
#include <stdexcept>
#include <vector>

#include <catch2/catch.hpp>

using namespace tread;

TEST_CASE("every call is made once, with any number of threads") {
  const int threads = GENERATE(-1, 1, 3, 64);
  std::vector<int> calls(20);
  onThreads(threads)(calls.size(), [&](size_t i) { ++calls[i]; });
  CHECK(calls == std::vector<int>(20, 1));
  onThreads(threads)(0, [](size_t) { FAIL("nothing was to be done"); });
}

TEST_CASE("after a call fails no more are handed out, and the caller gets its reason") {
  std::atomic<int> calls{0};
  const auto body = [&](size_t i) {
    ++calls;
    if (i == 7) throw std::runtime_error("seven");
  };
  CHECK_THROWS_WITH(onThreads(1)(20, body), "seven");
  CHECK(calls == 8);
  calls = 0;
  CHECK_THROWS_WITH(onThreads(3)(1'000'000'000, body), "seven");
  CHECK(calls < 100'000'000);
}
