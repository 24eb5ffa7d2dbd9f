// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/ins_driver/ins_bench.hpp"

using namespace tread;
using namespace tread::ins;

namespace {

InsConfig withCourse() {
  InsConfig config = withOrigin();
  config.headings = {HeadingSource::kAttitude, HeadingSource::kDualAntenna, HeadingSource::kCourse};
  return config;
}

/// .1 s of positions and course; with a measured yaw rate if given.
void step(Bench& bench, int& tenth, double course, double kmh, const std::string& more = "") {
  const double t = tenth * 0.1;
  bench.at(tenth * 100'000, gga(kNoon + t, 0.01 * tenth) + vtg(course, kmh) + more);
  ++tenth;
}

const std::string kNoTurn = line("GPROT,0.0,A");

}  // namespace

TEST_CASE("the course is no heading before nose and tail were told apart") {
  Bench bench(withCourse());
  int tenth = 0;
  for (int i = 0; i < 20; ++i) step(bench, tenth, 90.0, 7.2, kNoTurn);
  CHECK((bench.last().status & InsStatus::kNoHeading) != 0);
  step(bench, tenth, 90.0, 7.2, hdt(90.0) + kNoTurn);
  for (int i = 0; i < 20; ++i) step(bench, tenth, 100.0, 7.2, kNoTurn);
  CHECK_FALSE(bench.last().status & InsStatus::kNoHeading);
  CHECK(bench.angles().yaw == Approx(-10.0 * kDeg).margin(1e-6));
  CHECK(bench.last().v_body.x() == Approx(2.0).margin(1e-6));
}

TEST_CASE("driving backwards the nose stays where it was, also after a turn on the spot") {
  Bench bench(withCourse());
  int tenth = 0;
  step(bench, tenth, 90.0, 7.2, hdt(90.0) + kNoTurn);
  for (int i = 0; i < 15; ++i) step(bench, tenth, 90.0, 7.2, kNoTurn);
  for (int i = 0; i < 20; ++i) step(bench, tenth, 123.0, 0.05, kNoTurn);  // at rest
  for (int i = 0; i < 20; ++i) step(bench, tenth, 270.0, 7.2, kNoTurn);   // and reverses
  CHECK(bench.angles().yaw == Approx(0.0).margin(1e-6));
  CHECK(bench.last().v_body.x() == Approx(-2.0).margin(1e-6));
  // Half a turn to the right on the spot, measured: 1800 degrees per minute for 6 s.
  for (int i = 0; i < 60; ++i) step(bench, tenth, 0.0, 0.05, line("GPROT,1800.0,A"));
  for (int i = 0; i < 20; ++i) step(bench, tenth, 270.0, 7.2, kNoTurn);
  CHECK(std::abs(bench.angles().yaw) == Approx(kPi).margin(1e-6));
  CHECK(bench.last().v_body.x() == Approx(2.0).margin(1e-6));
}

TEST_CASE("without a measured rate a stop makes nose and tail unknown again") {
  Bench bench(withCourse());
  int tenth = 0;
  step(bench, tenth, 90.0, 7.2, hdt(90.0));
  for (int i = 0; i < 20; ++i) step(bench, tenth, 90.0, 7.2);
  CHECK_FALSE(bench.last().status & InsStatus::kNoHeading);
  step(bench, tenth, 90.0, 0.5);
  for (int i = 0; i < 20; ++i) step(bench, tenth, 270.0, 7.2);
  CHECK((bench.last().status & InsStatus::kNoHeading) != 0);
  CHECK(bench.ins.assembler().headings().coursesRefused() == 20);
}

TEST_CASE(
    "a course across the vehicle is no heading, one of a car without reverse gear always is") {
  Bench bench(withCourse());
  int tenth = 0;
  step(bench, tenth, 90.0, 7.2, hdt(90.0) + kNoTurn);
  for (int i = 0; i < 20; ++i) step(bench, tenth, 180.0, 7.2, kNoTurn);  // slides to its right
  CHECK((bench.last().status & InsStatus::kNoHeading) != 0);

  InsConfig car = withCourse();
  car.drives_backward = false;
  Bench forward(car);
  tenth = 0;
  step(forward, tenth, 45.0, 7.2);
  CHECK(forward.angles().yaw == Approx(45.0 * kDeg).margin(1e-6));
  step(forward, tenth, 45.0, 1.8);  // too slow
  step(forward, tenth, 45.0, 1.8);
  CHECK((forward.last().status & InsStatus::kNoHeading) != 0);
}

TEST_CASE("a heading that is not configured is not used, and the order is the configured one") {
  InsConfig config = withOrigin();
  config.headings = {HeadingSource::kDualAntenna, HeadingSource::kAttitude};
  Bench bench(config);
  bench.at(kSecond, gga(kNoon) + hdt(80.0) + pashr(kNoon, 90.0));
  CHECK(bench.angles().yaw == Approx(10.0 * kDeg).margin(1e-6));
  config.headings = {HeadingSource::kAttitude};
  Bench attitude_only(config);
  attitude_only.at(kSecond, gga(kNoon) + hdt(80.0));
  CHECK((attitude_only.last().status & InsStatus::kNoHeading) != 0);
}
