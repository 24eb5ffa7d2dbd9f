// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <map>
#include <sstream>
#include <vector>

#include <GeographicLib/LocalCartesian.hpp>
#include <catch2/catch.hpp>

#include "modules/simulator/emulators/nmea/nmea_ins_emulator.hpp"
#include "tests/helpers.hpp"

namespace tread::sim {
namespace {

using tread::testing::linesOf;

bool checksumFits(const std::string& line) {
  const size_t star = line.find('*');
  if (line.size() < 9 || line[0] != '$' || star == std::string::npos) return false;
  unsigned sum = 0;
  for (size_t i = 1; i < star; ++i) sum ^= static_cast<unsigned char>(line[i]);
  char text[4];
  std::snprintf(text, sizeof text, "%02X", sum);
  return line.substr(star + 1) == std::string(text) + "\r";
}

std::vector<std::string> fieldsOf(const std::string& line) {
  std::vector<std::string> fields(1);
  for (char c : line.substr(0, line.find('*'))) {
    if (c == ',') {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  return fields;
}

double degreesOf(const std::string& text, size_t digits) {
  return std::stod(text.substr(0, digits)) + std::stod(text.substr(digits)) / 60.0;
}

InsMeasurement movingSample() {
  InsMeasurement sample;
  sample.utime = 3723004000;
  sample.p_map = {12.3456, -7.8912, 0.5};
  sample.yaw = 0.3;
  sample.pitch = -0.05;
  sample.roll = 0.02;
  sample.v_body = {1.0, 0.1, 0.0};
  sample.rate_body = {0.0, 0.0, 0.25};
  return sample;
}

/// Sentences of one measurement by address.
std::map<std::string, std::vector<std::string>> sentencesOf(NmeaInsEmulator& ins,
                                                            const InsMeasurement& sample) {
  ins.add(sample);
  std::map<std::string, std::vector<std::string>> sentences;
  for (const std::string& line : linesOf(ins.transmit(sample.utime))) {
    REQUIRE(checksumFits(line));
    const auto fields = fieldsOf(line);
    sentences[fields[0]] = fields;
  }
  return sentences;
}

}  // namespace

TEST_CASE("all sentences of a measurement carry it, in this order, with correct checksums") {
  NmeaInsSettings settings;
  settings.utc_at_zero = 1709164800000000;  // 2024-02-29 00:00:00
  NmeaInsEmulator ins(settings, 1);
  ins.add(movingSample());
  const auto lines = linesOf(ins.transmit(0));
  std::vector<std::string> order;
  for (const auto& line : lines) {
    CHECK(checksumFits(line));
    order.push_back(fieldsOf(line)[0].substr(1));
  }
  CHECK(order ==
        std::vector<std::string>{"GPZDA", "GPRMC", "GPGGA", "GPVTG", "GPHDT", "PASHR", "GPROT"});
  CHECK(lines[0].substr(0, 35) == "$GPZDA,010203.004,29,02,2024,00,00*");
}

TEST_CASE("position, heading, attitude, course and turn are what the sample says") {
  NmeaInsSettings settings;
  NmeaInsEmulator ins(settings, 1);
  const InsMeasurement sample = movingSample();
  auto sentences = sentencesOf(ins, sample);

  const auto& gga = sentences["$GPGGA"];
  const GeographicLib::LocalCartesian map(settings.origin_latitude, settings.origin_longitude,
                                          settings.origin_height);
  double x = 0.0, y = 0.0, z = 0.0;
  map.Forward(degreesOf(gga[2], 2), degreesOf(gga[4], 3), std::stod(gga[9]) + std::stod(gga[11]), x,
              y, z);
  CHECK(gga[3] == "N");
  CHECK(gga[5] == "E");
  CHECK(gga[6] == "4");
  CHECK(x == Approx(sample.p_map.x()).margin(1e-4));
  CHECK(y == Approx(sample.p_map.y()).margin(1e-4));
  CHECK(z == Approx(sample.p_map.z()).margin(1e-3));

  const double degree = kPi / 180.0;
  CHECK(std::stod(sentences["$GPHDT"][1]) == Approx(90.0 - 0.3 / degree).margin(6e-4));
  const auto& pashr = sentences["$PASHR"];
  CHECK(std::stod(pashr[2]) == Approx(90.0 - 0.3 / degree).margin(6e-4));
  CHECK(std::stod(pashr[4]) == Approx(0.02 / degree).margin(6e-4));  // left side up
  CHECK(std::stod(pashr[5]) == Approx(0.05 / degree).margin(6e-4));  // bow up
  CHECK(std::stod(sentences["$GPROT"][1]) == Approx(-0.25 / degree * 60.0).margin(1e-3));
  const auto& vtg = sentences["$GPVTG"];
  CHECK(std::stod(vtg[1]) == Approx(90.0 - (0.3 + std::atan2(0.1, 1.0)) / degree).margin(1e-3));
  CHECK(std::stod(vtg[7]) / 3.6 == Approx(std::hypot(1.0, 0.1)).margin(1e-4));
  CHECK(std::stod(sentences["$GPRMC"][7]) * 1852.0 / 3600.0 ==
        Approx(std::hypot(1.0, 0.1)).margin(1e-3));
}

TEST_CASE("headings are compass degrees from 0 to below 360 whatever the yaw") {
  NmeaInsEmulator ins({}, 1);
  for (double yaw : {kPi / 2.0, kPi / 2.0 + 1e-9, kPi / 2.0 - 1e-9, -10.0, 20.0, 1e-7}) {
    InsMeasurement sample = movingSample();
    sample.yaw = yaw;
    const double heading = std::stod(sentencesOf(ins, sample)["$GPHDT"][1]);
    CHECK(heading >= 0.0);
    CHECK(heading < 360.0);
    CHECK(std::abs(wrapAngle(kPi / 2.0 - heading * kPi / 180.0 - yaw)) < 1e-4);
  }
}

TEST_CASE("south and west are hemispheres, not signs") {
  NmeaInsSettings settings;
  settings.origin_latitude = -33.5;
  settings.origin_longitude = -70.25;
  NmeaInsEmulator ins(settings, 1);
  const auto gga = sentencesOf(ins, movingSample())["$GPGGA"];
  CHECK(gga[3] == "S");
  CHECK(gga[5] == "W");
  CHECK(gga[2].substr(0, 4) == "3330");
  CHECK(gga[4].substr(0, 5) == "07014");
}

TEST_CASE("rates are per sentence") {
  NmeaInsSettings settings;
  settings.rates = {10, 5, 2, 0, 1, 1, 1};
  NmeaInsEmulator ins(settings, 1);
  for (int i = 0; i < 100; ++i) ins.add(movingSample());
  std::map<std::string, int> count;
  for (const auto& line : linesOf(ins.transmit(0))) ++count[fieldsOf(line)[0]];
  CHECK(count["$GPZDA"] == 10);
  CHECK(count["$GPRMC"] == 20);
  CHECK(count["$GPGGA"] == 50);
  CHECK(count["$GPVTG"] == 0);
  CHECK(count["$GPHDT"] == 100);
}

TEST_CASE("without a fix positions and velocities are empty, heading stays") {
  NmeaInsEmulator ins({}, 1);
  NmeaInsFaults faults;
  faults.no_fix = true;
  ins.setFaults(faults);
  auto sentences = sentencesOf(ins, movingSample());
  CHECK(sentences["$GPGGA"][2].empty());
  CHECK(sentences["$GPGGA"][6] == "0");
  CHECK(sentences["$GPRMC"][2] == "V");
  CHECK(sentences["$GPVTG"][7].empty());
  CHECK_FALSE(sentences["$GPHDT"][1].empty());
  faults.no_heading = true;
  ins.setFaults(faults);
  sentences = sentencesOf(ins, movingSample());
  CHECK(sentences["$GPHDT"][1].empty());
  CHECK(sentences.count("$PASHR") == 0);
}

TEST_CASE("line faults spoil the share of sentences they are told to, others stay good") {
  NmeaInsEmulator ins({}, 3);
  NmeaInsFaults faults;
  faults.corrupt_share = 0.2;
  ins.setFaults(faults);
  for (int i = 0; i < 1000; ++i) ins.add(movingSample());
  int good = 0, bad = 0;
  for (const auto& line : linesOf(ins.transmit(0))) (checksumFits(line) ? good : bad) += 1;
  const double share = static_cast<double>(bad) / (good + bad);
  CHECK(share == Approx(0.2).margin(0.03));

  faults = {};
  faults.silent = true;
  ins.setFaults(faults);
  ins.add(movingSample());
  CHECK(ins.transmit(0).empty());
  faults = {};
  faults.garbage_share = 0.3;
  faults.cut_share = 0.1;
  ins.setFaults(faults);
  for (int i = 0; i < 100; ++i) ins.add(movingSample());
  CHECK(ins.transmit(0).size() > 10000);
}

TEST_CASE("the same seed and faults give the same bytes") {
  const auto bytes = [](uint64_t seed) {
    NmeaInsEmulator ins({}, seed);
    NmeaInsFaults faults;
    faults.garbage_share = faults.corrupt_share = faults.cut_share = 0.2;
    ins.setFaults(faults);
    for (int i = 0; i < 50; ++i) ins.add(movingSample());
    return ins.transmit(0);
  };
  CHECK(bytes(4) == bytes(4));
  CHECK(bytes(4) != bytes(5));
}

}  // namespace tread::sim
