// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The driver of Hokuyo's range finders with their emulator, written independently.
#include <catch2/catch.hpp>

#include <cmath>
#include <random>

#include "common/link/make_link.hpp"
#include "modules/lidar_driver/hokuyo/scip_session.hpp"
#include "modules/lidar_driver/scan_connection.hpp"
#include "modules/simulator/emulators/hokuyo/scip_emulator.hpp"
#include "tests/helpers.hpp"
#include "tests/lidar_driver/device_line.hpp"

using namespace tread;
using namespace tread::lidar;
using namespace tread::testing;

namespace {

struct ScipLine : testkit::DeviceLine<ScipSession, sim::ScipEmulator, sim::LaserScan> {
  explicit ScipLine(const sim::ScipSettings& settings = {}, bool short_ranges = false)
      : DeviceLine(
            ScipSession({short_ranges, 0.0}), [](int64_t finished) { return sweep(finished); },
            settings, 1) {}

  /// 2 m to the right, 3 m to the left, no return ahead, no measurement next to it.
  static sim::LaserScan sweep(int64_t finished, int beams = 541) {
    sim::LaserScan scan;
    scan.utime = finished - sim::LaserParameters{}.sweep_us;
    scan.ranges.assign(static_cast<size_t>(beams), 2.0F);
    std::fill(scan.ranges.begin() + beams / 2, scan.ranges.end(), 3.0F);
    scan.ranges[static_cast<size_t>(beams / 2)] = INFINITY;
    scan.ranges[static_cast<size_t>(beams / 2 + 1)] = NAN;
    return scan;
  }
  std::string reason() const { return session.reason(now).words; }
};

/// A session's error for a reply to PP.
std::string refusalOf(const std::string& parameters) {
  ScipSession session({});
  int64_t now = 1'000'000;
  session.open(now);
  std::string asked;
  for (int i = 0; i < 40; ++i, now += 50'000) {
    asked = session.poll(now);
    if (asked.empty()) continue;
    const std::string echo = asked.substr(0, asked.size() - 1);
    session.receive(echo == "PP" ? "PP\n00P\n" + parameters + "\n" : echo + "\n00P\n\n", now);
  }
  return session.reason(now).words;
}

std::string parameterLine(const std::string& text) {
  return text + ";" + sim::scipSum(text) + "\n";
}

}  // namespace

