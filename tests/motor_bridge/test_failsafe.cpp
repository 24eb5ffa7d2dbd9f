// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "modules/motor_bridge/core/failsafe.hpp"
#include "tests/helpers.hpp"

using namespace tread;
using namespace tread::motor;

namespace {

constexpr int64_t kCycle = 10'000;

/// Drives a failsafe in virtual time; inputs are good unless set otherwise.
struct Rig {
  Failsafe failsafe;
  FailsafeInputs in;
  FailsafeOutputs out;

  Rig() {
    in.now = 1'000'000;
    in.leased = true;
  }

  void step() {
    in.now += kCycle;
    out = failsafe.update(in);
    in.arm = in.disarm = false;
    in.series_end = {};
  }
  void run(int64_t us) {
    for (const int64_t end = in.now + us; in.now < end;) step();
  }
  void arm() {
    run(1'100'000);
    in.arm = true;
    in.requested_by = "operator";
    step();
    REQUIRE(out.state == BridgeState::kArmed);
  }
  void drive() {
    arm();
    in.start_wanted = true;
    step();
    REQUIRE(out.state == BridgeState::kDriving);
    in.start_wanted = false;
    in.playing = true;
  }
};

/// The inputs that stop, highest priority first, with the resulting state.
struct Cause {
  Reason FailsafeInputs::*fault;
  BridgeState state;
  StopReason code;
};
const std::vector<Cause> kCauses = {
    {&FailsafeInputs::link_fault, BridgeState::kFault, StopReason::kControllerLost},
    {&FailsafeInputs::device_fault, BridgeState::kFault, StopReason::kControllerFault},
    {&FailsafeInputs::bridge_fault, BridgeState::kFault, StopReason::kBridgeHeldUp},
    {&FailsafeInputs::program_fault, BridgeState::kDisarmed, StopReason::kBadProgram},
    {&FailsafeInputs::operator_fault, BridgeState::kDisarmed, StopReason::kOperatorLost},
    {&FailsafeInputs::lease_fault, BridgeState::kDisarmed, StopReason::kProgramLate},
    {&FailsafeInputs::ins_fault, BridgeState::kDisarmed, StopReason::kInsStale},
    {&FailsafeInputs::tilt_fault, BridgeState::kDisarmed, StopReason::kTilt},
    {&FailsafeInputs::fence_fault, BridgeState::kDisarmed, StopReason::kFenceNear},
    {&FailsafeInputs::motion_fault, BridgeState::kDisarmed, StopReason::kStuck},
};

}  // namespace

