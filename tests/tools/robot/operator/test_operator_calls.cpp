// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <memory>

#include <catch2/catch.hpp>

#include "common/bus/virtual_bus.hpp"
#include "common/messages/fence_messages.hpp"
#include "tools/robot/operator/calls.hpp"
#include "tools/robot/operator/fence_call.hpp"

namespace tread::operators {
namespace {

/// A robot with controllable replies, on the operator's endpoint.
struct Stand {
  explicit Stand(Bus& operators_bus) : bus(operators_bus) {
    bus.subscribe<arm_t>(kArm, [this](const arm_t& message) {
      ++arms;
      last_arm = message;
    });
    bus.subscribe<estop_t>(kEstop, [this](const estop_t& message) {
      ++stops;
      last_stop = message;
    });
    bus.subscribe<operator_t>(kOperator, [this](const operator_t& m) { last_operator = m; });
    bus.subscribe<fence_t>(kFence, [this](const fence_t& message) { fences.push_back(message); });
    bus.subscribe<goal_t>(kGoal, [this](const goal_t& message) { goals.push_back(message); });
  }
  void motor(int64_t utime, int16_t now_in, const std::string& reason = "") {
    motor_t message{};
    message.utime = utime;
    message.bridge_state = state = now_in;
    message.state_reason = reason;
    message.holder = held_by;
    bus.publish(kMotor, message);
  }
  void holder(int64_t utime, const std::string& name) {
    held_by = name;
    motor_t message{};
    message.utime = utime;
    message.bridge_state = state;
    message.holder = name;
    bus.publish(kMotor, message);
  }
  void plan(int64_t utime, int64_t goal_id, int16_t status) {
    plan_t message{};
    message.utime = utime;
    message.goal_id = goal_id;
    message.plan_status = status;
    bus.publish(kPlan, message);
  }

  Bus& bus;
  std::string held_by;
  int16_t state = motor_t::STATE_DISARMED;
  int arms = 0;
  int stops = 0;
  arm_t last_arm{};
  estop_t last_stop{};
  operator_t last_operator{};
  void keeps(int64_t utime, const std::string& process, const std::vector<Fence>& in_force) {
    fences_t message{};
    message.utime = utime;
    message.keeper = process;
    for (const Fence& fence : in_force) message.fences.push_back(toMessage({"", false, fence}));
    message.num_fences = static_cast<int32_t>(message.fences.size());
    bus.publish(kFences, message);
  }
  std::vector<goal_t> goals;
  std::vector<fence_t> fences;
};

/// A passive node.
class Seat : public Node {
 public:
  int64_t period() const override { return 1'000'000; }
  void step(int64_t /*utime*/) override {}
};

/// A virtual bus with the operator outside and the robot as a node.
struct Scene {
  Scene() {
    bus.addNode("robot", [this](Bus& end) {
      stand = std::make_unique<Stand>(end);
      return std::make_unique<Seat>();
    });
  }
  VirtualBus bus{1};
  Bus& desk = bus.outside();
  std::unique_ptr<Stand> stand;