TEST_CASE("angles of a SCIP device come from its own parameters and honour the front step") {
  // UTM-30LX: 1081 steps of 0.25 degrees, 540 forward.
  const ScipGeometry utm{0, 1080, 540, 1440, 23, 30000, 2400};
  REQUIRE_FALSE(utm.problem());
  REQUIRE(utm.angleFirst() == Approx(-135.0 * M_PI / 180.0));
  REQUIRE(utm.angleFirst() + 1080 * utm.angleStep() == Approx(135.0 * M_PI / 180.0));
  REQUIRE(utm.sweep() == 18'750);
  REQUIRE(utm.beams() == 1081);
  // URG-04LX: not symmetric about its front.
  const ScipGeometry urg{44, 725, 384, 1024, 20, 5600, 600};
  REQUIRE_FALSE(urg.problem());
  REQUIRE(urg.angleFirst() == Approx((44 - 384) * 2 * M_PI / 1024));
}

TEST_CASE("a device with invalid parameters is refused in one line") {
  REQUIRE(ScipGeometry{0, 1080, 540, 0}.problem()->find("ARES 0") != std::string::npos);
  REQUIRE(ScipGeometry{10, 10, 0, 1440}.problem());
  REQUIRE(ScipGeometry{0, 1440, 540, 1440}.problem());
  REQUIRE(ScipGeometry{9500, 10000, 9700, 20000}.problem());
  REQUIRE(ScipGeometry{0, 1080, 1440, 1440}.problem()->find("AFRT 1440") != std::string::npos);
  REQUIRE(ScipGeometry{0, 1080, 540, 1440, 100, 100}.problem());
  REQUIRE(ScipGeometry{0, 1080, 540, 1440, 20, 30000, 0}.problem());
  CHECK(refusalOf(parameterLine("MODL:URG-04LX")).find("does not report its parameters") !=
        std::string::npos);
  const std::string good = parameterLine("DMIN:20") + parameterLine("DMAX:5600") +
                           parameterLine("ARES:1024") + parameterLine("AMIN:44") +
                           parameterLine("AMAX:725") + parameterLine("SCAN:600");
  CHECK(refusalOf(good + parameterLine("AFRT:384")) != "");
  CHECK(refusalOf(good + parameterLine("AFRT:384")).find("device") == std::string::npos);
  CHECK(refusalOf(good + parameterLine("AFRT:3x4")).find("no number for AFRT") !=
        std::string::npos);
  CHECK(refusalOf(good + parameterLine("AFRT:2000")).find("AFRT 2000; allowed 0..ARES-1") !=
        std::string::npos);
  CHECK(refusalOf(good + "AFRT:384;x\n").find("wrong checksums") != std::string::npos);
}

TEST_CASE("scans of a Hokuyo come out with its own angles, ranges and times") {
  for (const bool short_ranges : {false, true}) {
    ScipLine line({}, short_ranges);
    const auto scans = line.run(1050);
    REQUIRE(scans.size() >= 9);
    const RangeScan& scan = scans.back();
    REQUIRE(scan.ranges.size() == 541);
    CHECK(scan.angle_first == Approx(-0.75 * M_PI));
    CHECK(scan.angle_step == Approx(M_PI / 360));
    CHECK(scan.ranges.front() == Approx(2.0F));
    CHECK(scan.ranges.back() == Approx(3.0F));
    CHECK(scan.ranges[270] > scan.range_max);
    CHECK(scan.ranges[271] < scan.range_min);
    CHECK(scan.range_min == Approx(0.1));
    CHECK(scan.range_max == Approx(short_ranges ? 4.094 : 15.0));
    CHECK(scan.duration_us == 18'750);
    CHECK(scan.utime + scan.duration_us == line.now - 50'000);
    CHECK(line.session.reason(line.now).rank == Rank::kNone);
    CHECK(line.session.identity() == "UTM-30LX-EW (emulated), 1.0, T0000001");
  }
}

TEST_CASE("scans that are late on their way keep the time of the device's clock, over its wrap") {
  ScipLine line;
  // 24 bits of milliseconds.
  line.now = (int64_t{1} << 24) * 1000 - 1'000'000;
  line.now -= line.now % 100'000;
  line.session.close();
  line.session.open(line.now);
  REQUIRE(line.run(500).size() >= 4);
  line.delay = 40'000;
  const auto scans = line.run(2000);
  REQUIRE(scans.size() == 20);
  CHECK(line.now > (int64_t{1} << 24) * 1000);
  for (size_t i = 1; i < scans.size(); ++i) CHECK(scans[i].utime - scans[i - 1].utime == 100'000);
  CHECK(scans.back().utime + scans.back().duration_us == line.now);
  CHECK(line.counted("device restarts or clock jumps") == 0);
}

TEST_CASE("a device that speaks SCIP 1.1 is switched to 2.0") {
  sim::ScipSettings old;
  old.scip1 = true;
  ScipLine line(old);
  CHECK(line.run(1000).size() >= 8);
}

TEST_CASE("each fault of a Hokuyo costs the scans that it touches, by name, and no other") {
  struct Fault {
    bool sim::ScipFaults::*kind;
    const char* counted;
  };
  for (const Fault& fault :
       {Fault{&sim::ScipFaults::bad_sums, "wrong checksums"},
        Fault{&sim::ScipFaults::dropped_byte, "wrong checksums"},
        Fault{&sim::ScipFaults::half_scan, "wrong checksums"},
        Fault{&sim::ScipFaults::repeats, "refused: a scan that was here before"},
        Fault{&sim::ScipFaults::trouble, "refused: a status in the place of a scan, '50'"},
        Fault{&sim::ScipFaults::silent, "restarts: no good scan for 1 s"}}) {
    ScipLine line;
    REQUIRE(line.run(500).size() >= 4);
    sim::ScipFaults faults;
    faults.*fault.kind = true;
    line.device.setFaults(faults);
    CAPTURE(fault.counted);
    // The first of the repeated ones is new.
    CHECK(line.run(1200).size() == (fault.kind == &sim::ScipFaults::repeats ? 2 : 0));
    line.device.setFaults({});
    CHECK(line.run(3000).size() >= 10);
    CHECK(line.counted(fault.counted) > 0);
    CHECK(line.session.reason(line.now).rank == Rank::kNone);
  }
}

TEST_CASE("random bytes between the scans of a Hokuyo cost few of them") {
  ScipLine line;
  REQUIRE(line.run(500).size() >= 4);
  sim::ScipFaults faults;
  faults.garbage = true;
  line.device.setFaults(faults);
  const std::vector<RangeScan> scans = line.run(10'000);
  CHECK(scans.size() >= 80);
  for (const RangeScan& scan : scans) {
    // A sweep ends each 100 ms, whenever earlier bytes arrived.
    const int64_t off = (scan.utime + scan.duration_us) % 100'000;
    CHECK(std::min(off, 100'000 - off) < 5'000);
  }
}

TEST_CASE("noise long before a scan does not make it, or those that follow, older than they are") {
  ScipLine line;
  line.run(1030);
  line.session.receive("noise", line.now);
  const std::vector<RangeScan> scans = line.run(2000);
  CHECK(scans.size() >= 18);
  for (const RangeScan& scan : scans) {
    const int64_t off = (scan.utime + scan.duration_us) % 100'000;
    CHECK(std::min(off, 100'000 - off) < 5'000);
  }
}

TEST_CASE("a laser that does not come on is refused with what the device says of itself") {
  ScipLine line;
  sim::ScipFaults faults;
  faults.ill = true;
  line.device.setFaults(faults);
  CHECK(line.run(3000).empty());
  CHECK(line.session.lost());
  CHECK(line.reason().find("refused by the device: BM, status '01'; its own report: "
                           "Malfunction 005") == 0);
}

TEST_CASE("a port that answers otherwise or never is one clear line") {
  ScipSession session({});
  int64_t now = 1'000'000;
  session.open(now);
  for (; !session.lost(); now += 10'000) session.poll(now);
  CHECK(session.reason(now).words ==
        "connected, but no answer to QT; is this the range finder's line?");
  CHECK(now < 3'000'000);
  session.close();
  session.open(now);
  for (; !session.lost(); now += 10'000) {
    const std::string asked = session.poll(now);
    if (!asked.empty()) session.receive(asked.substr(0, asked.size() - 1) + "\n0E\n\n", now);
  }
  CHECK(session.reason(now).words ==
        "refused by the device: PP, status '0E' (3); does its firmware support SCIP 2.0?");
  session.close();
  session.open(now);
  session.poll(now);
  session.receive("HTTP/1.1 400 Bad Request\r\n\nServer: none\n\n", now);
  CHECK(session.reason(now).rank >= Rank::kUnreadable);
}

TEST_CASE("a line that is too slow for a Hokuyo's scans is named, with what to do") {
  ScipLine line;
  std::string waiting;
  for (int i = 0; i < 6000 && !line.session.lost(); ++i) {
    line.now += 1000;
    if (line.now % 100'000 == 0) line.device.add(ScipLine::sweep(line.now));
    line.device.receive(line.session.poll(line.now), line.now);
    const std::string sent = line.device.transmit(line.now);
    // A device drops a scan while it is still sending the previous one.
    if (waiting.size() < 2000) waiting += sent;
    const size_t carried = std::min<size_t>(waiting.size(), 1);  // 9600 baud
    line.session.receive(waiting.substr(0, carried), line.now);
    waiting.erase(0, carried);
    CHECK(line.session.take(line.now).empty());
  }
  CHECK(line.reason().find("the line is too slow: a scan has 1623 bytes; raise its rate, or set "
                           "short_ranges") != std::string::npos);
}

TEST_CASE("a Hokuyo that falls silent within a scan is not said to be on a slow line") {
  ScipLine line;
  line.run(1030);
  bool part = false;
  for (int i = 0; i < 3000; ++i) {
    line.now += 1000;
    const std::string asked = line.session.poll(line.now);
    if (!part) line.session.receive("MD0000108001000\n99b\n" + std::string(300, '0'), line.now);
    part = true;
    CHECK(line.reason().find("too slow") == std::string::npos);
  }
}

TEST_CASE("none of a Hokuyo's scans outlives a disconnect") {
  ScipLine line;
  REQUIRE(line.run(500).size() >= 4);
  line.device.add(ScipLine::sweep(line.now));
  const std::string late = line.device.transmit(line.now);
  line.session.close();
  line.session.open(line.now);
  line.session.receive(late, line.now);
  CHECK(line.session.take(line.now).empty());
  CHECK(line.counted("scans before the start") == 1);
  CHECK(line.run(1000).size() >= 8);
}

TEST_CASE("a Hokuyo's laser is switched off when nobody reads it any longer") {
  auto [near, far] = makePipe();
  sim::ScipEmulator device({}, 1);
  const auto exchange = [&](int64_t now) {
    uint8_t buffer[512];
    while (const auto size = far->read(buffer, sizeof buffer)) {
      if (*size == 0) break;
      device.receive({reinterpret_cast<const char*>(buffer), *size}, now);
    }
    const std::string bytes = device.transmit(now);
    far->write(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
    return bytes;
  };
  int64_t now = 1'000'000;
  {
    ScanConnection connection(*near, std::make_unique<ScipSession>(ScipConfig{}));
    size_t scans = 0;
    for (int i = 0; i < 100; ++i, now += 10'000) {
      if (i % 10 == 0) device.add(ScipLine::sweep(now));
      exchange(now);
      scans += connection.take(now).size();
    }
    CHECK(scans >= 8);
  }
  CHECK(exchange(now) == "QT\n00P\n\n");
  device.add(ScipLine::sweep(now));
  CHECK(exchange(now).empty());
}

TEST_CASE("a million random and mutated bytes give few scans that SCIP cannot vouch for") {
  ScipLine line;
  line.run(500);
  size_t scans = 0;
  line.mistreat(effort(1'100'000), 5, 50'000, 0, [&](const RangeScan& scan) {
    ++scans;
    REQUIRE(scan.ranges.size() == 541);
    REQUIRE(scan.utime + scan.duration_us <= line.now);
    REQUIRE(scan.duration_us == 18'750);
  });
  // A sum of six bits lets one changed line in 64 pass.
  CHECK(scans < 20);
  CHECK(line.session.counters().size() < 20);
}
