// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>

#include <catch2/catch.hpp>

#include "tests/motor_bridge/bridge_world.hpp"

using namespace tread;
using namespace tread::motor;
using Catch::Contains;

namespace {

constexpr FootprintSize kBody{0.65, 0.65, 0.34};
constexpr double kSpeed = 1.1;  // [m/s] of a track at full power
constexpr double kGauge = 0.6;  // [m]

Fence yard() {
  return {"yard", false, {{-5, -5}, {10, -5}, {10, 5}, {-5, 5}}};
}

BridgeConfig fenced(std::vector<Fence> own) {
  BridgeConfig config;
  config.fences = {std::move(own), kBody, 0.5};
  return config;
}

/// A robot that follows commands with a delay and publishes its pose.
struct FencedWorld : BridgeWorld {
  Pose2 truth;
  double left = 0.0, right = 0.0;  ///< [m/s]
  double lag = 0.2;                ///< [s] of the tracks
  bool tells_speed = true, tells_turn = true;
  double least_room = 1e9;  ///< [m] least distance of the true outline to any fence of the bridge

  explicit FencedWorld(std::vector<Fence> own, const Pose2& start = {}) : truth(start) {
    bridge = Bridge(fenced(std::move(own)));
    planner.commands = 10;
    motion.position_std = 0.02;
    tell();
  }
  void tell() {
    motion.x = truth.x;
    motion.y = truth.y;
    motion.yaw = truth.yaw;
    const double unknown = InsMotion::kUnknown;
    motion.v_forward = tells_speed ? 0.5 * (left + right) : unknown;
    motion.v_left = tells_speed ? 0.0 : unknown;
    motion.yaw_rate = tells_turn ? 0.5 * (right - left) / kGauge : unknown;
  }
  void blind(bool speed, bool turn) {
    tells_speed = !speed;
    tells_turn = !turn;
    tell();
  }
  void runFor(int64_t us) {
    for (const int64_t end = now + us; now < end;) move();
  }
  void move() {
    step();
    const double dt = 1e-6 * kStep;
    left += (kSpeed * out.command[0] - left) * dt / lag;
    right += (kSpeed * out.command[1] - right) * dt / lag;
    truth = truth * integrate({0.5 * (left + right), 0.0, 0.5 * (right - left) / kGauge}, dt);
    tell();
    least_room = std::min(least_room, roomAt(bridge.fences().fences(), truth, kBody).metres);
  }
  void start(double power_left, double power_right) {
    planner.always = TrackCommand{power_left, power_right};
    runFor(1'300'000);
    arm();
    runFor(100'000);
  }
  /// Discards pending motion after a stop.
  void restart(double power_left, double power_right) {
    planner.stands = true;
    runFor(1'000'000);
    planner.stands = false;
    start(power_left, power_right);
  }
  void add(const Fence& fence, const std::string& by = "stranger") {
    bridge.receive(FenceRequest{by, false, fence}, now);
  }
  void remove(const std::string& name, const std::string& by) {
    bridge.receive(FenceRequest{by, true, {name, false, {}}}, now);
  }
};

}  // namespace

TEST_CASE(
    "at full speed towards a fence the outline stays within, and the reason names the fence") {
  for (const double yaw : {0.0, 0.7, kPi / 2, 2.0, kPi}) {
    for (const double power : {1.0, 0.4, -1.0}) {
      FencedWorld world({yard()}, {0, 0, yaw});
      world.start(power, power);
      REQUIRE(world.state() == BridgeState::kDriving);
      world.runFor(30'000'000);
      CHECK(world.least_room >= 0.0);
      CHECK(world.least_room < 1.0);
      CHECK(world.state() == BridgeState::kDisarmed);
      CHECK_THAT(world.reason(), Contains("fence yard") && Contains("less than it takes to stop"));
    }
  }
}

TEST_CASE("a turn beside a fence stops before a corner of the outline crosses it") {
  for (const double gap : {0.02, 0.05, 0.1, 0.2}) {
    FencedWorld world({yard()}, {0, 5.0 - 0.34 - gap, 0});
    world.motion.position_std = 0.0;
    world.start(-1.0, 1.0);
    world.runFor(5'000'000);
    CHECK(world.least_room >= 0.0);
    CHECK(world.state() == BridgeState::kDisarmed);
  }
}

TEST_CASE("along a fence, and in the middle of the yard, it drives on") {
  FencedWorld along({yard()}, {-4, 5.0 - 0.34 - 0.15, 0});
  along.start(1.0, 1.0);
  along.runFor(8'000'000);
  CHECK(along.state() == BridgeState::kDriving);
  FencedWorld turning({yard()});
  turning.start(-1.0, 1.0);
  turning.runFor(8'000'000);
  CHECK(turning.state() == BridgeState::kDriving);
}

TEST_CASE("it keeps out of a polygon from every side, and of one that is smaller than itself") {
  for (const double side : {4.0, 0.2}) {
    for (int i = 0; i < 12; ++i) {
      const double angle = i * kPi / 6;
      const double h = side / 2;
      FencedWorld world({{"pond", true, {{-h, -h}, {h, -h}, {h, h}, {-h, h}}}},
                        {6 * std::cos(angle), 6 * std::sin(angle), angle + kPi});
      world.start(1.0, 1.0);
      world.runFor(15'000'000);
      CHECK(world.least_room >= 0.0);
      CHECK(world.least_room < 1.0);
      CHECK(world.state() == BridgeState::kDisarmed);
    }
  }
}

TEST_CASE("the worse the position is known, the earlier it stops") {
  double before = 0.0;
  for (const double std : {0.0, 0.1, 0.5}) {
    FencedWorld world({yard()});
    world.motion.position_std = std;
    world.start(1.0, 1.0);
    world.runFor(20'000'000);
    CHECK(world.least_room >= before);
    before = world.least_room + 0.1;
  }
  FencedWorld unknown({yard()});
  unknown.motion.position_std = std::nan("");
  unknown.start(1.0, 1.0);
  unknown.runFor(20'000'000);
  CHECK(unknown.least_room > 0.15);
}

TEST_CASE("what measures no velocity counts as fast as it can be") {
  struct Blind : BridgeWorld {
  } world;
  world.bridge = Bridge(fenced({yard()}));
  world.motion = InsMotion{0, 9.0, 0.0, 0.0};
  world.drive();
  // It would cross the fence within its stopping time.
  CHECK(world.state() == BridgeState::kDisarmed);
  CHECK_THAT(world.reason(), Contains("fence yard"));
}

TEST_CASE("blind for its speed it stops at a fence, and is driven away from it and back in") {
  for (const bool no_turn : {false, true}) {
    FencedWorld world({yard()}, {9.0, 0, 0});
    world.blind(true, no_turn);
    world.start(0.3, 0.3);
    CHECK(world.state() == BridgeState::kDisarmed);
    CHECK_THAT(world.reason(), Contains("fence yard"));
    CHECK(world.truth.x < 9.1);
    world.restart(-1.0, -1.0);
    world.runFor(3'000'000);
    CHECK(world.state() == BridgeState::kDriving);
    CHECK(world.truth.x < 7.0);
    FencedWorld out({yard()}, {14.0, 0, 0});
    out.blind(true, no_turn);
    out.start(0.3, 0.3);
    out.runFor(1'000'000);
    CHECK(out.state() == BridgeState::kDisarmed);
    CHECK_THAT(out.reason(), Contains("outside fence yard"));
    CHECK(out.truth.x < 14.2);
    out.restart(-1.0, -1.0);
    out.runFor(9'000'000);
    CHECK(out.state() == BridgeState::kDriving);
    CHECK(out.truth.x < 9.0);
  }
}

TEST_CASE("blind for its speed it counts as fast after its last command, and then as standing") {
  FencedWorld world({yard()}, {4.0, 0, 0});
  world.blind(true, false);
  world.start(1.0, 1.0);
  while (world.state() == BridgeState::kDriving) world.runFor(10'000);
  const int64_t stopped = world.now;
  // It reports the reason as long as it may still continue.
  while (world.now < stopped + 700'000) {
    world.runFor(10'000);
    REQUIRE_THAT(world.reason(), Contains("fence yard"));
  }
  world.restart(-1.0, -1.0);
  CHECK(world.state() == BridgeState::kDriving);
}

TEST_CASE("a turn that is not measured does not make a known speed unknown") {
  FencedWorld world({yard()}, {8.5, 0, 0});
  world.blind(false, true);
  world.start(0.15, 0.15);
  world.runFor(20'000'000);
  CHECK(world.state() == BridgeState::kDisarmed);
  CHECK(world.least_room >= 0.0);
  CHECK(world.least_room < 0.25);
}

TEST_CASE("over a ditch it drives out to either side, but not across, and not back again") {
  const Fence ditch{"ditch", true, {{-0.1, -9}, {0.1, -9}, {0.1, 9}, {-0.1, 9}}};
  for (const double side : {-1.0, 1.0})
    for (const double yaw : {0.0, 0.3}) {
      const Pose2 there{side * 0.3, 0, yaw};
      FencedWorld out({ditch}, there);
      out.start(side, side);
      out.runFor(3'000'000);
      CHECK(out.state() == BridgeState::kDriving);
      CHECK(side * out.truth.x > 1.0);
      FencedWorld across({ditch}, there);
      across.start(-side, -side);
      across.runFor(3'000'000);
      CHECK(across.state() == BridgeState::kDisarmed);
      CHECK_THAT(across.reason(), Contains("outside fence ditch") && Contains("only back in"));
      CHECK(side * across.truth.x > 0.1);
      // Outwards for a part, then back.
      FencedWorld turns({ditch}, there);
      turns.start(0.5 * side, 0.5 * side);
      turns.runFor(300'000);
      REQUIRE(turns.state() == BridgeState::kDriving);
      const double reached = side * turns.truth.x;
      REQUIRE(reached < 0.6);
      turns.planner.always = TrackCommand{-0.5 * side, -0.5 * side};
      turns.runFor(3'000'000);
      CHECK(turns.state() == BridgeState::kDisarmed);
      CHECK(side * turns.truth.x > reached - 0.1);
    }
}

TEST_CASE("over a fence only the way back in is driven") {
  for (const double x : {10.2, 10.6, 14.0}) {
    FencedWorld out({yard()}, {x, 0, 0});
    out.start(1.0, 1.0);
    out.runFor(2'000'000);
    CHECK(out.state() == BridgeState::kDisarmed);
    CHECK_THAT(out.reason(), Contains("outside fence yard by") && Contains("only back in"));
    CHECK(out.truth.x < x + 0.4);
    FencedWorld back({yard()}, {x, 0, 0});
    back.start(-1.0, -1.0);
    back.runFor(9'000'000);
    CHECK(back.state() == BridgeState::kDriving);
    CHECK(back.truth.x < 9.0);
  }
}

TEST_CASE("over a fence it does not go back and forth: half a way back is not given up again") {
  FencedWorld world({yard()}, {14, 0, 0});
  world.start(-1.0, -1.0);
  world.runFor(2'000'000);
  REQUIRE(world.state() == BridgeState::kDriving);
  const double reached = world.truth.x;
  world.planner.always = TrackCommand{1.0, 1.0};
  world.runFor(3'000'000);
  CHECK(world.state() == BridgeState::kDisarmed);
  CHECK(world.truth.x < reached + 0.1);
}

TEST_CASE("back over one fence it does not cross another one") {
  FencedWorld world({yard(), {"pond", true, {{5, -3}, {8, -3}, {8, 3}, {5, 3}}}}, {14, 0, 0});
  world.start(-1.0, -1.0);
  world.runFor(15'000'000);
  CHECK(world.state() == BridgeState::kDisarmed);
  CHECK_THAT(world.reason(), Contains("fence pond"));
  CHECK(world.truth.x - 0.65 >= 8.0);
}

TEST_CASE("a fence that comes while it drives stops it, whoever sent it") {
  FencedWorld world({});
  world.start(1.0, 1.0);
  REQUIRE(world.state() == BridgeState::kDriving);
  world.add(yard());
  world.runFor(20'000'000);
  CHECK(world.least_room >= 0.0);
  CHECK(world.state() == BridgeState::kDisarmed);
  CHECK(world.bridge.counters().at("FENCE added") == 1);
}

TEST_CASE("strangers who fill the book do not keep the operator's fence out") {
  FencedWorld world({});
  world.start(0.0, 0.0);
  for (size_t i = 0; i < FenceBook::kMost; ++i) {
    const double x = 100.0 + static_cast<double>(i);
    world.add({"far", true, {{x, 0}, {x + 1, 0}, {x, 1}}});
  }
  world.add(yard(), "ADA (operator)");
  const std::vector<Fence>& fences = world.bridge.fences().fences();
  CHECK(fences.front().name == "yard");
  CHECK(fences.size() == FenceBook::kMost);
}

TEST_CASE("a fence is removed by the operator who holds the robot, and by nobody else") {
  FencedWorld world({});
  world.start(0.0, 0.0);
  world.add(yard());
  world.remove("yard", "stranger");
  CHECK(world.bridge.fences().fences().size() == 1);
  world.remove("yard", "ADA (operator)");
  CHECK(world.bridge.fences().fences().size() == 0);
  world.add(yard());
  world.operator_alive = false;
  world.runFor(3'000'000);
  world.remove("yard", "operator");
  CHECK(world.bridge.fences().fences().size() == 1);
}

TEST_CASE("without fences nothing is looked at") {
  FencedWorld world({});
  world.start(1.0, 1.0);
  world.runFor(60'000'000);
  CHECK(world.state() == BridgeState::kDriving);
  CHECK(world.truth.x > 50.0);
}

TEST_CASE(
    "on ground on which it takes longer to stop than its file says it learns to stop earlier") {
  FencedWorld world({});
  world.lag = 0.9;
  world.start(1.0, 1.0);
  world.runFor(4'000'000);
  world.bridge.receive(ArmRequest{world.now, false, "operator", ""}, world.now);
  world.runFor(6'000'000);
  REQUIRE(world.bridge.stopping().count() == 1);
  CHECK(world.bridge.stopping().seconds() > 0.9);
  const double near = world.truth.x + 20.0;
  world.add({"pond", true, {{near, -9}, {near + 9, -9}, {near + 9, 9}, {near, 9}}});
  world.arm();
  world.runFor(60'000'000);
  CHECK(world.state() == BridgeState::kDisarmed);
  CHECK(world.truth.x > near - 5.0);
  CHECK(world.least_room >= 0.0);
}

TEST_CASE("an INS message that was overtaken puts the robot nowhere else") {
  FencedWorld world({yard()}, {8.9, 0, 0});
  world.start(0.0, 0.0);
  InsMotion far = world.motion;
  far.x = 0.0;
  world.planner.always = TrackCommand{0.8, 0.8};
  for (int i = 0; i < 300; ++i) {
    world.move();
    far.utime = world.now - 25'000;
    world.bridge.receive(InsNotice{far.utime, true, far, world.ins_seq, world.tilt}, world.now);
  }
  CHECK(world.least_room >= 0.0);
}

namespace {

constexpr int64_t kFenceNow = 10'000'000;  // [us]

/// The watch alone: a robot in the yard, `room` [m] from its front to the fence ahead.
struct FenceBench {
  FenceWatch watch{{{yard()}, kBody, 0.5}, {}};
  InsMotion ins{kFenceNow, 0, 0, 0, 0.0, 0.0, 0.0, 0.0};

  explicit FenceBench(double room = 5.0) { ins.x = 10.0 - 0.65 - room; }
  std::string fault(int64_t now = kFenceNow) {
    watch.receive(ins);
    return watch.fault(now).words;
  }
};

}  // namespace

TEST_CASE("room is told in centimetres") {
  const std::pair<double, std::string> cases[] = {{0.05, "0.05 m"}, {0.4, "0.40 m"}};
  for (const auto& [room, words] : cases) {
    FenceBench bench(room);
    bench.ins.v_forward = 1.0;
    CHECK(bench.fault() ==
          "fence yard: " + words + " of room, less than it takes to stop; drive away from it");
  }
}

TEST_CASE("a pose counts for half a second, and for a second it is told that none does") {
  FenceBench bench;
  CHECK(bench.fault(kFenceNow + 500'000).empty());
  CHECK(bench.fault(kFenceNow + 500'001) == "position unknown: fences cannot be kept");
  CHECK_FALSE(bench.fault(kFenceNow + 1'500'001).empty());
  CHECK(bench.fault(kFenceNow + 1'500'002).empty());
  bench.ins.utime = kFenceNow + 2'000'000;
  CHECK(bench.fault(kFenceNow + 2'000'000).empty());
  CHECK_FALSE(bench.fault(kFenceNow + 2'600'000).empty());
}

TEST_CASE("the age of a pose is driven on, up to half a second") {
  FenceBench bench(0.7);
  bench.ins.v_forward = 1.0;
  CHECK(bench.fault(kFenceNow + 190'000).empty());
  CHECK_FALSE(bench.fault(kFenceNow + 210'000).empty());
  FenceBench from_future(0.45);
  from_future.ins.v_forward = 1.0;
  CHECK_FALSE(from_future.fault(kFenceNow - 200'000).empty());
}

TEST_CASE("3 cm/s and 3 crad/s are a motion, less is none") {
  FenceBench ahead(0.01);
  ahead.ins.v_forward = 0.03;
  CHECK_FALSE(ahead.fault().empty());
  ahead.ins.v_forward = 0.029;
  CHECK(ahead.fault().empty());
  FenceBench beside;
  beside.ins.y = 5.0 - 0.34 - 1e-4;
  beside.ins.yaw_rate = 0.03;
  CHECK_FALSE(beside.fault().empty());
  beside.ins.yaw_rate = 0.029;
  CHECK(beside.fault().empty());
}

TEST_CASE("a position that is told without its accuracy is no better known than the one before") {
  FenceBench bench(0.3);
  bench.ins.v_forward = 0.2;
  CHECK(bench.fault().empty());
  bench.ins.position_std = 0.11;
  CHECK_FALSE(bench.fault().empty());
  bench.ins.position_std = InsMotion::kUnknown;
  bench.watch.restart();
  bench.ins.x -= 0.005;
  CHECK_FALSE(bench.fault().empty());
}

TEST_CASE("over a fence a way may lead 5 cm farther out, for poses are no better known") {
  FenceBench bench(-0.2);
  CHECK(bench.fault().empty());
  bench.ins.v_forward = 0.098;
  CHECK(bench.fault().empty());
  bench.ins.v_forward = 0.102;
  CHECK_THAT(bench.fault(), Contains("outside fence yard by 0.20 m: only back in"));
}

TEST_CASE("ways are looked at every 0.1 s: a corner that swings out between is seen") {
  // With the outline's diagonal towards the fence the corner is farthest out.
  const double reach = std::hypot(0.65, 0.34);
  const double diagonal = kPi / 2 - std::atan2(0.34, 0.65);
  constexpr double kRate = 1.3;  // [rad/s]
  const auto faultWhenOutAfter = [&](double seconds) {
    FenceBench bench;
    bench.ins.yaw_rate = kRate;
    bench.ins.yaw = diagonal - kRate * seconds;
    bench.ins.y = 5.0 - reach + 0.001;
    return bench.fault();
  };
  CHECK_FALSE(faultWhenOutAfter(0.1).empty());
  CHECK_FALSE(faultWhenOutAfter(0.3).empty());
  CHECK_FALSE(faultWhenOutAfter(0.5).empty());
  CHECK(faultWhenOutAfter(0.25).empty());  // by 1 mm for 80 ms
}

TEST_CASE("of a commanded turn 0.7 are made at most, measured or not") {
  const double turned = 0.7 * (2 * kSpeed * 0.05 / kGauge) * 0.5;  // [rad]
  const double corner = 0.65 * std::sin(turned) + 0.34 * std::cos(turned);
  for (const double rate : {0.0, InsMotion::kUnknown}) {
    FenceBench bench;
    bench.ins.yaw_rate = rate;
    bench.watch.command({-0.05, 0.05}, kFenceNow);
    bench.ins.y = 5.0 - corner + 0.001;
    CHECK_FALSE(bench.fault().empty());
    bench.ins.y = 5.0 - corner - 0.001;
    CHECK(bench.fault().empty());
  }
}

TEST_CASE("a measured drift to the side counts beside a command of the same speed") {
  FenceBench bench;
  bench.ins.y = 5.0 - 0.34 - 0.1;
  bench.ins.v_forward = 0.5 * kSpeed;
  bench.watch.command({0.5, 0.5}, kFenceNow);
  CHECK(bench.fault().empty());
  bench.ins.v_left = 0.5;
  CHECK_FALSE(bench.fault().empty());
}

TEST_CASE("the fastest command of the last 0.25 s may still be under way, and then no more") {
  FenceBench bench(0.3);
  bench.watch.command({0.0, 0.0}, kFenceNow);
  CHECK(bench.fault().empty());
  bench.watch.command({1.0, 1.0}, kFenceNow);
  CHECK_FALSE(bench.fault().empty());
  bench.watch.command({0.2, 0.1}, kFenceNow + 10'000);
  bench.watch.command({0.2, 0.1}, kFenceNow + 259'999);
  CHECK_FALSE(bench.fault(kFenceNow + 10'000).empty());
  bench.watch.command({0.2, 0.1}, kFenceNow + 260'000);
  CHECK(bench.fault(kFenceNow + 10'000).empty());
}

TEST_CASE("blind for its speed, one track backwards may move it backwards") {
  for (const TrackCommand& command : {TrackCommand{-0.05, 0.05}, TrackCommand{0.05, -0.05}}) {
    FenceBench behind;
    behind.ins.x = -5.0 + 0.65 + 0.3;
    behind.ins.v_forward = InsMotion::kUnknown;
    behind.watch.command(command, kFenceNow);
    CHECK_FALSE(behind.fault().empty());
    FenceBench ahead(0.3);
    ahead.ins.v_forward = InsMotion::kUnknown;
    ahead.watch.command(command, kFenceNow);
    CHECK_FALSE(ahead.fault().empty());
  }
}

TEST_CASE("blind for its speed, a command counts for its delay and the stopping time, 0.75 s") {
  const auto behind = [] {
    FenceBench bench;
    bench.ins.x = -5.0 + 0.65 + 0.3;
    bench.ins.v_forward = InsMotion::kUnknown;
    return bench;
  };
  FenceBench back = behind();
  back.watch.command({-0.05, -0.05}, kFenceNow - 749'999);
  back.watch.command({0.0, 0.0}, kFenceNow - 740'000);
  CHECK_FALSE(back.fault().empty());
  CHECK(back.fault(kFenceNow + 1).empty());
  FenceBench ahead(0.3);
  ahead.ins.v_forward = InsMotion::kUnknown;
  ahead.watch.command({0.05, 0.05}, kFenceNow - 749'999);
  ahead.watch.command({0.0, 0.0}, kFenceNow - 740'000);
  CHECK_FALSE(ahead.fault().empty());
  CHECK(ahead.fault(kFenceNow + 1).empty());
  for (const TrackCommand& no_way_back : {TrackCommand{0.05, 0.0}, TrackCommand{0.0, 0.05}}) {
    FenceBench bench = behind();
    bench.watch.command(no_way_back, kFenceNow);
    CHECK(bench.fault().empty());
  }
}

TEST_CASE("blind for its speed, a measured turn on the spot counts where nothing was commanded") {
  FenceBench bench;
  bench.ins.y = 5.0 - 0.65 - 0.01;
  bench.ins.yaw = -kPi / 2;  // its rear at the fence
  bench.ins.v_forward = InsMotion::kUnknown;
  bench.ins.yaw_rate = 0.3;
  CHECK_FALSE(bench.fault().empty());
  bench.watch.command({0.5, 0.5}, kFenceNow);  // away from it
  CHECK(bench.fault().empty());
}

TEST_CASE("of two commands as fast the older one counts, too") {
  FenceBench bench(0.3);
  bench.watch.command({1.0, 1.0}, kFenceNow);
  bench.watch.command({-1.0, 1.0}, kFenceNow);
  CHECK_FALSE(bench.fault().empty());
}

TEST_CASE("a turn that is not measured is as commanded, a measured one is not") {
  FenceBench bench;
  bench.ins.v_forward = 1.0;
  bench.ins.y = 5.0 - 0.76;  // beyond the swing of a turn on the spot
  bench.watch.command({-0.5, 0.5}, kFenceNow);
  CHECK(bench.fault().empty());
  bench.ins.yaw_rate = InsMotion::kUnknown;
  CHECK_FALSE(bench.fault().empty());
}

TEST_CASE("a turn that is neither measured nor commanded is none, a measured one no way ahead") {
  FenceBench bench(0.4);
  bench.ins.v_forward = 1.0;
  bench.ins.yaw_rate = InsMotion::kUnknown;
  CHECK_FALSE(bench.fault().empty());
  bench.ins.yaw_rate = 4.0;
  CHECK(bench.fault().empty());
}

TEST_CASE("who was within, or just at the fence, may stand where it is found outside") {
  for (const double room : {0.3, 0.0}) {
    FenceBench bench;
    bench.watch = FenceWatch({{yard()}, {0.5, 0.5, 0.25}, 0.5}, {});
    bench.ins.position_std = 0.0;
    bench.ins.x = 10.0 - 0.5 - room;
    CHECK(bench.fault().empty());
    bench.ins.x = 10.0 - 0.5 + 0.2;
    CHECK(bench.fault().empty());
  }
}

TEST_CASE("outside it may not be farther out than it was, where it stands, either") {
  FenceBench bench(-0.2);
  CHECK(bench.fault().empty());
  bench.ins.x += 0.2;
  CHECK_THAT(bench.fault(), Contains("only back in"));
  // Another fence: its present position is evaluated again.
  FenceBook& book = bench.watch.book();
  const Fence moved{"moved", false, {{-5, -5}, {9, -5}, {9, 5}, {-5, 5}}};
  FenceWatch watch({{}, kBody, 0.5}, {});
  REQUIRE(watch.book().take({"operator", false, yard()}, true) == FenceReceipt::kAdded);
  bench.watch = watch;
  bench.ins.x = 10.0 - 0.65 + 0.2;
  CHECK(bench.fault().empty());
  REQUIRE(book.take({"operator", true, {"yard", false, {}}}, true) == FenceReceipt::kRemoved);
  REQUIRE(book.take({"operator", false, moved}, true) == FenceReceipt::kAdded);
  CHECK(bench.fault().empty());
}

TEST_CASE("at a fence, and 5 cm farther out, to the last bit") {
  const Fence border{"border", false, {{-9, -9}, {0, -9}, {0, 9}, {-9, 9}}};
  FenceBench bench;
  bench.watch = FenceWatch({{border}, {0.5, 0.5, 0.25}, 0.5}, {});
  bench.ins.x = -0.5;
  bench.ins.v_forward = 1.0;
  CHECK_THAT(bench.fault(), Contains("fence border: 0.00 m of room"));
  bench.ins.v_forward = 0.0;
  bench.ins.x = -0.25;
  CHECK(bench.fault().empty());
  bench.ins.x = -0.2;
  CHECK(bench.fault().empty());
  bench.ins.x = -0.199;
  CHECK_FALSE(bench.fault().empty());
}

TEST_CASE("the first of two fences in its way is told, whatever the second one is") {
  FenceBench bench(0.3);
  const Fence pond{"pond", true, {{-4, -4}, {-3, -4}, {-3, -3}, {-4, -3}}};
  bench.watch = FenceWatch({{yard(), pond}, kBody, 0.5}, {});
  bench.ins.v_forward = 1.0;
  CHECK_THAT(bench.fault(), Contains("fence yard"));
}
