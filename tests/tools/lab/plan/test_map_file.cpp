// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <algorithm>

#include "common/config/config_reader.hpp"
#include "tests/tools/lab/plan/plan_samples.hpp"
#include "tools/lab/plan/map_file.hpp"
#include "tools/lab/plan/plan_files.hpp"

using namespace tread;
using namespace tread::plan;
using namespace tread::plan::samples;
using Catch::Contains;

namespace {

const std::string kPicture = std::string("P5\n# drawn by hand\n3 2\n255\n") + std::string(
                                                                                  "\xfe\xcd\x00"
                                                                                  "\x00\xfe\xfe",
                                                                                  6);

std::string yaml(const std::string& more = "") {
  return "image: map.pgm\nresolution: 0.050\norigin: [-1.02, 2.5, 0.0]\nnegate: 0\n"
         "occupied_thresh: 0.65\nfree_thresh: 0.196\n" +
         more;
}

MapFile nav2Map(const std::string& text, const std::string& picture = kPicture) {
  const Folder folder;
  folder.write("map.pgm", picture);
  return readMap(folder.write("map.yaml", text));
}

std::vector<int> cellsOf(const Grid& grid) {
  return {grid.cells().begin(), grid.cells().end()};
}

double share(const Grid& grid, Cell cell) {
  const auto count = std::count(grid.cells().begin(), grid.cells().end(), cell);
  return static_cast<double>(count) / static_cast<double>(grid.cells().size());
}

}  // namespace

TEST_CASE("a nav2 map stands with its picture's last row lowest and its origin as a pose") {
  const MapFile map = nav2Map(yaml());
  CHECK(map.grid.cellSize() == 0.05);
  CHECK(map.grid.lower() == CellIndex{0, 0});
  CHECK(map.grid.width() == 3);
  CHECK(map.grid.height() == 2);
  CHECK(cellsOf(map.grid) == std::vector<int>{kObstacle, kFree, kFree, kFree, kUnknown, kObstacle});
  CHECK(map.costs.empty());
  CHECK_FALSE(map.T_map_start);
  CHECK_FALSE(map.nominal_speed);
  const Eigen::Vector2d p_map = map.T_map_grid * map.grid.centre({2, 1});
  CHECK(p_map.x() == Approx(-1.02 + 0.125));
  CHECK(p_map.y() == Approx(2.5 + 0.075));
}

TEST_CASE("a nav2 map that is turned lies turned about its lower left corner") {
  std::string text = yaml();
  text.replace(text.find("0.0]"), 3, "1.5707963267948966");
  const MapFile map = nav2Map(text);
  const Eigen::Vector2d p_map = map.T_map_grid * map.grid.centre({2, 0});
  CHECK(p_map.x() == Approx(-1.02 - 0.025));
  CHECK(p_map.y() == Approx(2.5 + 0.125));
}

TEST_CASE("a nav2 map's thresholds, negation and modes are those of its own loader") {
  std::string text = yaml();
  text.replace(text.find("0.196"), 5, "0.25");
  CHECK(cellsOf(nav2Map(text).grid)[4] == kFree);  // (255 - 205) / 255 = 0.196
  text = yaml();
  text.replace(text.find("negate: 0"), 9, "negate: 1");
  CHECK(cellsOf(nav2Map(text).grid) ==
        std::vector<int>{kFree, kObstacle, kObstacle, kObstacle, kObstacle, kFree});
  const std::string grey = "P2 4 1 255 230 140 100 80\n";
  CHECK(cellsOf(nav2Map(yaml("mode: trinary\n"), grey).grid) ==
        std::vector<int>{kFree, kUnknown, kUnknown, kObstacle});
  // (1 - 140 / 255 - 0.196) / (0.65 - 0.196) = 0.5614
  CHECK(cellsOf(nav2Map(yaml("mode: scale\n"), grey).grid) ==
        std::vector<int>{kFree, 56, 91, kObstacle});
  CHECK(cellsOf(nav2Map(yaml("mode: raw\n"), grey).grid) ==
        std::vector<int>{kUnknown, kUnknown, kObstacle, 80});
}

