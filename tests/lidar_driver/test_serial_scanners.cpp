// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Drivers of scanners on serial lines with their emulators, written independently.
#include <catch2/catch.hpp>

#include <cmath>
#include <random>

#include "modules/lidar_driver/rplidar/rplidar_session.hpp"
#include "modules/lidar_driver/sick_lms2xx/lms_session.hpp"
#include "modules/simulator/emulators/rplidar/rplidar_emulator.hpp"
#include "modules/simulator/emulators/sick_lms2xx/lms_emulator.hpp"
#include "tests/helpers.hpp"
#include "tests/lidar_driver/device_line.hpp"

using namespace tread;
using namespace tread::lidar;
using namespace tread::testing;

namespace {

template <class Session, class Device>
struct SerialLine : testkit::DeviceLine<Session, Device, sim::LaserScan> {
  explicit SerialLine(Session made)
      : testkit::DeviceLine<Session, Device, sim::LaserScan>(std::move(made), sweep,
                                                             sim::LaserParameters{}) {}

  /// 2 m to the right, 3 m to the left, no return ahead.
  static sim::LaserScan sweep(int64_t finished) {
    sim::LaserScan scan;
    scan.utime = finished - sim::LaserParameters{}.sweep_us;
    scan.ranges.assign(541, 2.0F);
    std::fill(scan.ranges.begin() + 270, scan.ranges.end(), 3.0F);
    scan.ranges[270] = INFINITY;
    return scan;
  }
};

struct LmsLine : SerialLine<LmsSession, sim::LmsEmulator> {
  explicit LmsLine(double resolution = 1.0) : SerialLine(LmsSession({resolution, 0.0})) {}
};
struct RplidarLine : SerialLine<RplidarSession, sim::RplidarEmulator> {
  explicit RplidarLine(double step = 1.0) : SerialLine(RplidarSession({step, 12.0, 0.0})) {}
};

/// Number of scans from damaged bytes.
template <class Line>
size_t mistreat(Line& line, int bytes_to_feed, unsigned seed) {
  size_t scans = 0;
  line.mistreat(bytes_to_feed, seed, 100'000, 100'000, [&](const RangeScan& scan) {
    ++scans;
    REQUIRE(scan.utime + scan.duration_us <= line.now);
    REQUIRE(scan.duration_us <= 1'000'000);
    REQUIRE(std::abs(scan.angle_step) * static_cast<double>(scan.ranges.size() - 1) < 6.2832);
  });
  return scans;
}

}  // namespace

TEST_CASE("LMS telegrams are those of the manual") {
  CHECK(lmsFrame("\x20\x24") == std::string("\x02\x00\x02\x00\x20\x24\x34\x08", 8));
  CHECK(lmsFrame("\x20\x25") == std::string("\x02\x00\x02\x00\x20\x25\x35\x08", 8));
}

