// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "common/bus/lcm_bus.hpp"

using namespace tread;

namespace {

constexpr int64_t kMaxJump = 100'000;
constexpr int64_t kStart = 5'000'000'000;  // [us] time of the messages at host time 0

/// A time set by three messages at 50 Hz; the host's clock is then at 40 ms.
FollowedTime running() {
  FollowedTime time(0, kMaxJump);
  for (const int64_t host : {0, 20'000, 40'000}) REQUIRE(time.observe(kStart + host, host));
  REQUIRE(time.now(40'000) == kStart + 40'000);
  return time;
}

}  // namespace

TEST_CASE("time starts with three messages that agree, not with the first") {
  FollowedTime time(0, kMaxJump);
  CHECK(time.observe(kStart * 1000, 0));  // a wrong one first
  CHECK(time.observe(kStart, 10));
  CHECK(time.observe(kStart, 20));  // a repetition
  CHECK(time.observe(kStart + 20'000, 20'000));
  CHECK(time.now(20'000) == 20'000);
  CHECK(time.observe(kStart + 40'000, 40'000));
  CHECK(time.now(40'000) == kStart + 40'000);
  CHECK(time.now(50'000) == kStart + 50'000);
}

TEST_CASE("time follows the newest message, and late ones do not turn it back") {
  FollowedTime time = running();
  CHECK(time.observe(kStart + 130'000, 60'000));
  CHECK(time.now(60'000) == kStart + 130'000);
  CHECK(time.observe(kStart + 80'000, 80'000));
  CHECK(time.now(80'000) == kStart + 150'000);
}

TEST_CASE("wrong times between right ones are refused for as long as they come") {
  FollowedTime time = running();
  for (int64_t host = 60'000; host < 60'000'000; host += 20'000) {
    CHECK(time.observe(kStart + host, host));
    for (int64_t k = 1; k <= 5; ++k) CHECK_FALSE(time.observe(2 * kStart + host + k, host + k));
  }
  CHECK(time.now(60'000'000) == kStart + 60'000'000);
}

TEST_CASE("another log begins: its time is believed after 0.2 s without contradiction") {
  FollowedTime time = running();
  int64_t host = 60'000;
  for (; host <= 240'000; host += 20'000) CHECK_FALSE(time.observe(2 * kStart + host, host));
  CHECK(time.observe(2 * kStart + host, host));
  CHECK(time.now(host) == 2 * kStart + host);
}

TEST_CASE("times that no clock has are refused always and overflow nothing") {
  FollowedTime time(0, kMaxJump);
  for (int i = 0; i < 10; ++i) {
    CHECK_FALSE(time.observe(INT64_MAX - 10 + i, i));
    CHECK_FALSE(time.observe(INT64_MIN + i, i));
  }
  CHECK(time.now(10) == 10);
}
