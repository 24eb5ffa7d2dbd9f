// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <limits>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/motor_bridge/bridge_world.hpp"

using namespace tread;
using namespace tread::motor;

namespace {

constexpr int64_t kBridgeStep = BridgeWorld::kStep;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// A bridge in its world, and a program for manual control that sends MANUAL at 50 Hz.
struct HandWorld : BridgeWorld {
  ManualNotice wish{7, "operator", 0, 0, true, false, 0.0, 0.0};
  bool hand_alive = true;
  bool loop_closed = true;  ///< the program receives MOTOR
  int64_t seen = 0;         ///< [us]

  void tell() {
    if (loop_closed) seen = now - 10'000;
    wish.seen_utime = seen;
    ++wish.seq;
    bridge.receive(wish, now);
  }
  void step() {
    if (hand_alive && now % 20'000 == 0) tell();
    BridgeWorld::step();
  }
  void run(int64_t us) {
    for (const int64_t end = now + us; now < end;) step();
  }
  /// A planner without motion: only manual control may move the armed robot.
  void armForHand() {
    planner.stands = true;
    const bool holds = std::exchange(wish.hold, false);
    run(1'200'000);
    arm();
    run(100'000);
    wish.hold = holds;
    REQUIRE(state() == BridgeState::kArmed);
  }
  void stick(double left, double right) {
    wish.left = left;
    wish.right = right;
  }
  /// Runs until the planner drives, with the stick at rest.
  void drive() {
    wish.hold = false;
    run(1'200'000);
    arm();
    run(200'000);
    wish.hold = true;
    run(100'000);
    REQUIRE(state() == BridgeState::kDriving);
  }
  /// Runs until a person drives at full stick.
  void driveByHand() {
    drive();
    stick(1.0, 1.0);
    run(1'000'000);
    REQUIRE(state() == BridgeState::kManual);
    REQUIRE(out.command == Command{0.5, 0.5});
  }
  /// Steps until `done`; returns the duration [us].
  template <class Done>
  int64_t until(Done&& done) {
    const int64_t from = now;
    while (!done() && now - from < 5'000'000) step();
    return now - from;
  }
  bool stands() const { return isZero(out.command); }
};

}  // namespace

TEST_CASE("a moved stick takes over within 100 ms of its message, and the program is gone") {
  HandWorld world;
  world.drive();
  const int64_t execution = world.out.execution_id;
  world.stick(0.6, 0.4);
  world.tell();
  CHECK(world.until([&] { return world.state() == BridgeState::kManual; }) <= kBridgeStep);
  CHECK(world.stands());  // the pattern's power is gone before the manual command rises
  CHECK(world.until([&] { return world.out.command[0] > 0.0; }) <= 100'000 - kBridgeStep);
  CHECK(world.reason() == "driven by hand by operator");
  CHECK(world.last().execution_id == execution);
  CHECK(world.last().outcome == ExecutionOutcome::kAborted);
  CHECK(world.last().reason.words == "driven by hand by operator");
  CHECK(world.out.execution_id == 0);
  CHECK(world.out.run_id == 0);
  CHECK(world.out.command_index == -1);
  CHECK(world.out.kinds == kindsOf(trackChannels(CommandKind::kPower)));
  world.run(5'000'000);
  CHECK(world.state() == BridgeState::kManual);
  CHECK(world.last().execution_id == execution);
  CHECK(world.bridge.counters().at("PROGRAM refused: the robot is driven by hand") > 50);
}

TEST_CASE("by hand power has a limit and grows at a limited rate, less of it comes at once") {
  HandWorld world;
  world.drive();
  world.stick(1.0, -1.0);
  world.run(50'000);
  double before = world.out.command[0];
  for (int i = 0; i < 200; ++i) {
    world.step();
    REQUIRE(world.out.command[0] - before <= 0.02 + 1e-9);
    REQUIRE(std::abs(world.out.command[1]) <= 0.5);
    before = world.out.command[0];
  }
  CHECK(world.out.command == Command{0.5, -0.5});
  world.stick(0.2, 0.0);
  world.tell();
  world.run(2 * kBridgeStep);
  CHECK(world.out.command[0] == Approx(0.1));
  CHECK(world.out.command[1] == 0.0);
  world.stick(-1.0, 0.0);
  world.tell();
  world.run(2 * kBridgeStep);
  CHECK(world.out.command[0] <= 0.0);
  CHECK(world.out.command[0] >= -0.02 - 1e-9);
}

TEST_CASE("a released dead-man's button: zero in the next step, armed, in the hand") {
  HandWorld world;
  world.driveByHand();
  world.wish.hold = false;
  world.tell();
  CHECK(world.until([&] { return world.stands(); }) == kBridgeStep);
  CHECK(world.state() == BridgeState::kManual);
  CHECK(world.reason() == "in the hand of operator, dead-man's button released");
  world.run(3'000'000);
  CHECK(world.state() == BridgeState::kManual);
  CHECK(world.stands());
  world.wish.hold = true;
  CHECK(world.until([&] { return !world.stands(); }) <= 60'000);
}

TEST_CASE(
    "a silent hand: zero within its lease and a step of what it saw last, and it stays zero") {
  HandWorld world;
  world.driveByHand();
  SECTION("its program is gone") {
    world.hand_alive = false;
  }
  SECTION("its program hears nothing of the robot") {
    world.loop_closed = false;
  }
  world.until([&] { return world.stands(); });
  CHECK(world.now - world.seen <= 200'000 + kBridgeStep);
  CHECK(world.now - world.seen > 200'000);
  CHECK(world.state() == BridgeState::kManual);
  CHECK(world.reason() == "in the hand of operator, who is silent");
  world.run(2'000'000);
  CHECK(world.stands());
  world.hand_alive = world.loop_closed = true;
  world.run(1'000'000);
  CHECK(world.stands());  // the stick has not been touched since
  CHECK(world.reason() ==
        "in the hand of operator: the stick was not seen at rest: let it go once");
  world.wish.hold = false;
  world.run(50'000);
  world.wish.hold = true;
  world.run(500'000);
  CHECK(world.stands());  // a released button does not count as rest
  world.stick(0.0, 0.0);
  world.run(50'000);
  world.stick(0.5, 0.5);
  CHECK(world.until([&] { return !world.stands(); }) <= 60'000);
}

TEST_CASE("given back: zero, then the planner's next program, and what was taken is not resumed") {
  HandWorld world;
  world.driveByHand();
  const int64_t execution = world.last().execution_id;
  world.wish.give_back = true;
  world.tell();
  world.step();
  CHECK(world.stands());
  CHECK(world.state() == BridgeState::kStopping);
  CHECK(world.reason() == "given back by hand");
  world.run(300'000);
  CHECK(world.state() == BridgeState::kDriving);
  CHECK(world.last().execution_id > execution);
  world.wish.give_back = false;
  world.stick(0.0, 0.0);
  world.run(1'000'000);
  CHECK(world.state() == BridgeState::kDriving);
}

TEST_CASE("neither ending nor falling silent gives back, and who starts anew may give back") {
  HandWorld world;
  world.driveByHand();
  world.hand_alive = false;
  SECTION("the hand's program lets go in good order, another one of the operator goes on") {
    world.bridge.receive(OperatorNotice{7, "operator", true, world.now, 0, ""}, world.now);
    world.bridge.receive(OperatorNotice{7, "operator", false, world.now, 0, ""}, world.now);
    world.run(300'000);
    CHECK(world.state() == BridgeState::kDisarmed);
    CHECK(world.reason() == "disarmed by operator, whose program has ended");
  }
  SECTION("another program lets go") {
    world.bridge.receive(OperatorNotice{8, "operator", true, world.now, 0, ""}, world.now);
    world.bridge.receive(OperatorNotice{8, "operator", false, world.now, 0, ""}, world.now);
    world.run(1'000'000);
    CHECK(world.state() == BridgeState::kManual);
  }
  SECTION("started anew with the stick held: nothing moves before it was let go") {
    world.run(500'000);
    world.wish.station = 9;
    world.wish.seq = 0;
    world.hand_alive = true;
    world.run(1'000'000);
    CHECK(world.stands());
    world.wish.give_back = true;
    world.run(300'000);
    CHECK(world.state() == BridgeState::kDriving);
  }
}

TEST_CASE("what stops a program stops the hand: zero in the next step, and ARM is needed") {
  HandWorld world;
  world.driveByHand();
  SECTION("E-stop") {
    world.bridge.receive(EstopRequest{world.now, true, "operator", "person"}, world.now);
  }
  SECTION("link") {
    world.device.link_fault = "no answer";
  }
  SECTION("controller, its undervoltage among others") {
    world.device.device_fault = "undervoltage";
  }
  SECTION("disarmed") {
    world.bridge.receive(ArmRequest{world.now, false, "operator", ""}, world.now);
  }
  SECTION("the bridge was held up") {
    world.now += 200'000;
  }
  world.BridgeWorld::step();
  CHECK(world.stands());
  CHECK(!isArmed(world.state()));
  world.device = DeviceReport{};
  world.run(3'000'000);
  CHECK(world.stands());
  CHECK(!isArmed(world.state()));
}

TEST_CASE("a lost operator stops the hand, and so does one who lets go with all programs") {
  HandWorld world;
  world.driveByHand();
  world.operator_alive = false;
  SECTION("silent") {
    world.hand_alive = false;
    world.run(1'300'000);
    CHECK(world.state() == BridgeState::kDisarmed);
    CHECK(world.reason().find("the operator is lost") != std::string::npos);
  }
  SECTION("let go") {
    world.bridge.receive(OperatorNotice{1, "operator", false, world.now, 0, ""}, world.now);
    world.step();
    CHECK(world.stands());
    CHECK(world.state() == BridgeState::kStopping);
    CHECK(world.reason() == "operator has let go");
  }
}

TEST_CASE(
    "a person sees the robot: neither INS nor planner nor what it makes of its commands stop "
    "the hand, but they are told, and count again when it is given back") {
  HandWorld world;
  world.driveByHand();
  SECTION("INS") {
    world.ins_alive = false;
  }
  SECTION("planner") {
    world.planner_alive = false;
  }
  world.run(1'000'000);
  CHECK(world.state() == BridgeState::kManual);
  CHECK(world.out.command == Command{0.5, 0.5});
  CHECK_FALSE(world.out.failsafe.standing_fault.empty());
  world.wish.give_back = true;
  world.run(50'000);
  CHECK(world.state() == BridgeState::kDisarmed);
  CHECK(world.stands());
}

TEST_CASE("the hand needs the dead-man's button, the lease and valid numbers to take over") {
  HandWorld world;
  world.drive();
  SECTION("no button") {
    world.wish.hold = false;
  }
  SECTION("another operator") {
    world.wish.name = "eve";
  }
  SECTION("an old view") {
    world.loop_closed = false;
    world.seen = world.now - 250'000;
  }
  SECTION("a played-back message") {
    world.hand_alive = false;
  }
  SECTION("a button that gives back") {
    world.wish.give_back = true;
  }
  SECTION("no number") {
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    for (const auto& [left, right] : std::vector<std::pair<double, double>>{
             {kUnknown, 0.5}, {0.5, kUnknown}, {0.5, kInfinite}, {0.5, -1.5}, {-1.5, 0.5}}) {
      CAPTURE(left, right);
      // Only a stick measured at rest could take over.
      world.stick(0.0, 0.0);
      world.run(200'000);
      world.stick(left, right);
      world.run(1'000'000);
      CHECK(world.state() == BridgeState::kDriving);
    }
    world.wish.hold = false;
  }
  world.stick(1.0, 1.0);
  if (!world.hand_alive) world.bridge.receive(world.wish, world.now);  // seq and view as before
  world.run(1'000'000);
  CHECK(world.state() == BridgeState::kDriving);
}

TEST_CASE("a second hand of the same operator is refused while the first is there") {
  HandWorld world;
  world.driveByHand();
  ManualNotice second = world.wish;
  second.station = 8;
  second.left = second.right = -1.0;
  for (int i = 0; i < 20; ++i) {
    second.seen_utime = world.now - 10'000;
    ++second.seq;
    world.bridge.receive(second, world.now);
    world.step();
    REQUIRE(world.out.command == Command{0.5, 0.5});
  }
  CHECK(world.bridge.counters().at("MANUAL ignored: another program has manual control") == 20);
}

TEST_CASE(
    "a disarmed robot is not moved by hand, and arming moves nothing before the stick rests") {
  HandWorld world;
  world.stick(1.0, 1.0);
  world.run(2'000'000);
  CHECK(world.state() == BridgeState::kDisarmed);
  world.planner_alive = false;  // nothing else may begin
  world.arm();
  world.run(1'000'000);
  CHECK(world.stands());
  CHECK(world.state() == BridgeState::kDisarmed);
}

TEST_CASE("armed again after a stop with the stick still held, nothing moves before it rests") {
  HandWorld world;
  world.driveByHand();
  SECTION("E-stop, cleared") {
    world.bridge.receive(EstopRequest{world.now, true, "operator", "person"}, world.now);
    world.run(1'500'000);
    world.bridge.receive(EstopRequest{world.now, false, "operator", ""}, world.now);
  }
  SECTION("disarmed") {
    world.bridge.receive(ArmRequest{world.now, false, "operator", ""}, world.now);
  }
  world.run(1'500'000);
  world.planner.stands = true;  // so that only manual control may move it
  world.arm();
  world.run(50'000);
  CHECK(world.state() == BridgeState::kDisarmed);
  CHECK_THAT(world.reason(), Catch::EndsWith("; ARM refused: the stick was not seen at rest: let "
                                             "it go once"));
  world.wish.hold = false;
  world.run(50'000);
  world.arm();
  world.run(50'000);
  world.wish.hold = true;
  for (int i = 0; i < 200; ++i) {
    world.step();
    REQUIRE(world.stands());
  }
  CHECK(world.state() == BridgeState::kArmed);
  world.stick(0.0, 0.0);
  world.run(100'000);
  world.stick(1.0, 1.0);
  world.run(100'000);
  CHECK(world.state() == BridgeState::kManual);
  CHECK_FALSE(world.stands());
}

TEST_CASE("a repeated ARM of a hand that was disarmed at once does not arm it again") {
  HandWorld world;
  world.run(1'300'000);
  const ArmRequest ahead{world.now + 40'000, true, "operator", "go"};
  world.bridge.receive(ahead, world.now);
  world.step();
  REQUIRE(world.state() == BridgeState::kManual);
  world.bridge.receive(ArmRequest{world.now, false, "operator", ""}, world.now);
  world.step();
  world.bridge.receive(ahead, world.now);
  world.run(100'000);
  CHECK(world.state() == BridgeState::kDisarmed);
}

TEST_CASE("a stick that goes to rest gives zero in the next step") {
  HandWorld world;
  world.driveByHand();
  for (int i = 0; i < 4; ++i) {
    world.stick(0.0, 0.0);
    world.tell();
    world.step();
    CHECK(world.stands());
    world.stick(1.0, 1.0);
    world.run(200'000 + i * kBridgeStep);
    CHECK_FALSE(world.stands());
  }
}

TEST_CASE(
    "with the button held and the stick at rest, ARM arms for the hand, without INS and "
    "planner") {
  HandWorld world;
  world.planner_alive = world.ins_alive = false;
  world.run(1'300'000);
  world.arm();
  world.run(50'000);
  CHECK(world.state() == BridgeState::kManual);
  CHECK(world.stands());
  world.stick(1.0, 1.0);
  world.run(1'000'000);
  CHECK(world.out.command == Command{0.5, 0.5});
}

TEST_CASE("without the button ARM needs what a program needs") {
  HandWorld world;
  world.wish.hold = false;
  world.ins_alive = false;
  world.run(1'300'000);
  world.arm();
  world.run(50'000);
  CHECK(world.state() == BridgeState::kDisarmed);
}

TEST_CASE("an overtaken message of the hand counts for nothing") {
  HandWorld world;
  world.driveByHand();
  ManualNotice old = world.wish;
  world.wish.hold = false;
  world.tell();
  world.bridge.receive(old, world.now);
  world.step();
  CHECK(world.stands());
}

TEST_CASE("a hand's command changes every 20 ms, and grows from zero when it takes over again") {
  HandWorld world;
  world.driveByHand();
  world.wish.give_back = true;
  world.run(100'000);
  REQUIRE(world.state() == BridgeState::kDriving);
  world.wish.give_back = false;
  world.tell();
  world.until([&] { return world.state() == BridgeState::kManual; });
  CHECK(world.stands());
  std::vector<int64_t> changes;
  for (Command before; world.out.command[0] < 0.4; before = world.out.command) {
    world.step();
    if (!(world.out.command == before)) changes.push_back(world.now);
    CHECK(world.out.command[0] - before[0] <= 0.02 + 1e-9);
  }
  REQUIRE(changes.size() > 10);
  for (size_t i = 1; i < changes.size(); ++i) CHECK(changes[i] - changes[i - 1] == 20'000);
}

TEST_CASE("where the hand has limits of tilt or fences to keep, a silent INS stops it, once") {
  HandWorld world;
  BridgeConfig config;
  std::string told;
  SECTION("tilt") {
    config.tilt = TiltLimits{0.5, 0.5, 1.0, 1.0};
    told = "INS measures no roll and pitch: their limits cannot be kept";
  }
  SECTION("fences") {
    config.fences.own = {{"yard", false, {{-50, -50}, {50, -50}, {50, 50}, {-50, 50}}}};
    told = "position unknown: fences cannot be kept";
  }
  world.bridge = Bridge(config);
  world.motion.x = world.motion.y = world.motion.yaw = 0.0;
  world.tilt = InsTilt{0, 0.0, 0.0, 0.0, 0.0};
  world.driveByHand();
  world.ins_alive = false;
  CHECK(world.until([&] { return world.stands(); }) <= 550'000);
  CHECK(world.state() == BridgeState::kDisarmed);
  CHECK_THAT(world.reason(), Catch::StartsWith(told));
  world.stick(0.0, 0.0);
  world.run(2'500'000);
  CHECK(world.state() == BridgeState::kDisarmed);
  // A person who arms again knows it.
  world.arm();
  world.run(50'000);
  CHECK(world.state() == BridgeState::kManual);
  world.stick(1.0, 1.0);
  world.run(1'000'000);
  CHECK(world.out.command == Command{0.5, 0.5});
}

TEST_CASE("with fences a position that does not move with the robot stops the hand, too") {
  HandWorld world;
  const bool fenced = GENERATE(true, false);
  BridgeConfig config;
  if (fenced) config.fences.own = {{"yard", false, {{-50, -50}, {50, -50}, {50, 50}, {-50, 50}}}};
  world.bridge = Bridge(config);
  world.motion.x = world.motion.y = world.motion.yaw = 0.0;
  world.motion.v_forward = world.motion.v_left = world.motion.yaw_rate = 0.0;
  world.planner.stands = true;
  world.wish.hold = false;
  world.run(1'200'000);
  world.arm();
  world.run(200'000);
  world.wish.hold = true;
  world.stick(1.0, 1.0);
  world.run(4'000'000);
  CHECK((world.state() == BridgeState::kManual) == !fenced);
  CHECK(world.stands() == fenced);
}

TEST_CASE("`go_back` takes a lost person's robot from the hand, and says so") {
  HandWorld world;
  BridgeConfig config;
  config.operators.lost = OperatorLost::kGoBack;
  world.bridge = Bridge(config);
  world.driveByHand();
  world.operator_alive = world.hand_alive = false;
  CHECK(world.until([&] { return world.stands(); }) <= 200'000 + kBridgeStep);
  world.until([&] { return world.state() != BridgeState::kManual; });
  CHECK_THAT(world.reason(), Catch::Contains("the operator is lost"));
  CHECK(isArmed(world.state()));
}

TEST_CASE("a program that is new takes over only after its stick has been at rest") {
  ManualControl hand{ManualLimits{}};
  const auto says = [&](int64_t station, int64_t seq, double stick, int64_t now) {
    hand.update(now, false, true);
    CHECK(hand.receive({station, "operator", seq, now, true, false, stick, stick}, now).empty());
    hand.update(now, false, true);
  };
  says(7, 1, 0.0, 1'000'000);
  says(8, 1, 0.5, 2'000'000);
  CHECK_FALSE(hand.takes());
  CHECK(hand.words() == "in the hand of operator: the stick was not seen at rest: let it go once");
  says(8, 2, 0.0, 2'020'000);
  says(8, 3, 0.5, 2'040'000);
  CHECK(hand.takes());
}

TEST_CASE("a stick that was not seen at rest moves nothing, whatever is done with the button") {
  HandWorld world;
  const double left = GENERATE(-1.0, 0.06, kUnknown, 0.0);
  const double right = GENERATE(1.0, kUnknown, -0.06);
  world.stick(left, right);
  world.wish.hold = GENERATE(true, false);
  world.armForHand();
  for (int i = 0; i < 400; ++i) {
    if (i % 30 == 0) world.wish.hold = !world.wish.hold;
    world.step();
    REQUIRE(world.stands());
    REQUIRE(world.state() == BridgeState::kArmed);
  }
  world.wish.hold = true;
  world.run(50'000);
  CHECK(world.reason() == "armed by operator; the stick was not seen at rest: let it go once");
  world.wish.hold = false;
  world.run(50'000);
  CHECK(world.reason() == "armed by operator");
  world.stick(0.0, 0.0);
  world.run(50'000);
  world.wish.hold = true;
  world.stick(0.5, 0.5);
  world.run(100'000);
  CHECK(world.state() == BridgeState::kManual);
  CHECK_FALSE(world.stands());
}

TEST_CASE("a track at a time is no rest: both are seen at rest in one message") {
  HandWorld world;
  world.armForHand();
  world.run(500'000);
  world.hand_alive = false;
  world.run(500'000);  // silent: it must be measured at rest again
  world.hand_alive = true;
  for (int i = 0; i < 50; ++i) {
    world.stick(i % 2 == 0 ? 0.0 : 1.0, i % 2 == 0 ? 1.0 : 0.0);
    world.run(20'000);
    REQUIRE(world.stands());
  }
}

TEST_CASE("a stick whose place is lost while it drives: zero in the next step, until it rests") {
  HandWorld world;
  world.driveByHand();
  const bool left = GENERATE(true, false);
  world.stick(left ? kUnknown : 1.0, left ? 1.0 : kUnknown);
  world.tell();
  world.step();
  CHECK(world.stands());
  world.stick(1.0, 1.0);
  world.run(500'000);
  CHECK(world.stands());
  CHECK(world.state() == BridgeState::kManual);
  world.stick(0.0, 0.0);
  world.run(50'000);
  world.stick(1.0, 1.0);
  world.run(100'000);
  CHECK_FALSE(world.stands());
}

TEST_CASE("with its place unknown a stick gives back, and arms nothing for the hand") {
  HandWorld world;
  SECTION("gives back") {
    world.driveByHand();
    world.stick(kUnknown, kUnknown);
    world.wish.give_back = true;
    world.run(300'000);
    CHECK(world.state() == BridgeState::kDriving);
  }
  SECTION("arms nothing") {
    world.planner_alive = world.ins_alive = false;
    world.stick(kUnknown, kUnknown);
    world.run(1'300'000);
    world.arm();
    world.run(50'000);
    CHECK(world.state() == BridgeState::kDisarmed);
  }
}

TEST_CASE("a worn spring: up to a twentieth counts as rest, and moves nothing") {
  HandWorld world;
  world.armForHand();
  world.stick(0.05, -0.05);
  world.run(500'000);
  CHECK(world.state() == BridgeState::kArmed);
  world.stick(0.06, -0.05);
  world.run(500'000);
  CHECK(world.state() == BridgeState::kManual);
  CHECK(world.out.command[0] == Approx(0.03));
  world.stick(-0.05, 0.05);
  world.tell();
  world.step();
  CHECK(world.stands());
}

TEST_CASE("a stick deflected with its button released while the robot is armed must rest first") {
  HandWorld world;
  world.planner.stands = true;
  world.run(1'200'000);
  world.wish.hold = false;
  world.stick(1.0, 1.0);
  world.run(100'000);
  world.arm();
  world.run(100'000);
  REQUIRE(world.state() == BridgeState::kArmed);
  world.wish.hold = true;
  world.run(1'000'000);
  CHECK(world.stands());
  CHECK(world.state() == BridgeState::kArmed);
}

TEST_CASE("a stick that was silent while the planner drove takes over only after it rests again") {
  HandWorld world;
  world.drive();
  world.hand_alive = false;
  world.run(500'000);
  world.stick(1.0, 1.0);
  world.hand_alive = true;
  world.run(500'000);
  CHECK(world.state() == BridgeState::kDriving);
  world.stick(0.0, 0.0);
  world.run(50'000);
  world.stick(1.0, 1.0);
  world.run(50'000);
  CHECK(world.state() == BridgeState::kManual);
}

TEST_CASE("two stations of which each rests for the other move nothing") {
  HandWorld world;
  world.armForHand();
  for (int i = 0; i < 8; ++i) {
    world.hand_alive = false;
    world.run(250'000);
    world.wish.station = 7 + i % 2;
    const double way = i % 2 == 0 ? 0.0 : 1.0;
    world.stick(way, way);
    world.hand_alive = true;
    world.run(200'000);
    REQUIRE(world.stands());
  }
}

TEST_CASE("while kept fences are lost neither hand nor planner drives, until they are removed") {
  HandWorld world;
  world.wish.hold = GENERATE(true, false);
  if (world.wish.hold)
    world.driveByHand();
  else
    world.BridgeWorld::drive();
  REQUIRE_FALSE(world.stands());
  world.bridge.receive(FenceRequest{"planner", false, lostFences()}, world.now);
  world.step();
  CHECK(world.stands());
  CHECK_THAT(world.reason(), Catch::StartsWith("kept fences are lost: set them anew"));
  world.stick(0.0, 0.0);
  world.run(1'500'000);
  world.arm();
  world.run(100'000);
  CHECK(world.state() == BridgeState::kDisarmed);
  CHECK_THAT(world.reason(), Catch::Contains("ARM refused: kept fences are lost"));
  world.bridge.receive(FenceRequest{"operator", true, lostFences()}, world.now);
  world.run(1'500'000);
  world.arm();
  world.run(100'000);
  CHECK(isArmed(world.state()));
}
