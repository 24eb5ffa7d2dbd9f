// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "common/geometry/se2.hpp"
#include "modules/ins_driver/nmea/nmea_parser.hpp"
#include "tests/helpers.hpp"

using namespace tread;
using namespace tread::ins;

namespace {

using tread::testing::kDeg;

template <class Sentence>
Sentence good(const std::string& body) {
  CAPTURE(body);
  const ParseResult result = parseNmea(body);
  REQUIRE(std::holds_alternative<NmeaSentence>(result));
  REQUIRE(std::holds_alternative<Sentence>(std::get<NmeaSentence>(result)));
  return std::get<Sentence>(std::get<NmeaSentence>(result));
}

/// Reason as text, for readable failures; "" if the sentence is accepted.
std::string refusal(const std::string& body) {
  const ParseResult result = parseNmea(body);
  const auto* reason = std::get_if<SentenceRefusal>(&result);
  return reason ? name(*reason) : "";
}

constexpr int64_t microseconds(int h, int m, int s, int64_t us) {
  return ((h * 60 + m) * 60 + s) * int64_t{1000000} + us;
}

}  // namespace

TEST_CASE("GGA is read into radians and metres") {
  const Gga gga =
      good<Gga>("GPGGA,204132.10,4205.733715,N,08802.040978,W,2,08,1.0,221.921,M,,,3,0138");
  CHECK(gga.time_of_day == microseconds(20, 41, 32, 100000));
  CHECK(gga.quality == FixQuality::kDifferential);
  REQUIRE(gga.position);
  CHECK(gga.position->latitude == Approx((42.0 + 5.733715 / 60.0) * kDeg).epsilon(1e-15));
  CHECK(gga.position->longitude == Approx(-(88.0 + 2.040978 / 60.0) * kDeg).epsilon(1e-15));
  CHECK(gga.altitude == 221.921);
  CHECK(gga.hdop == 1.0);
  CHECK(gga.satellites == 8);
  const Gga south = good<Gga>("GNGGA,204132,3352.5,S,15112.5,E,4,12,0.7,-2.5,M,22.1,M,1.2,0001");
  CHECK(south.position->latitude == Approx(-33.875 * kDeg));
  CHECK(south.position->longitude == Approx(151.208333333333 * kDeg));
  CHECK(south.altitude == -2.5);
}

TEST_CASE("GGA without a real fix has no position, coordinates or not") {
  CHECK_FALSE(good<Gga>("GPGGA,,,,,,0,,,,M,,M,,").position);
  CHECK_FALSE(good<Gga>("GPGGA,,,,,,0,00,99.99,,,,,,").time_of_day);
  for (const char* quality : {"0", "", "7", "8"}) {
    const Gga gga = good<Gga>(std::string("GPGGA,204132.10,4205.7,N,08802.0,W,") + quality +
                              ",08,1.0,221.9,M,,,3,0138");
    CAPTURE(quality);
    CHECK_FALSE(gga.position);
    CHECK_FALSE(gga.altitude);
    CHECK(gga.time_of_day);
  }
  // A position without altitude is valid; an altitude without position is not.
  CHECK(good<Gga>("GPGGA,204132.10,4205.7,N,08802.0,W,1,08,1.0,,M,,,3,0138").position);
  CHECK_FALSE(good<Gga>("GPGGA,204132.10,,,,,1,08,1.0,221.9,M,,,3,0138").altitude);
}

TEST_CASE("GGA without its last field is read where both units stand in their places") {
  const Gga gga = good<Gga>("GPGGA,064929.00,1726.5842,N,07822.4470,E,1,38,0.4,649.70,M,-76.80,M,");
  CHECK(gga.altitude == 649.7);
  CHECK(gga.satellites == 38);
}

TEST_CASE("RMC is read with course as yaw and speed in metres per second") {
  const Rmc rmc =
      good<Rmc>("GPRMC,204132.00,A,4205.733476,N,08802.041110,W,9.415,21.404,190214,,,D");
  CHECK(rmc.time_of_day == microseconds(20, 41, 32, 0));
  CHECK(rmc.position);
  CHECK(*rmc.speed == Approx(9.415 * 1852.0 / 3600.0));
  CHECK(*rmc.course == Approx((90.0 - 21.404) * kDeg));
  REQUIRE(rmc.date);
  CHECK(daysSinceEpoch(*rmc.date) == 16120);
  CHECK_FALSE(good<Rmc>("GPRMC,152505.00,A,5547.82113,N,02334.14130,E,0.253,,091209,,,A").course);
  CHECK(good<Rmc>("GPRMC,152505.00,A,5547.8,N,02334.1,E,0.2,1.0,091209,,,A,V").position);
  CHECK(good<Rmc>("GPRMC,152505.00,A,5547.8,N,02334.1,E,0.2,1.0,091209,,").position);
}

