// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <random>
#include <vector>

#include "modules/ins_driver/nmea/nmea_ins.hpp"
#include "modules/ins_driver/nmea/nmea_parser.hpp"
#include "tests/ins_driver/nmea_lines.hpp"

using namespace tread;
using namespace tread::ins;

namespace {

const std::vector<std::string>& examples() {
  static const std::vector<std::string> kExamples = {
      line("GPGGA,204132.10,4205.733715,N,08802.040978,W,2,08,1.0,221.921,M,,,3,0138"),
      line("GPRMC,204132.00,A,4205.733476,N,08802.041110,W,9.415,21.404,190214,,,D"),
      line("GPVTG,97.75,T,112.39,M,0.04,N,0.07,K,A"),
      line("GPHDT,274.07,T"),
      line("PASHR,204132.000,010.51,T,+00.39,-00.79,-00.84,0.151,0.075,0.555,1,0"),
      line("GPROT,-35.6,A"),
      line("GPZDA,193913.00,07,09,2018,00,00")};
  return kExamples;
}

/// Bodies of the sentences accepted by framer and parser.
std::vector<std::string> acceptedOf(const std::string& bytes) {
  NmeaFramer framer;
  std::vector<std::string> bodies;
  for (const char byte : bytes) {
    const auto body = framer.push(byte);
    if (body && std::holds_alternative<NmeaSentence>(parseNmea(*body))) bodies.emplace_back(*body);
  }
  return bodies;
}

/// Promises of an estimate for any input: status bits and NaN agree, everything else is finite.
void checkHonest(const InsEstimate& ins, int64_t now) {
  const bool position = !(ins.status & InsStatus::kNoPosition);
  CHECK(std::isfinite(ins.p_map_body.x()) == position);
  CHECK(std::isfinite(ins.p_map_body.y()) == position);
  const bool heading = !(ins.status & InsStatus::kNoHeading);
  CHECK(std::isfinite(ins.R_map_body.norm()) == heading);
  if (heading) CHECK(std::abs(ins.R_map_body.norm() - 1.0) < 1e-9);
  CHECK(std::isfinite(ins.v_body.x()) == !(ins.status & InsStatus::kNoVelocity));
  CHECK(ins.utime <= now);
  for (int i = 0; i < 3; ++i) CHECK_FALSE(std::isinf(ins.position_std[i]));
}

/// Alters bytes of a line; in half of the cases the checksum is corrected, so that the parser is
/// reached.
std::string mutated(std::string text, std::mt19937_64& random) {
  const int changes = 1 + static_cast<int>(random() % 4);
  for (int i = 0; i < changes && text.size() > 2; ++i) {
    const size_t at = random() % text.size();
    constexpr char kAlphabet[] = "0123456789.,,,-+*$\r\nAVNSEWTMK";
    const char letter = random() % 4 == 0 ? static_cast<char>(random() & 0xFF)
                                          : kAlphabet[random() % (sizeof kAlphabet - 1)];
    switch (random() % 4) {
      case 0:
        text[at] = letter;
        break;
      case 1:
        text.insert(at, 1 + random() % 3, letter);
        break;
      case 2:
        text.erase(at, 1 + random() % 8);
        break;
      default:
        text += examples()[random() % examples().size()].substr(random() % 20);
    }
  }
  const size_t star = text.find('*');
  if (random() % 2 == 0 && star != std::string::npos && star > 1)
    return line(text.substr(1, star - 1));
  return text;
}

}  // namespace

TEST_CASE("every single flipped bit of a sentence is refused or harmless") {
  int refused = 0;
  int harmless = 0;
  for (const std::string& text : examples()) {
    const std::string original = acceptedOf(text).at(0);
    const std::string next = acceptedOf(line("GPHDT,1.0,T")).at(0);
    for (size_t bit = 0; bit < text.size() * 8; ++bit) {
      std::string flipped = text;
      flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << (bit % 8)));
      const auto bodies = acceptedOf(flipped + line("GPHDT,1.0,T"));
      CAPTURE(text, bit);
      REQUIRE_FALSE(bodies.empty());
      CHECK(bodies.back() == next);
      CHECK(bodies.size() <= 2);
      if (bodies.size() == 2) CHECK(bodies.front() == original);
      ++(bodies.size() == 2 ? harmless : refused);
    }
  }
  WARN("flipped bits: " << refused << " refused, " << harmless
                        << " harmless (case of a checksum digit, line end)");
  CHECK(refused > 20 * harmless);
}

