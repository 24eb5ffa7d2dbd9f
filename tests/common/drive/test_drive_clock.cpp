// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "common/drive/drive_clock.hpp"

using namespace tread;

namespace {

constexpr int64_t kMs = 1000, kSecond = 1'000'000;  // [us]
constexpr int64_t kUtc = 1'764'190'000'000'000;  // [us] of the recorder when the robot's clock is 0
constexpr int64_t kBegin = 50 * kSecond, kPeriod = 10'000;  // [us]

struct Tick {
  int64_t recorded = 0;
  std::optional<int64_t> utime;
  int64_t truth = 0;  ///< [us] the robot's time of reception
};

/// Every second event has a stamp and a delay of 2 ms or 6 ms.
std::vector<Tick> drive(int events, int64_t recorder = kUtc) {
  std::vector<Tick> ticks;
  for (int i = 0; i < events; ++i) {
    Tick tick;
    tick.truth = kBegin + i * kPeriod;
    tick.recorded = tick.truth + recorder;
    if (i % 2 == 0) tick.utime = tick.truth - (i % 4 == 0 ? 2 : 6) * kMs;
    ticks.push_back(tick);
  }
  return ticks;
}

struct Result {
  std::vector<DriveClock::Dated> dated;
  std::vector<std::string> notes;
  size_t wrong = 0;
  int64_t farthest = 0;  ///< [us] largest error
};

Result dated(const std::vector<Tick>& ticks) {
  DriveClock clock;
  Result result;
  const auto take = [&] {
    while (const auto one = clock.next()) result.dated.push_back(*one);
  };
  for (const Tick& tick : ticks) {
    clock.add(tick.recorded, tick.utime);
    take();
  }
  clock.close();
  take();
  REQUIRE(result.dated.size() == ticks.size());
  result.notes = clock.notes();
  for (size_t i = 0; i < ticks.size(); ++i) {
    result.wrong += result.dated[i].wrong;
    result.farthest = std::max(result.farthest, std::abs(result.dated[i].utime - ticks[i].truth));
    if (i > 0) REQUIRE(result.dated[i].utime >= result.dated[i - 1].utime);
  }
  return result;
}

void requireOneNote(const Result& result, const std::string& words) {
  REQUIRE(result.notes.size() == 1);
  REQUIRE_THAT(result.notes[0], Catch::Contains(words));
}

}  // namespace

TEST_CASE("a recorder in UTC does not matter, and nothing is told of a healthy log") {
  const Result result = dated(drive(1000));
  CHECK(result.farthest <= 2 * kMs);  // delay of the fastest message
  CHECK(result.notes.empty());
  CHECK(result.wrong == 0);
}

TEST_CASE("where both clocks are one the recorder's times stay to the microsecond") {
  const Result result = dated(drive(1000, 0));
  CHECK(result.farthest == 0);
  CHECK(result.notes.empty());
}

