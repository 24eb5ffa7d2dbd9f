// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <limits>
#include <set>

#include <catch2/catch.hpp>

#include "modules/motor_bridge/core/failsafe.hpp"
#include "modules/motor_bridge/core/program.hpp"
#include "tests/motor_bridge/programs.hpp"

using namespace tread;
using namespace tread::motor;

namespace {

constexpr int64_t kNow = 10'000'000;

ProgramRefusal admit(ProgramGate& gate, const Program& program, int64_t now = kNow) {
  return gate.admit(program, now, true).refusal;
}

}  // namespace

TEST_CASE("programs from the future and older than the lease are refused") {
  ProgramGate gate({});
  CHECK(admit(gate, makeProgram(kNow + 50'001, makeSlot(1, 4))) == ProgramRefusal::kFromFuture);
  CHECK(admit(gate, makeProgram(kNow - 200'001, makeSlot(1, 4))) == ProgramRefusal::kTooOld);
  CHECK(admit(gate, makeProgram(kNow - 200'000, makeSlot(1, 4))) == ProgramRefusal::kNone);
  CHECK(admit(gate, makeProgram(kNow + 50'000, makeSlot(1, 4))) == ProgramRefusal::kNone);
}

TEST_CASE("stamp zero is not now, and lease zero is not for ever") {
  ProgramGate gate({});
  CHECK(admit(gate, makeProgram(0, makeSlot(1, 4))) == ProgramRefusal::kTooOld);
  Program program = makeProgram(kNow, makeSlot(1, 4));
  program.lease_us = 0;
  CHECK(admit(gate, program) == ProgramRefusal::kBadLease);
  program.lease_us = -1;
  CHECK(admit(gate, program) == ProgramRefusal::kBadLease);
}

TEST_CASE("duplicated and reordered programs are refused and do not renew anything") {
  ProgramGate gate({});
  CHECK(admit(gate, makeProgram(kNow, makeSlot(1, 4))) == ProgramRefusal::kNone);
  CHECK(admit(gate, makeProgram(kNow, makeSlot(1, 4))) == ProgramRefusal::kOutOfOrder);
  CHECK(admit(gate, makeProgram(kNow - 50'000, makeSlot(1, 4))) == ProgramRefusal::kOutOfOrder);
  CHECK_FALSE(gate.leaseValid(kNow));
}

TEST_CASE(
    "the lease runs from receipt and from utime, whichever is older, and is never longer than "
    "allowed") {
  ProgramGate gate({});
  Program program = makeProgram(kNow - 120'000, makeSlot(1, 4));
  program.lease_us = 10'000'000;
  gate.renew(program, kNow);
  CHECK(gate.leaseValid(kNow + 80'000));
  CHECK_FALSE(gate.leaseValid(kNow + 80'001));
  program.utime = kNow + 40'000;
  gate.renew(program, kNow);
  CHECK(gate.leaseValid(kNow + 200'000));
  CHECK_FALSE(gate.leaseValid(kNow + 200'001));
}

TEST_CASE("a planner may ask for a shorter lease") {
  ProgramGate gate({});
  Program program = makeProgram(kNow, makeSlot(1, 4));
  program.lease_us = 60'000;
  gate.renew(program, kNow);
  CHECK(gate.leaseValid(kNow + 60'000));
  CHECK_FALSE(gate.leaseValid(kNow + 60'001));
}

TEST_CASE(
    "another run is let in only where it may be adopted, and late words of the old run never") {
  ProgramGate gate({});
  CHECK(gate.admit(makeProgram(kNow, makeSlot(1, 4)), kNow, false).new_run);
  Program other = makeProgram(kNow + 50'000, makeSlot(1, 4));
  other.run_id = 2;
  CHECK(gate.admit(other, kNow + 50'000, false).refusal == ProgramRefusal::kRunChanged);
  const ProgramGate::Admission adopted = gate.admit(other, kNow + 50'000, true);
  CHECK(adopted.refusal == ProgramRefusal::kNone);
  CHECK(adopted.new_run);
  CHECK(admit(gate, makeProgram(kNow + 40'000, makeSlot(2, 4)), kNow + 60'000) ==
        ProgramRefusal::kOutOfOrder);
}

TEST_CASE("bad slots are refused in both places") {
  ProgramGate gate({});
  ProgramSlot bad = makeSlot(2, 4);
  bad.series[0][0] = 2.0;
  CHECK(gate.admit(makeProgram(kNow, bad), kNow, true).slot_fault == SlotFault::kOutOfRange);
  CHECK(gate.admit(makeProgram(kNow + 1, makeSlot(1, 4), bad), kNow + 1, true).refusal ==
        ProgramRefusal::kBadSlot);
}

TEST_CASE("the INS limit is three periods, at least 100 ms") {
  CHECK(InsLimits{20'000}.maxAge() == 100'000);
  CHECK(InsLimits{50'000}.maxAge() == 150'000);
}

TEST_CASE("an INS that repeats its last measurement is as good as silent") {
  InsWatch watch({});
  CHECK(watch.fault(kNow).words == "no INS yet");
  for (int64_t t = 0; t <= 200'000; t += 20'000) watch.receive({kNow, true}, kNow + t);
  CHECK(watch.fault(kNow + 100'000).empty());
  CHECK_FALSE(watch.fault(kNow + 100'001).empty());
  watch.receive({kNow + 200'000, true}, kNow + 210'000);
  CHECK(watch.fault(kNow + 220'000).empty());
}

TEST_CASE("INS from the future, out of the past or without position or heading does not count") {
  InsWatch watch({});
  watch.receive({kNow + 60'000, true}, kNow);
  CHECK_FALSE(watch.fault(kNow).empty());
  watch.receive({kNow - 400'000, true}, kNow);
  CHECK_FALSE(watch.fault(kNow).empty());
  watch.receive({kNow, false}, kNow);
  CHECK_FALSE(watch.fault(kNow).empty());
  watch.receive({kNow + 20'000, true}, kNow + 20'000);
  CHECK(watch.fault(kNow + 20'000).empty());
}

TEST_CASE("permission to drive must be fresh, newer than the last stop, and is used once") {
  OperatorRequests requests({});
  using Effect = OperatorRequests::Effect;
  const ArmRequest arm{kNow, true, "operator", "go"};
  CHECK(requests.classify(arm, kNow, kNow - 1) == Effect::kArm);
  CHECK(requests.classify(arm, kNow + 1'500'001, 0) == Effect::kUntimely);
  CHECK(requests.classify(arm, kNow - 50'001, 0) == Effect::kUntimely);
  CHECK(requests.classify(arm, kNow, kNow) == Effect::kIgnored);
  requests.consume(arm);
  CHECK(requests.classify(arm, kNow, 0) == Effect::kIgnored);
  CHECK(requests.classify({0, false, "anyone", "stop"}, kNow, kNow) == Effect::kDisarm);
}

TEST_CASE("an E-stop always counts, its clearing must be fresh and newer") {
  OperatorRequests requests({});
  requests.receive({0, true, "nobody", "clock is wrong"}, kNow);
  CHECK(requests.estop());
  CHECK(requests.estopReason() == "clock is wrong (nobody)");
  CHECK_FALSE(requests.receive({kNow - 2'000'000, false, "operator", ""}, kNow));
  requests.receive({kNow, true, "operator", "person"}, kNow);
  CHECK_FALSE(requests.receive({kNow - 10, false, "operator", "late word"}, kNow));
  CHECK(requests.receive({kNow + 10, false, "operator", "clear"}, kNow + 10));
  CHECK_FALSE(requests.estop());
}

TEST_CASE("an E-stop stamped in the far future can still be cleared") {
  OperatorRequests requests({});
  requests.receive({kNow * 100, true, "broken clock", "?"}, kNow);
  CHECK(requests.estop());
  CHECK(requests.receive({kNow + 1, false, "operator", "clear"}, kNow + 1));
}

TEST_CASE("the smallest utime of all is old, not new: no difference overflows") {
  constexpr int64_t kBeginning = std::numeric_limits<int64_t>::min();
  ProgramGate gate({});
  CHECK(admit(gate, makeProgram(kBeginning, makeSlot(1, 4))) == ProgramRefusal::kTooOld);
  InsWatch watch({});
  watch.receive({kBeginning, true}, kNow);
  CHECK(watch.fault(kNow).words == "no INS yet");
  OperatorRequests requests({});
  CHECK(requests.classify({kBeginning, true, "operator", "go"}, kNow, kBeginning) ==
        OperatorRequests::Effect::kUntimely);
}

namespace {

/// An INS watch's verdict at `now` on one measurement received at kNow.
std::string faultOf(int64_t utime, int64_t now = kNow) {
  InsWatch watch({});
  watch.receive({utime, true}, kNow);
  return watch.fault(now).words;
}

}  // namespace

TEST_CASE("an INS measurement counts up to 300 ms behind and 50 ms ahead of the clock") {
  CHECK(faultOf(kNow - 300'000).empty());
  CHECK(faultOf(kNow - 300'001) == "no INS yet");
  CHECK(faultOf(kNow + 50'000).empty());
  CHECK(faultOf(kNow + 50'001) == "no INS yet");
}

TEST_CASE("an INS is stale 100 ms after its last message, and 300 ms after its measurement") {
  CHECK(faultOf(kNow, kNow + 100'000).empty());
  CHECK(faultOf(kNow, kNow + 100'001) == "INS is stale: nothing new within 100 ms");
  CHECK(faultOf(kNow - 250'000, kNow + 50'000).empty());
  CHECK(faultOf(kNow - 250'000, kNow + 50'001) ==
        "INS is stale: its newest measurement is too old");
}

TEST_CASE("an INS driver that begins to count anew is a fault for 100 ms") {
  InsWatch watch({});
  watch.receive({kNow, true, {}, 7}, kNow);
  watch.receive({kNow + 1, true, {}, 7}, kNow + 1);
  CHECK(watch.fault(kNow + 1).empty());
  watch.receive({kNow + 2, true, {}, 0}, kNow + 2);
  CHECK(watch.fault(kNow + 2).words == "the INS driver has been restarted");
  watch.receive({kNow + 90'000, true, {}, 1}, kNow + 90'000);
  CHECK(watch.fault(kNow + 100'001).words == "the INS driver has been restarted");
  CHECK(watch.fault(kNow + 100'002).empty());
}

TEST_CASE("a permission counts up to 1.5 s behind and 50 ms ahead of the clock") {
  CHECK(OperatorRequests::timely(kNow - 1'500'000, kNow));
  CHECK_FALSE(OperatorRequests::timely(kNow - 1'500'001, kNow));
  CHECK(OperatorRequests::timely(kNow + 50'000, kNow));
  CHECK_FALSE(OperatorRequests::timely(kNow + 50'001, kNow));
}

TEST_CASE("an E-stop is always taken, however often it is repeated") {
  OperatorRequests requests;
  CHECK(requests.receive({kNow, true, "operator", "person"}, kNow));
  CHECK(requests.receive({kNow, true, "operator", "person"}, kNow));
}

TEST_CASE("clearing counts where an E-stop is engaged, from its own time on, and forgets why") {
  OperatorRequests requests;
  CHECK_FALSE(requests.receive({kNow, false, "operator", "clear"}, kNow));
  requests.receive({kNow, true, "operator", "person"}, kNow);
  CHECK_FALSE(requests.receive({kNow - 1, false, "operator", "clear"}, kNow));
  CHECK(requests.receive({kNow, false, "operator", "clear"}, kNow));
  CHECK(requests.estopReason().empty());
}

TEST_CASE("each refusal and each fault of a slot has its own words") {
  std::set<std::string> words;
  for (int i = 0; i <= static_cast<int>(SlotFault::kOutOfRange); ++i)
    words.insert(describe(static_cast<SlotFault>(i)));
  for (int i = 0; i <= static_cast<int>(ProgramRefusal::kBadSlot); ++i)
    words.insert(describe(static_cast<ProgramRefusal>(i)));
  CHECK(words.size() == 15);
  CHECK(describe(static_cast<SlotFault>(99)) == std::string("an unknown fault"));
  CHECK(describe(static_cast<ProgramRefusal>(99)) == std::string("unknown"));
}

TEST_CASE("what is just within the limits of a slot is let in, what is just beyond is not") {
  const SlotLimits limits;
  ProgramSlot slot = makeSlot(1, 1200);
  CHECK(slot.durationUs() == limits.max_duration_us);
  CHECK(checkSlot(slot, limits) == SlotFault::kNone);
  slot = makeSlot(1, 4);
  slot.period_us = limits.max_period_us;
  CHECK(checkSlot(slot, limits) == SlotFault::kNone);
  CHECK(checkSlot(makeSlot(1, 4, 1.0 + 1e-6, 1.0), limits) == SlotFault::kNone);
  CHECK(checkSlot(makeSlot(1, 4, 1.0, 1.0 + 1e-6), limits) == SlotFault::kNone);
  CHECK(checkSlot(makeSlot(1, 4, 1.0000011, 0.0), limits) == SlotFault::kOutOfRange);
  CHECK(checkSlot(makeSlot(1, 4, 0.0, -1.0000011), limits) == SlotFault::kOutOfRange);
  SlotLimits none;
  none.channels.clear();
  slot = makeSlot(1, 4);
  slot.kinds.clear();
  CHECK(checkSlot(slot, none) == SlotFault::kUnknownKind);
}

TEST_CASE("each channel of a slot is held to its own kind and range") {
  SlotLimits limits;
  limits.channels = {{"throttle", CommandKind::kPower, -0.5, 1.0},
                     {"steering", CommandKind::kSteeringAngle, -0.4, 0.4}};
  ProgramSlot slot = makeSlot(1, 4, 0.9, 0.3);
  CHECK(checkSlot(slot, limits) == SlotFault::kUnknownKind);
  slot.kinds = kindsOf(limits.channels);
  CHECK(checkSlot(slot, limits) == SlotFault::kNone);
  for (const Command& wrong : {Command{-0.6, 0.0}, Command{0.0, 0.41}, Command{0.0, -0.41}}) {
    slot.series[2] = wrong;
    CHECK(checkSlot(slot, limits) == SlotFault::kOutOfRange);
  }
  slot.series[2] = {0.0, 0.0};
  slot.series[2][2] = 0.1;  // a channel that the drive lacks
  CHECK(checkSlot(slot, limits) == SlotFault::kOutOfRange);
  slot.kinds.push_back(CommandKind::kPower);
  CHECK(checkSlot(slot, limits) == SlotFault::kUnknownKind);
}

TEST_CASE("a program that names a long lease is not let in for longer") {
  ProgramGate gate({});
  Program program = makeProgram(kNow - 200'001, makeSlot(1, 4));
  program.lease_us = 10'000'000;
  CHECK(admit(gate, program) == ProgramRefusal::kTooOld);
}

TEST_CASE("of programs sent in the same microsecond the next in number counts, or another run's") {
  ProgramGate gate({});
  Program program = makeProgram(kNow, makeSlot(1, 4));
  CHECK(admit(gate, program) == ProgramRefusal::kNone);
  program.seq += 1;
  CHECK(admit(gate, program) == ProgramRefusal::kNone);
  CHECK(admit(gate, program) == ProgramRefusal::kOutOfOrder);
  program.seq = 0;
  CHECK(admit(gate, program) == ProgramRefusal::kOutOfOrder);
  program.run_id = 2;
  CHECK(admit(gate, program) == ProgramRefusal::kNone);
}

TEST_CASE("the first program counts although everything in it is zero") {
  ProgramGate gate({});
  Program program = makeProgram(0, makeSlot(1, 4));
  program.run_id = 0;
  CHECK(admit(gate, program, 100'000) == ProgramRefusal::kNone);
}
