// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The driver of a Velodyne with its emulator, written independently, and with data of a real
// VLP-16.
#include <catch2/catch.hpp>

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <random>

#include "common/link/make_link.hpp"
#include "modules/lidar_driver/scan_connection.hpp"
#include "modules/lidar_driver/velodyne/velodyne_session.hpp"
#include "modules/simulator/emulators/velodyne/velodyne_emulator.hpp"
#include "tests/common/capture/capture_file.hpp"
#include "tests/helpers.hpp"

using namespace tread;
using namespace tread::lidar;
using namespace tread::testing;

namespace {

/// A sensor on its network line, stepped each millisecond.
struct VelodyneLine {
  explicit VelodyneLine(const VelodyneConfig& config = {}) : session(config) { session.open(now); }

  /// 2 m to the right, 3 m to the left, no return ahead and behind.
  static sim::LaserScan sweep(int64_t finished) {
    sim::LaserScan scan;
    scan.utime = finished - sim::LaserParameters{}.sweep_us;
    scan.ranges.assign(541, 2.0F);
    std::fill(scan.ranges.begin() + 270, scan.ranges.end(), 3.0F);
    std::fill(scan.ranges.begin() + 266, scan.ranges.begin() + 275, INFINITY);
    return scan;
  }
  std::vector<RangeScan> run(int milliseconds) {
    std::vector<RangeScan> scans;
    for (int i = 0; i < milliseconds; ++i) {
      now += 1000;
      if (now % 100'000 == 0) device.add(sweep(now));
      session.poll(now);
      session.receive(device.transmit(now), now);
      for (RangeScan& scan : session.take(now)) scans.push_back(std::move(scan));
    }
    return scans;
  }
  int64_t counted(const std::string& what) const {
    const auto found = session.counters().find(what);
    return found == session.counters().end() ? 0 : found->second;
  }

  int64_t now = 1'000'000;
  VelodyneSession session;
  sim::VelodyneEmulator device{sim::LaserParameters{}};
};

double bearing(const std::array<float, 3>& point) {
  return std::atan2(point[1], point[0]);
}
bool isReturn(const std::array<float, 3>& point) {
  return std::isfinite(point[0]);
}

std::string captureOf(const std::vector<std::pair<int64_t, std::string>>& datagrams,
                      const CaptureForm& form = {}) {
  CaptureFile file(form);
  for (const auto& [time, payload] : datagrams) file.add(time, payload);
  return file.bytes();
}

std::vector<std::pair<int64_t, std::string>> packetsOf(int count) {
  sim::VelodyneEmulator device{sim::LaserParameters{}};
  device.add(VelodyneLine::sweep(1'000'000));
  std::vector<std::pair<int64_t, std::string>> packets;
  for (int64_t now = 1'000'000; packets.size() < static_cast<size_t>(count); now += 100)
    if (std::string bytes = device.transmit(now); !bytes.empty()) packets.emplace_back(now, bytes);
  return packets;
}

/// Plays a capture in pieces; returns the scans with their times.
std::vector<RangeScan> play(VelodyneSession& session, const std::string& file, int64_t until) {
  std::vector<RangeScan> scans;
  size_t at = 0;
  int64_t now = 5'000'000;
  session.open(now);
  for (; now < 5'000'000 + until; now += 5'000) {
    while (session.hungry() && at < file.size()) {
      session.receive(std::string_view(file).substr(at, 4096), now);
      at += 4096;
    }
    if (at >= file.size()) session.close();
    for (RangeScan& scan : session.take(now)) {
      REQUIRE(scan.utime + scan.duration_us <= now);
      scans.push_back(std::move(scan));
    }
  }
  return scans;
}

}  // namespace

TEST_CASE("slices of a VLP-16 hold points in equal steps of time, NaN where nothing came back") {
  VelodyneLine line;
  const auto scans = line.run(2000);
  REQUIRE(scans.size() > 70);
  const RangeScan& scan = scans.back();
  REQUIRE(scan.points.size() == 19 * 12 * 16);
  CHECK(scan.ranges.empty());
  CHECK(scan.duration_us == Approx(227 * 2 * 55.296).margin(1));
  CHECK(scans[40].utime - scans[39].utime == Approx(19 * 24 * 55.296).margin(150));
  size_t right = 0;
  size_t left = 0;
  for (const RangeScan& slice : scans)
    for (size_t i = 0; i < slice.points.size(); ++i) {
      const auto& point = slice.points[i];
      if (!isReturn(point)) continue;
      REQUIRE((i % 16 == 1 || i % 16 == 14));
      const double range = std::hypot(point[0], point[1]);
      const bool is_left = bearing(point) > 0.0;
      REQUIRE(std::abs(bearing(point)) > 0.01);  // nothing ahead
      REQUIRE(range == Approx(is_left ? 3.0 : 2.0).epsilon(0.001));
      REQUIRE(point[2] == Approx((i % 16 == 1 ? 1 : -1) * range * std::tan(kDeg)).margin(0.002));
      ++(is_left ? left : right);
    }
  CHECK(left == Approx(right).epsilon(0.05));
  CHECK(line.session.reason(line.now).rank == Rank::kNone);
  CHECK(line.counted("slices cut short: packets lost or clock moved") == 0);
}

TEST_CASE("a point's index tells the time at which the sensor looked there") {
  VelodyneLine line({19, 2, 0.0});
  // The emulated sensor faces ahead at each multiple of 100 ms.
  for (const RangeScan& scan : line.run(1500)) {
    const double step =
        static_cast<double>(scan.duration_us) / static_cast<double>(scan.points.size() / 16 - 1);
    for (size_t i = 1; i < scan.points.size(); i += 16) {
      if (!isReturn(scan.points[i])) continue;
      const double time = static_cast<double>(scan.utime) + step * static_cast<double>(i / 16);
      const double clockwise = 2.0 * M_PI * std::fmod(time, 100'000.0) / 100'000.0;
      // The line is read each millisecond.
      const double late = std::remainder(-bearing(scan.points[i]) - clockwise, 2.0 * M_PI);
      REQUIRE(std::abs(late / (2.0 * M_PI) * 0.1) < 0.001);
    }
  }
}

TEST_CASE("two returns a firing: the last one is taken, at half the packets' pace") {
  VelodyneLine line;
  sim::VelodyneFaults faults;
  faults.dual_return = true;
  line.device.setFaults(faults);
  const auto scans = line.run(1000);
  REQUIRE(scans.size() > 50);
  CHECK(scans.back().points.size() == 19 * 6 * 16);
  CHECK(scans.back().duration_us == Approx(113 * 2 * 55.296).margin(1));
  CHECK(line.counted("slices cut short: packets lost or clock moved") == 0);
}

TEST_CASE("faults of a Velodyne's line cost the packets that they touch, and are counted") {
  struct Fault {
    bool sim::VelodyneFaults::*kind;
    const char* counted;
    bool scans;
  };
  for (const Fault& fault :
       {Fault{&sim::VelodyneFaults::lost_packet, "slices cut short: packets lost or clock moved",
              true},
        Fault{&sim::VelodyneFaults::half_packet, "bytes outside of packets", false},
        Fault{&sim::VelodyneFaults::wrong_flag, "bytes outside of packets", false},
        Fault{&sim::VelodyneFaults::other_product, "refused: packets of another product, HDL-32E",
              false}}) {
    VelodyneLine line;
    REQUIRE(line.run(500).size() > 10);
    sim::VelodyneFaults faults;
    faults.*fault.kind = true;
    line.device.setFaults(faults);
    line.run(30);
    CAPTURE(fault.counted);
    const auto scans = line.run(600);
    CHECK(scans.empty() != fault.scans);
    // Two packets between two lost ones.
    for (const RangeScan& scan : scans) CHECK(scan.points.size() == 2 * 12 * 16);
    CHECK(line.counted(fault.counted) > 0);
    line.device.setFaults({});
    CHECK(line.run(1000).size() > 35);
  }
}

TEST_CASE("a Velodyne that falls silent is named, one that reboots is taken up again") {
  VelodyneLine line;
  CHECK(line.run(1500).size() > 50);
  sim::VelodyneFaults faults;
  faults.silent = true;
  line.device.setFaults(faults);
  line.run(1500);
  CHECK(line.session.reason(line.now).words.find("no packets; is this host's address") == 0);
  line.device.setFaults({});
  line.device.reboot(line.now);
  CHECK(line.run(1000).size() > 30);
  CHECK(line.counted("restarts of the device's clock") == 1);
  CHECK(line.session.reason(line.now).rank == Rank::kNone);
}

TEST_CASE("the full hour of the device's clock, at which it begins anew, loses nothing") {
  VelodyneLine line;
  line.device.reboot(1'000'000);
  line.run(500);
  // A large step: the last two seconds of the hour.
  line.session.close();
  line.now = 1'000'000 + 3'599'000'000;
  line.session.open(line.now);
  const auto scans = line.run(2500);
  REQUIRE(scans.size() > 90);
  for (size_t i = 1; i < scans.size(); ++i)
    REQUIRE(scans[i].utime - scans[i - 1].utime == Approx(25'215).margin(800));
  CHECK(line.counted("restarts of the device's clock") == 0);
}

TEST_CASE("datagrams need not come one by one, nor whole") {
  std::string bytes = "\xFF\xEEnoise";
  for (const auto& [time, packet] : packetsOf(60)) bytes += packet;
  VelodyneSession session({});
  session.open(1'000'000);
  for (size_t at = 0; at < bytes.size(); at += 777)
    session.receive(std::string_view(bytes).substr(at, 777), 1'000'000 + static_cast<int64_t>(at));
  CHECK(session.counters().at("packets") == 60);
  CHECK(session.counters().at("bytes outside of packets") == 7);
}

TEST_CASE("a capture is played once, at the pace of its own times, whatever its form") {
  const auto packets = packetsOf(76);
  for (const CaptureForm& form : {CaptureForm{}, CaptureForm{1, 0, false, true, true},
                                  CaptureForm{1, 2}, CaptureForm{276}, CaptureForm{113, 1, true}}) {
    VelodyneSession session({});
    const auto scans = play(session, captureOf(packets, form), 300'000);
    CAPTURE(form.link_type);
    REQUIRE(scans.size() == 4);
    CHECK(scans[3].utime - scans[2].utime == Approx(25'215).margin(150));
    CHECK(session.counters().at("packets") == 76);
  }
}

TEST_CASE("captures that cannot be played say why") {
  std::string damaged = captureOf(packetsOf(2));
  damaged[24 + 8 + 3] = '\x7F';
  VelodyneSession session({});
  session.open(0);
  session.receive(damaged, 0);
  CHECK(session.reason(0).words.find("the capture is damaged") == 0);
  VelodyneSession gzipped({});
  gzipped.open(0);
  gzipped.receive("\x1F\x8B\x08 and more than the 24 bytes of a header", 0);
  CHECK(gzipped.reason(0).words == "the capture is gzipped (1); unpack it with gunzip");
  VelodyneSession infrared({});
  infrared.open(0);
  infrared.receive(captureOf(packetsOf(2), CaptureForm{147}), 0);
  CHECK(infrared.reason(0).words.find("link layer 147") != std::string::npos);
}

TEST_CASE("packets of another sensor are named with what is read, also after the capture's end") {
  struct Other {
    const char* name;
    char product;
    char flag;
  };
  for (const Other& other : {Other{"VLP-32C", '\x28', '\xEE'}, Other{"HDL-32E", '\x21', '\xEE'},
                             Other{"HDL-64E", '\x12', '\xDD'}, Other{"VLS-128", '\xA1', '\xBB'}}) {
    auto packets = packetsOf(20);
    for (auto& [time, packet] : packets) {
      packet[1205] = other.product;
      packet[101] = other.flag;
    }
    const std::string path = "velodyne_" + std::to_string(getpid()) + ".pcap";
    std::ofstream(path, std::ios::binary) << captureOf(packets);
    const std::unique_ptr<Link> file = makeLink("file:" + path);
    ScanConnection source(*file, std::make_unique<VelodyneSession>(VelodyneConfig{}));
    int64_t now = 5'000'000;
    for (; now < 20'000'000; now += 5'000) REQUIRE(source.take(now).empty());
    std::remove(path.c_str());
    CAPTURE(other.name);
    const NotedReason reason = source.reason(now);
    CHECK(reason.rank == Rank::kRefused);
    CHECK(reason.words == "refused: packets of another product, " + std::string(other.name) +
                              " (20); this driver reads VLP-16, Puck LITE and Puck Hi-Res, in "
                              "return modes strongest, last and dual; the file is at its end");
  }
}

TEST_CASE("slices too large for a message are refused by the configuration") {
  const auto read = [](const std::string& text) {
    ConfigReader reader = ConfigReader::fromText(text, "lidar.yaml");
    return readVelodyneConfig(reader);
  };
  CHECK(read("packets: 38\nevery: 3\n").every == 3);
  CHECK_THROWS_WITH(read("packets: 19\nevery: 1\n"),
                    Catch::Contains("lidar.yaml:1") && Catch::Contains("7296 points"));
}

TEST_CASE("a million random and mutated bytes give no slice that a Velodyne cannot vouch for") {
  std::mt19937 random(7);
  VelodyneLine line;
  line.run(300);
  for (int fed = 0; fed < effort(2'000'000);) {
    line.now += 10'000;
    line.device.add(VelodyneLine::sweep(line.now));
    std::string bytes = line.device.transmit(line.now);
    if (bytes.empty()) bytes.resize(1 + random() % 3000);
    for (auto i = random() % 20; i > 0; --i)
      bytes[random() % bytes.size()] = static_cast<char>(random());
    if (random() % 8 == 0)
      for (char& byte : bytes) byte = static_cast<char>(random());
    fed += static_cast<int>(bytes.size());
    line.session.receive(bytes, line.now);
    for (const RangeScan& scan : line.session.take(line.now)) {
      REQUIRE(scan.points.size() <= kMostPoints);
      REQUIRE((scan.duration_us >= 0 && scan.utime + scan.duration_us <= line.now));
      for (const auto& point : scan.points)
        REQUIRE((!isReturn(point) || std::hypot(point[0], point[1], point[2]) < 132.0));
    }
  }
  CHECK(line.session.counters().size() < 20);
  CHECK(line.counted("packets") > effort(100));
}

TEST_CASE("a recorded VLP-16 comes out as slices: every packet, its times, its rings") {
  const std::string path = recorded("lidar/velodyne/sample_velodyne_vlp16_gps.pcap");
  if (path.empty()) {
    WARN("skipped: the Velodyne capture is not here (TREAD_RECORDINGS)");
    return;
  }
  VelodyneSession session({1, 1, 0.0});
  ScanCheck check({0.1, 100.0, 4000, 1});
  size_t accepted = 0;
  size_t returns = 0;
  for (const RangeScan& scan : play(session, contentOf(path), 1'000'000)) {
    accepted += check.accept(scan) ? 1 : 0;
    for (const auto& point : scan.points) returns += isReturn(point) ? 1 : 0;
  }
  CHECK(session.counters().at("packets") == 293);
  CHECK(session.counters().at("captured datagrams of another length") == 57);
  CHECK(session.counters().count("slices cut short: packets lost or clock moved") == 0);
  CHECK(accepted == 293);
  CHECK(returns > 25'000);
}
