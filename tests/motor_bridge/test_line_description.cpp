// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <limits>
#include <stdexcept>

#include <catch2/catch.hpp>

#include "modules/motor_bridge/core/checksums.hpp"
#include "modules/motor_bridge/line_protocol/line_description.hpp"

using namespace tread;
using namespace tread::motor;

namespace {

std::string refusal(const std::string& text) {
  try {
    ConfigReader reader = ConfigReader::fromText(text, "drive.yaml");
    readLineDescription(reader, {});
    reader.finish();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

const std::string kLeast = "name: x\ncommand: [\"M {left} {right}\"]\n";

}  // namespace

TEST_CASE("checksums have the check values of their standards") {
  CHECK(crc16("123456789") == 0x31c3);
  CHECK(crc8("123456789") == 0xf4);
  CHECK(sum8("123456789") == 0xdd);
  CHECK(xorOf("GPGLL,5300.97914,N,00259.98174,E,125926,A") == 0x28);
}

TEST_CASE("numbers are written in their forms and clamped to what these can hold") {
  const auto line = [](const std::string& text, double value) {
    return LineTemplate(text).format({{"a", value}});
  };
  CHECK(line("!{a}", 12.6) == "!13");
  CHECK(line("{a:+d}|{a:04d}", -7.0) == "-7|-0007");
  CHECK(line("{a:+d}", 0.0) == "+0");
  CHECK(line("{a:+05.2f}", 1.239) == "+01.24");
  CHECK(line("{a:.1f}", -0.04) == "0.0");
  CHECK(line("{{{a:02x}}}", 200.0) == "{c8}");
  CHECK(line("{a:+04X}", -2.0) == "FFFE");
  CHECK(line("{a:+04X}", 1e9) == "7FFF");
  CHECK(line("{a:02x}", -5.0) == "00");
  CHECK(line("{a}", std::numeric_limits<double>::quiet_NaN()) == "0");
  CHECK(LineTemplate("{a}").format({}) == "0");
}

TEST_CASE("lines are read as they are written, and others are not") {
  const LineTemplate line("V={_}:{v:d},{f:.1f}*{h:+02x}");
  const auto values = line.match("V=abc:-12,+3.5*fe");
  REQUIRE(values);
  CHECK(values->at("v") == -12.0);
  CHECK(values->at("f") == 3.5);
  CHECK(values->at("h") == -2.0);
  for (const char* other :
       {"", "V=", "V=a:1,2*f", "V=a:1,2*fff", "V=a:x,2*ff", "V=a:1,2.2.2*ff", "V=a:--1,2*ff",
        "V=a:1,2*ff ", "v=a:1,2*ff", "V=a:99999999999999999999999,2*ff"})
    CHECK_FALSE(line.match(other));
}

TEST_CASE("templates that could mean two things are refused with what is wrong") {
  for (const char* text : {"{a", "a}", "{}", "{A}", "{a:}", "{a:q}", "{a:.f}", "{a:0d}", "{a:+x}",
                           "{a}{b}", "{a:.2d}", "{a:09x}", "a\tb", "{a:f}"}) {
    INFO(text);
    CHECK_THROWS_AS(LineTemplate(text), std::invalid_argument);
  }
  CHECK_NOTHROW(LineTemplate("{a:02x}{b:02x}"));
}

TEST_CASE("a description is refused with its line and a remedy") {
  CHECK(refusal(kLeast).empty());
  for (const std::string bad :
       {"name: x", "name: x\ncommand: [\"M {left}\"]", "name: x\ncommand: [\"M {left} {rigth}\"]",
        "name: x\ncommand: [\"M {left:04x} {right:04x}\"]", "name: x\ncommand: []"}) {
    INFO(bad);
    CHECK(refusal(bad).rfind("drive.yaml:", 0) == 0);
  }
  for (const char* more :
       {"line_end: tab", "checksum: md5", "full_command: 0", "watchdog: 0", "watchdog: 5",
        "stop: [\"S {left}\"]", "start: [{send: \"W {_}\", expect: K}]", "start: [{send: W}]",
        "queries: [{send: Q, expect: \"{volts}\"}]", "faults: [{mask: 0, means: x}]",
        "emergency_stop: E", "units: {speed: 0}", "wachdog: 0.2", "acknowledge: \"{\""}) {
    const std::string line = refusal(kLeast + more);
    INFO(more << " -> " << line);
    CHECK(line.rfind("drive.yaml:3", 0) == 0);
    CHECK(line.find('\n') == std::string::npos);
  }
}

TEST_CASE("every checksum proves its line, and a wrong one does not") {
  for (const auto kind :
       {LineChecksum::kXor, LineChecksum::kSum8, LineChecksum::kCrc8, LineChecksum::kCrc16}) {
    LineDescription description;
    description.checksum = kind;
    description.checksum_mark = "*";
    description.checksum_skip = 1;
    std::string line = description.framed("$ABC,12");
    line.pop_back();
    for (size_t i = 1; i < line.size(); ++i) {
      std::string broken = line;
      broken[i] ^= 1;
      CHECK_FALSE(description.unframe(broken));
    }
    CHECK(description.unframe(line));
    CHECK(line == "$ABC,12");
    std::string shorter = "*";
    CHECK_FALSE(description.unframe(shorter));
  }
}
