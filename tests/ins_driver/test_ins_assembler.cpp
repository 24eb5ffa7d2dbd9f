// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <random>

#include "modules/ins_driver/nmea/nmea_epoch.hpp"
#include "tests/ins_driver/ins_bench.hpp"

using namespace tread;
using namespace tread::ins;

TEST_CASE("position, attitude and velocity of one epoch end in one estimate") {
  Bench bench(withOrigin());
  bench.at(kSecond, gga(kNoon, 3.0, 4.0, 4, 222.5) + pashr(kNoon, 60.0, 2.0, -3.0) +
                        vtg(60.0, 7.2) + line("GPROT,-57.29578,A") +
                        line("GPZDA," + hhmmss(kNoon) + ",09,12,2009,00,00"));
  const InsEstimate& ins = bench.last();
  CHECK(ins.utime == kSecond);
  CHECK(ins.device_utc == 1260360000000000);
  CHECK(ins.status == InsStatus::kGood);
  CHECK(ins.p_map_body.x() == Approx(3.0).margin(0.01));
  CHECK(ins.p_map_body.y() == Approx(4.0).margin(0.01));
  CHECK(ins.p_map_body.z() == Approx(1.5).margin(0.001));
  CHECK(bench.angles().yaw == Approx(30.0 * kDeg).margin(1e-9));
  CHECK(bench.angles().roll == Approx(2.0 * kDeg).margin(1e-9));
  CHECK(bench.angles().pitch == Approx(3.0 * kDeg).margin(1e-9));  // nose down
  CHECK(ins.v_body.x() == Approx(2.0).margin(1e-9));
  CHECK(ins.v_body.y() == Approx(0.0).margin(1e-9));
  CHECK(std::isnan(ins.v_body.z()));
  CHECK(ins.rate_body.z() == Approx(1.0 / 60.0).epsilon(1e-6));
  CHECK(std::isnan(ins.rate_body.x()));
  CHECK(ins.attitude_std.x() == Approx(0.1 * kDeg));
  CHECK(ins.attitude_std.y() == Approx(0.2 * kDeg));
  CHECK(ins.attitude_std.z() == Approx(0.3 * kDeg));
  CHECK(ins.position_std.x() == Approx(0.02 / std::sqrt(2.0)));
  CHECK(ins.satellites == 12);
}

TEST_CASE("the map does not depend on where on Earth it is: 100 m are 100 m") {
  // Meridian and parallel arcs of WGS84 at 42.1 degrees north, from the radii of curvature.
  const double a = 6378137.0;
  const double e2 = 6.69437999014e-3;
  const double lat = kStartLatitude * kDeg;
  const double w2 = 1.0 - e2 * std::sin(lat) * std::sin(lat);
  const double meridian = a * (1.0 - e2) / std::pow(w2, 1.5);
  const double parallel = a / std::sqrt(w2) * std::cos(lat);
  const LocalFrame frame({{lat, kStartLongitude * kDeg}, 0.0, 0.0});
  const Eigen::Vector3d north = frame.toMap({lat + 100.0 / meridian, kStartLongitude * kDeg}, 0.0);
  CHECK(north.y() == Approx(100.0).margin(1e-3));
  CHECK(north.x() == Approx(0.0).margin(1e-6));
  const Eigen::Vector3d east = frame.toMap({lat, kStartLongitude * kDeg + 100.0 / parallel}, 0.0);
  CHECK(east.x() == Approx(100.0).margin(1e-3));
}

TEST_CASE("the first good fix becomes the origin, a poor one does not") {
  InsConfig config;
  config.origin_max_hdop = 1.5;
  Bench bench(config);
  bench.at(kSecond, line("GPGGA,120000.000,4205.7,N,08802.0,W,1,04,3.0,200.0,M,,M,,"));
  CHECK_FALSE(bench.ins.assembler().origin());
  CHECK(bench.last().status & InsStatus::kNoPosition);
  bench.at(2 * kSecond, line("GPGGA,120001.000,4205.7,N,08802.0,W,1,08,1.0,200.0,M,,M,,"));
  REQUIRE(bench.ins.assembler().origin());
  CHECK(bench.ins.assembler().origin()->altitude == 200.0);
  CHECK(bench.last().p_map_body.norm() < 1e-6);
}

