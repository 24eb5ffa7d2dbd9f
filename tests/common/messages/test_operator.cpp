// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <limits>
#include <set>
#include <string>

#include <catch2/catch.hpp>

#include "common/bus/virtual_bus.hpp"
#include "common/messages/operator_beacon.hpp"

namespace tread {
namespace {

using State = OperatorLease::State;
using Heard = OperatorLease::Receipt;

constexpr int64_t kSecond = 1'000'000;
constexpr int64_t kStart = 100 * kSecond;

OperatorNotice from(int64_t station, const std::string& name, int64_t seen) {
  OperatorNotice notice;
  notice.station = station;
  notice.name = name;
  notice.seen_utime = seen;
  return notice;
}

}  // namespace

TEST_CASE("the lease counts from what the operator has seen, not from when it was heard") {
  OperatorLease lease(kSecond);
  CHECK(lease.state(kStart) == State::kNone);
  CHECK(lease.receive(from(1, "ada", kStart - 800'000), kStart) == Heard::kTaken);
  CHECK(lease.valid(kStart + 200'000));
  CHECK(lease.state(kStart + 200'001) == State::kLost);
  // The uplink works, but the operator has received nothing new.
  CHECK(lease.receive(from(1, "ada", kStart - 800'000), kStart + 300'000) == Heard::kStale);
  CHECK(lease.state(kStart + 300'000) == State::kLost);
}

TEST_CASE("what was not seen, or long ago, holds nothing: no time of any size does") {
  using Limits = std::numeric_limits<int64_t>;
  for (const int64_t seen : {Limits::min(), int64_t{-1}, int64_t{0}, kStart - 1'000'001,
                             kStart + 100'001, Limits::max()}) {
    OperatorLease lease(kSecond);
    CHECK(lease.receive(from(1, "ada", seen), kStart) != Heard::kTaken);
    CHECK_FALSE(lease.valid(kStart));
  }
}

TEST_CASE("the first operator holds the robot, another one needs it handed over") {
  OperatorLease lease(kSecond);
  lease.receive(from(1, "ada", kStart), kStart);
  CHECK(lease.receive(from(2, "bob", kStart), kStart) == Heard::kOfAnother);
  OperatorNotice giving = from(1, "ada", kStart + 1);
  giving.hand_over_to = "carl";  // absent
  lease.receive(giving, kStart + 1);
  CHECK(lease.holder() == "ada");
  giving.hand_over_to = "bob";
  giving.seen_utime = kStart + 2;
  lease.receive(giving, kStart + 2);
  CHECK(lease.holder() == "bob");
  CHECK(lease.valid(kStart + 2));
  CHECK(lease.receive(from(1, "ada", kStart + 3), kStart + 3) == Heard::kOfAnother);
}

TEST_CASE("who lets go keeps the robot from others as long as it is armed, who is lost as well") {
  for (const bool lets_go : {true, false}) {
    OperatorLease lease(kSecond);
    lease.receive(from(1, "ada", kStart), kStart);
    OperatorNotice last = from(1, "ada", kStart + 1);
    last.drives = false;
    if (lets_go) lease.receive(last, kStart + 1);
    const int64_t later = kStart + 2 * kSecond;
    CHECK(lease.state(later) == (lets_go ? State::kNone : State::kLost));
    lease.update(later, true);
    CHECK(lease.receive(from(2, "bob", later), later) == Heard::kOfAnother);
    CHECK(lease.holder() == "ada");
    lease.update(later, false);
    CHECK(lease.receive(from(2, "bob", later), later) == Heard::kTaken);
    CHECK(lease.holder() == "bob");
  }
}

TEST_CASE("of two programs of one operator one may fall silent, but its goal is not stood for") {
  OperatorLease lease(kSecond);
  OperatorNotice with_goal = from(1, "ada", kStart);
  with_goal.goal_id = 7;
  lease.receive(with_goal, kStart);
  CHECK(lease.standsFor(7, kStart + kSecond));
  const int64_t later = kStart + kSecond + 1;
  lease.receive(from(2, "ada", later), later);
  lease.update(later, true);
  CHECK_FALSE(lease.standsFor(7, later));
  CHECK(lease.valid(later));
  OperatorNotice last = from(2, "ada", later);
  last.drives = false;
  lease.receive(last, later);
  CHECK(lease.state(later) == State::kNone);
}

TEST_CASE("a flood of stations takes no memory, and does not push out who holds the robot") {
  OperatorLease lease(kSecond);
  lease.receive(from(1, "ada", kStart), kStart);
  int refused = 0;
  for (int64_t station = 2; station < 1000; ++station)
    refused += lease.receive(from(station, "mob", kStart), kStart) == Heard::kTooMany;
  CHECK(refused > 900);
  CHECK(lease.receive(from(1, "ada", kStart + 1), kStart + 1) == Heard::kTaken);
  CHECK(lease.holder() == "ada");
}

TEST_CASE("the robot's clock is known to the shortest way of a message, and may drift") {
  RobotClock clock;
  CHECK_FALSE(clock.offset());
  constexpr int64_t kOffset = -37 * kSecond;
  for (int64_t host = kStart, i = 0; i < 600; ++i, host += 50'000)
    clock.observe(host + kOffset - 1'000 - (i * 7919) % 90'000, host);
  CHECK(*clock.offset() <= kOffset - 1'000);
  CHECK(*clock.offset() > kOffset - 6'000);
  // The other machine's clock drifts by .1 % for a quarter of an hour.
  int64_t host = kStart + 60 * kSecond;
  for (int i = 0; i < 18'000; ++i, host += 50'000)
    clock.observe(host + kOffset - (host - kStart) / 1'000, host);
  const int64_t true_offset = kOffset - (host - kStart) / 1'000;
  CHECK(std::abs(*clock.offset() - true_offset) < 20'000);
}

TEST_CASE("a beacon speaks at 5 Hz in the robot's time once it hears the robot, and then lets go") {
  VirtualBus bus(1);
  std::vector<operator_t> heard;
  Bus& end = bus.outside();
  end.subscribe<operator_t>(kOperator, [&](const operator_t& m) { heard.push_back(m); });
  OperatorBeacon beacon(end, "ada");
  beacon.standFor(3);
  constexpr int64_t kAhead = 5 * kSecond;  // the robot's clock
  const auto run = [&](double seconds, bool robot) {
    for (int i = 0; i < static_cast<int>(seconds * 50.0); ++i) {
      motor_t motor{};
      motor.utime = bus.now() + kAhead;
      if (robot) end.publish(kMotor, motor);
      bus.runUntil(bus.now() + 20'000);
      beacon.step(bus.now());
    }
  };
  run(1.0, false);
  CHECK(heard.empty());
  run(2.0, true);
  CHECK(heard.size() >= 9);
  CHECK(heard.size() <= 11);
  CHECK(std::abs(heard.back().utime - bus.now() - kAhead) < 300'000);
  CHECK(heard.back().stands_for == 3);
  CHECK(heard.back().allowed == operator_t::ALLOW_DRIVING);
  CHECK(beacon.clockWords().find("5.0 s ahead of") != std::string::npos);
  beacon.letGo(bus.now());
  bus.runUntil(bus.now() + 100'000);
  CHECK(heard.back().allowed == operator_t::ALLOW_NOTHING);
}

TEST_CASE("an operator without a name, or with a page for one, is nobody") {
  operator_t message{};
  message.allowed = operator_t::ALLOW_DRIVING;
  CHECK_FALSE(noticeFrom(message));
  message.operator_name.assign(65, 'x');
  CHECK_FALSE(noticeFrom(message));
  message.operator_name = "ada\x1b[2J";
  CHECK_FALSE(noticeFrom(message));
  message.operator_name = "ada";
  CHECK(noticeFrom(message));
}

TEST_CASE("each answer to a notice has words of its own") {
  std::set<std::string> words;
  for (const OperatorLease::Receipt receipt :
       {OperatorLease::Receipt::kTaken, OperatorLease::Receipt::kOfAnother,
        OperatorLease::Receipt::kStale, OperatorLease::Receipt::kFromFuture,
        OperatorLease::Receipt::kTooMany, static_cast<OperatorLease::Receipt>(99)})
    words.insert(describe(receipt));
  CHECK(words.size() == 6);
}

}  // namespace tread
