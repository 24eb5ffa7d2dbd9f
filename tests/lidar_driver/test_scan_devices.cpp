// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Drivers and emulators, written independently of each other from the devices' documents.
#include <catch2/catch.hpp>

#include <cmath>
#include <random>

#include "common/link/make_link.hpp"
#include "modules/lidar_driver/scan_connection.hpp"
#include "modules/lidar_driver/scan_devices.hpp"
#include "modules/lidar_driver/sick_cola/cola_session.hpp"
#include "modules/simulator/emulators/sick_cola/cola_emulator.hpp"
#include "tests/helpers.hpp"

using namespace tread;
using namespace tread::lidar;
using namespace tread::testing;

namespace {

/// The emulated scanner and the driver's session, with time between them.
struct Bench {
  explicit Bench(ColaDialect dialect) : session(configOf(dialect)) { session.open(now); }

  static ColaConfig configOf(ColaDialect dialect) {
    ColaConfig config;
    config.dialect = dialect;
    config.latency = 0.0;
    return config;
  }
  /// One period of 100 ms: a scan whose first range is its number.
  std::vector<RangeScan> step() {
    now += 100'000;
    sim::LaserScan scan;
    scan.utime = now - 30'000;
    scan.ranges.assign(541, 3.0F);
    scan.ranges[0] = 1.0F + 0.001F * static_cast<float>(++number);
    scan.ranges[270] = INFINITY;
    for (int i = 0; i < 10; ++i) exchange();
    device.add(scan);
    exchange();
    return session.take(now);
  }
  void exchange() {
    device.receive(session.poll(now), now);
    session.receive(device.transmit(now), now);
  }
  std::vector<RangeScan> steps(int count) {
    std::vector<RangeScan> scans;
    for (int i = 0; i < count; ++i)
      for (RangeScan& scan : step()) scans.push_back(std::move(scan));
    return scans;
  }
  int64_t counted(const std::string& what) const {
    const auto found = session.counters().find(what);
    return found == session.counters().end() ? 0 : found->second;
  }

  sim::ColaEmulator device{sim::LaserParameters{}};
  ColaSession session;
  int64_t now = 5'000'000'000;
  int number = 0;
};

/// A decoder must not return an invalid scan during this time.
void requireVouched(const RangeScan& scan, int64_t now) {
  REQUIRE(scan.ranges.size() >= 2);
  REQUIRE(scan.ranges.size() <= 4000);
  REQUIRE(std::isfinite(scan.angle_first));
  REQUIRE(std::abs(scan.angle_step) * static_cast<double>(scan.ranges.size() - 1) < 6.2832);
  REQUIRE(scan.duration_us >= 0);
  REQUIRE(scan.duration_us <= 1'000'000);
  REQUIRE(scan.utime + scan.duration_us <= now);
  for (const float range : scan.ranges) REQUIRE_FALSE(std::isnan(range));
}

}  // namespace