TEST_CASE("a configured origin may turn the map: x start-forward instead of east") {
  InsConfig config = withOrigin();
  config.origin->yaw = 90.0 * kDeg;
  Bench bench(config);
  bench.at(kSecond, gga(kNoon, 0.0, 5.0) + pashr(kNoon, 0.0) + vtg(0.0, 3.6));
  CHECK(bench.last().p_map_body.x() == Approx(5.0).margin(0.01));
  CHECK(bench.last().p_map_body.y() == Approx(0.0).margin(0.01));
  CHECK(bench.angles().yaw == Approx(0.0).margin(1e-9));
  CHECK(bench.last().v_body.x() == Approx(1.0).margin(1e-9));
}

TEST_CASE("the lever arm moves the antenna's position to the body's origin") {
  InsConfig config = withOrigin();
  config.p_body_antenna = {1.0, 0.5, 2.0};
  Bench bench(config);
  bench.at(kSecond, gga(kNoon, 10.0, 20.0, 4, 223.0) + pashr(kNoon, 0.0));  // nose north
  CHECK(bench.last().p_map_body.x() == Approx(10.5).margin(0.01));
  CHECK(bench.last().p_map_body.y() == Approx(19.0).margin(0.01));
  CHECK(bench.last().p_map_body.z() == Approx(0.0).margin(0.001));
  // Rolled 90 degrees to the right the mast points right, which is east.
  bench.at(2 * kSecond, gga(kNoon + 1.0, 10.0, 20.0, 4, 223.0) + pashr(kNoon + 1.0, 0.0, 90.0));
  CHECK(bench.last().p_map_body.x() == Approx(8.0).margin(0.01));
  CHECK(bench.last().p_map_body.y() == Approx(19.0).margin(0.01));
  CHECK(bench.last().p_map_body.z() == Approx(1.5).margin(0.001));
}