TEST_CASE("a picture may be text or bytes, with comments and another white than 255") {
  const GreyImage text = parsePgm("P2\n# a\n2 # wide\n2\n15\n0 15\n# between\n7\n3", "a.pgm");
  CHECK(text.white == 15);
  CHECK(text.pixels == std::vector<uint8_t>{0, 15, 7, 3});
  // A byte equal to a blank or hash is an ordinary pixel.
  const GreyImage bytes = parsePgm("P5 2 2 255\n# \n\x09", "a.pgm");
  CHECK(bytes.pixels == std::vector<uint8_t>{'#', ' ', '\n', 9});
}

TEST_CASE("a picture that is none or broken is one clear line") {
  const auto parse = [](const std::string& text) { parsePgm(text, "a.pgm"); };
  CHECK_THROWS_WITH(parse("\x89PNG"), Contains("a.pgm:1: is not a PGM picture"));
  CHECK_THROWS_WITH(parse(""), Contains("is not a PGM picture"));
  CHECK_THROWS_WITH(parse("P5\n3"), "a.pgm:2: the file ends where the height should be");
  CHECK_THROWS_WITH(parse("P5\n3 x\n"), Contains("a.pgm:2: the height is x; a whole number"));
  CHECK_THROWS_WITH(parse("P5 3 3 65535\n"), Contains("two bytes a pixel; convert"));
  CHECK_THROWS_WITH(parse("P5 3 3 255\n12345"), Contains("holds 5 of 9 pixels; it is truncated"));
  CHECK_THROWS_WITH(parse("P5 50000 50000 255\n"), Contains("more than 64000000 pixels"));
  CHECK_THROWS_WITH(parse("P2 7000 7000 255\n1 2"), Contains("it is truncated"));
  CHECK_THROWS_WITH(parse("P2 2 1 15\n1 16"), Contains("a pixel is \"16\""));
  CHECK_THROWS_WITH(parse("P5 1 1 15\n\x20"), Contains("a pixel is 32, more than"));
}

TEST_CASE(
    "what stands between the greatest grey value and the pixels, or behind them, is refused") {
  const auto parse = [](const std::string& text) { parsePgm(text, "a.pgm"); };
  const std::string comment =
      "there is a comment after the largest grey value, where PGM allows none";
  CHECK_THROWS_WITH(parse("P5\n3 2\n255\n# by hand\n123456"),
                    "a.pgm:3: the file holds 16 bytes for 6 pixels; " + comment);
  CHECK_THROWS_WITH(parse("P5\n3 2\n255 # by hand\n123456"), Contains(comment));
  CHECK_THROWS_WITH(parse("P5\n3 2\n255# by hand\n123456"), Contains(comment));
  CHECK_THROWS_WITH(parse("P5\n3 2\n255#123456"), Contains(comment));
  CHECK_THROWS_WITH(parse("P5\r\n3 2\r\n255\r\n123456"),
                    "a.pgm:3: the file holds 7 bytes for 6 pixels; there is CR LF after the "
                    "largest grey value, where PGM allows one byte");
  CHECK_THROWS_WITH(parse("P5\n3 2\n255\n123456\n"), Contains("allows nothing after the pixels"));
  CHECK_THROWS_WITH(parse("P5 1 1 255\n1P5 1 1 255\n1"), Contains("nothing after the pixels"));
  CHECK_THROWS_WITH(parse("P2 2 1 255\n1 2 3\n"),
                    Contains("there is more text after the last of 2"));
  CHECK(parsePgm("P2 2 1 255\n1 002\n# end\n", "a.pgm").pixels == std::vector<uint8_t>{1, 2});
  CHECK(parsePgm("\xEF\xBB\xBFP2\r\n# a\r\n2 1\r\n255\r\n1 2\r\n", "a.pgm").pixels.size() == 2);
}

TEST_CASE("a map's unknown that its free_thresh makes free is told") {
  std::string text = yaml();
  CHECK(nav2Map(text).note.empty());
  text.replace(text.find("0.196"), 5, ".25");
  CHECK(nav2Map(text).note ==
        "1 cells of grey 205, which map_saver writes for unknown cells, are free by free_thresh "
        "0.25, "
        "as nav2 reads it; with mode: trinary and free_thresh: 0.196 they are unknown");
  CHECK(nav2Map(text, "P2 2 1 255 254 0\n").note.empty());
  CHECK(nav2Map(text, "P2 2 1 205 205 0\n").note.empty());
  CHECK(nav2Map(text + "mode: raw\n").note.empty());
  CHECK_THAT(nav2Map(yaml("mode: scale\n")).note, Contains("are free by free_thresh 0.196"));
  text.replace(text.find("negate: 0"), 9, "negate: True");
  CHECK(nav2Map(text).note.empty());
}

