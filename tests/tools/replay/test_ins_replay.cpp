// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "tests/ins_driver/nmea_lines.hpp"
#include "tools/replay/sensor_replay.hpp"

using namespace tread;
using namespace tread::ins;

TEST_CASE("rst39.log through the real node: 152 sentences in, 152 decoded, 116 poses") {
  const auto log = recording("ins/nmea/rst39.log");
  if (!log) {
    WARN("skipped: rst39.log is not here (TREAD_RECORDINGS)");
    return;
  }
  const InsReplay replay = replayIns(*log, {});
  WARN(reportOf(replay));
  CHECK(replay.counts.sentences == 152);
  CHECK(replay.counts.decoded == 152);
  CHECK(replay.counts.refused.total() == 0);
  // 40 fixes at 10 Hz; attitudes at 25 Hz between them, with the position carried.
  CHECK(replay.poses == 116);
  CHECK(replay.poses - replay.epochs.positions_carried == 40);
  REQUIRE(replay.track.size() == 117);
  for (size_t i = 1; i < replay.track.size(); ++i) {
    const int64_t interval = replay.track[i].utime - replay.track[i - 1].utime;
    CHECK(interval > 0);
    CHECK(interval <= 100'000);
    CHECK((replay.track[i].ins_status & (ins_t::STATUS_GAP | ins_t::STATUS_JUMP)) == 0);
  }
  REQUIRE(replay.last_pose);
  CHECK(replay.last_pose->position[0] == Approx(15.255).margin(0.01));
  CHECK(replay.last_pose->position[1] == Approx(8.909).margin(0.01));
  CHECK(replay.last_pose->device_utc == 1392842496000000);
}

TEST_CASE("hemi.log through the real node: 753 sentences in, a heading four times") {
  const auto log = recording("ins/nmea/hemi.log");
  if (!log) {
    WARN("skipped: hemi.log is not here (TREAD_RECORDINGS)");
    return;
  }
  const InsReplay replay = replayIns(*log, {});
  WARN(reportOf(replay));
  CHECK(replay.counts.sentences == 753);
  CHECK(replay.counts.decoded == 753);
  CHECK(replay.poses == 4);
}

TEST_CASE("a log that is no log is reported, not crashed upon") {
  CHECK(replayIns("", {}).track.empty());
  const InsReplay garbage = replayIns(std::string(300'000, 'x'), {});
  CHECK(garbage.counts.stray_bytes == 300'000);
  CHECK(garbage.track.empty());
  CHECK_THROWS_WITH(replayInsFile("/no/such/file.log", {}), Catch::Contains("/no/such/file.log"));
}