  /// Steps a call each 20 ms until it ends or the time is over; `act` plays the robot.
  CallResult run(Call& call, double seconds, const std::function<void(int64_t)>& act) {
    for (int i = 0; i < static_cast<int>(seconds * 50.0); ++i) {
      act(bus.now());
      const CallResult result = call.step(bus.now());
      if (result != CallResult::kPending) return result;
      bus.runUntil(bus.now() + 20'000);
    }
    return CallResult::kPending;
  }
};

}  // namespace

TEST_CASE("arming is repeated until MOTOR shows it, and an answer from before does not count") {
  Scene scene;
  ArmCall call(scene.desk, {"me", "a try"}, {}, 5.0);
  const auto result = scene.run(call, 6.0, [&](int64_t now) {
    scene.stand->motor(now,
                       scene.stand->arms >= 5 ? motor_t::STATE_ARMED : motor_t::STATE_DISARMED);
  });
  CHECK(result == CallResult::kDone);
  CHECK(scene.stand->arms >= 5);
  CHECK(scene.stand->last_arm.armed_by == "me (operator)");
  CHECK(scene.stand->last_arm.arm_reason == "a try");
  CHECK(call.describe(scene.bus.now()) == "armed");
}

TEST_CASE("who arms hears that another program has the same operator's name") {
  for (const std::string name : {"ada", "bob"}) {
    Scene scene;
    ArmCall call(scene.desk, {"ada", "", "ada"}, {}, 5.0);
    scene.run(call, 6.0, [&](int64_t now) {
      scene.stand->motor(now, motor_t::STATE_ARMED);
      operator_t other{};
      other.station = 99;
      other.allowed = operator_t::ALLOW_DRIVING;
      other.operator_name = name;
      scene.stand->bus.publish(kOperator, other);
    });
    CHECK((call.describe(scene.bus.now()).find("; another program of ada holds the robot, too") !=
           std::string::npos) == (name == "ada"));
  }
}

TEST_CASE("a robot that another operator holds is not armed for this one, and the line names him") {
  for (const std::string name : {"ada", "bob"}) {
    Scene scene;
    ArmCall call(scene.desk, {"bob", "", "bob"}, {}, 5.0);
    const CallResult result = scene.run(call, 6.0, [&](int64_t now) {
      scene.stand->motor(now, motor_t::STATE_DRIVING, "playing");
      if (now % 1'000'000 < 20'000) scene.stand->holder(now, name);
    });
    CHECK((result == CallResult::kDone) == (name == "bob"));
    CHECK((call.describe(scene.bus.now())
               .find("ada holds the robot (ada can hand it over: tread-arm "
                     "--hand-over bob)") != std::string::npos) == (name == "ada"));
  }
}

TEST_CASE("who is to hold a robot of another's waits until it is handed over") {
  Scene scene;
  ArmOptions holding;
  holding.hold = true;
  ArmCall call(scene.desk, {"bob", "", "bob"}, holding, 5.0);
  const int64_t begun = scene.bus.now();
  const auto drive = [&](int64_t now) {
    scene.stand->motor(now, motor_t::STATE_DRIVING, "playing");
    if (now % 1'000'000 < 20'000) scene.stand->holder(now, now - begun > 8'000'000 ? "bob" : "ada");
  };
  CHECK(scene.run(call, 7.0, drive) == CallResult::kPending);
  CHECK_THAT(call.notice(), Catch::StartsWith("ada holds the robot") && Catch::EndsWith("waiting"));
  CHECK(scene.run(call, 4.0, drive) == CallResult::kPending);
  CHECK(call.notice() == "armed and held: Ctrl-C disarms");
}

TEST_CASE("a hand-over is done when the bridge names the other one, else it is refused") {
  for (const bool obeyed : {true, false}) {
    Scene scene;
    ArmOptions request;
    request.hand_over_to = "bob";
    ArmCall call(scene.desk, {"ada", "", "ada"}, request, 5.0);
    const int64_t begun = scene.bus.now();
    const CallResult result = scene.run(call, 6.0, [&](int64_t now) {
      scene.stand->motor(now, motor_t::STATE_DRIVING, "playing");
      const bool given = obeyed && now > begun + 1'500'000;
      if (now % 1'000'000 < 20'000) scene.stand->holder(now, given ? "bob" : "ada");
    });
    CHECK(result == (obeyed ? CallResult::kDone : CallResult::kRefused));
    CHECK_THAT(call.describe(scene.bus.now()),
               Catch::StartsWith(obeyed ? "handed over to bob" : "not handed over: "));
  }
}

TEST_CASE("a goal gives up without a robot, and its end ends no other goal") {
  Scene scene;
  GoalCall alone(scene.desk, {}, "me", 5, {});
  CHECK(scene.run(alone, 10.0, [](int64_t) {}) == CallResult::kRefused);
  CHECK_THAT(alone.describe(scene.bus.now()), Catch::Contains("no MOTOR message came"));
  GoalCall refused(scene.desk, {}, "me", 6, {});
  scene.run(refused, 2.0, [&](int64_t now) {
    scene.stand->motor(now, motor_t::STATE_DRIVING);
    scene.stand->plan(now, 7, plan_t::PLAN_DRIVING);
  });
  refused.cancel(scene.bus.now());
  scene.bus.runUntil(scene.bus.now() + 100'000);
  CHECK(scene.stand->goals.back().goal_id == 6);
}

TEST_CASE("a robot that was armed before the call is told with the bridge's words") {
  Scene scene;
  ArmCall call(scene.desk, {}, {}, 1.0);
  const auto result = scene.run(call, 3.0, [&](int64_t now) {
    scene.stand->motor(now, motor_t::STATE_ARMED, "armed by ada");
  });
  CHECK(result == CallResult::kDone);
  CHECK(call.describe(scene.bus.now()) == "armed since before this call: armed by ada");
}

TEST_CASE("a bridge that does not arm is quoted") {
  Scene scene;
  ArmCall call(scene.desk, {}, {}, 1.0);
  const auto result = scene.run(call, 3.0, [&](int64_t now) {
    scene.stand->motor(now, motor_t::STATE_FAULT, "controller lost");
  });
  CHECK(result == CallResult::kRefused);
  CHECK(call.describe(scene.bus.now()) == "not armed; the motor bridge says: controller lost");
}

TEST_CASE("a stop is repeated fast, and a silent robot is told loudly") {
  Scene scene;
  StopCall call(scene.desk, {}, true, 1.0);
  CHECK(scene.run(call, 3.0, [](int64_t) {}) == CallResult::kRefused);
  CHECK(scene.stand->stops >= 16);
  CHECK(scene.stand->last_stop.engaged);
  CHECK_THAT(call.describe(scene.bus.now()), Catch::StartsWith("NOBODY CONFIRMS THE STOP"));
}

TEST_CASE("a goal is repeated each second, ends with the arrival, and gives up where no way is") {
  Scene scene;
  GoalRequest request;
  request.T_map_goal = {3.0, 4.0, 0.0};
  request.patience = 2.0;
  GoalCall call(scene.desk, request, "me", 77, {});
  const int64_t begun = scene.bus.now();
  auto result = scene.run(call, 10.0, [&](int64_t now) {
    scene.stand->motor(now, motor_t::STATE_ARMED);
    if (now - begun < 2'000'000) return;
    // The arrival at another operator's goal does not count.
    const bool ours = now - begun > 4'000'000;
    scene.stand->plan(now, ours ? 77 : 76, plan_t::PLAN_ARRIVED);
  });
  CHECK(result == CallResult::kDone);
  CHECK(scene.stand->goals.size() == 5);
  CHECK(scene.stand->goals.front().goal_id == 77);

  GoalCall hopeless(scene.desk, request, "me", 78, {});
  const int64_t asked = scene.bus.now();
  result = scene.run(hopeless, 10.0, [&](int64_t now) {
    scene.stand->motor(now, motor_t::STATE_ARMED);
    // A short block does not end it.
    const bool free = now - asked > 1'000'000 && now - asked < 1'500'000;
    scene.stand->plan(now, 78, free ? plan_t::PLAN_DRIVING : plan_t::PLAN_BLOCKED);
  });
  CHECK(result == CallResult::kRefused);
  CHECK(scene.bus.now() - asked > 3'400'000);
  hopeless.cancel(scene.bus.now());
  scene.bus.runUntil(scene.bus.now() + 100'000);
  CHECK(scene.stand->goals.back().goal_id == 0);
}

TEST_CASE("a permission that is lost on the way ends the call with the bridge's reason") {
  Scene scene;
  GoalCall call(scene.desk, {}, "me", 5, {});
  const int64_t begun = scene.bus.now();
  const auto result = scene.run(call, 10.0, [&](int64_t now) {
    scene.stand->plan(now, 5, plan_t::PLAN_DRIVING);
    // Armed, then lost; a short loss would be tolerated.
    const double t = static_cast<double>(now - begun) * 1e-6;
    const bool armed = t < 4.0;
    scene.stand->motor(now, armed ? motor_t::STATE_DRIVING : motor_t::STATE_FAULT, "INS is stale");
  });
  CHECK(result == CallResult::kRefused);
  CHECK(scene.bus.now() - begun > 5'900'000);
  CHECK_THAT(call.describe(scene.bus.now()), Catch::Contains("not armed any more (INS is stale)"));
}

TEST_CASE("a goal for a robot that is not armed, or that the planner has ended, is told at once") {
  Scene scene;
  GoalCall early(scene.desk, {}, "me", 5, {});
  auto result = scene.run(early, 10.0, [&](int64_t now) {
    scene.stand->motor(now, motor_t::STATE_DISARMED, "not armed yet");
  });
  CHECK(result == CallResult::kRefused);
  CHECK_THAT(early.describe(scene.bus.now()),
             Catch::Contains("not armed (not armed yet): tread-arm, then again"));
  GoalCall ended(scene.desk, {}, "me", 6, {});
  const int64_t begun = scene.bus.now();
  result = scene.run(ended, 10.0, [&](int64_t now) {
    scene.stand->motor(now, motor_t::STATE_ARMED);
    scene.stand->plan(now, now - begun < 2'000'000 ? 6 : 0, plan_t::PLAN_IDLE);
  });
  CHECK(result == CallResult::kRefused);
  CHECK_THAT(ended.describe(scene.bus.now()), Catch::Contains("give it again"));
}

TEST_CASE("a robot that is held stays held until the program ends, which disarms it") {
  Scene scene;
  ArmOptions holding;
  holding.hold = true;
  ArmCall call(scene.desk, {"me", ""}, holding, 5.0);
  const auto result = scene.run(call, 60.0, [&](int64_t now) {
    scene.stand->motor(now, scene.stand->arms > 0 ? motor_t::STATE_ARMED : motor_t::STATE_DISARMED);
  });
  CHECK(result == CallResult::kPending);
  CHECK(call.notice() == "armed and held: Ctrl-C disarms");
  CHECK_THAT(call.describe(scene.bus.now()), Catch::Contains("armed and held"));
  call.cancel(scene.bus.now());
  call.letGo(scene.bus.now());
  scene.bus.runUntil(scene.bus.now() + 100'000);
  CHECK_FALSE(scene.stand->last_arm.armed);
  CHECK(scene.stand->last_operator.allowed == operator_t::ALLOW_NOTHING);
}

TEST_CASE("whatever this machine's clock says, requests bear the robot's time") {
  for (const int64_t ahead : {-3'600'000'000LL, 1'000'000LL, 86'400'000'000LL}) {
    Scene scene;
    ArmCall call(scene.desk, {"me", ""}, {}, 5.0);
    const auto result = scene.run(call, 6.0, [&](int64_t now) {
      const bool timely = std::abs(scene.stand->last_arm.utime - now - ahead) < 300'000;
      scene.stand->motor(now + ahead, timely ? motor_t::STATE_ARMED : motor_t::STATE_DISARMED);
    });
    CHECK(result == CallResult::kDone);
    CHECK_THAT(call.describe(scene.bus.now()), Catch::Contains("taken into account"));
  }
}

TEST_CASE("a fence is repeated until both the bridge and the planner show it") {
  for (const bool removes : {false, true}) {
    Scene scene;
    const Fence yard = fenceFrom("yard", true, {0, 0, 4, 0, 4, 3});
    FenceCall call(scene.desk, {"me", ""}, {"", removes, yard}, 5.0);
    const std::vector<Fence> with{yard}, without, &after = removes ? without : with;
    const std::vector<Fence>& before = removes ? with : without;
    const int64_t begun = scene.bus.now();
    const auto result = scene.run(call, 4.0, [&](int64_t now) {
      scene.stand->motor(now, motor_t::STATE_ARMED);
      scene.stand->keeps(now, "motor_bridge", after);
      scene.stand->keeps(now, "planner", now - begun > 2'000'000 ? after : before);
    });
    CHECK(result == CallResult::kDone);
    CHECK(scene.bus.now() - begun > 2'000'000);
    REQUIRE(scene.stand->fences.size() >= 8);
    const fence_t& sent = scene.stand->fences.back();
    CHECK(sent.fence_by == "me (operator)");
    CHECK(sent.fence_kind == (removes ? fence_t::FENCE_REMOVED : fence_t::FENCE_KEEP_OUT));
    CHECK_THAT(
        call.describe(scene.bus.now()),
        Catch::Contains(removes ? "no fence yard is in force any more" : "fence yard is in force"));
  }
}

TEST_CASE("a fence that one of the two does not take is told with its name") {
  const bool planner_there = GENERATE(true, false);
  Scene scene;
  const Fence yard = fenceFrom("yard", false, {0, 0, 4, 0, 4, 3});
  FenceCall call(scene.desk, {"me", ""}, {"", false, yard}, 2.0);
  const auto result = scene.run(call, 4.0, [&](int64_t now) {
    scene.stand->motor(now, motor_t::STATE_ARMED);
    scene.stand->keeps(now, "motor_bridge", {yard});
    if (planner_there) scene.stand->keeps(now, "planner", {});
  });
  CHECK(result == CallResult::kRefused);
  CHECK_THAT(call.describe(scene.bus.now()),
             Catch::Contains(planner_there ? "fence yard is not in force in planner"
                                           : "no FENCES from planner"));
  CHECK_THROWS_WITH(fenceFrom("a", true, {1, 2, 3}), Catch::Contains("one number is missing"));
  CHECK_THROWS_WITH(fenceFrom("a", true, {1, 2, 3, 4}), Catch::Contains("3 to 64 corners"));
}

TEST_CASE("an older fence of the same name is no answer, and keeps the name from being gone") {
  const Fence yard = fenceFrom("yard", false, {0, 0, 4, 0, 4, 3});
  const Fence older = fenceFrom("yard", false, {0, 0, 9, 0, 9, 9});
  for (const bool removes : {false, true}) {
    Scene scene;
    FenceCall call(scene.desk, {"me", ""}, {"", removes, yard}, 2.0);
    const auto result = scene.run(call, 4.0, [&](int64_t now) {
      scene.stand->motor(now, motor_t::STATE_ARMED);
      scene.stand->keeps(now, "motor_bridge", {older});
      scene.stand->keeps(now, "planner", {older});
    });
    CHECK(result == CallResult::kRefused);
  }
}

}  // namespace tread::operators
