// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <random>

#include "tests/ins_driver/ins_bench.hpp"

using namespace tread;
using namespace tread::ins;

TEST_CASE("a position between two attitudes takes the last one, carried on by its rate") {
  Bench bench(withOrigin());
  for (int i = 0; i <= 2; ++i) bench.at(i * 40'000, pashr(kNoon + i * 0.04, 10.0 + i, 1.0));
  bench.at(100'000, gga(kNoon + 0.1));
  CHECK(bench.angles().yaw == Approx((90.0 - 12.5) * kDeg).margin(1e-6));
  CHECK(bench.angles().roll == Approx(1.0 * kDeg).margin(1e-6));
  CHECK(bench.last().attitude_std.z() == Approx(std::hypot(0.3, 0.5) * kDeg));
  CHECK(bench.ins.assembler().counts().carried == 1);
  // An old attitude is not extrapolated.
  bench.at(300'000, gga(kNoon + 0.3));
  CHECK(bench.last().status & InsStatus::kNoHeading);
}

TEST_CASE("25 Hz of attitudes with 10 Hz of positions are 25 poses a second, carried by velocity") {
  for (const bool wanted : {true, false}) {
    InsConfig config = withOrigin();
    config.attitude_epochs = wanted;
    Bench bench(config);
    for (int i = 0; i < 100; ++i) {
      const double t = i * 0.02;
      std::string burst;
      if (i % 5 == 0) burst += gga(kNoon + t, 2.0 * t) + vtg(90.0, 7.2);
      if (i % 2 == 0) burst += pashr(kNoon + t, 90.0);
      if (!burst.empty()) bench.at(i * 20'000, burst);
    }
    // 20 of 60 times have a position; the attitudes in between extrapolate it.
    CHECK(bench.out.size() == (wanted ? 60 : 20));
    for (const InsEstimate& ins : bench.out) {
      CHECK(ins.p_map_body.x() == Approx(2.0 * static_cast<double>(ins.utime) * 1e-6).margin(0.01));
      CHECK(ins.v_body.x() == Approx(2.0).margin(1e-6));
      CHECK(ins.status == InsStatus::kGood);
      const bool carried = ins.utime % 100'000 != 0;
      CHECK((ins.position_std.x() > 0.0142) == carried);
    }
  }
}

TEST_CASE(
    "without a told velocity a position is carried by the last two, but no velocity is told") {
  Bench bench(withOrigin());
  for (int i = 0; i < 20; ++i) {
    const double t = i * 0.04;
    bench.at(i * 40'000, (i % 5 == 0 ? gga(kNoon + t, t) : "") + pashr(kNoon + t, 90.0));
  }
  // The first attitudes have only one earlier position; the others have it for 150 ms.
  CHECK(bench.out.size() == 4 + 3 * 3);
  CHECK(bench.last().status == InsStatus::kNoVelocity);
  CHECK(bench.last().p_map_body.x() == Approx(0.72).margin(0.01));
}

TEST_CASE("instants with attitude alone are published when positions stay away") {
  Bench bench(withOrigin());
  bench.at(0, gga(kNoon) + pashr(kNoon, 10.0));
  for (int i = 0; i < 50; ++i) bench.at(2'000'000 + i * 40'000, pashr(kNoon + 2 + i * 0.04, 10.0));
  CHECK(bench.out.size() == 51);
  CHECK(bench.last().status == (InsStatus::kNoPosition | InsStatus::kNoVelocity));
}

TEST_CASE("more than three periods of silence are a gap, once") {
  Bench bench(withOrigin());
  int64_t utime = 0;
  double t = kNoon;
  for (int i = 0; i < 10; ++i, utime += 20'000, t += 0.02) {
    bench.at(utime, gga(t) + pashr(t, 0.0));
    CHECK_FALSE(bench.last().status & InsStatus::kGap);
  }
  utime += 60'000;
  t += 0.06;
  bench.at(utime, gga(t) + pashr(t, 0.0));
  CHECK(bench.last().status & InsStatus::kGap);
  bench.at(utime + 20'000, gga(t + 0.02) + pashr(t + 0.02, 0.0));
  CHECK_FALSE(bench.last().status & InsStatus::kGap);
  CHECK(bench.ins.assembler().counts().gaps == 1);
}

TEST_CASE("a position that the vehicle cannot have reached is a jump, once the next one is there") {
  InsConfig config = withOrigin();
  config.max_speed = 5.0;
  config.jump_slack = 0.3;
  Bench bench(config);
  double east = 0.0;
  for (int i = 0; i < 20; ++i) {
    if (i == 10) east += 2.0;
    const double t = kNoon + i * 0.1;
    bench.at(i * 100'000, gga(t, east) + pashr(t, 90.0));
    CHECK(bench.out.size() == static_cast<size_t>(i < 10 ? i + 1 : i));
    CHECK(((bench.last().status & InsStatus::kJump) != 0) == (i == 11));
    east += 0.4;
  }
  CHECK(bench.ins.assembler().counts().doubted == 1);
}

TEST_CASE("a gap before a position that is left out is still told") {
  InsConfig config = withOrigin();
  config.max_speed = 5.0;
  Bench bench(config);
  for (int i = 0; i < 20; ++i) {
    if (i > 9 && i < 15) continue;
    const double t = kNoon + i * 0.1;
    bench.at(i * 100'000, gga(t, i == 15 ? 400.0 : 0.0) + pashr(t, 90.0));
    CHECK(((bench.last().status & InsStatus::kGap) != 0) == (i == 16));
  }
}

TEST_CASE("a position far off and alone, as a weak checksum lets through, is left out") {
  InsConfig config = withOrigin();
  config.max_speed = 5.0;
  Bench bench(config);
  for (int i = 0; i < 20; ++i) {
    const double t = kNoon + i * 0.1;
    const double lie = i == 7 ? 400.0 : i == 12 ? -30.0 : 0.0;
    bench.at(i * 100'000, gga(t, 0.04 * i + lie) + pashr(t, 90.0));
  }
  CHECK(bench.out.size() == 18);
  CHECK(bench.ins.assembler().counts().doubted == 2);
  for (const InsEstimate& ins : bench.out) {
    CHECK(ins.p_map_body.head<2>().norm() < 2.0);
    CHECK_FALSE(ins.status & (InsStatus::kJump | InsStatus::kGap));
  }
}

TEST_CASE("a device clock that is set, back or forth, is a jump and times run on") {
  Bench bench(withOrigin());
  int64_t utime = 5 * kSecond;
  const auto run = [&](double from) {
    for (int i = 0; i < 20; ++i, utime += 100'000) {
      const double t = from + i * 0.1;
      bench.at(utime, gga(t) + pashr(t, 90.0));
    }
  };
  run(kNoon);
  run(kNoon - 600.0);
  run(kNoon + 600.0);
  REQUIRE(bench.out.size() == 60);
  for (size_t i = 0; i < bench.out.size(); ++i) {
    CAPTURE(i);
    CHECK(bench.out[i].utime == 5 * kSecond + static_cast<int64_t>(i) * 100'000);
    CHECK(((bench.out[i].status & InsStatus::kJump) != 0) == (i == 20 || i == 40));
  }
  CHECK(bench.ins.assembler().counts().clock_steps == 2);
}

TEST_CASE("polling jitter does not become jitter of the measurement times") {
  InsConfig config = withOrigin();
  config.latency_us = 3'000;
  Bench bench(config);
  std::mt19937_64 random(9);
  for (int i = 0; i < 1000; ++i) {
    const double t = kNoon + i * 0.02;
    const int64_t jitter = i == 0 ? 0 : static_cast<int64_t>(random() % 4000);
    bench.at(kSecond + i * 20'000 + jitter, gga(t) + pashr(t, 90.0));
    const int64_t error = bench.last().utime - (kSecond + i * 20'000 - 3'000);
    CHECK(error >= 0);
    CHECK(error < 50);  // [us], of jitter up to 4000
  }
}

TEST_CASE("a backlog read at one instant keeps its spacing and ends at its arrival") {
  NmeaIns ins(withOrigin());
  for (int i = 0; i < 150; ++i) {
    const double t = kNoon + i * 0.02;
    ins.push(gga(t) + pashr(t, 90.0), 10 * kSecond);
  }
  std::vector<InsEstimate> out;
  while (const auto estimate = ins.next(10 * kSecond + 10'000)) out.push_back(*estimate);
  REQUIRE(out.size() == 150);
  for (int i = 0; i < 150; ++i) {
    CHECK(out[static_cast<size_t>(i)].utime == 10 * kSecond - (149 - i) * 20'000);
    CHECK(out[static_cast<size_t>(i)].status == InsStatus::kNoVelocity);
  }
}

TEST_CASE("a device that tells no time is stamped with its arrival less the latency") {
  InsConfig config = withOrigin();
  config.latency_us = 3'000;
  Bench bench(config);
  bench.at(kSecond, hdt(90.0));
  CHECK(bench.last().utime == kSecond - 3'000);
  CHECK(bench.last().device_utc == -1);
  bench.at(kSecond + 100'000, line("GPGGA,,4205.7,N,08802.0,W,4,12,1.0,221,M,,M,,") + hdt(90.0));
  CHECK(bench.last().utime == kSecond + 97'000);
  CHECK_FALSE(bench.last().status & InsStatus::kNoPosition);
}
