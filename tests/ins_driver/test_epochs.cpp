// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <random>

#include "modules/ins_driver/core/epoch_collector.hpp"
#include "modules/ins_driver/core/track_monitor.hpp"
#include "modules/ins_driver/nmea/nmea_epoch.hpp"
#include "tests/helpers.hpp"

using namespace tread::ins;

namespace {

using tread::testing::kSecond;

Gga ggaAt(int64_t time_of_day) {
  Gga gga;
  gga.time_of_day = time_of_day;
  return gga;
}

Zda zdaAt(int64_t time_of_day, CivilDate date) {
  return Zda{time_of_day, date};
}

/// Feeds a sentence and its time of reception.
bool feed(EpochCollector& collector, const NmeaSentence& sentence, int64_t arrival) {
  collector.noteBytes(arrival);
  if (const auto* zda = std::get_if<Zda>(&sentence)) {
    const int64_t utc = daysSinceEpoch(*zda->date) * kDayUs + *zda->time_of_day;
    collector.pushDate(utc, *zda->time_of_day, sentence.index());
    return true;
  }
  return collector.push(partOf(sentence, {}), sentence.index(), timeOfDay(sentence), arrival);
}

template <class Sentence>
bool holds(const DeviceEpoch& epoch) {
  return epoch.holds(NmeaSentence(Sentence{}).index());
}

}  // namespace

