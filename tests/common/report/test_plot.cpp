// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cstdio>
#include <fstream>
#include <iterator>

#include <unistd.h>

#include "common/report/plot.hpp"

using namespace tread;
using namespace tread::report;

TEST_CASE("a picture with a map and a curve is a PNG of the asked size") {
  const std::string path = "test_plot_" + std::to_string(getpid()) + ".png";
  {
    Picture picture(640, 320, "test");
    Panel map(picture, {60, 60, 240, 200}, {"map", "x [m]", "y [m]", -5, 5, -5, 5, true});
    Grid grid(0.5, {-10, -10}, 20, 20);
    grid.set({0, 0}, kObstacle);
    grid.set({1, 1}, kFree);
    map.grid(grid);
    map.finish();
    Panel curve(picture, {360, 60, 240, 200}, {"error", "pattern", "[m]", 0, 3, 0, 1});
    curve.line({{0, 0.1}, {1, 0.5}, {2, NAN}, {3, 0.2}}, {kBlue, 2.0, false, "single"});
    curve.finish();
    picture.save(path);
  }
  std::ifstream file(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  std::remove(path.c_str());
  REQUIRE(bytes.size() > 1000);
  REQUIRE(bytes.substr(1, 3) == "PNG");
  // A PNG has width and height as big-endian at bytes 16 and 20.
  REQUIRE(static_cast<unsigned char>(bytes[18]) * 256 + static_cast<unsigned char>(bytes[19]) ==
          640);
  REQUIRE(static_cast<unsigned char>(bytes[22]) * 256 + static_cast<unsigned char>(bytes[23]) ==
          320);
}

TEST_CASE("a picture that cannot be written is one clear line") {
  Picture picture(10, 10, "");
  REQUIRE_THROWS_WITH(picture.save("/nowhere/at/all.png"),
                      Catch::Contains("/nowhere/at/all.png: cannot be written"));
}