TEST_CASE("maps in text may begin with a byte order mark and have lines of other systems") {
  std::string lines = "\xEF\xBB\xBF" + yaml();
  for (size_t at = 0; (at = lines.find('\n', at)) != std::string::npos; at += 2)
    lines.replace(at, 1, "\r\n");
  CHECK(nav2Map(lines).grid.width() == 3);
  lines = "\xEF\xBB\xBF" + kEnvironment;
  for (size_t at = 0; (at = lines.find('\n', at)) != std::string::npos; at += 2)
    lines.replace(at, 1, "\r\n");
  lines.replace(lines.find("0.8"), 3, "+.8");
  CHECK(parseSbplEnvironment(lines, "a.cfg").nominal_speed == 0.8);
  CHECK_THROWS_WITH(parseSbplEnvironment(std::string("\xFF\xFE"
                                                     "d\0",
                                                     4),
                                         "a.cfg"),
                    Contains("a.cfg: is UTF-16 text; save it as UTF-8"));
}

TEST_CASE("a nav2 map that cannot be used is one clear line with its file and line") {
  CHECK_THROWS_WITH(nav2Map("resolution: 0.05\n"), Contains("image"));
  std::string text = yaml();
  text.replace(text.find("0.050"), 5, "0.000");
  CHECK_THROWS_WITH(nav2Map(text), Contains("map.yaml:2: resolution is 0"));
  text = yaml();
  text.replace(text.find("0.0]"), 4, "0.0, 1]");
  CHECK_THROWS_WITH(nav2Map(text), Contains("map.yaml:3: origin"));
  text = yaml();
  text.replace(text.find("0.65"), 4, "0.10");
  CHECK_THROWS_WITH(nav2Map(text), Contains("free_thresh: must be below occupied_thresh"));
  CHECK_THROWS_WITH(nav2Map(yaml("mode: colour\n")), Contains("allowed trinary, scale, raw"));
  const Folder folder;
  CHECK_THROWS_WITH(readMap(folder.write("map.yaml", yaml())),
                    Contains("map.pgm: cannot be read (No such file"));
  CHECK_THROWS_WITH(readMap(folder.path("")), Contains("a map is the .yaml of a nav2 map"));
  CHECK_THROWS_WITH(readMap(folder.path("map.png")), Contains("a map is the .yaml"));
}

TEST_CASE("an SBPL environment gives its cells, its query and how its robot moves") {
  const MapFile map = parseSbplEnvironment(kEnvironment, "a.cfg");
  CHECK(map.grid.cellSize() == 0.5);
  CHECK(map.grid.lower() == CellIndex{0, 0});
  CHECK(map.costs[map.grid.offset({2, 1})] == 128);
  CHECK(map.T_map_grid.position() == Eigen::Vector2d(0.0, 0.0));
  REQUIRE(map.T_map_start);
  CHECK(map.T_map_start->x == 0.25);
  REQUIRE(map.T_map_goal);
  CHECK(map.T_map_goal->yaw == -1.5);
  CHECK(map.nominal_speed == 0.8);
  CHECK(map.turn_time == 3.0);
  CHECK(map.thresholds.possibly_circumscribed == 128);
}

TEST_CASE("in an SBPL environment lethal cells block a footprint, inscribed ones a point, too") {
  const MapFile map = parseSbplEnvironment(kEnvironment, "a.cfg");
  const Grid footprint = gridForFootprint(map);
  CHECK(footprint.cells() == map.grid.cells());
  CHECK(footprint.at({3, 0}) == kObstacle);
  CHECK(footprint.at({3, 1}) == kObstacle);
  CHECK(footprint.at({2, 0}) == kFree);
  CHECK(share(footprint, kObstacle) == Approx(2.0 / 12));
  const Grid point = gridForPoint(map);
  CHECK(point.at({2, 0}) == kObstacle);
  CHECK(point.at({2, 1}) == kFree);
  CHECK(share(point, kObstacle) == Approx(3.0 / 12));
}

