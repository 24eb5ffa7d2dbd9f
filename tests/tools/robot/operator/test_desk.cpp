// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "common/bus/virtual_bus.hpp"
#include "common/messages/blank.hpp"
#include "tools/robot/operator/desk.hpp"

using namespace tread;
using tread::operators::OperatorDesk;

namespace {

/// A desk, and a robot that only says that it is armed.
struct Desk {
  VirtualBus bus{1};
  OperatorDesk desk{bus.outside(), "ADA", "test"};
  int arms = 0, disarms = 0, stops = 0, clears = 0, cancels = 0, goals = 0, let_go = 0;
  int64_t last_allowed = 0;
  Bus* robot = nullptr;

  /// The robot's end of the bus.
  struct Robot : Node {
    explicit Robot(Bus& end) : bus(end) {}
    int64_t period() const override { return 50'000; }
    void step(int64_t utime) override {
      auto motor = blank<motor_t>();
      motor.utime = utime;
      motor.seq = seq++;
      motor.bridge_state = motor_t::STATE_ARMED;
      motor.state_reason = "armed by ADA";
      bus.publish(kMotor, motor);
    }
    Bus& bus;
    int64_t seq = 0;
  };

  Desk() {
    bus.addNode("motor_bridge", [&](Bus& end) {
      end.subscribe<arm_t>(kArm, [this](const arm_t& arm) { ++(arm.armed ? arms : disarms); });
      end.subscribe<estop_t>(kEstop,
                             [this](const estop_t& stop) { ++(stop.engaged ? stops : clears); });
      end.subscribe<goal_t>(
          kGoal, [this](const goal_t& goal) { ++(goal.goal_id != 0 ? goals : cancels); });
      end.subscribe<operator_t>(kOperator, [this](const operator_t& person) {
        if (person.allowed == operator_t::ALLOW_DRIVING)
          last_allowed = bus.now();
        else
          ++let_go;
      });
      return std::make_unique<Robot>(end);
    });
    run(0.5, false);
  }
  void run(double seconds, bool page_lives) {
    const int64_t end = bus.now() + std::llround(1e6 * seconds);
    while (bus.now() < end) {
      bus.runUntil(bus.now() + 20'000);
      if (page_lives && bus.now() % 200'000 < 20'000) take(R"({"op":"alive"})");
      desk.step(bus.now());
    }
  }
  /// A page that shows what is now, unless the command says itself what it has seen.
  std::string take(const std::string& json, uint64_t page = 1) {
    const bool whole = json.find("\"seen\"") != std::string::npos || json.back() != '}';
    const std::string seen = ",\"seen\":" + std::to_string(bus.now()) + "}";
    return desk.take(whole ? json : json.substr(0, json.size() - 1) + seen, page, bus.now());
  }
  double silentFor() const { return static_cast<double>(bus.now() - last_allowed) * 1e-6; }
};

}  // namespace

TEST_CASE("a goal by click holds the robot for as long as the page lives") {
  Desk desk;
  REQUIRE(desk.take(R"({"op":"goal","x":3,"y":4})").empty());
  desk.run(3.0, true);
  CHECK(desk.goals >= 3);
  CHECK(desk.silentFor() < 0.3);
  desk.run(2.0, false);
  CHECK(desk.silentFor() > 1.0);
  CHECK(desk.let_go > 0);
  CHECK(desk.cancels > 0);
  CHECK_THAT(desk.desk.words(), Catch::Contains("the page is silent"));
}

TEST_CASE("a goal that is cancelled leaves the robot armed and held") {
  Desk desk;
  REQUIRE(desk.take(R"({"op":"arm"})").empty());
  desk.run(1.0, true);
  REQUIRE(desk.take(R"({"op":"goal","x":3,"y":4})").empty());
  desk.run(1.0, true);
  REQUIRE(desk.take(R"({"op":"cancel"})").empty());
  desk.run(2.0, true);
  CHECK(desk.cancels > 0);
  CHECK(desk.disarms == 0);
  CHECK(desk.silentFor() < 0.3);
  REQUIRE(desk.take(R"({"op":"disarm"})").empty());
  desk.run(0.5, true);
  CHECK(desk.disarms > 0);
}

TEST_CASE("a page that is closed lets go at once") {
  Desk desk;
  REQUIRE(desk.take(R"({"op":"goal","x":3,"y":4})").empty());
  desk.run(1.0, true);
  desk.desk.leave(1, desk.bus.now());
  desk.run(0.3, false);
  CHECK(desk.let_go > 0);
  CHECK(desk.silentFor() >= 0.28);
}

TEST_CASE("the emergency stop is taken from every page, a goal only from the one that holds") {
  Desk desk;
  REQUIRE(desk.take(R"({"op":"goal","x":3,"y":4})", 1).empty());
  desk.run(0.2, true);
  CHECK(desk.take(R"({"op":"goal","x":1,"y":1})", 2) == "another page holds the robot");
  CHECK(desk.take(R"({"op":"estop"})", 2).empty());
  desk.run(0.5, true);
  CHECK(desk.stops > 0);
}

TEST_CASE("a page may take over where the other one has gone silent") {
  Desk desk;
  REQUIRE(desk.take(R"({"op":"goal","x":3,"y":4})", 1).empty());
  desk.run(1.5, false);
  CHECK(desk.take(R"({"op":"goal","x":1,"y":1})", 2).empty());
}

TEST_CASE("a page that is behind holds nothing, and may still stop") {
  Desk desk;
  REQUIRE(desk.take(R"({"op":"goal","x":3,"y":4})").empty());
  desk.run(1.0, true);
  const std::string old =
      R"({"op":"alive","seen":)" + std::to_string(desk.bus.now() - 900'000) + "}";
  for (int i = 0; i < 10; ++i) {
    CHECK_THAT(desk.take(old), Catch::Contains("has not seen the robot"));
    desk.run(0.2, false);
  }
  CHECK(desk.silentFor() > 1.0);
  CHECK(desk.take(R"({"op":"estop"})").empty());
  desk.run(0.3, false);
  CHECK(desk.stops > 0);
}

TEST_CASE("an emergency stop ends what asked for its opposite") {
  Desk desk;
  REQUIRE(desk.take(R"({"op":"clear_estop"})").empty());
  desk.run(0.1, true);
  REQUIRE(desk.take(R"({"op":"arm"})").empty());
  REQUIRE(desk.take(R"({"op":"estop"})").empty());
  desk.run(0.2, true);
  const int cleared = desk.clears, armed = desk.arms;
  desk.run(2.0, true);
  CHECK(desk.stops > 5);
  CHECK(desk.clears == cleared);
  CHECK(desk.arms == armed);
  // However often the key is pressed, it is one call.
  const int stops = desk.stops;
  for (int i = 0; i < 50; ++i) desk.take(R"({"op":"estop"})");
  desk.run(1.0, true);
  CHECK(desk.stops - stops < 40);
}

TEST_CASE("a page that takes over from a silent one does not inherit what that had asked for") {
  Desk desk;
  REQUIRE(desk.take(R"({"op":"goal","x":3,"y":4})", 1).empty());
  desk.run(0.5, true);
  // Time passes, and the other page is there before the desk has looked.
  desk.bus.runUntil(desk.bus.now() + 700'000);
  const int cancels = desk.cancels;
  REQUIRE(desk.take(R"({"op":"alive"})", 2).empty());
  desk.bus.runUntil(desk.bus.now() + 100'000);
  CHECK(desk.cancels > cancels);
}

TEST_CASE("commands that are none are told in a line and do nothing") {
  Desk desk;
  for (const char* bad :
       {"{", "[]", R"({"op":"fly"})", R"({"op":"goal","x":3})", R"({"op":"goal","x":1e9,"y":0})",
        R"({"op":"goal","x":"a","y":0})", R"({"op":"fence","name":"f","corners":[[0,0],[1,1]]})"}) {
    CAPTURE(bad);
    CHECK_FALSE(desk.take(bad).empty());
  }
  desk.run(1.0, true);
  CHECK(desk.goals == 0);
  CHECK(desk.arms == 0);
}