TEST_CASE("RMC with status V, no status or an invalid mode holds nothing but its time") {
  for (const char* body : {"GPRMC,204132.00,V,4205.733476,N,08802.041110,W,9.4,21.4,190214,,,D",
                           "GPRMC,204132.00,,4205.733476,N,08802.041110,W,9.4,21.4,190214,,,D",
                           "GPRMC,204132.00,A,4205.733476,N,08802.041110,W,9.4,21.4,190214,,,N",
                           "GPRMC,204132.00,A,4205.733476,N,08802.041110,W,9.4,21.4,190214,,,S"}) {
    const Rmc rmc = good<Rmc>(body);
    CHECK(rmc.time_of_day);
    CHECK_FALSE(rmc.position);
    CHECK_FALSE(rmc.speed);
    CHECK_FALSE(rmc.course);
    CHECK_FALSE(rmc.date);
  }
  CHECK_FALSE(good<Rmc>("GPRMC,,V,,,,,,,,,,N").time_of_day);
}

TEST_CASE("VTG prefers km/h, falls back to knots and keeps empty fields empty") {
  const Vtg vtg = good<Vtg>("GPVTG,97.75,T,112.39,M,0.04,N,0.07,K,A");
  CHECK(*vtg.speed == Approx(0.07 / 3.6));
  CHECK(*vtg.course == Approx(-7.75 * kDeg));
  CHECK(*good<Vtg>("GPVTG,97.75,T,,M,10.0,N,,K").speed == Approx(5.144444444));
  const Vtg empty = good<Vtg>("GPVTG,,T,,M,,N,,K,N");
  CHECK_FALSE(empty.speed);
  CHECK_FALSE(empty.course);
  CHECK_FALSE(good<Vtg>("GPVTG,97.75,T,112.39,M,0.04,N,0.07,K,N").speed);
}

TEST_CASE("headings become yaws counter-clockwise from east") {
  struct Case {
    const char* heading;
    double yaw_deg;
  };
  for (const Case& c :
       {Case{"0.0", 90.0}, Case{"90.0", 0.0}, Case{"180", -90.0}, Case{"270.00", 180.0},
        Case{"360.0", 90.0}, Case{"271", 179.0}, Case{"025.50", 64.5}}) {
    CAPTURE(c.heading);
    const Hdt hdt = good<Hdt>(std::string("GPHDT,") + c.heading + ",T");
    CHECK(*hdt.yaw == Approx(c.yaw_deg * kDeg).margin(1e-12));
  }
  CHECK_FALSE(good<Hdt>("GPHDT,,T").yaw);
  CHECK_FALSE(good<Hdt>("HEHDT,,").yaw);
}

TEST_CASE("THS is a heading where its mode says that it was measured") {
  CHECK(*good<Ths>("GNTHS,271.0,A").yaw == Approx(179.0 * kDeg));
  CHECK(*good<Ths>("GNTHS,90.0,E").yaw == Approx(0.0).margin(1e-12));
  for (const char* body : {"GNTHS,271.0,V", "GNTHS,271.0,M", "GNTHS,271.0,S", "GNTHS,271.0,N",
                           "GNTHS,271.0,", "GNTHS,,A", "GNTHS,,V"}) {
    CAPTURE(body);
    CHECK_FALSE(good<Ths>(body).yaw);
  }
}

TEST_CASE("PASHR: roll right side down stays positive, pitch nose up becomes negative") {
  const Pashr pashr =
      good<Pashr>("PASHR,204132.000,010.51,T,+00.39,-00.79,-00.84,0.151,0.075,0.555,1,0");
  CHECK(pashr.time_of_day == microseconds(20, 41, 32, 0));
  CHECK(*pashr.yaw == Approx(79.49 * kDeg));
  CHECK(*pashr.roll == Approx(0.39 * kDeg));
  CHECK(*pashr.pitch == Approx(0.79 * kDeg));
  CHECK(*pashr.roll_std == Approx(0.151 * kDeg));
  CHECK(*pashr.pitch_std == Approx(0.075 * kDeg));
  CHECK(*pashr.yaw_std == Approx(0.555 * kDeg));
}