TEST_CASE("sentences of one time are one epoch, the next time ends it") {
  EpochCollector collector(10'000);
  feed(collector, ggaAt(5 * kSecond), 100);
  feed(collector, Vtg{}, 200);
  feed(collector, Rmc{5 * kSecond, {}, {}, {}, {}}, 300);
  CHECK_FALSE(collector.next(400));
  feed(collector, ggaAt(6 * kSecond), 1000100);
  const auto epoch = collector.next(1000200);
  REQUIRE(epoch);
  CHECK(epoch->arrival == 100);
  CHECK(epoch->device_time == 5 * kSecond);
  CHECK(holds<Gga>(*epoch));
  CHECK(holds<Vtg>(*epoch));
  CHECK(holds<Rmc>(*epoch));
  CHECK_FALSE(holds<Hdt>(*epoch));
  CHECK_FALSE(collector.next(1000200));
}

TEST_CASE("a quiet line ends the epoch, a slow line does not") {
  EpochCollector collector(10'000);
  feed(collector, ggaAt(5 * kSecond), 100'000);
  for (int64_t t = 100'000; t < 180'000; t += 1'000) {
    collector.noteBytes(t);  // a long sentence at 9600 baud
    CHECK_FALSE(collector.next(t));
  }
  feed(collector, Vtg{}, 180'000);
  CHECK_FALSE(collector.next(189'999));
  const auto epoch = collector.next(190'000);
  REQUIRE(epoch);
  CHECK(holds<Vtg>(*epoch));
}

TEST_CASE("where the last sentence is known, the epoch ends with it") {
  const NmeaSentence last = Rot{};
  EpochCollector collector(10'000, last.index());
  feed(collector, ggaAt(5 * kSecond), 100);
  feed(collector, Vtg{}, 200);
  CHECK_FALSE(collector.next(300));
  feed(collector, last, 300);
  const auto epoch = collector.next(300);
  REQUIRE(epoch);
  CHECK(holds<Rot>(*epoch));
  CHECK(holds<Vtg>(*epoch));
  CHECK_FALSE(feed(collector, Rmc{5 * kSecond, {}, {}, {}, {}}, 400));
}

TEST_CASE("sentences without a time before the timed one belong to its epoch") {
  EpochCollector collector(10'000);
  for (int i = 0; i < 3; ++i) {
    const int64_t arrival = i * 500'000;
    feed(collector, Hdt{0.1 * i}, arrival);
    feed(collector, ggaAt(arrival + kSecond), arrival);
    feed(collector, Vtg{0.2 * i, {}}, arrival);
  }
  // Detected by the second HDT instead of silence, as when a whole log is read at once.
  for (int i = 0; i < 2; ++i) {
    const auto epoch = collector.next(1'000'000);
    REQUIRE(epoch);
    CHECK(epoch->device_time == i * 500'000 + kSecond);
    CHECK(epoch->headings[1]->yaw == 0.1 * i);
    CHECK(epoch->velocity->speed == 0.2 * i);
  }
}

TEST_CASE("a sentence older than what was handed out is late, and the next one is not") {
  EpochCollector collector(10'000);
  CHECK(feed(collector, ggaAt(10 * kSecond), 0));
  CHECK(collector.next(20'000));
  CHECK_FALSE(feed(collector, Rmc{10 * kSecond, {}, {}, {}, {}}, 21'000));
  CHECK_FALSE(feed(collector, ggaAt(9 * kSecond), 22'000));
  CHECK(feed(collector, ggaAt(11 * kSecond), 1'000'000));
}

TEST_CASE(
    "a device clock set back starts anew: at once for a long way, after ten for a short one") {
  EpochCollector collector(10'000);
  feed(collector, ggaAt(3600 * kSecond), 0);
  CHECK(feed(collector, ggaAt(3000 * kSecond), kSecond));
  CHECK_FALSE(collector.next(kSecond)->clock_was_set);
  const auto after = collector.next(2 * kSecond);
  CHECK(after->clock_was_set);
  CHECK(after->device_time == 3000 * kSecond);

  int refused = 0;
  for (int i = 0; i < 20; ++i) {
    const int64_t time_of_day = 2999 * kSecond + i * 20'000;
    if (!feed(collector, ggaAt(time_of_day), 3 * kSecond + i * 20'000)) ++refused;
  }
  CHECK(refused == 10);
  REQUIRE(collector.next(4 * kSecond));
}

TEST_CASE("device time runs on through midnight, the date only with a date sentence") {
  EpochCollector collector(10'000);
  const int64_t before = kDayUs - 100'000;
  feed(collector, ggaAt(before), 0);
  feed(collector, zdaAt(before, {2024, 2, 28}), 0);
  feed(collector, ggaAt(0), 100'000);
  feed(collector, ggaAt(100'000), 200'000);
  const auto first = collector.next(300'000);
  const auto second = collector.next(300'000);
  const auto third = collector.next(300'000);
  REQUIRE((first && second && third));
  CHECK(*second->device_time - *first->device_time == 100'000);
  CHECK(*third->device_time - *second->device_time == 100'000);
  CHECK(first->device_utc == 1709164799900000);   // 2024-02-28 23:59:59.9
  CHECK(second->device_utc == 1709164800000000);  // before any new date
}

TEST_CASE("there is no UTC before the device told a date") {
  EpochCollector collector(10'000);
  feed(collector, ggaAt(kSecond), 0);
  CHECK(collector.next(20'000)->device_utc == -1);
  feed(collector, ggaAt(2 * kSecond), kSecond);
  feed(collector, zdaAt(2 * kSecond, {1970, 1, 2}), kSecond);
  CHECK(collector.next(2 * kSecond)->device_utc == kDayUs + 2 * kSecond);
}

TEST_CASE("ten days of hourly fixes without a date keep counting days") {
  EpochCollector collector(10'000);
  int64_t last = -1;
  for (int64_t hour = 0; hour < 240; ++hour) {
    feed(collector, ggaAt(hour % 24 * 3600 * kSecond), hour * 3600 * kSecond);
    const auto epoch = collector.next(hour * 3600 * kSecond + kSecond);
    REQUIRE(epoch);
    if (last >= 0) CHECK(*epoch->device_time - last == 3600 * kSecond);
    last = *epoch->device_time;
  }
}

TEST_CASE("the arrival filter takes jitter out and never puts a measurement after its arrival") {
  std::mt19937_64 random(3);
  std::exponential_distribution<double> delay(1.0 / 4000.0);  // mean 4 ms
  ArrivalFilter filter(10'000'000);
  double worst = 0.0;
  double worst_arrival = 0.0;
  const double drift = 20e-6;
  for (int i = 0; i < 20000; ++i) {
    const int64_t device_time = i * int64_t{20'000};
    const double truth = static_cast<double>(device_time) * (1.0 + drift) + 5e6;
    const int64_t arrival = static_cast<int64_t>(truth + 1000.0 + delay(random));
    filter.add(device_time, arrival);
    const int64_t mapped = filter.hostTime(device_time);
    CHECK(mapped <= arrival);
    if (i < 500) continue;
    worst = std::max(worst, std::abs(static_cast<double>(mapped) - truth - 1000.0));
    worst_arrival =
        std::max(worst_arrival, std::abs(static_cast<double>(arrival) - truth - 1000.0));
  }
  CAPTURE(worst, worst_arrival);
  CHECK(worst < 300.0);            // [us]: 20 ppm over the window are 200
  CHECK(worst_arrival > 20000.0);  // without the filter
}

TEST_CASE("a stalled reader does not move the measurement times") {
  ArrivalFilter filter(10'000'000);
  for (int i = 0; i < 100; ++i) filter.add(i * 20'000, 7'000'000 + i * 20'000);
  // The process was halted for 2 s: all bytes are read at the same time.
  for (int i = 100; i < 200; ++i) {
    filter.add(i * 20'000, 7'000'000 + 200 * 20'000);
    CHECK(filter.hostTime(i * 20'000) == 7'000'000 + i * 20'000);
  }
}

TEST_CASE("a date told one second ahead neither moves the epochs nor falsifies their UTC") {
  EpochCollector collector(10'000);
  for (int i = 0; i < 5; ++i) {
    const int64_t time_of_day = kDayUs - 2 * kSecond + i * kSecond;
    const bool tomorrow = time_of_day + kSecond >= kDayUs;
    feed(collector, zdaAt((time_of_day + kSecond) % kDayUs, {2024, 2, tomorrow ? 29 : 28}),
         i * kSecond);
    CHECK(feed(collector, ggaAt(time_of_day % kDayUs), i * kSecond));
    const auto epoch = collector.next(i * kSecond + 20'000);
    REQUIRE(epoch);
    CHECK(epoch->device_utc == 1709164798000000 + i * kSecond);
  }
}

TEST_CASE("a week counted modulo 1024 goes on through its roll-over, a set clock does not") {
  GpsWeeks weeks;
  const int64_t first = weeks.timeOf(1023, kWeekUs - kSecond);  // 2038-11-20 23:59:59
  CHECK(first == 3072 * kWeekUs - kSecond);
  CHECK(weeks.timeOf(0, 0) == 3072 * kWeekUs);
  CHECK(weeks.timeOf(0, kSecond) == 3072 * kWeekUs + kSecond);
  CHECK(weeks.rollovers() == 1);
  CHECK(weeks.timeOf(2100, 0) == 2100 * kWeekUs);
  CHECK(weeks.timeOf(2100, kSecond) == 2100 * kWeekUs + kSecond);
  CHECK(weeks.rollovers() == 1);
  // Once the receiver has its era, the time is the same.
  GpsWeeks learns;
  CHECK(learns.timeOf(300, 0) == 2348 * kWeekUs);
  CHECK(learns.timeOf(2348, kSecond) == 2348 * kWeekUs + kSecond);
  CHECK(utcOfGps(2348 * kWeekUs, 18) == 1736035182000000);  // 2025-01-04 23:59:42
}