TEST_CASE("good lines after a megabyte of garbage are all decoded") {
  for (const bool printable : {false, true}) {
    std::mt19937_64 random(21);
    std::string garbage(1 << 20, '\0');
    for (char& byte : garbage)
      byte = static_cast<char>(printable ? 0x20 + random() % 0x5F : random() & 0xFF);
    InsConfig config;
    NmeaIns ins(config);
    ins.push(garbage, 1'000'000);
    const int64_t before = ins.counts().decoded;
    CHECK(ins.counts().sentences > 1000);
    for (int i = 0; i < 100; ++i) {
      const double t = 43200.0 + i * 0.02;
      ins.push(gga(t) + pashr(t, 90.0), 2'000'000 + i * 20'000);
    }
    CHECK(ins.counts().decoded - before == 200);
    int estimates = 0;
    while (ins.next(10'000'000)) ++estimates;
    CHECK(estimates == 100);
  }
}

TEST_CASE("mutated sentences neither crash nor lie, and good ones after them are heard") {
  std::mt19937_64 random(77);
  InsConfig config;
  config.p_body_antenna = {0.5, 0.1, 1.0};
  NmeaIns ins(config);
  int64_t utime = 1'000'000;
  int64_t last = INT64_MIN;
  int64_t estimates = 0;
  const auto collect = [&] {
    while (const auto estimate = ins.next(utime)) {
      checkHonest(*estimate, utime);
      CHECK(estimate->utime > last);
      last = estimate->utime;
      ++estimates;
    }
  };
  for (int i = 0; i < 60'000; ++i) {
    const double t = static_cast<double>(utime) * 1e-6;
    const std::string current[] = {gga(t, 0.1 * (i % 7)), pashr(t, i % 360), vtg(i % 360, i % 20)};
    const bool timed = random() % 4 != 0;
    const std::string text =
        timed ? current[random() % 3] : examples()[random() % examples().size()];
    ins.push(random() % 2 == 0 ? text : mutated(text, random), utime);
    utime += static_cast<int64_t>(random() % 20'000);
    collect();
  }
  ins.interrupt();
  collect();
  const NmeaCounts counts = ins.counts();
  CHECK(counts.sentences == counts.decoded + counts.refused.total());
  CHECK(estimates > 100);
  WARN("fuzz: " << counts.sentences << " sentences, " << counts.decoded << " decoded, " << estimates
                << " estimates");
  for (size_t i = 0; i < kRefusalCount; ++i) CHECK(counts.refused.of[i] > 0);
  const int64_t before = counts.decoded;
  for (int i = 0; i < 100; ++i) {
    const double t = 72000.0 + i * 0.02;
    utime += 20'000;
    ins.push(gga(t) + pashr(t, 90.0), utime);
    collect();
  }
  // Ten late ones at most, until it is clear that the device's clock was set back.
  CHECK(ins.counts().decoded - before >= 200 - 11);
}

TEST_CASE(
    "random bodies with a good checksum neither crash nor pass as measurements out of range") {
  std::mt19937_64 random(5);
  const char* addresses[] = {"GPGGA", "GPRMC", "GPVTG", "GPHDT", "PASHR", "GPROT", "GPZDA"};
  int accepted = 0;
  for (int i = 0; i < 200'000; ++i) {
    std::string body = addresses[random() % 7];
    const size_t length = random() % 60;
    for (size_t k = 0; k < length; ++k) body += "0123456789.,,,,,-ATVNWEMK"[random() % 25];
    const ParseResult result = parseNmea(body);
    const auto* sentence = std::get_if<NmeaSentence>(&result);
    if (!sentence) continue;
    ++accepted;
    const auto time_of_day = timeOfDay(*sentence);
    if (time_of_day) CHECK((*time_of_day >= 0 && *time_of_day < 86401 * int64_t{1000000}));
    if (const auto* hdt = std::get_if<Hdt>(sentence)) {
      if (hdt->yaw) CHECK(std::abs(*hdt->yaw) <= M_PI);
    }
  }
  CHECK(accepted > 0);
}