TEST_CASE("turning on the spot the antenna moves, the body does not") {
  InsConfig config = withOrigin();
  config.p_body_antenna = {1.0, 0.0, 0.0};
  for (const bool with_rot : {true, false}) {
    Bench bench(config);
    const double rate = 0.5;  // [rad/s], to the left
    for (int i = 0; i < 50; ++i) {
      const double t = i * 0.02;
      const double yaw = rate * t;
      const double heading = 90.0 - yaw / kDeg;
      // The antenna swings to the left of the nose.
      const double course = std::fmod(heading - 90.0 + 720.0, 360.0);
      std::string burst = gga(kNoon + t, std::cos(yaw), std::sin(yaw)) +
                          pashr(kNoon + t, std::fmod(heading + 360.0, 360.0)) +
                          vtg(course, rate * 3.6);
      if (with_rot) burst += line("GPROT,-1718.873,A");
      bench.at(kSecond + i * 20'000, burst);
      CHECK(bench.last().p_map_body.head<2>().norm() < 0.01);
      if (i == 0 && !with_rot) continue;  // a single heading has no rate
      CHECK(bench.last().v_body.head<2>().norm() < 0.01);
      CHECK_FALSE(bench.last().status & (InsStatus::kJump | InsStatus::kGap));
    }
    CHECK(std::isnan(bench.last().rate_body.z()) != with_rot);
  }
}

TEST_CASE("a device that is mounted turned reports the body's attitude") {
  InsConfig config = withOrigin();
  config.body_device = {90.0 * kDeg, 0.0, 0.0};  // the device's nose points to the left
  Bench bench(config);
  bench.at(kSecond, gga(kNoon) + pashr(kNoon, 0.0, 5.0, 0.0));
  // The device faces north, so the body faces east; the device's roll is the body's pitch.
  CHECK(bench.angles().yaw == Approx(0.0).margin(1e-9));
  CHECK(bench.angles().pitch == Approx(5.0 * kDeg).margin(1e-9));
  CHECK(bench.angles().roll == Approx(0.0).margin(1e-9));
}

TEST_CASE("at standstill the course is not believed: velocity is zero whatever its direction") {
  Bench bench(withOrigin());
  std::mt19937_64 random(5);
  for (int i = 0; i < 50; ++i) {
    const double t = i * 0.1;
    bench.at(kSecond + i * 100'000, gga(kNoon + t) + pashr(kNoon + t, 25.0) +
                                        vtg(static_cast<double>(random() % 360), 0.07));
    CHECK(bench.last().v_body.head<2>().norm() == 0.0);
    CHECK(bench.angles().yaw == Approx(65.0 * kDeg).margin(1e-9));
    CHECK(bench.last().status == InsStatus::kGood);
  }
}

TEST_CASE(
    "without a heading there is no orientation and no velocity, and the course is not taken for "
    "it") {
  InsConfig config = withOrigin();
  config.p_body_antenna = {1.5, 0.0, 1.0};
  Bench bench(config);
  bench.at(kSecond, gga(kNoon) + vtg(60.0, 20.0) + line("GPHDT,,T"));
  const InsEstimate& ins = bench.last();
  CHECK(ins.status == (InsStatus::kNoHeading | InsStatus::kNoAttitude | InsStatus::kNoVelocity));
  CHECK(std::isnan(ins.R_map_body.w()));
  CHECK(std::isnan(ins.v_body.x()));
  // The arm is left out, which the accuracy reflects.
  CHECK(ins.p_map_body.x() == Approx(0.0).margin(0.01));
  CHECK(ins.position_std.x() > 1.5);
}

TEST_CASE("speed without course is no velocity, unless the vehicle stands") {
  Bench bench(withOrigin());
  bench.at(kSecond, gga(kNoon) + pashr(kNoon, 0.0) + line("GPVTG,,T,,M,,N,2.0,K,D"));
  CHECK(bench.last().status == InsStatus::kNoVelocity);
  bench.at(2 * kSecond, gga(kNoon + 1) + pashr(kNoon + 1, 0.0) + line("GPVTG,,T,,M,,N,0.1,K,D"));
  CHECK(bench.last().status == InsStatus::kGood);
  CHECK(bench.last().v_body.x() == 0.0);
}

TEST_CASE("a heading without roll and pitch says that it assumes them") {
  Bench bench(withOrigin());
  bench.at(kSecond, gga(kNoon) + hdt(90.0));
  CHECK(bench.last().status == (InsStatus::kNoAttitude | InsStatus::kNoVelocity));
  CHECK(bench.angles().yaw == Approx(0.0).margin(1e-9));
  CHECK(std::isnan(bench.last().attitude_std.x()));
  CHECK(std::isnan(bench.last().attitude_std.z()));
}

TEST_CASE("a lost fix is said at once, with position NaN") {
  Bench bench(withOrigin());
  bench.at(kSecond, gga(kNoon) + pashr(kNoon, 0.0));
  bench.at(2 * kSecond, gga(kNoon + 1, 0.0, 0.0, 0) + pashr(kNoon + 1, 0.0));
  CHECK(bench.last().status == (InsStatus::kNoPosition | InsStatus::kNoVelocity));
  CHECK(std::isnan(bench.last().p_map_body.x()));
  CHECK(bench.angles().yaw == Approx(90.0 * kDeg));
}

TEST_CASE("a fix far from the origin is refused, for the plane ends there") {
  Bench bench(withOrigin());
  bench.at(kSecond, line("GPGGA,120000.000,4305.7,N,08802.0,W,4,12,1.0,221,M,,M,,"));
  CHECK(bench.last().status & InsStatus::kNoPosition);
  CHECK(bench.ins.assembler().counts().too_far == 1);
  CHECK(bench.ins.assembler().farDistance() == Approx(111000.0).epsilon(0.01));
}

TEST_CASE("RMC alone gives position and velocity, and leaves the height unknown") {
  Bench bench;
  for (int i = 0; i < 20; ++i) {
    const double t = kNoon + i * 0.1;
    bench.at(kSecond + i * 100'000,
             line("GPRMC," + hhmmss(t) + ",A,4205.733476,N,08802.041110,W,9.415,90.0,190214,,,D") +
                 hdt(90.0));
  }
  const InsEstimate& ins = bench.last();
  CHECK_FALSE(ins.status & InsStatus::kNoPosition);
  CHECK(ins.p_map_body.head<2>().norm() < 1e-6);
  CHECK(std::isnan(ins.p_map_body.z()));
  CHECK(ins.v_body.x() == Approx(4.8435).epsilon(1e-4));
  CHECK(ins.device_utc > 0);
}

TEST_CASE("the stated accuracy follows the fix quality") {
  const auto east = [](FixQuality quality, std::optional<double> hdop) {
    Gga fix;
    fix.quality = quality;
    fix.hdop = hdop;
    return positionStd(fix).x();
  };
  CHECK(east(FixQuality::kRtkFixed, 1.0) < 0.02);
  CHECK(east(FixQuality::kRtkFixed, 1.0) < east(FixQuality::kRtkFloat, 1.0));
  CHECK(east(FixQuality::kRtkFloat, 1.0) < east(FixQuality::kDifferential, 1.0));
  CHECK(east(FixQuality::kDifferential, 1.0) < east(FixQuality::kStandard, 1.0));
  CHECK(east(FixQuality::kStandard, 2.0) == 2.0 * east(FixQuality::kStandard, 1.0));
  CHECK(std::isnan(east(FixQuality::kEstimated, 1.0)));
  CHECK(std::isnan(east(FixQuality::kRtkFixed, std::nullopt)));
}
