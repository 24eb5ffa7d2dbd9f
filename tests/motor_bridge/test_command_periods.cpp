// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "modules/motor_bridge/core/command_periods.hpp"

using tread::motor::CommandPeriods;

TEST_CASE("the periods of the command stream: least, median and longest of the newest") {
  CommandPeriods periods;
  CHECK(periods.summary().median == 0);
  int64_t now = 1'000'000;
  periods.sent(now);
  CHECK(periods.summary().longest == 0);
  for (const int64_t period : {20'000, 19'000, 20'000, 31'000, 20'500}) periods.sent(now += period);
  CHECK(periods.summary().least == 19'000);
  CHECK(periods.summary().median == 20'000);
  CHECK(periods.summary().longest == 31'000);
  for (int i = 0; i < 600; ++i) periods.sent(now += 20'000);
  CHECK(periods.summary().longest == 20'000);
}
