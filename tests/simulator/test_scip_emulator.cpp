// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <limits>
#include <sstream>

#include <catch2/catch.hpp>

#include "modules/simulator/emulators/hokuyo/scip_emulator.hpp"
#include "tests/helpers.hpp"

namespace tread::sim {
namespace {

using tread::testing::linesOf;

LaserScan scanOf(int beams, int64_t utime) {
  LaserScan scan;
  scan.utime = utime;
  for (int i = 0; i < beams; ++i) scan.ranges.push_back(1.0f + 0.001f * static_cast<float>(i));
  scan.ranges[10] = std::numeric_limits<float>::infinity();
  scan.ranges[11] = std::numeric_limits<float>::quiet_NaN();
  return scan;
}

/// Ranges [mm] in the data lines of a reply, with verified checksums.
std::vector<int> rangesOf(const std::vector<std::string>& lines, size_t first) {
  std::string values;
  for (size_t i = first; i < lines.size() && !lines[i].empty(); ++i) {
    const std::string body = lines[i].substr(0, lines[i].size() - 1);
    REQUIRE(body.size() <= 64);
    REQUIRE(lines[i].back() == scipSum(body));
    values += body;
  }
  REQUIRE(values.size() % 3 == 0);
  std::vector<int> ranges;
  for (size_t i = 0; i < values.size(); i += 3) {
    ranges.push_back(((values[i] - 0x30) << 12) + ((values[i + 1] - 0x30) << 6) + values[i + 2] -
                     0x30);
  }
  return ranges;
}

}  // namespace

TEST_CASE("sums and numbers are those of the protocol's examples") {
  CHECK(scipSum("00") == 'P');
  CHECK(scipSum("99") == 'b');
  CHECK(scipSum("VEND:Hokuyo Automatic Co.,Ltd.") == '[');
  CHECK(scipEncode(1234, 2) == "CB");
  CHECK(scipEncode(5432, 3) == "1Dh");
  CHECK(scipEncode(16000000, 4) == "m2@0");
}

TEST_CASE("the start-up that drivers use is answered command by command") {
  ScipEmulator device({}, 1);
  const auto ask = [&](const std::string& command) {
    device.receive(command + "\n", 0);
    return device.transmit(0);
  };
  CHECK(ask("QT") == "QT\n00P\n\n");
  CHECK(ask("SS115200") == "SS115200\n00P\n\n");
  CHECK(ask("SCIP2.0") == "SCIP2.0\n00P\n\n");
  CHECK(ask("BM") == "BM\n00P\n\n");
  CHECK(ask("BM") == "BM\n02R\n\n");
  CHECK(ask("HS0") == "HS0\n00P\n\n");
  CHECK(ask("XY") == "XY\n0Ee\n\n");
  const auto pp = linesOf(ask("PP"));
  REQUIRE(pp.size() == 11);
  CHECK(pp[3] == std::string("DMIN:100;") + scipSum("DMIN:100"));
  CHECK(pp[5] == std::string("ARES:720;") + scipSum("ARES:720"));
  CHECK(pp[8] == std::string("AFRT:270;") + scipSum("AFRT:270"));
  CHECK(linesOf(ask("VV")).size() == 8);
  CHECK(ask("QT") == "QT\n00P\n\n");
}

TEST_CASE("bytes may come one at a time and lines may end with CR or LF") {
  ScipEmulator device({}, 1);
  std::string heard;
  for (char byte : std::string("QT\r\nBM\n")) {
    device.receive(std::string_view(&byte, 1), 0);
    heard += device.transmit(0);
  }
  CHECK(heard == "QT\n00P\n\nBM\n00P\n\n");
}

TEST_CASE("MD streams scans with time, ranges and sums until QT") {
  ScipEmulator device({}, 1);
  device.receive("MD0000054001000\n", 0);
  CHECK(device.transmit(0) == "MD0000054001000\n00P\n\n");
  for (int k = 0; k < 3; ++k) {
    device.add(scanOf(541, 5000000 + k * 100000));
    const auto lines = linesOf(device.transmit(0));
    CHECK(lines[0] == "MD0000054001000");
    CHECK(lines[1] == "99b");
    const std::string time = scipEncode(static_cast<uint32_t>(5000 + k * 100), 4);
    CHECK(lines[2] == time + scipSum(time));
    const std::vector<int> ranges = rangesOf(lines, 3);
    REQUIRE(ranges.size() == 541);
    CHECK(ranges[0] == 1000);
    CHECK(ranges[540] == 1540);
    CHECK(ranges[10] == 65533);
    CHECK(ranges[11] == 1);
    CHECK(lines.back().empty());
  }
  device.receive("QT\n", 0);
  device.transmit(0);
  device.add(scanOf(541, 0));
  CHECK(device.transmit(0).empty());
}

TEST_CASE("MD honours first and last step, cluster, interval and number of scans") {
  ScipEmulator device({}, 1);
  device.receive("MD0100020003102;note\n", 0);
  CHECK(device.transmit(0) == "MD0100020003102;note\n00P\n\n");
  std::vector<std::string> echoes;
  for (int k = 0; k < 8; ++k) {
    device.add(scanOf(541, k));
    const auto lines = linesOf(device.transmit(0));
    if (lines.empty()) continue;
    echoes.push_back(lines[0]);
    const std::vector<int> ranges = rangesOf(lines, 3);
    REQUIRE(ranges.size() == 34);
    CHECK(ranges[0] == 1100);
    CHECK(ranges[1] == 1103);
  }
  CHECK(echoes == std::vector<std::string>{"MD0100020003101;note", "MD0100020003100;note"});
}

TEST_CASE("requests out of range are refused with the reason's code") {
  ScipEmulator device({}, 1);
  const auto status = [&](const std::string& command) {
    device.receive(command + "\n", 0);
    return linesOf(device.transmit(0))[1].substr(0, 2);
  };
  CHECK(status("MDx000054001000") == "01");
  CHECK(status("MD0000x54001000") == "02");
  CHECK(status("MD00000540x1000") == "03");
  CHECK(status("MD0000054101000") == "04");
  CHECK(status("MD0300020001000") == "05");
  CHECK(status("MD0000054001x00") == "06");
  CHECK(status("MD00000540010x0") == "07");
  CHECK(status("MD00") == "0C");
  device.add(scanOf(541, 0));
  CHECK(device.transmit(0).empty());
}

TEST_CASE("faults: silence, wrong sums, a cut line and long rubbish") {
  ScipEmulator device({}, 2);
  ScipFaults faults;
  faults.silent = true;
  device.setFaults(faults);
  device.receive("QT\n", 0);
  CHECK(device.transmit(0).empty());
  faults = {};
  faults.bad_sums = true;
  device.setFaults(faults);
  device.receive("MD0000054001000\n", 0);
  device.transmit(0);
  ScipEmulator good({}, 2);
  good.receive("MD0000054001000\n", 0);
  good.transmit(0);
  device.add(scanOf(541, 0));
  good.add(scanOf(541, 0));
  const std::string spoilt = device.transmit(0), whole = good.transmit(0);
  REQUIRE(spoilt.size() == whole.size());
  int differing = 0;
  for (size_t i = 0; i < whole.size(); ++i) differing += spoilt[i] != whole[i] ? 1 : 0;
  CHECK(differing == 1);

  device.reconnect();
  device.add(scanOf(541, 0));
  CHECK(device.transmit(0).empty());
  device.receive(std::string(100000, 'x') + "\nQT\n", 0);
  CHECK(device.transmit(0) == "QT\n00P\n\n");
}

TEST_CASE("the device's parameters are those of the simulated laser") {
  LaserParameters laser;
  laser.range_max = 30.0;
  const ScipSettings settings = scipSettingsOf(laser);
  CHECK(settings.steps_per_turn == 720);
  CHECK(settings.last_step == 540);
  CHECK(settings.front_step == 270);
  CHECK(settings.range_max_mm == 30000);
  CHECK(settings.turns_per_minute == 2400);
}

}  // namespace tread::sim