TEST_CASE("PASHR with empty fields, without the last field, and Ashtech's own sentences") {
  const Pashr empty = good<Pashr>("PASHR,,,,,,,,,,0,0");
  CHECK_FALSE(empty.yaw);
  CHECK_FALSE(empty.roll);
  CHECK_FALSE(empty.pitch_std);
  const Pashr short_one = good<Pashr>("PASHR,163029.000,158.09,T,-0.30,+0.31,+0.01,,,,1");
  CHECK(short_one.yaw);
  CHECK_FALSE(short_one.yaw_std);
  CHECK(refusal("PASHR,POS,0,08,204132.00,4205.7,N,08802.0,W,221.9,,1,2") == "unknown sentence");
  CHECK(refusal("PASHR,ACK") == "unknown sentence");
}

TEST_CASE("ROT is clockwise degrees a minute, and only with status A") {
  CHECK(*good<Rot>("GPROT,-90.0,A").yaw_rate == Approx(1.5 * kDeg));
  CHECK(*good<Rot>("GPROT,3437.7468,A").yaw_rate == Approx(-1.0).epsilon(1e-6));
  CHECK_FALSE(good<Rot>("GPROT,35.6,V").yaw_rate);
  CHECK_FALSE(good<Rot>("GPROT,,A").yaw_rate);
  CHECK_FALSE(good<Rot>("GPROT,,").yaw_rate);
}

TEST_CASE("ZDA holds time and date, leap days and leap seconds exist where the calendar has them") {
  const Zda zda = good<Zda>("GPZDA,193913.00,07,09,2018,00,00");
  CHECK(zda.time_of_day == microseconds(19, 39, 13, 0));
  CHECK(daysSinceEpoch(*zda.date) == 17781);
  CHECK_FALSE(good<Zda>("GPZDA,,,,,00,00").date);
  CHECK(good<Zda>("GPZDA,235960.50,31,12,2016,00,00").time_of_day ==
        microseconds(23, 59, 60, 500000));
  CHECK(good<Zda>("GPZDA,000000,29,02,2024,,").date);
  CHECK(refusal("GPZDA,000000,29,02,2023,,") == "out of range");
  CHECK(refusal("GPZDA,000000,31,04,2023,,") == "out of range");
  CHECK(refusal("GPZDA,000000,00,01,2023,,") == "out of range");
}

TEST_CASE("any two-letter talker is heard, others are unknown") {
  for (const char* talker : {"GP", "GN", "IN", "HE", "II", "ZZ"})
    CHECK(refusal(std::string(talker) + "HDT,1.0,T").empty());
  for (const char* address : {"PXHDT", "GHDT", "GPSHDT", "gpHDT", "G1HDT", "HDT", "GPHDX", "",
                              "GPGSV", "PASHS", "PGRMZ"}) {
    CAPTURE(address);
    CHECK(refusal(std::string(address) + ",1.0,T") == "unknown sentence");
  }
}

TEST_CASE("a number is digits with at most one point and a sign, and nothing else") {
  for (const char* text : {"1e2", "inf", "nan", "-nan", "0x10", " 1.0", "1.0 ", "1,0x", "--1",
                           "+-1", "1..0", "1.2.3", ".", "-", "+", "4X05", "1'000", "1_0"}) {
    CAPTURE(text);
    const std::string body = std::string("GPROT,") + text + ",A";
    CHECK((refusal(body) == "bad field" || refusal(body) == "field count"));
  }
  for (const char* text : {"1", "+1", "-1", "1.", ".5", "-.5", "0001.0"}) {
    CAPTURE(text);
    CHECK(refusal(std::string("GPROT,") + text + ",A").empty());
  }
}

