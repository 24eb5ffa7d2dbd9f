// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <limits>

#include <catch2/catch.hpp>

#include "tests/motor_bridge/programs.hpp"

using namespace tread;
using namespace tread::motor;

TEST_CASE("a slot within its limits has no fault, and an empty slot neither") {
  CHECK(checkSlot(makeSlot(1, 20), {}) == SlotFault::kNone);
  CHECK(checkSlot(ProgramSlot{}, {}) == SlotFault::kNone);
}

TEST_CASE("full power passes although 32-bit floats may round it up") {
  ProgramSlot slot = makeSlot(1, 20, 1.0, -1.0);
  slot.series[3][0] = std::nextafter(1.0F, 2.0F);
  CHECK(checkSlot(slot, {}) == SlotFault::kNone);
}

TEST_CASE("every fault of a slot is found and named") {
  ProgramSlot slot = makeSlot(5, 20);
  SlotFault expected = SlotFault::kNone;
  SECTION("negative id") {
    slot.execution_id = -5;
    expected = SlotFault::kBadId;
  }
  SECTION("no kind") {
    slot.kinds.clear();
    expected = SlotFault::kUnknownKind;
  }
  SECTION("a kind the controller is not set up for") {
    slot.kinds = kindsOf(trackChannels(CommandKind::kTrackSpeed));
    expected = SlotFault::kUnknownKind;
  }
  SECTION("a kind that does not exist") {
    slot.kinds[1] = static_cast<CommandKind>(77);
    expected = SlotFault::kUnknownKind;
  }
  SECTION("period 0") {
    slot.period_us = 0;
    expected = SlotFault::kBadPeriod;
  }
  SECTION("period not a multiple of the step") {
    slot.period_us = 55'000;
    expected = SlotFault::kBadPeriod;
  }
  SECTION("period longer than the controller's watchdog likes") {
    slot.period_us = 500'000;
    expected = SlotFault::kBadPeriod;
  }
  SECTION("no commands") {
    slot.series.clear();
    expected = SlotFault::kNoCommands;
  }
  SECTION("more than a minute") {
    slot.series.assign(1201, Command{});
    expected = SlotFault::kTooLong;
  }
  SECTION("NaN") {
    slot.series.back()[1] = std::numeric_limits<double>::quiet_NaN();
    expected = SlotFault::kNotFinite;
  }
  SECTION("infinity") {
    slot.series.front()[0] = -std::numeric_limits<double>::infinity();
    expected = SlotFault::kNotFinite;
  }
  SECTION("out of range") {
    slot.series[10][1] = -1.01;
    expected = SlotFault::kOutOfRange;
  }
  CHECK(expected != SlotFault::kNone);
  CHECK(checkSlot(slot, {}) == expected);
  CHECK_FALSE(std::string(describe(expected)).empty());
}