TEST_CASE("a recorder's clock that is set anywhere changes no time, and is told once") {
  for (const int64_t by :
       {-3600 * kSecond, -5 * kSecond, -300 * kMs, 5 * kSecond, 86'400 * 400 * kSecond})
    for (const size_t from : {101U, 500U, 985U})
      for (const int64_t recorder : {int64_t{0}, kUtc}) {
        std::vector<Tick> ticks = drive(1000, recorder);
        for (size_t i = from; i < ticks.size(); ++i) ticks[i].recorded += by;
        CAPTURE(by, from, recorder);
        const Result result = dated(ticks);
        CHECK(result.farthest <= 20 * kMs);
        CHECK(result.wrong == 0);
        requireOneNote(result, "the recorder's clock jumped by");
      }
}

TEST_CASE("a step below a second cannot be told from a recorder held up at once, but soon") {
  std::vector<Tick> ticks = drive(2000);
  for (size_t i = 500; i < ticks.size(); ++i) ticks[i].recorded += 700 * kMs;
  const Result result = dated(ticks);
  CHECK(result.farthest <= 710 * kMs);
  CHECK(std::abs(result.dated.back().utime - ticks.back().truth) <= 2 * kMs);
  requireOneNote(result, "jumped by 0.7 s");
}

TEST_CASE("a recorder that was held up has not jumped") {
  for (const size_t count : {30U, 80U, 400U}) {
    std::vector<Tick> ticks = drive(2000);
    for (size_t i = 500; i < 500 + count; ++i) ticks[i].recorded = ticks[500 + count].recorded;
    CAPTURE(count);
    const Result result = dated(ticks);
    CHECK(result.notes.empty());
    CHECK(result.wrong == 0);
    CHECK(std::abs(result.dated.back().utime - ticks.back().truth) <= 2 * kMs);
  }
}

TEST_CASE("what a recorder wrote at once after a minute is dated by the robot's own times") {
  for (const size_t from : {0U, 1U, 2U, 5U, 10U, 500U})
    for (const size_t after : {0U, 1000U})
      for (const int64_t recorder : {int64_t{0}, kUtc, -40 * kSecond}) {
        std::vector<Tick> ticks = drive(static_cast<int>(from + 6000 + after), recorder);
        for (size_t i = from; i < from + 6000; ++i)
          ticks[i].recorded = ticks[from + 5999].recorded + static_cast<int64_t>(i - from);
        CAPTURE(from, after, recorder);
        const Result result = dated(ticks);
        CHECK(result.farthest <= 20 * kMs);
        CHECK(result.notes.empty());
        CHECK(result.wrong == 0);
      }
}

TEST_CASE("any bit flipped in the recorder's time of any event moves no other one") {
  for (int bit = 0; bit < 64; ++bit)
    for (const size_t at : {0U, 1U, 2U, 500U, 501U, 998U, 999U}) {
      std::vector<Tick> ticks = drive(1000);
      ticks[at].recorded =
          static_cast<int64_t>(static_cast<uint64_t>(ticks[at].recorded) ^ uint64_t{1} << bit);
      CAPTURE(bit, at);
      const Result result = dated(ticks);
      // Below 1 s the recorder may have been delayed. At an end no neighbour confirms a pause.
      const bool may_be = bit < 21 || (bit < 24 && (at == 0 || at == 999));
      CHECK(result.farthest <= (may_be ? 10 * kSecond : 50 * kMs));
      CHECK(result.notes.empty());
      if (!may_be) CHECK(result.wrong == 1);
    }
}

TEST_CASE("any bit flipped in a message's utime, or in both times, moves nothing") {
  for (int bit = 21; bit < 63; ++bit)
    for (const size_t at : {0U, 500U, 998U})
      for (const bool both : {false, true}) {
        std::vector<Tick> ticks = drive(1000);
        ticks[at].utime = *ticks[at].utime ^ int64_t { 1 } << bit;
        if (both) ticks[at].recorded += *ticks[at].utime - (ticks[at].truth - 2 * kMs);
        CAPTURE(bit, at, both);
        const Result result = dated(ticks);
        // At an end no neighbour confirms a pause.
        const bool may_be = both && bit < 24 && at != 500;
        CHECK(result.farthest <= (may_be ? 10 * kSecond : 50 * kMs));
        CHECK(result.wrong <= 1);
        CHECK(result.notes.empty());
      }
}

TEST_CASE("a silence in which both clocks went on is one") {
  for (const int64_t pause : {2 * kSecond, 3600 * kSecond, 86'400 * kSecond}) {
    std::vector<Tick> ticks = drive(1000);
    for (size_t i = 501; i < ticks.size(); ++i) {
      ticks[i].recorded += pause;
      ticks[i].truth += pause;
      if (ticks[i].utime) *ticks[i].utime += pause;
    }
    const Result result = dated(ticks);
    CHECK(result.farthest <= 2 * kMs);
    CHECK(result.notes.empty());
    CHECK(result.wrong == 0);
  }
}

TEST_CASE("where the robot's clock begins anew times go on, and it is told") {
  for (const int64_t pause : {0 * kSecond, 60 * kSecond}) {
    std::vector<Tick> ticks = drive(1000);
    for (size_t i = 500; i < ticks.size(); ++i) {
      ticks[i].recorded += pause;
      ticks[i].truth += pause;
      if (ticks[i].utime) *ticks[i].utime -= 40 * kSecond;
    }
    const Result result = dated(ticks);
    CHECK(result.farthest <= 20 * kMs);
    requireOneNote(result, "the robot's clock restarted at");
  }
}

TEST_CASE("parts in the wrong order, or another log of the same clock, follow each other") {
  std::vector<Tick> ticks = drive(1000);
  const std::vector<Tick> again = drive(1000);
  ticks.insert(ticks.end(), again.begin(), again.end());
  for (size_t i = 1000; i < ticks.size(); ++i) ticks[i].truth += 1000 * kPeriod;
  const Result result = dated(ticks);
  CHECK(result.farthest <= 20 * kMs);
  requireOneNote(result, "the robot's clock restarted at 10.0 s");
}

TEST_CASE("an event both clocks of which say another year ends in the present") {
  std::vector<Tick> ticks = drive(1000);
  for (size_t i = 500; i < ticks.size(); ++i) {
    ticks[i].recorded += 35 * 365 * 86'400 * kSecond;
    if (ticks[i].utime) *ticks[i].utime += 35 * 365 * 86'400 * kSecond;
  }
  const Result result = dated(ticks);
  CHECK(result.farthest <= 20 * kMs);
  requireOneNote(result, "the robot's clock restarted at");
}

TEST_CASE("of two robots in one log the one that is heard first gives the time") {
  std::vector<Tick> ticks = drive(1000);
  for (size_t i = 2; i < ticks.size(); i += 4) *ticks[i].utime += 86'400 * kSecond;
  const Result result = dated(ticks);
  CHECK(result.farthest <= 20 * kMs);
  CHECK(result.wrong == 250);
  CHECK(result.notes.empty());
}

TEST_CASE("a recorder that counts nanoseconds is named and read") {
  for (const int64_t recorder : {int64_t{0}, kUtc}) {
    std::vector<Tick> ticks = drive(1000, recorder);
    for (Tick& tick : ticks) tick.recorded *= 1000;
    const Result result = dated(ticks);
    CHECK(result.farthest <= 2 * kMs);
    requireOneNote(result, "nanoseconds");
  }
}

TEST_CASE("a log all times of which are nanoseconds is named") {
  std::vector<Tick> ticks = drive(100);
  for (Tick& tick : ticks) {
    tick.recorded *= 1000;
    tick.truth *= 1000;
    if (tick.utime) *tick.utime *= 1000;
  }
  requireOneNote(dated(ticks), "are their times nanoseconds?");
}

TEST_CASE("without stamps the recorder's times are all there is") {
  std::vector<Tick> ticks = drive(1000, 0);
  for (Tick& tick : ticks) tick.utime.reset();
  CHECK(dated(ticks).farthest == 0);
  ticks[300].recorded ^= int64_t{1} << 50;
  ticks[600].recorded = -1;
  const Result flipped = dated(ticks);
  CHECK(flipped.farthest <= 10 * kMs);
  CHECK(flipped.wrong == 2);
  for (size_t i = 700; i < ticks.size(); ++i) ticks[i].recorded -= 5 * kSecond;
  const Result set_back = dated(ticks);
  CHECK(set_back.farthest <= 10 * kMs);
  requireOneNote(set_back, "jumped by -5.0 s at 7.0 s");
  for (Tick& tick : ticks) tick.recorded -= kUtc;
  CHECK(dated(ticks).dated.back().utime <= 10 * kSecond);
}