TEST_CASE("an INS message counts once, and neither from the future nor from long ago") {
  InsWatch watch({});
  constexpr int64_t kNow = 10'000'000;
  CHECK_FALSE(watch.receive({kNow + 60'000}, kNow));
  CHECK(watch.receive({kNow - 20'000}, kNow));
  CHECK_FALSE(watch.receive({kNow - 20'000}, kNow));  // a repetition
  CHECK_FALSE(watch.receive({kNow - 40'000}, kNow));  // overtaken
  CHECK_FALSE(watch.receive({kNow + 2'000'000 - 600'000}, kNow + 2'000'000));
}

TEST_CASE("it comes up disarmed and does not arm by itself") {
  Rig rig;
  rig.in.start_wanted = true;
  rig.run(60'000'000);
  CHECK(rig.out.state == BridgeState::kDisarmed);
  CHECK_FALSE(rig.out.may_drive);
  CHECK(rig.out.reason == "not armed yet");
}

TEST_CASE("arming needs a second of good inputs, and says so") {
  Rig rig;
  rig.run(500'000);
  rig.in.arm = true;
  rig.step();
  CHECK(rig.out.state == BridgeState::kDisarmed);
  CHECK(rig.out.arm_refused);
  CHECK(rig.out.reason == "not armed yet; ARM refused: inputs good for 500 ms, 1000 are needed");
  rig.run(600'000);
  rig.in.arm = true;
  rig.step();
  CHECK(rig.out.state == BridgeState::kArmed);
}

TEST_CASE("every cause stops in the very step it is seen, stays stopped and needs ARM") {
  for (const Cause& cause : kCauses) {
    Rig rig;
    rig.drive();
    rig.in.*cause.fault = {cause.code, "something"};
    rig.step();
    CHECK_FALSE(rig.out.may_drive);
    CHECK(rig.out.state == cause.state);
    CHECK(rig.out.reason == "something");
    rig.in.playing = false;
    rig.in.*cause.fault = {};
    rig.in.start_wanted = true;
    rig.run(10'000'000);
    CHECK(rig.out.state == cause.state);
    CHECK(rig.out.standing_fault.empty());
    rig.in.arm = true;
    rig.step();
    CHECK(rig.out.state == BridgeState::kArmed);
    CHECK_FALSE(rig.out.may_drive);
    rig.step();
    CHECK(rig.out.state == BridgeState::kDriving);
  }
}

TEST_CASE("ARM while a fault stands is refused with that fault") {
  for (const Cause& cause : kCauses) {
    Rig rig;
    rig.run(2'000'000);
    rig.in.*cause.fault = {cause.code, "something"};
    rig.in.arm = true;
    rig.step();
    CHECK(rig.out.state == BridgeState::kDisarmed);
    CHECK(rig.out.reason == "not armed yet; ARM refused: something");
  }
}

TEST_CASE("the worst cause is the one that is named") {
  for (size_t worst = 0; worst < kCauses.size(); ++worst) {
    Rig rig;
    rig.drive();
    for (size_t i = worst; i < kCauses.size(); ++i)
      rig.in.*kCauses[i].fault = {kCauses[i].code, "cause " + std::to_string(i)};
    rig.step();
    CHECK(rig.out.reason == "cause " + std::to_string(worst));
    CHECK(rig.out.state == kCauses[worst].state);
  }
}

TEST_CASE("a second E-stop, or a second fault of one kind, is not hidden behind the first") {
  Rig rig;
  rig.drive();
  rig.in.estop = true;
  rig.in.estop_reason = "smoke (ada)";
  rig.step();
  CHECK(rig.out.standing_said);
  rig.in.estop_reason = "person in front (ben)";
  rig.step();
  CHECK(rig.out.reason == "E-stop: smoke (ada)");
  CHECK_FALSE(rig.out.standing_said);
  CHECK(rig.out.standing_fault.words == "E-stop: person in front (ben)");
}

TEST_CASE("an E-stop wins over everything, latches, and needs clearing and then ARM") {
  Rig rig;
  rig.drive();
  rig.in.estop = true;
  rig.in.estop_reason = "person in front (operator)";
  rig.in.link_fault = {StopReason::kControllerLost, "gone"};
  rig.step();
  CHECK(rig.out.state == BridgeState::kEstop);
  CHECK(rig.out.reason == "E-stop: person in front (operator)");
  rig.in.playing = false;
  rig.in.link_fault = {};
  rig.run(3'000'000);
  rig.in.arm = true;
  rig.step();
  CHECK(rig.out.state == BridgeState::kEstop);
  CHECK(rig.out.arm_refused);
  rig.in.estop = false;
  rig.run(5'000'000);
  CHECK(rig.out.state == BridgeState::kDisarmed);
  CHECK(rig.out.reason == "E-stop cleared");
  rig.in.arm = true;
  rig.step();
  CHECK(rig.out.state == BridgeState::kArmed);
}

TEST_CASE("an E-stop reaches a bridge that is disarmed or in fault, too") {
  for (const bool fault : {false, true}) {
    Rig rig;
    if (fault) {
      rig.drive();
      rig.in.link_fault = {StopReason::kControllerLost, "gone"};
      rig.step();
      REQUIRE(rig.out.state == BridgeState::kFault);
    }
    rig.in.estop = true;
    rig.step();
    CHECK(rig.out.state == BridgeState::kEstop);
  }
}

TEST_CASE("the normal end of a series stops, stays armed and may go on after one zero") {
  Rig rig;
  rig.drive();
  rig.in.playing = false;
  rig.in.start_wanted = true;
  rig.in.series_end = StopReason::kSeriesEnded;
  rig.step();
  CHECK(rig.out.state == BridgeState::kStopping);
  CHECK_FALSE(rig.out.may_drive);
  CHECK(rig.out.reason == "series ended without a next");
  rig.step();
  CHECK(rig.out.state == BridgeState::kDriving);
}

TEST_CASE(
    "zero is repeated at the command rate for a second after every stop, then at the idle rate") {
  Rig rig;
  rig.drive();
  rig.in.playing = false;
  rig.step();
  const int64_t stopped = rig.in.now;
  while (rig.out.zero_fast) rig.step();
  CHECK(rig.in.now - stopped == 1'000'000);
  CHECK(rig.out.state == BridgeState::kArmed);
  rig.run(5'000'000);
  rig.in.estop = true;
  rig.step();
  CHECK(rig.out.zero_fast);
}

TEST_CASE("disarming stops, and wins over arming in the same step") {
  Rig rig;
  rig.drive();
  rig.in.arm = true;
  rig.in.disarm = true;
  rig.in.requested_by = "operator";
  rig.step();
  CHECK(rig.out.state == BridgeState::kDisarmed);
  CHECK(rig.out.reason == "disarmed by operator");
}

TEST_CASE("any sequence of inputs keeps the promises (ten hours of random scenario)") {
  std::mt19937_64 random(20260701);
  const auto chance = [&random](double p) {
    return static_cast<double>(random() >> 11) * 0x1.0p-53 < p;
  };
  Rig rig;
  int64_t good_since = 0;
  for (int step = 0; step < testing::effort(3'600'000); ++step) {
    const BridgeState before = rig.failsafe.state();
    bool good = true;
    for (const Cause& cause : kCauses) {
      Reason& fault = rig.in.*cause.fault;
      const bool bad = fault.empty() ? chance(0.0005) : !chance(0.05);
      fault = bad ? Reason(cause.code) : Reason();
      good = good && !bad;
    }
    rig.in.estop = rig.in.estop ? !chance(0.02) : chance(0.0003);
    good = good && !rig.in.estop;
    const bool arm = rig.in.arm = chance(0.01);
    rig.in.disarm = chance(0.0005);
    rig.in.start_wanted = chance(0.5);
    rig.in.playing = before == BridgeState::kDriving && chance(0.98);
    rig.step();
    if (!good) good_since = rig.in.now + kCycle;
    const BridgeState after = rig.out.state;
    const bool enabled = !isArmed(before) && isArmed(after);
    REQUIRE(rig.out.may_drive == (after == BridgeState::kDriving));
    REQUIRE((good || !rig.out.may_drive));
    REQUIRE((!enabled || (arm && rig.in.now - good_since >= 1'000'000)));
    REQUIRE((before != BridgeState::kDriving || rig.in.playing || !rig.out.may_drive));
    REQUIRE((!rig.in.estop || after == BridgeState::kEstop));
  }
}

TEST_CASE("inputs that were good for a second to the microsecond are enough to arm") {
  FailsafeInputs in;
  in.now = 1'000'000;
  in.leased = true;
  for (const int64_t early : {1, 0}) {
    Failsafe failsafe;
    in.now = 1'000'000;
    failsafe.update(in);
    in.now = 2'000'000 - early;
    in.arm = true;
    CHECK(failsafe.update(in).arm_refused == (early > 0));
    CHECK(isArmed(failsafe.state()) == (early == 0));
    in.arm = false;
  }
}

TEST_CASE("each change of state, of its reason or of a refusal is told, and nothing else") {
  Rig rig;
  rig.step();
  CHECK_FALSE(rig.out.changed);
  rig.in.arm = true;
  rig.step();
  CHECK(rig.out.arm_refused);
  CHECK(rig.out.changed);  // only the refusal is new
  rig.step();
  CHECK_FALSE(rig.out.arm_refused);
  CHECK_FALSE(rig.out.changed);
  rig.arm();
  CHECK_FALSE(rig.out.arm_refused);
  CHECK(rig.out.changed);
  rig.in.playing = rig.in.start_wanted = true;
  rig.step();
  REQUIRE(rig.out.state == BridgeState::kDriving);
  rig.in.playing = rig.in.start_wanted = false;
  rig.step();
  REQUIRE(rig.out.state == BridgeState::kStopping);
  const std::string reason = rig.out.reason;
  CHECK(reason == "series ended");  // no reason was given
  const int64_t stopped = rig.in.now;
  while (rig.out.state == BridgeState::kStopping) {
    rig.step();
    CHECK(rig.out.changed == (rig.out.state == BridgeState::kArmed));
  }
  CHECK(rig.out.reason == reason);  // only the state is new
  CHECK(rig.in.now - stopped == 1'000'000);
}

TEST_CASE("disarming a robot in fault leaves the fault to be seen, and when it stopped") {
  Rig rig;
  rig.arm();
  rig.in.link_fault = {StopReason::kControllerLost, "the line is down"};
  rig.step();
  const int64_t stopped = rig.failsafe.disarmedAt();
  CHECK(stopped == rig.in.now);
  rig.in.link_fault = {};
  rig.run(100'000);
  rig.in.disarm = true;
  rig.step();
  CHECK(rig.out.state == BridgeState::kFault);
  CHECK(rig.out.reason == "the line is down");
  CHECK(rig.failsafe.disarmedAt() == stopped);
  rig.arm();
  REQUIRE(isArmed(rig.out.state));
  CHECK(rig.failsafe.disarmedAt() == stopped);
}

TEST_CASE("armed for the hand it says whose, and a series waits a step after it is given back") {
  Rig rig;
  rig.in.hand = true;
  rig.in.hand_words = "driven by hand by ada";
  rig.in.ins_fault = StopReason::kNoIns;
  rig.run(1'100'000);
  rig.in.arm = true;
  rig.in.requested_by = "ada";
  rig.step();
  CHECK(rig.out.state == BridgeState::kManual);
  CHECK(rig.out.reason == "driven by hand by ada");
  rig.in.ins_fault = {};
  rig.in.hand = false;
  rig.in.start_wanted = true;
  rig.step();
  CHECK(rig.out.state == BridgeState::kStopping);
  CHECK(rig.out.reason == "given back by hand");
  rig.step();
  CHECK(rig.out.state == BridgeState::kDriving);
}

TEST_CASE("armed with no hand there it says by whom") {
  Rig rig;
  rig.in.hand_words = "nobody's hand";
  rig.arm();
  CHECK(rig.out.reason == "armed by operator");
}
