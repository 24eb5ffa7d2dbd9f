// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "modules/motor_bridge/core/series_player.hpp"
#include "tests/motor_bridge/programs.hpp"

using namespace tread;
using namespace tread::motor;

namespace {

constexpr int64_t kStart = 5'000'000;

/// A player that started execution 1 (4 commands of 50 ms) at kStart, with this next slot.
SeriesPlayer playing(const ProgramSlot& next = {}) {
  SeriesPlayer player;
  player.beginRun(1);
  REQUIRE(player.offer(makeProgram(kStart, makeSlot(1, 4), next), kStart) == Offer::kAccepted);
  player.start(kStart);
  return player;
}

}  // namespace

TEST_CASE("each command is held for one period, to the microsecond") {
  SeriesPlayer player;
  player.beginRun(1);
  ProgramSlot slot = makeSlot(1, 4);
  for (size_t i = 0; i < 4; ++i) slot.series[i][0] = 0.1 * static_cast<double>(i + 1);
  player.offer(makeProgram(kStart, slot), kStart);
  player.start(kStart);
  for (int64_t t = 0; t < 200'000; t += 1'000) {
    CHECK_FALSE(player.advance(kStart + t).ended);
    CHECK(player.give() == slot.series[static_cast<size_t>(t / 50'000)]);
  }
  CHECK(player.advance(kStart + 200'000).ended);
  CHECK_FALSE(player.playing());
}

TEST_CASE("the next slot begins at the scheduled time even if the step is late") {
  SeriesPlayer player = playing(makeSlot(2, 4));
  player.advance(kStart + 190'000);
  const SeriesPlayer::Advance advance = player.advance(kStart + 207'000);
  CHECK(advance.switched);
  CHECK_FALSE(advance.ended);
  CHECK(player.current().execution_id == 2);
  CHECK(player.log().records()[0].ended == kStart + 200'000);
  CHECK(player.log().records()[1].started == kStart + 200'000);
}

TEST_CASE("a chain of 1000 series does not drift, with steps that are always late") {
  SeriesPlayer player = playing(makeSlot(2, 4));
  int64_t next_id = 2;
  for (int64_t t = kStart; next_id <= 1000; t += 10'007) {
    if (player.advance(t).switched) {
      ++next_id;
      player.offer(makeProgram(t, makeSlot(next_id - 1, 4), makeSlot(next_id, 4)), t);
    }
    REQUIRE(player.playing());
    player.give();
  }
  const ExecutionRecord& last = player.log().records().back();
  CHECK(last.started == kStart + (last.execution_id - 1) * 200'000);
}

TEST_CASE("the log keeps the last eight executions with their times and outcome") {
  SeriesPlayer player = playing(makeSlot(2, 4));
  for (int64_t id = 2; id <= 12; ++id) {
    const int64_t t = kStart + (id - 1) * 200'000;
    player.give();
    player.advance(t);
    player.offer(makeProgram(t, makeSlot(id, 4), makeSlot(id + 1, 4)), t);
  }
  player.give();
  player.abort(kStart + 11 * 200'000 + 70'000, StopReason::kEstopEngaged);
  const auto& records = player.log().records();
  REQUIRE(records.size() == 8);
  CHECK(records.front().execution_id == 5);
  CHECK(records.front().outcome == ExecutionOutcome::kCompleted);
  CHECK(records.back().execution_id == 12);
  CHECK(records.back().pattern_id == 112);
  CHECK(records.back().set_version == 7);
  CHECK(records.back().run_id == 1);
  CHECK(records.back().outcome == ExecutionOutcome::kAborted);
  CHECK(records.back().ended == kStart + 11 * 200'000 + 70'000);
  CHECK(records.back().commands_played == 1);
  CHECK(records.back().commands_total == 4);
  CHECK(records.back().reason == Reason(StopReason::kEstopEngaged));
}

TEST_CASE("the pending slot may be replaced and withdrawn until it begins") {
  SeriesPlayer player = playing(makeSlot(2, 4));
  CHECK(player.offer(makeProgram(kStart, makeSlot(1, 4), makeSlot(3, 4)), kStart) ==
        Offer::kAccepted);
  CHECK(player.pending().execution_id == 3);
  CHECK(player.offer(makeProgram(kStart, makeSlot(1, 4)), kStart) == Offer::kAccepted);
  CHECK(player.pending().empty());
  CHECK(player.advance(kStart + 200'000).ended);
}

TEST_CASE("after the switch a program that runs the former next slot is normal") {
  SeriesPlayer player = playing(makeSlot(2, 4));
  player.advance(kStart + 200'000);
  CHECK(player.offer(makeProgram(0, makeSlot(2, 4), makeSlot(3, 4)), kStart + 210'000) ==
        Offer::kAccepted);
  CHECK(player.pending().execution_id == 3);
}

TEST_CASE("a planner a little ahead or behind of the switch is tolerated, and changes nothing") {
  SeriesPlayer player = playing(makeSlot(2, 4));
  const Program ahead = makeProgram(0, makeSlot(2, 4), makeSlot(3, 4));
  const Program behind = makeProgram(0, makeSlot(1, 4), makeSlot(2, 4));
  CHECK(player.offer(ahead, kStart + 50'000) == Offer::kRunningUnknown);
  CHECK(player.offer(ahead, kStart + 150'000) == Offer::kPlannerAhead);
  CHECK(player.pending().execution_id == 2);
  player.advance(kStart + 200'000);
  CHECK(player.offer(behind, kStart + 250'000) == Offer::kPlannerBehind);
  CHECK(player.pending().empty());
  CHECK(player.offer(behind, kStart + 310'000) == Offer::kRunningUnknown);
}

TEST_CASE("whatever does not continue what is played is refused") {
  SeriesPlayer player = playing(makeSlot(2, 4));
  CHECK(player.offer(makeProgram(0, makeSlot(9, 4)), kStart) == Offer::kRunningUnknown);
  CHECK(player.offer(makeProgram(0, makeSlot(1, 4, 0.6)), kStart) == Offer::kRunningAltered);
  CHECK(player.offer(makeProgram(0, makeSlot(1, 5)), kStart) == Offer::kRunningAltered);
  CHECK(player.offer(makeProgram(0, makeSlot(1, 4), makeSlot(1, 4)), kStart) ==
        Offer::kNextOutOfOrder);
  CHECK(player.pending().execution_id == 2);
  CHECK(player.current().execution_id == 1);
}

TEST_CASE("an idle player starts only executions above the last one, once") {
  SeriesPlayer player = playing();
  player.advance(kStart + 200'000);
  CHECK(player.offer(makeProgram(0, makeSlot(1, 4), makeSlot(2, 4)), kStart + 200'000) ==
        Offer::kAlreadyExecuted);
  CHECK_FALSE(player.startable());
  CHECK(player.offer(makeProgram(0, makeSlot(2, 4)), kStart + 200'000) == Offer::kAccepted);
  CHECK(player.startable());
  player.dropCandidate();
  CHECK_FALSE(player.startable());
}

TEST_CASE(
    "an aborted execution is not played again, in this run and after a visit of another run") {
  SeriesPlayer player = playing();
  player.abort(kStart + 10'000, StopReason::kInsStale);
  CHECK(player.offer(makeProgram(0, makeSlot(1, 4)), kStart) == Offer::kAlreadyExecuted);
  player.beginRun(2);
  CHECK(player.offer(makeProgram(0, makeSlot(1, 4)), kStart) == Offer::kAccepted);
  player.beginRun(1);
  CHECK(player.offer(makeProgram(0, makeSlot(1, 4)), kStart) == Offer::kAlreadyExecuted);
}

TEST_CASE("an empty running slot is the planner's stop") {
  SeriesPlayer player = playing();
  CHECK(player.offer(makeProgram(0, ProgramSlot{}), kStart) == Offer::kStop);
}

TEST_CASE("commands whose period passed between two steps are counted as skipped, not as played") {
  SeriesPlayer player = playing(makeSlot(2, 4));
  player.give();
  CHECK(player.advance(kStart + 120'000).skipped == 1);
  player.give();
  CHECK(player.advance(kStart + 260'000).skipped == 2);
  player.give();
  CHECK(player.log().records()[0].commands_played == 2);
  CHECK(player.log().records()[0].outcome == ExecutionOutcome::kCompleted);
  CHECK(player.log().records()[1].commands_played == 1);
}