TEST_CASE(
    "scans of a SICK come out in both dialects with the angles, ranges and times of its own") {
  for (const ColaDialect dialect : {ColaDialect::kA, ColaDialect::kB}) {
    Bench bench(dialect);
    const auto scans = bench.steps(10);
    REQUIRE(scans.size() >= 9);
    const RangeScan& scan = scans.back();
    REQUIRE(scan.ranges.size() == 541);
    CHECK(scan.angle_first == Approx(-0.75 * M_PI).margin(1e-5));
    CHECK(scan.angle_step == Approx(M_PI / 360).margin(1e-6));
    CHECK(scan.ranges[0] == Approx(1.010F));
    CHECK(scan.ranges[270] == 0.0F);
    CHECK(scan.duration_us == Approx(18'750).margin(10));
    // Sent 1 ms after its last beam; the fixed transmission time of 10.25 ms is unknown.
    CHECK(scan.utime == Approx(bench.now - 1000 - 18'750).margin(20));
    CHECK(bench.session.identity().find("LMS10x") != std::string::npos);
    CHECK(bench.session.reason(bench.now).rank == Rank::kNone);
  }
}

TEST_CASE("a telegram as a LMS111 sends it is read, and cut anywhere before its end it is none") {
  std::string telegram =
      "1 1 8D4C04 0 0 45FF 37 280F6 28A73 0 0 7 0 0 1388 168 0 1 DIST1 3F800000 00000000 FFF92230 "
      "1388 21D";
  for (int i = 0; i < 0x21D; ++i) telegram += " 7E";
  telegram += " 0 0 0 0 0 0";
  std::string problem;
  const ColaScan scan = parseColaScan(ColaDialect::kA, telegram, problem);
  REQUIRE(problem.empty());
  CHECK(scan.ranges.size() == 541);
  CHECK(scan.ranges[7] == Approx(0.126F));
  CHECK(scan.angle_first == Approx(-M_PI / 4));
  CHECK(scan.angle_step == Approx(M_PI / 360));
  CHECK(scan.scan_frequency == 50.0);
  CHECK(scan.sent_us - scan.started_us == 2429);
  for (size_t length = 0; length + 5 < telegram.size(); ++length) {
    parseColaScan(ColaDialect::kA, std::string_view(telegram).substr(0, length), problem);
    CAPTURE(length);
    REQUIRE_FALSE(problem.empty());
  }
}

TEST_CASE("a disconnect never repeats a scan, and none of before comes after it") {
  Bench bench(ColaDialect::kA);
  REQUIRE(bench.steps(5).size() >= 4);
  bench.device.add(sim::LaserScan{bench.now, 0, 0, 0, std::vector<float>(541, 9.0F), false});
  const std::string late = bench.device.transmit(bench.now);
  bench.session.close();
  CHECK(bench.session.take(bench.now).empty());
  bench.session.open(bench.now);
  bench.session.receive(late, bench.now);
  CHECK(bench.session.take(bench.now).empty());
  CHECK(bench.counted("scans before the start") == 1);
  bench.device.reconnect();
  for (const RangeScan& scan : bench.steps(5)) CHECK(scan.ranges[1] == 3.0F);
}

TEST_CASE("each fault of the line costs the scans that it touches, by name, and no other") {
  struct Fault {
    bool sim::ColaFaults::*kind;
    const char* counted;
    bool told_by_text;  // CoLa A has no checksum: with a byte less a number may change
  };
  for (const Fault& fault :
       {Fault{&sim::ColaFaults::half_telegram, "bytes outside of telegrams", true},
        Fault{&sim::ColaFaults::repeats, "refused: a telegram that was here before", true},
        Fault{&sim::ColaFaults::bad_checksum, "wrong checksums", false},
        Fault{&sim::ColaFaults::dropped_byte, "wrong checksums", false}})
    for (const ColaDialect dialect : {ColaDialect::kA, ColaDialect::kB}) {
      const bool text = dialect == ColaDialect::kA;
      if (text && !fault.told_by_text) continue;
      CAPTURE(text, fault.counted);
      Bench bench(dialect);
      REQUIRE(bench.steps(3).size() == 3);
      sim::ColaFaults faults;
      faults.*fault.kind = true;
      bench.device.setFaults(faults);
      CHECK(bench.steps(4).empty());
      bench.device.setFaults({});
      CHECK(bench.steps(4).size() >= 3);
      CHECK(bench.counted(fault.counted) > 0);
    }
}

TEST_CASE(
    "a scanner that reboots or falls silent is started up again, and it is said in one line") {
  Bench bench(ColaDialect::kB);
  bench.steps(5);
  bench.device.reboot(bench.now);
  const auto after = bench.steps(20);
  CHECK(after.size() >= 7);
  for (const RangeScan& scan : after) CHECK(scan.utime > bench.now - 2'000'000);
  CHECK(bench.counted("restarts: no good scan for 1 s") == 1);
  sim::ColaFaults silent;
  silent.silent = true;
  bench.device.setFaults(silent);
  CHECK(bench.steps(12).empty());
  CHECK(bench.session.reason(bench.now).words == "no good scan for 1 s; starting it up again");
  CHECK(bench.steps(20).empty());
  CHECK(bench.session.lost());
  CHECK(bench.session.reason(bench.now).words.find("no answer to LMDscandata") !=
        std::string::npos);
}

TEST_CASE("over a link a device is started up after each reconnect") {
  auto [near, far] = makePipe();
  Link* pipe = far.get();
  ScanConnection source(*near, std::make_unique<ColaSession>(Bench::configOf(ColaDialect::kB)));
  sim::ColaEmulator device{sim::LaserParameters{}};
  int64_t now = 1'000'000;
  const auto scansIn = [&](int milliseconds) {
    size_t scans = 0;
    for (int i = 0; i < milliseconds; i += 5, now += 5'000) {
      scans += source.take(now).size();
      if (!pipe->isOpen() && pipe->reopen(now)) device.reconnect();
      uint8_t buffer[512];
      while (const auto size = pipe->read(buffer, sizeof buffer)) {
        if (*size == 0) break;
        device.receive({reinterpret_cast<const char*>(buffer), *size}, now);
      }
      if (i % 50 == 0)
        device.add(sim::LaserScan{now - 20'000, 0, 0, 0, std::vector<float>(541, 4.0F), false});
      const std::string bytes = device.transmit(now);
      pipe->write(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
    }
    return scans;
  };
  CHECK(scansIn(1000) >= 17);
  setPipeConnected(*pipe, false);
  CHECK(scansIn(1000) == 0);
  CHECK(source.reason(now).words.find("unplugged") != std::string::npos);
  setPipeConnected(*pipe, true);
  CHECK(scansIn(1000) >= 17);
  CHECK(source.counters().at("connections") == 2);
}

TEST_CASE("a million random and mutated bytes give no scan that CoLa cannot vouch for") {
  std::mt19937 random(1);
  for (const ColaDialect dialect : {ColaDialect::kA, ColaDialect::kB}) {
    Bench bench(dialect);
    bench.steps(3);
    size_t scans = 0;
    for (int fed = 0; fed < effort(1'200'000);) {
      bench.device.add(
          sim::LaserScan{bench.now - 30'000, 0, 0, 0, std::vector<float>(541, 3.0F), false});
      std::string bytes = bench.device.transmit(bench.now);
      if (random() % 4 == 0 || bytes.empty()) bytes.resize(random() % 3000);
      const auto faults = 1 + random() % 20;
      for (unsigned i = 0; i < faults && !bytes.empty(); ++i)
        bytes[random() % bytes.size()] = static_cast<char>(random());
      if (random() % 8 == 0)
        for (char& byte : bytes) byte = static_cast<char>(random());
      fed += static_cast<int>(bytes.size()) + 1;
      bench.now += 50'000;
      bench.session.receive(bytes, bench.now);
      for (const RangeScan& scan : bench.session.take(bench.now)) {
        requireVouched(scan, bench.now);
        ++scans;
      }
      bench.exchange();
      if (bench.session.lost()) bench.session.open(bench.now);
    }
    // The binary dialect's 8-bit sum lets one in 256 pass, its structure fewer.
    if (dialect == ColaDialect::kB) CHECK(scans < 20);
    CHECK(bench.session.counters().size() < 40);
  }
}

TEST_CASE(
    "a SICK that speaks the other dialect is named with the key to set, for as long as it lasts") {
  // One that streams with its last settings and ignores commands, and one that only replies.
  for (const ColaDialect configured : {ColaDialect::kA, ColaDialect::kB})
    for (const bool streams : {false, true}) {
      const bool text = configured == ColaDialect::kA;
      const ColaDialect spoken = text ? ColaDialect::kB : ColaDialect::kA;
      ColaSession session(Bench::configOf(configured));
      ColaFramer heard(spoken);
      int64_t now = 5'000'000;
      session.open(now);
      for (int i = 0; i < 1200; ++i, now += 10'000) {
        const bool asked = !heard.push(session.poll(now)).empty();
        if (asked && !streams) session.receive(colaFrame(spoken, "sEA LMDscandata 0"), now);
        if (streams && i % 20 == 0)
          session.receive(colaFrame(spoken, "sSN LMDscandata 1 1 8D4C04 0 0 45FF"), now);
        if (session.lost()) {
          session.close();
          session.open(now);
        }
        CHECK(session.take(now).empty());
        if (i < 300) continue;
        const NotedReason reason = session.reason(now);
        REQUIRE(reason.rank == Rank::kRefused);
        REQUIRE(reason.words.find(text ? "CoLa B" : "CoLa A") != std::string::npos);
        REQUIRE(reason.words.find(text ? "telegrams: binary" : "telegrams: ascii") !=
                std::string::npos);
      }
    }
}

TEST_CASE("a device at an address where it cannot be is one line that says how to write it") {
  CHECK_NOTHROW(checkDeviceAddress("sick_cola", "tcp:192.168.0.1:2111"));
  CHECK_THROWS_WITH(checkDeviceAddress("sick_cola", "tty:/dev/ttyUSB0"),
                    Catch::Contains("write tcp:192.168.0.1:2111"));
  CHECK_THROWS_WITH(checkDeviceAddress("carmen", "tcp:a:1"), Catch::Contains("file:drive.log"));
  ConfigReader reader =
      ConfigReader::fromText("device: sick_cola\nsick_cola:\n  telegrams: morse\n", "lidar.yaml");
  CHECK_THROWS_WITH(readScanDevice(reader, 0.0), Catch::Contains("lidar.yaml:3"));
}
