// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "common/bus/virtual_bus.hpp"
#include "common/messages/blank.hpp"
#include "tools/robot/operator/console.hpp"

using namespace tread;
using tread::operators::OperatorConsole;

namespace {

/// A console, and a robot that only reports that it is armed.
struct Console {
  VirtualBus bus{1};
  OperatorConsole console{bus.outside(), "ADA", "test"};
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

  Console() {
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
      console.step(bus.now());
    }
  }
  /// A page with a current view, unless the command has its own "seen".
  std::string take(const std::string& json, uint64_t page = 1) {
    const bool whole = json.find("\"seen\"") != std::string::npos || json.back() != '}';
    const std::string seen = ",\"seen\":" + std::to_string(bus.now()) + "}";
    return console.take(whole ? json : json.substr(0, json.size() - 1) + seen, page, bus.now());
  }
  double silentFor() const { return static_cast<double>(bus.now() - last_allowed) * 1e-6; }
};

}  // namespace

TEST_CASE("a goal by click holds the robot for as long as the page lives") {
  Console console;
  REQUIRE(console.take(R"({"op":"goal","x":3,"y":4})").empty());
  console.run(3.0, true);
  CHECK(console.goals >= 3);
  CHECK(console.silentFor() < 0.3);
  console.run(2.0, false);
  CHECK(console.silentFor() > 1.0);
  CHECK(console.let_go > 0);
  CHECK(console.cancels > 0);
  CHECK_THAT(console.console.words(), Catch::Contains("no sign of life from the page"));
}

TEST_CASE("a goal that is cancelled leaves the robot armed and held") {
  Console console;
  REQUIRE(console.take(R"({"op":"arm"})").empty());
  console.run(1.0, true);
  REQUIRE(console.take(R"({"op":"goal","x":3,"y":4})").empty());
  console.run(1.0, true);
  REQUIRE(console.take(R"({"op":"cancel"})").empty());
  console.run(2.0, true);
  CHECK(console.cancels > 0);
  CHECK(console.disarms == 0);
  CHECK(console.silentFor() < 0.3);
  REQUIRE(console.take(R"({"op":"disarm"})").empty());
  console.run(0.5, true);
  CHECK(console.disarms > 0);
}

TEST_CASE("a page that is closed lets go at once") {
  Console console;
  REQUIRE(console.take(R"({"op":"goal","x":3,"y":4})").empty());
  console.run(1.0, true);
  console.console.leave(1, console.bus.now());
  console.run(0.3, false);
  CHECK(console.let_go > 0);
  CHECK(console.silentFor() >= 0.28);
}

TEST_CASE("the emergency stop is taken from every page, a goal only from the one that holds") {
  Console console;
  REQUIRE(console.take(R"({"op":"goal","x":3,"y":4})", 1).empty());
  console.run(0.2, true);
  CHECK(console.take(R"({"op":"goal","x":1,"y":1})", 2) == "another page holds the robot");
  CHECK(console.take(R"({"op":"estop"})", 2).empty());
  console.run(0.5, true);
  CHECK(console.stops > 0);
}

TEST_CASE("a page may take over where the other one has gone silent") {
  Console console;
  REQUIRE(console.take(R"({"op":"goal","x":3,"y":4})", 1).empty());
  console.run(1.5, false);
  CHECK(console.take(R"({"op":"goal","x":1,"y":1})", 2).empty());
}

TEST_CASE("a page that is behind holds nothing, and may still stop") {
  Console console;
  REQUIRE(console.take(R"({"op":"goal","x":3,"y":4})").empty());
  console.run(1.0, true);
  const std::string old =
      R"({"op":"alive","seen":)" + std::to_string(console.bus.now() - 900'000) + "}";
  for (int i = 0; i < 10; ++i) {
    CHECK_THAT(console.take(old), Catch::Contains("is too old to operate it"));
    console.run(0.2, false);
  }
  CHECK(console.silentFor() > 1.0);
  CHECK(console.take(R"({"op":"estop"})").empty());
  console.run(0.3, false);
  CHECK(console.stops > 0);
}

TEST_CASE("what a page says to have seen in the future, or in no time at all, holds nothing") {
  Console console;
  const std::string seen = GENERATE("9223372036854775807", "18446744073709551615", "1e300", "-1",
                                    "-9223372036854775808", "\"now\"", "null", "[]", "future");
  CAPTURE(seen);
  const auto saying = [&](const std::string& op) {
    return R"({"op":)" + op + R"(,"seen":)" +
           (seen == "future" ? std::to_string(console.bus.now() + 1) : seen) + "}";
  };
  CHECK_FALSE(console.take(saying(R"("arm")")).empty());
  console.run(0.5, false);
  CHECK(console.arms == 0);
  // Nor does it keep a robot that was taken properly.
  REQUIRE(console.take(R"({"op":"goal","x":3,"y":4})").empty());
  for (int i = 0; i < 10; ++i) {
    CHECK_FALSE(console.take(saying(R"("alive")")).empty());
    console.run(0.2, false);
  }
  CHECK(console.silentFor() > 1.0);
}

TEST_CASE("a page that sends commands without end is refused some, never a stop") {
  Console console;
  int taken = 0;
  std::string refused;
  for (int i = 0; i < 2000; ++i) {
    const std::string words =
        console.take(R"({"op":"fence","name":"f","corners":[[1,1],[2,1],[2,2]]})");
    words.empty() ? void(++taken) : void(refused = words);
  }
  CHECK(taken == 300);
  CHECK_THAT(refused, Catch::Contains("too many commands"));
  CHECK(console.take(R"({"op":"estop"})").empty());
  console.run(0.3, false);
  CHECK(console.stops > 0);
}

TEST_CASE("an emergency stop ends what asked for its opposite") {
  Console console;
  REQUIRE(console.take(R"({"op":"clear_estop"})").empty());
  console.run(0.1, true);
  REQUIRE(console.take(R"({"op":"arm"})").empty());
  REQUIRE(console.take(R"({"op":"estop"})").empty());
  console.run(0.2, true);
  const int cleared = console.clears, armed = console.arms;
  console.run(2.0, true);
  CHECK(console.stops > 5);
  CHECK(console.clears == cleared);
  CHECK(console.arms == armed);
  // Repeated keys make a single call.
  const int stops = console.stops;
  for (int i = 0; i < 50; ++i) console.take(R"({"op":"estop"})");
  console.run(1.0, true);
  CHECK(console.stops - stops < 40);
}

TEST_CASE("a page that takes over from a silent one does not inherit what that had asked for") {
  Console console;
  REQUIRE(console.take(R"({"op":"goal","x":3,"y":4})", 1).empty());
  console.run(0.5, true);
  // Time passes, and the other page connects before the console's next step.
  console.bus.runUntil(console.bus.now() + 700'000);
  const int cancels = console.cancels;
  REQUIRE(console.take(R"({"op":"alive"})", 2).empty());
  console.bus.runUntil(console.bus.now() + 100'000);
  CHECK(console.cancels > cancels);
}

TEST_CASE("commands that are none are told in a line and do nothing") {
  Console console;
  for (const char* bad :
       {"{", "[]", R"({"op":"fly"})", R"({"op":"goal","x":3})", R"({"op":"goal","x":1e9,"y":0})",
        R"({"op":"goal","x":"a","y":0})", R"({"op":"fence","name":"f","corners":[[0,0],[1,1]]})"}) {
    CAPTURE(bad);
    CHECK_FALSE(console.take(bad).empty());
  }
  console.run(1.0, true);
  CHECK(console.goals == 0);
  CHECK(console.arms == 0);
}
