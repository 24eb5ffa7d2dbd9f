// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cstring>
#include <string>

#include "modules/ins_driver/xsens/xbus_message.hpp"
#include "modules/ins_driver/xsens/xsens_ins.hpp"

using namespace tread::ins;

namespace {

std::string highFirst(uint64_t number, unsigned bytes) {
  std::string text;
  while (bytes-- > 0) text.push_back(static_cast<char>(number >> (8 * bytes) & 0xFFU));
  return text;
}

std::string doubles(std::initializer_list<double> numbers) {
  std::string text;
  for (const double number : numbers) {
    uint64_t bits = 0;
    std::memcpy(&bits, &number, sizeof bits);
    text += highFirst(bits, 8);
  }
  return text;
}

std::string datum(unsigned id, const std::string& bytes) {
  return highFirst(id, 2) + highFirst(bytes.size(), 1) + bytes;
}

std::string mtData2(const std::string& data) {
  std::string message =
      std::string("\xFF\x36", 2) +
      (data.size() < 0xFF ? highFirst(data.size(), 1) : '\xFF' + highFirst(data.size(), 2)) + data;
  unsigned sum = 0;
  for (const char byte : message) sum += static_cast<unsigned char>(byte);
  return '\xFA' + message + static_cast<char>(-sum & 0xFFU);
}

const std::string kXbusTime = datum(0x1060, highFirst(20'000, 4));
const std::string kXbusStatus = datum(0xE020, highFirst(0x01800007U, 4));

/// The first reason for not using a message; empty if it was used.
std::string refusalOf(const std::string& data) {
  XsensIns driver{InsConfig{}};
  driver.push(mtData2(data), 5'000'000);
  driver.interrupt();
  const ReasonCounts reasons = driver.reasons();
  return reasons.empty() ? "" : reasons.begin()->first;
}

}  // namespace

TEST_CASE("numbers of an MTData2 message are read in each of their four formats") {
  const std::string data =
      datum(0x2031, highFirst(0x00180000U, 4) + highFirst(0xFFE80000U, 4) + highFirst(0, 4)) +
      datum(0x5042, highFirst(0x40000000U, 4) + highFirst(50, 2) + highFirst(0x80000000U, 4) +
                        highFirst(0xFFF8U, 2)) +
      datum(0xD013, doubles({1.25, -2.5, 0.125})) +
      datum(0x8020, highFirst(0x3F000000U, 4) + highFirst(0xBF800000U, 4) + highFirst(0, 4));
  const std::string message = mtData2(data);
  const auto fields = XbusFields::of(message);
  REQUIRE(fields);
  CHECK(fields->numbers(XbusData::kEulerAngles, 3) == std::vector<double>{1.5, -1.5, 0.0});
  CHECK(fields->numbers(XbusData::kLatLon, 2) == std::vector<double>{50.25, -7.5});
  CHECK(fields->numbers(XbusData::kVelocity, 3) == std::vector<double>{1.25, -2.5, 0.125});
  CHECK(fields->numbers(XbusData::kRateOfTurn, 3) == std::vector<double>{0.5, -1.0, 0.0});
  CHECK(fields->numbers(XbusData::kQuaternion, 4).empty());
  CHECK(fields->numbers(XbusData::kLatLon, 3).empty());
}

TEST_CASE("a message of more than 254 bytes tells its length in two") {
  std::string data = kXbusTime;
  for (int i = 0; i < 20; ++i) data += datum(0x4020, std::string(12, '\x01'));
  const std::string message = mtData2(data + kXbusStatus);
  REQUIRE(message.size() > 300);
  const FrameLook look = lookForXbus(message);
  CHECK(look.verdict == FrameLook::Verdict::kFrame);
  CHECK(look.size == message.size());
  REQUIRE(XbusFields::of(message));
  CHECK(XbusFields::of(message)->holds(XbusData::kStatusWord));
}

TEST_CASE("an Xsens message that cannot be vouched for is refused by its reason") {
  CHECK(refusalOf(kXbusTime + kXbusStatus +
                  datum(0x2010, highFirst(0x3F800000U, 4) + highFirst(0, 4) + highFirst(0, 4) +
                                    highFirst(0, 4)))
            .empty());
  CHECK(refusalOf(kXbusStatus).find("SampleTimeFine") != std::string::npos);
  CHECK(refusalOf(kXbusTime).find("StatusWord") != std::string::npos);
  CHECK(refusalOf(kXbusTime + kXbusStatus + datum(0x2014, std::string(16, '\0')))
            .find("east, north, up") != std::string::npos);
  CHECK(refusalOf(kXbusTime + kXbusStatus + datum(0x2010, std::string(16, '\0')))
            .find("out of range") != std::string::npos);
  CHECK(refusalOf(kXbusTime + kXbusStatus + datum(0x5043, doubles({95.0, 7.0})))
            .find("out of range") != std::string::npos);
  CHECK(refusalOf(kXbusTime + kXbusStatus + "\x20\x10\x20").find("not known") != std::string::npos);
}
