// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <random>
#include <vector>

#include "tests/ins_driver/nmea_lines.hpp"

using namespace tread::ins;

namespace {

std::vector<std::string> bodiesOf(NmeaFramer& framer, const std::string& bytes) {
  std::vector<std::string> bodies;
  for (const char byte : bytes) {
    if (const auto body = framer.push(byte)) bodies.emplace_back(*body);
  }
  return bodies;
}

}  // namespace

TEST_CASE("a sentence comes out whole, however its bytes arrive") {
  NmeaFramer framer;
  CHECK(bodiesOf(framer, "$GPHDT,274.07").empty());
  CHECK(framer.refusals().total() == 0);
  CHECK(bodiesOf(framer, ",T*03\r\n$GPHDT,274.04,T*00\n$GPHDT,,T*1B\r") ==
        std::vector<std::string>{"GPHDT,274.07,T", "GPHDT,274.04,T", "GPHDT,,T"});
  CHECK(framer.sentences() == 3);
  CHECK(framer.strayBytes() == 0);
  CHECK(framer.refusals().total() == 0);
}

TEST_CASE("each malformed line is refused with its own reason") {
  struct Case {
    std::string bytes;
    SentenceRefusal reason;
  };
  const std::vector<Case> cases = {
      {"$GPHDT,274.07,T\r\n", SentenceRefusal::kNoChecksum},
      {"$GPHDT,274.07,T*0\r\n", SentenceRefusal::kNoChecksum},
      {"$GPHDT,274.07,T*0G\r\n", SentenceRefusal::kNoChecksum},
      {"$GPHDT,274.07,T*03 \r\n", SentenceRefusal::kNoChecksum},
      {"$GPHDT,274.07,T*03*03\r\n", SentenceRefusal::kNoChecksum},
      {"$\r\n", SentenceRefusal::kNoChecksum},
      {"$GPHDT,274.07,T*04\r\n", SentenceRefusal::kWrongChecksum},
      {"$GPHDT,274.08,T*03\r\n", SentenceRefusal::kWrongChecksum},
      {"$GPHDT,274\x80.07,T*03\r\n", SentenceRefusal::kNotPrintable},
      {std::string("$GPHDT,274\0.07,T*03\r\n", 22), SentenceRefusal::kNotPrintable},
      {"$GPHDT,274.$GPHDT,,T*1B\r\n", SentenceRefusal::kCut},
      {"$" + std::string(200, 'A') + "\r\n", SentenceRefusal::kTooLong},
  };
  for (const Case& c : cases) {
    CAPTURE(c.bytes);
    NmeaFramer framer;
    bodiesOf(framer, c.bytes);
    CHECK(framer.refusals()[c.reason] == 1);
    CHECK(framer.refusals().total() == 1);
    CHECK(bodiesOf(framer, "$GPHDT,274.04,T*00\r\n").size() == 1);
  }
}

TEST_CASE("the length limit counts the whole line with its end") {
  const std::string head = "GPXXX,";
  const size_t longest = NmeaFramer::kMaxLength - 6;  // '$', '*', two digits, CR, LF
  NmeaFramer framer;
  CHECK(bodiesOf(framer, line(head + std::string(longest - head.size(), '1'))).size() == 1);
  CHECK(bodiesOf(framer, line(head + std::string(longest - head.size() + 1, '1'))).empty());
  CHECK(framer.refusals()[SentenceRefusal::kTooLong] == 1);
}

TEST_CASE("sentences in are sentences out plus refusals, and nothing makes the framer deaf") {
  std::mt19937_64 random(11);
  std::string garbage(1 << 20, '\0');
  for (char& byte : garbage) byte = static_cast<char>(random() & 0xFF);
  NmeaFramer framer;
  int64_t good = static_cast<int64_t>(bodiesOf(framer, garbage).size());
  framer.interrupt();
  CHECK(framer.sentences() == good + framer.refusals().total());
  std::string lines;
  for (int i = 0; i < 200; ++i) lines += "$GPHDT,274.04,T*00\r\n";
  CHECK(bodiesOf(framer, lines).size() == 200);
}

TEST_CASE(
    "good lines are heard after a start without end and after a claim of a long binary frame") {
  NmeaFramer framer;
  bodiesOf(framer, "$GP" + std::string(5000, 'x'));
  bodiesOf(framer, std::string("\xAA\x44\x12\x1C\xFF\xFF\xFF\xFF", 8));
  CHECK(bodiesOf(framer, "$GPHDT,274.04,T*00\r\n").size() == 1);
  CHECK(framer.refusals()[SentenceRefusal::kTooLong] == 1);
}
