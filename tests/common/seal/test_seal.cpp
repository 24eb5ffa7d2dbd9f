// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "common/seal/seal.hpp"

using namespace tread;

namespace {

using Bytes = std::vector<uint8_t>;
using V = SealVerdict;

constexpr int64_t kNow = 1'000'000'000;

SealKey keyOf(uint8_t value) {
  SealKey key;
  key.bytes.fill(value);
  return key;
}

Sealer sealer(uint64_t sender, uint8_t key = 7, std::optional<uint64_t> session = 3) {
  return Sealer(keyOf(key), sender, session);
}

/// A message of this size, sealed on ARM.
Bytes sealedMessage(Sealer& by, int64_t utime = kNow, size_t size = 100) {
  Bytes bytes(size);
  for (size_t i = 0; i < size; ++i) bytes[i] = static_cast<uint8_t>(31 * i);
  REQUIRE(by.seal("ARM", bytes, utime));
  return bytes;
}

OpenedSeal open(Sealer& by, const Bytes& bytes, int64_t now = kNow,
                const std::string& channel = "ARM") {
  return by.open(channel, bytes.data(), bytes.size(), now);
}

V verdict(Sealer& by, const Bytes& bytes, int64_t now = kNow, const std::string& channel = "ARM") {
  return open(by, bytes, now, channel).verdict;
}

}  // namespace

TEST_CASE("a sealed message is taken once, with its own size and time of sending") {
  Sealer one = sealer(1);
  Sealer two = sealer(2);
  for (const size_t size : {0, 1, 100, 60000}) {
    const Bytes bytes = sealedMessage(one, kNow, size);
    CHECK(bytes.size() == size + kSealBytes);
    const OpenedSeal opened = open(two, bytes);
    CHECK(opened.verdict == V::kGood);
    CHECK(opened.size == size);
    CHECK(opened.sent >= kNow);
    CHECK(verdict(two, bytes) == V::kReplayed);
  }
}

