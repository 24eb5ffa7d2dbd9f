// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Queueing delays of messages, from logs with known times.
#include <catch2/catch.hpp>

#include <cmath>

#include "tests/tools/robot/report/invented_drive.hpp"
#include "tools/robot/report/drive_report.hpp"

using namespace tread;
using namespace tread::report;
using namespace tread::samples;

namespace {

/// A message as received by the logger, some milliseconds after its own time.
template <class Message>
LogEvent received(const Channel<Message>& channel, const Message& message, int64_t late_ms = 0) {
  LogEvent event = eventOf(channel, message);
  event.utime += late_ms * 1000;
  return event;
}

pattern_set_part_t partAt(double seconds, int64_t version, int part, int count) {
  auto message = blank<pattern_set_part_t>();
  message.utime = std::llround(seconds * 1e6);
  message.set_version = version;
  message.part = part;
  message.part_count = count;
  return message;
}

learning_t learnedAt(double seconds, int64_t version, bool changed = true) {
  learning_t learning = learningAt(seconds, true, 0.1, 0.1);
  learning.changed = changed;
  learning.result_version = version;
  return learning;
}

scan_t scanAt(double seconds) {
  auto scan = blank<scan_t>();
  scan.utime = std::llround(seconds * 1e6);
  return scan;
}

map_tile_t tileAt(double seconds) {
  auto tile = blank<map_tile_t>();
  tile.utime = std::llround(seconds * 1e6);
  return tile;
}

}  // namespace

TEST_CASE("a quantile is the value that a share does not exceed, and not a number of nothing") {
  Durations durations;
  CHECK(std::isnan(durations.quantile(0.5)));
  for (const double value : {7.0, 1.0, 3.0, 9.0, 5.0, 2.0, 8.0, 4.0, 10.0, 6.0})
    durations.add(value);
  CHECK(durations.count() == 10);
  CHECK(durations.quantile(0.0) == 1.0);
  CHECK(durations.quantile(0.1) == 1.0);
  CHECK(durations.quantile(0.5) == 5.0);
  CHECK(durations.quantile(0.51) == 6.0);
  CHECK(durations.quantile(0.99) == 10.0);
  CHECK(durations.quantile(1.0) == 10.0);
}

TEST_CASE("INS to set runs from the INS that passes the execution's end to the set's first part") {
  Latencies latencies;
  latencies.add(received(kIns, insAt(1.98, 0.0), 3));
  latencies.add(received(kIns, insAt(2.02, 0.0), 4));  // the first one after the end at 2 s
  latencies.add(received(kIns, insAt(2.04, 0.0), 3));
  SECTION("LEARNING comes before the set") {
    latencies.add(received(kLearning, learnedAt(2.0, 5), 30));
    latencies.add(received(kPatternSet, partAt(2.05, 5, 0, 2)));
  }
  SECTION("LEARNING comes after it") {
    latencies.add(received(kPatternSet, partAt(2.05, 5, 0, 2)));
    latencies.add(received(kLearning, learnedAt(2.0, 5), 60));
  }
  latencies.add(received(kPatternSet, partAt(2.06, 5, 1, 2)));
  latencies.add(received(kPatternSet, partAt(4.05, 5, 0, 2)));  // a repetition, no second time
  REQUIRE(latencies.insToSet().count() == 1);
  CHECK(latencies.insToSet().quantile(0.5) == Approx(26.0));
}

TEST_CASE("an execution that taught nothing has no latency") {
  Latencies latencies;
  latencies.add(received(kIns, insAt(2.0, 0.0)));
  latencies.add(received(kLearning, learnedAt(1.9, 5, false)));
  latencies.add(received(kPatternSet, partAt(2.1, 5, 0, 1)));
  CHECK(latencies.insToSet().count() == 0);
}

TEST_CASE("what was received at a time that the log has lost has no latency") {
  for (const bool of_ins : {true, false}) {
    Latencies latencies;
    latencies.add(received(kIns, insAt(2.02, 0.0)), of_ins);
    latencies.add(received(kLearning, learnedAt(2.0, 5)));
    latencies.add(received(kPatternSet, partAt(2.05, 5, 0, 1)), !of_ins);
    CHECK(latencies.insToSet().count() == 0);
  }
}

TEST_CASE("set to plan runs from the last part to the first plan with it, the first set left out") {
  Latencies latencies;
  latencies.add(received(kPatternSet, partAt(1.0, 1, 0, 1)));
  latencies.add(received(kPlan, planAt(1.5, plan_t::PLAN_DRIVING, "", 1)));
  CHECK(latencies.setToPlan().count() == 0);
  latencies.add(received(kPatternSet, partAt(2.00, 2, 0, 2)));
  latencies.add(received(kPlan, planAt(2.01, plan_t::PLAN_DRIVING, "", 2)));
  CHECK(latencies.setToPlan().count() == 0);  // not complete yet
  latencies.add(received(kPatternSet, partAt(2.02, 2, 1, 2)));
  latencies.add(received(kPlan, planAt(2.03, plan_t::PLAN_DRIVING, "", 1)));
  latencies.add(received(kPlan, planAt(2.10, plan_t::PLAN_DRIVING, "", 2)));
  latencies.add(received(kPlan, planAt(2.30, plan_t::PLAN_DRIVING, "", 2)));
  REQUIRE(latencies.setToPlan().count() == 1);
  CHECK(latencies.setToPlan().quantile(0.5) == Approx(80.0));
}

TEST_CASE("a set that another one overtakes before any plan used it has no latency") {
  Latencies latencies;
  for (const int64_t version : {1, 2, 3})
    latencies.add(received(kPatternSet, partAt(static_cast<double>(version), version, 0, 1)));
  latencies.add(received(kPlan, planAt(3.2, plan_t::PLAN_DRIVING, "", 3)));
  latencies.add(received(kPlan, planAt(3.4, plan_t::PLAN_DRIVING, "", 2)));
  CHECK(latencies.setToPlan().count() == 1);
  CHECK(latencies.setToPlan().quantile(1.0) == Approx(200.0));
}

TEST_CASE("scan to tile counts every scan once, in the first tile that is as new") {
  Latencies latencies;
  latencies.add(received(kScan, scanAt(1.0), 10));
  latencies.add(received(kScan, scanAt(1.1), 10));
  latencies.add(received(kMap, tileAt(1.0), 50));
  CHECK(latencies.scanToTile().count() == 1);
  latencies.add(received(kMap, tileAt(1.1), 90));
  latencies.add(received(kMap, tileAt(1.1), 95));
  REQUIRE(latencies.scanToTile().count() == 2);
  CHECK(latencies.scanToTile().quantile(0.5) == Approx(40.0));
  CHECK(latencies.scanToTile().quantile(1.0) == Approx(80.0));
}

TEST_CASE("events that are no messages of their channel's type have no latency") {
  Latencies latencies;
  latencies.add({1'000'000, kScan.name, {1, 2, 3}});
  latencies.add({1'000'000, "NOISE", {}});
  latencies.add(received(kMap, tileAt(2.0)));
  CHECK(latencies.scanToTile().count() == 0);
}