TEST_CASE("an environment's threshold of one makes each cost an obstacle") {
  std::string text = kEnvironment;
  text.replace(text.find("obsthresh: 254"), 14, "obsthresh: 1  ");
  text.replace(text.find("inscribed_thresh: 253"), 21, "inscribed_thresh: 1  ");
  const MapFile map = parseSbplEnvironment(text, "a.cfg");
  CHECK(share(gridForFootprint(map), kObstacle) == Approx(5.0 / 12));
  CHECK(gridForPoint(map).cells() == gridForFootprint(map).cells());
}

TEST_CASE("an SBPL environment that is broken is one clear line with its file and line") {
  const auto parse = [](const std::string& from, const std::string& to) {
    std::string text = kEnvironment;
    const size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    parseSbplEnvironment(text.replace(at, from.size(), to), "a.cfg");
  };
  CHECK_THROWS_WITH(parse("obsthresh: 254\n", ""),
                    Contains("a.cfg:9: missing before environment: obsthresh:"));
  CHECK_THROWS_WITH(parse("obsthresh: 254", "obsthresh: 254 obsthresh: 254"),
                    "a.cfg:2: obsthresh: is given twice");
  CHECK_THROWS_WITH(parse("start(meters,rads)", "start(cells)"),
                    Contains("a.cfg:8: \"start(cells):\" is not a key of an SBPL environment"));
  CHECK_THROWS_WITH(parse("0.8", "nan"), Contains("a.cfg:6: the speed is \"nan\"; a number"));
  CHECK_THROWS_WITH(parse("1.75", "inf"), Contains("a.cfg:9: the end's x is \"inf\""));
  CHECK_THROWS_WITH(parse("4 3", "4 0"), Contains("a.cfg:1: the height is \"0\""));
  CHECK_THROWS_WITH(parse("4 3", "60000 60000"), Contains("more than 64000000 cells"));
  CHECK_THROWS_WITH(parse("4 3", "4000 3000"), Contains("it is truncated"));
  CHECK_THROWS_WITH(parse("4 3", "4 4"), "a.cfg:13: the file ends where a cost should be");
  CHECK_THROWS_WITH(parse("4 3", "3 3"), "a.cfg:13: more costs than those of 3 x 3 cells follow");
  CHECK_THROWS_WITH(parse("100", "256"), Contains("a.cfg:11: a cost is \"256\""));
}

TEST_CASE("a damaged map is read or refused in one line, never worse") {
  std::mt19937_64 random(1);
  size_t refused = 0;
  for (int i = 0; i < 4000; ++i) {
    try {
      if (i % 2 == 0) {
        parseSbplEnvironment(damaged(kEnvironment, random), "a.cfg");
      } else {
        parsePgm(damaged(i % 4 == 1 ? kPicture : "P2 3 2 9\n1 2 3\n4 5 6\n", random), "a.pgm");
      }
    } catch (const ConfigError& error) {
      ++refused;
      const std::string line = error.what();
      CHECK((line.rfind("a.cfg:", 0) == 0 || line.rfind("a.pgm:", 0) == 0));
      CHECK(line.find('\n') == std::string::npos);
      CHECK(line.size() < 400);
    }
  }
  CHECK(refused > 1000);
  CHECK(refused < 4000);
}

TEST_CASE("recorded maps have the sizes and the shares of obstacles that were published") {
  const std::string cubicle = recorded("sbpl/cubicle-25mm-inflated-env.cfg");
  if (cubicle.empty()) {
    WARN("skipped: the planning scenarios are not here (TREAD_RECORDINGS)");
    return;
  }
  const MapFile map = readMap(cubicle);
  CHECK(map.grid.width() == 436);
  CHECK(map.grid.height() == 473);
  CHECK(share(gridForFootprint(map), kObstacle) == Approx(0.005).margin(0.0005));
  CHECK(share(gridForPoint(map), kObstacle) == Approx(0.154).margin(0.0005));
  const MapFile env2 = readMap(recorded("sbpl/env2.cfg"));
  CHECK(env2.grid.width() == 100);
  CHECK(env2.grid.height() == 1200);
  CHECK(share(gridForFootprint(env2), kObstacle) == Approx(0.128).margin(0.0005));
  CHECK(share(gridForPoint(env2), kObstacle) == Approx(0.128).margin(0.0005));
  const MapFile depot = readMap(recorded("maps/depot.yaml"));
  CHECK(depot.grid.width() == 604);
  CHECK(depot.grid.height() == 307);
  CHECK(share(depot.grid, kObstacle) == Approx(5947.0 / 185428));
}