TEST_CASE("a bit changed anywhere, a message cut anywhere, and another channel are refused") {
  Sealer one = sealer(1);
  const Bytes bytes = sealedMessage(one);
  Sealer two = sealer(2);
  for (size_t at = 0; at < bytes.size(); ++at) {
    for (int bit = 0; bit < 8; ++bit) {
      Bytes changed = bytes;
      changed[at] = static_cast<uint8_t>(changed[at] ^ (1 << bit));
      CAPTURE(at, bit);
      const V judged = verdict(two, changed);
      CHECK((judged == V::kWrongTag || judged == V::kUnsealed));
    }
  }
  for (size_t size = 0; size < bytes.size(); ++size) {
    CAPTURE(size);
    const Bytes front(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    const Bytes back(bytes.end() - static_cast<std::ptrdiff_t>(size), bytes.end());
    CHECK(verdict(two, front) == V::kUnsealed);
    const V judged = verdict(two, back);
    CHECK((judged == V::kWrongTag || judged == V::kUnsealed));
  }
  Bytes longer = bytes;
  longer.push_back(0);
  CHECK(verdict(two, longer) == V::kUnsealed);
  for (const char* channel : {"ARMS", "AR", "", "PROGRAM"})
    CHECK(verdict(two, bytes, kNow, channel) == V::kWrongTag);
  CHECK(verdict(two, bytes) == V::kGood);  // none has consumed it
}

TEST_CASE("a byte moved between channel and message changes the tag") {
  Sealer one = sealer(1);
  Sealer two = sealer(2);
  Bytes bytes{'x', 1, 2};
  REQUIRE(one.seal("A", bytes, kNow));
  const Bytes moved(bytes.begin() + 1, bytes.end());
  CHECK(verdict(two, moved, kNow, "Ax") == V::kWrongTag);
}

TEST_CASE("another key and another session are refused, and nothing without a seal is taken") {
  Sealer one = sealer(1);
  const Bytes bytes = sealedMessage(one);
  Sealer other_key = sealer(2, 8);
  CHECK(verdict(other_key, bytes) == V::kWrongTag);
  Sealer other_session = sealer(2, 7, 4);
  CHECK(verdict(other_session, bytes) == V::kOtherSession);
  Sealer two = sealer(2);
  CHECK(verdict(two, Bytes(100)) == V::kUnsealed);
  CHECK(verdict(two, Bytes()) == V::kUnsealed);
  CHECK(std::string(toWords(V::kUnsealed)) == "unsealed");
}

TEST_CASE("a message held up for long, or from the future, is refused") {
  Sealer one = sealer(1);
  const auto at = [&](int64_t sent) {
    Sealer fresh = sealer(2);
    return verdict(fresh, sealedMessage(one, sent));
  };
  CHECK(at(kNow - Sealer::kMaxAge - 1) == V::kTooOld);
  CHECK(at(kNow - Sealer::kMaxAge) == V::kGood);
  CHECK(at(kNow + Sealer::kMaxAhead) == V::kGood);
  CHECK(at(kNow + Sealer::kMaxAhead + 1) == V::kAhead);
}

TEST_CASE(
    "an earlier message of a sender on a channel is refused, other channels and senders go on") {
  Sealer one = sealer(1);
  Sealer other = sealer(2);
  Sealer receiver = sealer(3);
  const Bytes first = sealedMessage(one);
  const Bytes second = sealedMessage(one);
  const Bytes third = sealedMessage(other, kNow - 1000);
  Bytes stop(10);
  REQUIRE(one.seal("ESTOP", stop, kNow - 1000));
  CHECK(verdict(receiver, second) == V::kGood);
  CHECK(verdict(receiver, first) == V::kReplayed);
  CHECK(verdict(receiver, third) == V::kGood);
  CHECK(verdict(receiver, stop, kNow, "ESTOP") == V::kGood);
  CHECK(verdict(receiver, second) == V::kReplayed);
}

TEST_CASE("the times of a sender only grow, also where its clock stands or goes back") {
  Sealer one = sealer(1);
  Sealer receiver = sealer(2);
  for (const int64_t utime : {kNow, kNow, kNow - 500'000, kNow, kNow + 10})
    CHECK(verdict(receiver, sealedMessage(one, utime)) == V::kGood);
}

TEST_CASE("a receiver that starts again takes nothing that was sent before") {
  Sealer one = sealer(1);
  const Bytes before = sealedMessage(one, kNow - 1);
  const Bytes after = sealedMessage(one, kNow + 1);
  Sealer receiver = sealer(2);
  receiver.refuseBefore(kNow);
  CHECK(verdict(receiver, before) == V::kTooOld);
  CHECK(verdict(receiver, after) == V::kGood);
}

TEST_CASE("the memory of senders is bounded: new ones are refused, active ones are not forgotten") {
  Sealer receiver = sealer(0);
  std::vector<Bytes> messages;
  for (uint64_t id = 1; id <= Sealer::kMostSenders; ++id) {
    Sealer one = sealer(id);
    messages.push_back(sealedMessage(one));
    REQUIRE(verdict(receiver, messages.back()) == V::kGood);
  }
  Sealer late = sealer(9999);
  const Bytes bytes = sealedMessage(late);
  CHECK(verdict(receiver, bytes) == V::kTooManySenders);
  for (const Bytes& message : messages) REQUIRE(verdict(receiver, message) == V::kReplayed);
  // Silent senders are dropped; their messages are too old by then.
  const int64_t later = kNow + Sealer::kMaxAge + 1;
  CHECK(verdict(receiver, sealedMessage(late, later), later) == V::kGood);
  CHECK(verdict(receiver, messages.front(), later) == V::kTooOld);
}

TEST_CASE("a sealer without a session adopts that of the first message with a right tag") {
  Sealer robot = sealer(1);
  Sealer stranger = sealer(1, 8, 5);
  Sealer away = sealer(2, 7, std::nullopt);
  Bytes bytes(10);
  CHECK_FALSE(away.seal("ARM", bytes, kNow));
  CHECK(bytes.size() == 10);
  constexpr int64_t kOtherClock = 55;
  CHECK(verdict(away, sealedMessage(stranger), kOtherClock) == V::kWrongTag);
  CHECK_FALSE(away.session());
  const Bytes first = sealedMessage(robot);
  const OpenedSeal opened = open(away, first, kOtherClock);
  CHECK(opened.verdict == V::kGood);
  CHECK(away.session() == 3);
  // The receiver knows the robot's clock now.
  const int64_t now = opened.sent + 10;
  CHECK(verdict(away, first, now) == V::kReplayed);
  CHECK(verdict(away, sealedMessage(robot), now) == V::kGood);
  REQUIRE(away.seal("ARM", bytes, now));
  CHECK(verdict(robot, bytes, now) == V::kGood);
}

TEST_CASE("who has no key leaves a seal out, and takes nothing else for one") {
  Sealer one = sealer(1);
  const Bytes bytes = sealedMessage(one);
  CHECK(sizeWithoutSeal(bytes.data(), bytes.size()) == 100);
  for (size_t size = 0; size < bytes.size(); ++size)
    CHECK(sizeWithoutSeal(bytes.data(), size) == size);
}
