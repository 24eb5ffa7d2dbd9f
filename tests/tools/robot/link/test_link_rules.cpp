// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "common/log/event_log.hpp"
#include "common/messages/blank.hpp"
#include "tools/robot/link/link_rules.hpp"

using namespace tread;
using namespace tread::link;

namespace {

map_tile_t tile(int x) {
  auto message = blank<map_tile_t>();
  message.tile_x = x;
  message.tile_cells = 8;
  message.cell_size = 0.1;
  message.num_cells = 64;
  message.cells.assign(64, 0);
  return message;
}

/// Number of messages that pass within a time.
template <class Message>
int passing(LinkFilter& filter, const Channel<Message>& channel, const Message& message,
            double rate, double seconds, int64_t& now) {
  int passed = 0;
  const auto bytes = encoded(message);
  for (int i = 0; i < static_cast<int>(rate * seconds); ++i) {
    now += static_cast<int64_t>(1e6 / rate);
    passed += filter.passes(channel.name, bytes, bytes.size(), now) ? 1 : 0;
  }
  return passed;
}

LinkConfig configOf(const std::string& text) {
  ConfigReader reader = ConfigReader::fromText(text, "link");
  return readLinkConfig(reader);
}

}  // namespace

TEST_CASE("a channel passes at its rate, what is not named never, and what is not limited always") {
  LinkFilter filter({{"INS", 10.0}, {"ESTOP", 0.0}}, 500.0);
  int64_t now = 1'000'000;
  CHECK(passing(filter, kIns, blank<ins_t>(), 50.0, 10.0, now) == Approx(100).margin(2));
  CHECK(passing(filter, kEstop, blank<estop_t>(), 1000.0, 1.0, now) == 1000);
  CHECK(passing(filter, kMotor, blank<motor_t>(), 20.0, 1.0, now) == 0);
  CHECK(filter.thinned() == Approx(400).margin(2));
}

TEST_CASE("what comes at the rate itself passes, also with jitter") {
  LinkFilter filter({{"INS", 10.0}}, 500.0);
  int64_t now = 1'000'000;
  CHECK(passing(filter, kIns, blank<ins_t>(), 10.3, 10.0, now) == 103);
}

TEST_CASE("each tile has its own rate, so that none starves") {
  LinkFilter filter({{"MAP", 1.0}}, 500.0);
  int64_t now = 1'000'000;
  for (int x = 0; x < 20; ++x) CHECK(passing(filter, kMap, tile(x), 5.0, 0.2, now) == 1);
}

TEST_CASE("the budget holds over time, and commands are not part of it") {
  LinkFilter filter({{"MAP", 1000.0}, {"GOAL", 0.0}}, 10.0);
  int64_t now = 1'000'000;
  const auto size = static_cast<double>(encoded(tile(0)).size());
  int passed = 0;
  for (int i = 0; i < 2000; ++i) {
    now += 5'000;
    const auto bytes = encoded(tile(i));
    passed += filter.passes("MAP", bytes, bytes.size(), now) ? 1 : 0;
  }
  CHECK(passed * size <= 10.0 * 10'000.0 + 5'000.0 + size);
  CHECK(passed * size > 0.9 * 10.0 * 10'000.0);
  CHECK(filter.over_budget() > 0);
  CHECK(passing(filter, kGoal, blank<goal_t>(), 100.0, 1.0, now) == 100);
}

TEST_CASE("a configuration that would go round for ever, or names what is not there, is refused") {
  CHECK(configOf("station_url: a\nto_station: {INS: 5}\nto_robot: {GOAL: 0}\n").to_station.size() ==
        1);
  CHECK_THROWS_WITH(configOf("station_url: a\nto_station: {INS: 5}\nto_robot: {INS: 0}\n"),
                    Catch::Contains("loop for ever"));
  CHECK_THROWS_WITH(configOf("station_url: a\nto_station: {CAMERA: 5}\nto_robot: {}\n"),
                    Catch::Contains("CAMERA"));
  CHECK_THROWS(configOf("to_station: {INS: 5}\nto_robot: {GOAL: 0}\n"));
  ConfigReader shipped =
      ConfigReader::fromFile(std::string(TREAD_SOURCE_DIR) + "/config/robots/teodor/link.yaml");
  CHECK(readLinkConfig(shipped).to_robot.size() == 7);
}
