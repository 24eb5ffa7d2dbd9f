// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "common/report/page.hpp"
#include "common/report/text.hpp"

using namespace tread;

TEST_CASE("formatted text may be of any length") {
  CHECK(formatted("%d %s", 7, "m") == "7 m");
  CHECK(formatted("%s", std::string(5000, 'x').c_str()).size() == 5000);
  CHECK(fixed(-1.25, 1) == "-1.2");
}

TEST_CASE("base64 is that of RFC 4648") {
  CHECK(base64("").empty());
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foobar") == "Zm9vYmFy");
  CHECK(base64("\xff\xfe") == "//4=");
}

TEST_CASE("letters that HTML reads as its own are escaped") {
  CHECK(escaped("<a b=\"c\"> & d") == "&lt;a b=&quot;c&quot;&gt; &amp; d");
}

TEST_CASE("a hash is that of FIPS 180-4") {
  CHECK(sha256("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST_CASE("ticks are round numbers within the range") {
  CHECK(tickStep(1.0, 5) == Approx(0.2));
  CHECK(ticks(-0.1, 0.5, 0.2).size() == 3);
  CHECK(tickText(0.2, 0.2) == "0.2");
  CHECK(tickText(100.0, 50.0) == "100");
}