TEST_CASE("scans of a LMS 2xx come out with the angles of their variant and the time of arrival") {
  for (const double resolution : {1.0, 0.5}) {
    LmsLine line(resolution);
    const auto scans = line.run(1050);
    REQUIRE(scans.size() >= 9);
    const RangeScan& scan = scans.back();
    const auto middle = static_cast<size_t>(std::lround(90.0 / resolution));
    REQUIRE(scan.ranges.size() == 2 * middle + 1);
    CHECK(scan.angle_first == Approx(-M_PI / 2));
    CHECK(scan.angle_step == Approx(resolution * kDeg));
    CHECK(scan.ranges.front() == Approx(2.0F));
    CHECK(std::isnan(scan.ranges[middle]));
    CHECK(scan.ranges.back() == Approx(3.0F));
    CHECK(scan.range_max == Approx(8.183).margin(0.001));
    CHECK(scan.utime + scan.duration_us == line.now - 50'000);
    CHECK(line.session.reason(line.now).rank == Rank::kNone);
  }
}

TEST_CASE("faults of a LMS' line cost the scans that they touch, and a reboot starts it up again") {
  struct Fault {
    bool sim::LmsFaults::*kind;
    const char* counted;
  };
  for (const Fault& fault : {Fault{&sim::LmsFaults::bad_checksum, "wrong checksums"},
                             Fault{&sim::LmsFaults::half_frame, "wrong checksums"},
                             Fault{&sim::LmsFaults::dropped_byte, "wrong checksums"},
                             Fault{&sim::LmsFaults::silent, "restarts: no good scan for 1 s"}}) {
    LmsLine line;
    REQUIRE(line.run(500).size() >= 3);
    sim::LmsFaults faults;
    faults.*fault.kind = true;
    line.device.setFaults(faults);
    CAPTURE(fault.counted);
    CHECK(line.run(1200).empty());
    CHECK(line.counted(fault.counted) > 0);
    line.device.setFaults({});
    CHECK(line.run(3000).size() >= 10);
    line.device.reboot();
    CHECK(line.run(3000).size() >= 15);
  }
}

TEST_CASE("turns of an RPLIDAR come out whole, clockwise, with their own times") {
  for (const double step : {1.0, 0.5}) {
    RplidarLine line(step);
    const auto scans = line.run(2000);
    REQUIRE(scans.size() >= 10);
    const RangeScan& scan = scans.back();
    REQUIRE(scan.ranges.size() == static_cast<size_t>(360 / step));
    CHECK(scan.angle_step == Approx(-step * kDeg));
    // Samples are a degree apart: of two steps of half a degree one may be empty.
    const auto at = [&](double degrees) {
      const auto beam = static_cast<size_t>(degrees / step);
      return std::isnan(scan.ranges[beam]) ? scan.ranges[beam + 1] : scan.ranges[beam];
    };
    CHECK(at(90.0) == Approx(2.0F));                                  // to the right
    CHECK(at(270.0) == Approx(3.0F));                                 // to the left
    CHECK(std::isnan(scan.ranges[static_cast<size_t>(180 / step)]));  // behind: not visible
    CHECK(scan.duration_us == Approx(100'000 * (1 - step / 360)).margin(2));
    CHECK(scans[5].utime - scans[4].utime == 100'000);
    CHECK(line.session.reason(line.now).rank == Rank::kNone);
  }
}

TEST_CASE("samples of an RPLIDAR without echo, told ahead of the others, spoil no turn") {
  // As Slamtec's SDK corrects angles: by up to 8 degrees, only for echoes.
  for (const double correction : {4.5, 8.0}) {
    RplidarLine line;
    sim::RplidarFaults faults;
    faults.correction = correction;
    line.device.setFaults(faults);
    const auto scans = line.run(3000);
    REQUIRE(scans.size() >= 20);
    CHECK(line.counted("refused: revolutions with discontinuous angles") == 0);
    const RangeScan& scan = scans.back();
    REQUIRE(scan.ranges.size() == 360);
    // The revolution begins at the first echo, so that the first beam is the first in time.
    CHECK(scan.angle_first == Approx(std::round(correction) * kDeg).margin(1.1 * kDeg));
    const auto at = [&](double degrees) {
      const auto beam = static_cast<size_t>(std::lround(degrees + scan.angle_first / kDeg + 360.0));
      // Corrected angles are fractional: a beam may have two of them, its neighbour none.
      const float range = scan.ranges[beam % 360];
      return std::isnan(range) ? scan.ranges[(beam + 1) % 360] : range;
    };
    CHECK(at(90.0) == Approx(2.0F));
    CHECK(at(270.0) == Approx(3.0F));
    CHECK(at(2.0) == Approx(2.0F));
    CHECK(at(-2.0) == Approx(3.0F));
    CHECK(std::isnan(at(180.0)));
  }
}

TEST_CASE("a turn of an RPLIDAR in which a byte is wrong or missing is not published") {
  struct Fault {
    bool sim::RplidarFaults::*kind;
    const char* counted;
  };
  for (const Fault& fault :
       {Fault{&sim::RplidarFaults::bad_check, "refused: samples with wrong check bits"},
        Fault{&sim::RplidarFaults::dropped_byte, "refused: samples with wrong check bits"},
        Fault{&sim::RplidarFaults::half_turn, "refused: incomplete revolutions"}}) {
    RplidarLine line;
    REQUIRE(line.run(1500).size() >= 5);
    sim::RplidarFaults faults;
    faults.*fault.kind = true;
    line.device.setFaults(faults);
    line.run(150);  // end of the last valid revolution
    CAPTURE(fault.counted);
    CHECK(line.run(800).empty());
    CHECK(line.counted(fault.counted) > 0);
    line.device.setFaults({});
    CHECK(line.run(2500).size() >= 10);
    line.device.reboot();
    CHECK(line.run(3000).size() >= 8);
  }
  RplidarLine ill;
  sim::RplidarFaults faults;
  faults.ill = true;
  ill.device.setFaults(faults);
  CHECK(ill.run(2000).empty());
  CHECK(ill.session.lost());
  CHECK(ill.session.reason(ill.now).words.find("its health is error") != std::string::npos);
}

TEST_CASE("a million random and mutated bytes give no scan that LMS and RPLIDAR cannot vouch for") {
  LmsLine lms;
  lms.run(500);
  CHECK(mistreat(lms, effort(1'100'000), 3) == 0);
  RplidarLine rplidar;
  rplidar.run(1500);
  // Two check bits let revolutions with single altered samples pass.
  CHECK(mistreat(rplidar, effort(1'100'000), 4) < 50);
  CHECK(lms.session.counters().size() + rplidar.session.counters().size() < 40);
}