TEST_CASE("what cannot be is out of range") {
  for (const char* body :
       {"GPGGA,204132,9000.1,N,08802.0,W,1,08,1.0,221,M,,,,",
        "GPGGA,204132,4260.0,N,08802.0,W,1,08,1.0,221,M,,,,",
        "GPGGA,204132,4205.0,N,18000.1,W,1,08,1.0,221,M,,,,",
        "GPGGA,204132,4205.0,N,08802.0,W,1,08,-1.0,221,M,,,,",
        "GPGGA,204132,4205.0,N,08802.0,W,1,08,1.0,99999,M,,,,",
        "GPGGA,996199,4205.0,N,08802.0,W,1,08,1.0,221,M,,,,",
        "GPGGA,240000,4205.0,N,08802.0,W,1,08,1.0,221,M,,,,",
        "GPGGA,120060,4205.0,N,08802.0,W,1,08,1.0,221,M,,,,", "GPHDT,360.1,T", "GPHDT,-0.1,T",
        "PASHR,204132.000,010.51,T,+00.39,-90.79,-00.84,0.151,0.075,0.555,1,0",
        "PASHR,204132.000,010.51,T,+00.39,-00.79,-00.84,-0.151,0.075,0.555,1,0",
        "GPVTG,97.75,T,112.39,M,-0.04,N,0.07,K,A", "GPROT,99999,A",
        "GPRMC,204132.00,A,4205.7,N,08802.0,W,9.4,21.4,997702,,,D"}) {
    CAPTURE(body);
    CHECK(refusal(body) == "out of range");
  }
}

TEST_CASE("what is not of its field's form is refused") {
  for (const char* body :
       {"GPGGA,204132.10,4X05.733715,N,08802.040978,W,2,08,1.0,221.921,M,,,3,0138",
        "GPGGA,204132.10,405.733715,N,08802.040978,W,2,08,1.0,221.921,M,,,3,0138",
        "GPGGA,204132.10,4205.733715,,08802.040978,W,2,08,1.0,221.921,M,,,3,0138",
        "GPGGA,204132.10,4205.733715,E,08802.040978,W,2,08,1.0,221.921,M,,,3,0138",
        "GPGGA,20413.10,4205.733715,N,08802.040978,W,2,08,1.0,221.921,M,,,3,0138",
        "GPGGA,204132.,4205.733715,N,08802.040978,W,2,08,1.0,221.921,M,,,3,0138",
        "GPGGA,204132.10,4205.733715,N,08802.040978,W,2,8.5,1.0,221.921,M,,,3,0138",
        "GPGGA,204132.10,4205.733715,N,08802.040978,W,X,08,1.0,221.921,M,,,3,0138",
        "GPGGA,204132.10,4205.733715,N,08802.040978,W,2,08,1.0,221.921,F,,,3,0138",
        "GPRMC,204132.00,B,4205.7,N,08802.0,W,9.4,21.4,190214,,,D",
        "GPRMC,204132.00,A,4205.7,N,08802.0,W,9.4,21.4,19022014,,,D",
        "GPRMC,204132.00,A,4205.7,N,08802.0,W,9.4,21.4,190214,,,Q", "GPHDT,274.07,M",
        "GPHDT,274.07,TT", "GPVTG,97.75,M,112.39,M,0.04,N,0.07,K,A", "GPROT,1.0,B"}) {
    CAPTURE(body);
    CHECK(refusal(body) == "bad field");
  }
}

TEST_CASE("a sentence with a field too many or too few is refused") {
  for (const char* body : {"GPGGA,204132.10,4205.7,N,08802.0,W,2,08,1.0,221.9,M,,,3",
                           "GPGGA,204132.10,4205.7,N,08802.0,W,2,08,1.0,221.9,M,-33.0,,3",
                           "GPGGA,204132.10,4205.7,N,08802.0,W,2,08,1.0,221.9,M,-33.0,M",
                           "GPGGA,204132.10,4205.7,N,08802.0,W,2,08,1.0,221.9,M,,,3,0138,",
                           "GPHDT,274.07", "GPHDT,274.07,T,", "GPHDT", "GPROT,1.0",
                           "GPZDA,193913.00,07,09,2018,00", "GPVTG,97.75,T,112.39,M,0.04,N,0.07",
                           "GPRMC,204132.00,A,4205.7,N,08802.0,W,9.4,21.4,190214",
                           "PASHR,204132.000,010.51,T,+00.39,-00.79",
                           "GPGGA,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,"}) {
    CAPTURE(body);
    CHECK(refusal(body) == "field count");
  }
}

TEST_CASE("days since 1970 agree with known days") {
  CHECK(daysSinceEpoch({1970, 1, 1}) == 0);
  CHECK(daysSinceEpoch({1969, 12, 31}) == -1);
  CHECK(daysSinceEpoch({2000, 2, 29}) == 11016);
  CHECK(daysSinceEpoch({2000, 3, 1}) == 11017);
  CHECK(daysSinceEpoch({2038, 1, 19}) == 24855);
}
