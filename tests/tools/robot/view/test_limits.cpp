// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "tools/robot/view/limits.hpp"

using namespace tread::view;

TEST_CASE("viewers who want all of the processor get 12 % of a core, and wait .25 s at most") {
  Limits limits;
  double used = 0.0, waits = 0.0, longest = 0.0;
  constexpr double kStep = 0.002;
  for (int i = 0; i < 50'000; ++i) {
    limits.wait(kStep);
    waits = limits.mayCompute() ? 0.0 : waits + kStep;
    longest = std::max(longest, waits);
    if (!limits.mayCompute()) continue;
    CHECK(limits.sends() > 0.0);
    limits.computed(0.001);
    used += 0.001;
  }
  CHECK(used < 100 * 0.12 + 0.1);
  CHECK(used > 100 * 0.12 - 0.1);
  CHECK(longest < 0.02);
  // One that is far too long.
  limits.computed(10.0);
  CHECK_FALSE(limits.mayCompute());
  CHECK_FALSE(limits.mayAccept());
  CHECK(limits.sends() <= 0.0);
  double waited = 0.0;
  for (; !limits.mayCompute(); waited += kStep) limits.wait(kStep);
  CHECK(waited > 0.2);
  CHECK(waited < 0.27);
}

TEST_CASE("newcomers are taken a hundred at once and 50 a second") {
  Limits limits;
  int taken = 0;
  const auto takeAll = [&] {
    for (; limits.mayAccept(); ++taken) limits.accepted();
  };
  takeAll();
  CHECK(taken == 100);
  for (int i = 0; i < 1000; ++i) {
    limits.wait(0.01);
    takeAll();
  }
  CHECK(taken == Approx(600).margin(2));
}
