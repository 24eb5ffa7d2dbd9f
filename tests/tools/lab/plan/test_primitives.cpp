// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>
#include <map>

#include "common/config/config_reader.hpp"
#include "tests/tools/lab/plan/lattice_oracle.hpp"
#include "tests/tools/lab/plan/plan_samples.hpp"
#include "tools/lab/plan/lattice_file.hpp"

using namespace tread;
using namespace tread::plan;
using namespace tread::plan::samples;
using Catch::Contains;

namespace {

std::string replaced(const std::string& from, const std::string& to) {
  std::string text = kPrimitives;
  const size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

PrimitiveFile parse(const std::string& text) {
  return parsePrimitives(text, "a.mprim");
}

}  // namespace

TEST_CASE("primitives are read with their headings, cells and poses") {
  const PrimitiveFile file = parse(kPrimitives);
  CHECK(file.resolution == 0.5);
  REQUIRE(file.headings.size() == 4);
  CHECK(file.headings[3] == Approx(1.5 * kPi));
  REQUIRE(file.primitives.size() == 3);
  CHECK(file.primitives[1].id == 1);
  CHECK(file.primitives[1].dx == 1);
  CHECK(file.primitives[1].dy == 1);
  CHECK(file.primitives[1].end_bin == 1);
  CHECK(file.primitives[1].cost_multiplier == 3);
  CHECK(file.primitives[1].poses[2].y == 0.4);
  CHECK(file.primitives[2].start_bin == 3);
  CHECK(file.primitives[2].end_bin == 3);  // written as -1
}

TEST_CASE("primitives are read with a byte order mark and with lines of other systems") {
  std::string text = "\xEF\xBB\xBF" + kPrimitives;
  for (size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2)
    text.replace(at, 1, "\r\n");
  CHECK(parse(text).primitives.size() == 3);
  CHECK_THROWS_WITH(parse(std::string("r\0e\0", 4)), Contains("a.mprim: is UTF-16 text"));
}

TEST_CASE("nav2's lattice gives the primitives that SBPL's file of the same set gives") {
  const Folder folder;
  const PrimitiveFile lattice = readLattice(folder.write("a.json", kLattice));
  const PrimitiveFile sbpl = parse(kPrimitives);
  CHECK(lattice.resolution == sbpl.resolution);
  CHECK(lattice.headings[3] == Approx(sbpl.headings[3]));
  REQUIRE(lattice.primitives.size() == 2);
  for (size_t i = 0; i < 2; ++i) {
    const LatticePrimitive& ours = lattice.primitives[i];
    const LatticePrimitive& theirs = sbpl.primitives[i];
    CHECK(ours.id == theirs.id);
    CHECK(ours.start_bin == theirs.start_bin);
    CHECK(ours.end_bin == theirs.end_bin);
    CHECK(ours.dx == theirs.dx);
    CHECK(ours.dy == theirs.dy);
    REQUIRE(ours.poses.size() == theirs.poses.size());
    for (size_t k = 0; k < ours.poses.size(); ++k) {
      CHECK(ours.poses[k].x == Approx(theirs.poses[k].x));
      CHECK(ours.poses[k].y == Approx(theirs.poses[k].y));
      CHECK(ours.poses[k].yaw == Approx(theirs.poses[k].yaw).margin(1e-4));
    }
  }
}

TEST_CASE("a lattice that cannot be used is one clear line") {
  const Folder folder;
  const auto read = [&](const std::string& from, const std::string& to) {
    std::string text = kLattice;
    text.replace(text.find(from), from.size(), to);
    readLattice(folder.write("a.json", text));
  };
  CHECK_THROWS_WITH(read("\"end_angle_index\": 1", "\"end_angle_index\": 2"),
                    Contains("a.json:26: primitives[1].poses: its last pose misses its end"));
  CHECK_THROWS_WITH(read("\"end_angle_index\": 1", "\"end_angle_index\": 4"), Contains("0..3"));
  CHECK_THROWS_WITH(read("[0.3, 0.4, 1.0]", "[0.3, 0.4]"),
                    Contains("a.json:26: primitives[1].poses"));
  CHECK_THROWS_WITH(read("1.5707963267948966,\n", "0.0,\n"), Contains("must rise"));
  CHECK_THROWS_WITH(read("[0.2, 0.0, 0.0],\n\t\t\t[0.5, 0.0, 0.0]", ""),
                    Contains("none are there"));
  CHECK_THROWS_WITH(parse(kLattice),
                    "a.mprim:1: this is JSON; nav2's lattice primitives are read "
                    "from a file FILE.json");
  CHECK_THROWS_WITH(read("\"grid_resolution\"", "\"resolution\""), Contains("grid_resolution"));
}

TEST_CASE("a lattice whose own counts are not those of what it holds is refused") {
  const Folder folder;
  const auto read = [&](const std::string& from, const std::string& to) {
    std::string text = kLattice;
    text.replace(text.find(from), from.size(), to);
    return readLattice(folder.write("a.json", text)).primitives.size();
  };
  CHECK_THROWS_WITH(read("\"number_of_trajectories\": 2", "\"number_of_trajectories\": 80"),
                    Contains("number_of_trajectories: says 80, but there are 2 primitives"));
  CHECK_THROWS_WITH(read("\"num_of_headings\": 4", "\"num_of_headings\": 8"),
                    Contains("num_of_headings: says 8, but there are 4 headings"));
  CHECK(read("\"num_of_headings\": 4,", "") == 2);
}

TEST_CASE("primitives may state uneven headings and their turning radius") {
  std::string text =
      replaced("numberofangles: 4\n",
               "min_turning_radius_m: 1.0\nnumberofangles: 4\nangle:0 0.0\nangle:1 1.4\n"
               "angle:2 3.1\nangle:3 4.5\n");
  text.replace(text.find("intermediateposes"), 0, "turning_radius: 0.0\n");
  const PrimitiveFile file = parse(text);
  CHECK(file.headings == std::vector<double>{0.0, 1.4, 3.1, 4.5});
  CHECK(nearestBin(file.headings, -0.1) == 0);
  CHECK(nearestBin(file.headings, 5.3) == 3);
  CHECK(nearestBin(file.headings, 5.5) == 0);
}

TEST_CASE("primitives that are broken are one clear line with file, line and primitive") {
  const auto read = [](const std::string& from, const std::string& to) {
    parse(replaced(from, to));
  };
  CHECK_THROWS_WITH(read("resolution_m", "resolution"),
                    "a.mprim:1: \"resolution:\" stands where resolution_m: should be");
  CHECK_THROWS_WITH(read("0.500000", "0"), Contains("a.mprim:1: resolution_m is \"0\""));
  CHECK_THROWS_WITH(read("numberofangles: 4", "numberofangles: 4000000"),
                    Contains("a.mprim:2: numberofangles is \"4000000\"; a whole number 1..720"));
  CHECK_THROWS_WITH(read("angles: 4\n", "angles: 4\nangle:0 0.5\nangle:1 0.5\n"),
                    "a.mprim:4: angle:1 is not greater than the angle before it");
  CHECK_THROWS_WITH(read("totalnumberofprimitives: 3", "totalnumberofprimitives: 4"),
                    Contains("a.mprim:27: primitive 4 of 4: the file ends where primID: should"));
  CHECK_THROWS_WITH(read("totalnumberofprimitives: 3", "totalnumberofprimitives: 2"),
                    Contains("a.mprim:20: there is more text after the last of 2 primitives"));
  CHECK_THROWS_WITH(read("additionalactioncostmult: 3\n", ""),
                    Contains("a.mprim:15: primitive 2 of 3: \"intermediateposes:\" stands where"));
  CHECK_THROWS_WITH(read("startangle_c: 3", "startangle_c: 4"),
                    Contains("a.mprim:22: primitive 3 of 3: startangle_c is \"4\""));
  CHECK_THROWS_WITH(read("0 1 -1", "0 1 8"), Contains("primitive 3 of 3: endpose_c's heading bin"));
  CHECK_THROWS_WITH(read("0.2000", "nan"),
                    Contains("a.mprim:10: primitive 1 of 3: a pose's x is \"nan\""));
  CHECK_THROWS_WITH(read("intermediateposes: 4", "intermediateposes: 2"),
                    Contains("a.mprim:18: primitive 2 of 3: its last pose misses its end"));
  CHECK_THROWS_WITH(read("endpose_c: 1 1 1", "endpose_c: 1 2 1"),
                    Contains("its last pose misses its end by more than half a cell or bin"));
  CHECK_THROWS_WITH(read("endpose_c: 1 1 1", "endpose_c: 1 1 2"), Contains("misses its end"));
  CHECK_THROWS_WITH(read("0.0000 0.0000 -1.5708", "0.0000 0.0000 0.0000"),
                    Contains("primitive 3 of 3: its first pose misses the start"));
  CHECK_THROWS_WITH(read("0 1 -1", "0 0 -1"), Contains("its last pose misses its end"));
  std::string still = replaced("0 1 -1", "0 0 -1");
  still.replace(still.find("0.0000 0.5000 4.7124"), 20, "0.0000 0.0000 4.7124");
  CHECK_THROWS_WITH(parse(still), Contains("primitive 3 of 3: it neither moves nor turns"));
}

TEST_CASE("damaged primitives are read or refused in one line, never worse") {
  std::mt19937_64 random(2);
  size_t refused = 0;
  for (int i = 0; i < 4000; ++i) {
    try {
      const PrimitiveFile file = parse(damaged(kPrimitives, random));
      for (const SearchPrimitive& primitive : onLattice(file, {0.001, 1e4}))
        CHECK(primitive.cost > 0.0);
      headingFree(file, {});
    } catch (const ConfigError& error) {
      ++refused;
      const std::string line = error.what();
      CHECK(line.rfind("a.mprim:", 0) == 0);
      CHECK(line.find('\n') == std::string::npos);
      CHECK(line.size() < 400);
    }
  }
  CHECK(refused > 1000);
  CHECK(refused < 4000);
}

TEST_CASE("heading-free primitives are those of heading 0 with the slower of way and turn") {
  const auto free = headingFree(parse(kPrimitives), {0.5, 1.0});
  REQUIRE(free.size() == 2);
  CHECK(free[0].id == 0);
  REQUIRE(free[0].poses.size() == 2);  // without the start
  CHECK(free[0].poses[0].x == 0.2);
  CHECK(free[0].duration == Approx(0.5 / 0.5));
  CHECK(free[0].cost == free[0].duration);
  // A quarter turn takes 2 s, its path of 0.3 + 0.4 + 0.224 m 1.85 s.
  CHECK(free[1].duration == Approx(2.0).epsilon(1e-4));
  CHECK(free[1].cost == Approx(3.0 * free[1].duration));
  CHECK(headingFree(parse(kPrimitives), {0.1, 1.0})[1].duration ==
        Approx((0.7 + std::hypot(0.2, 0.1)) / 0.1));
}

TEST_CASE("heading-free primitives stand in the frame of their start, their yaw unwrapped") {
  std::string text = replaced("numberofangles: 4\n",
                              "numberofangles: 4\nangle:0 0.5\nangle:1 2.0\nangle:2 3.6\n"
                              "angle:3 5.1\n");
  const auto put = [&text](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  put("totalnumberofprimitives: 3", "totalnumberofprimitives: 1");
  text.resize(text.find("primID: 1"));
  put("endpose_c: 1 0 0", "endpose_c: 1 0 3");
  put("0.0000 0.0000 0.0000\n", "0.0000 0.0000 0.5000\n");
  put("0.2000 0.0000 0.0000\n", "0.2000 0.0000 0.0000\n");
  put("0.5000 0.0000 0.0000\n", "0.5000 0.0000 5.1000\n");
  const auto free = headingFree(parse(text), {});
  REQUIRE(free.size() == 1);
  REQUIRE(free[0].poses.size() == 2);
  CHECK(free[0].poses[0].x == Approx(0.2 * std::cos(0.5)));
  CHECK(free[0].poses[0].y == Approx(-0.2 * std::sin(0.5)));
  CHECK(free[0].poses[0].yaw == Approx(-0.5));
  CHECK(free[0].poses[1].yaw == Approx(5.1 - 0.5 - 2.0 * kPi));
  CHECK(free[0].duration == Approx((0.5 + 2.0 * kPi - 5.1) / (kPi / 4.0) * 2.0));
}

TEST_CASE("without a primitive of heading 0 there is none for all headings") {
  std::string text = kPrimitives;
  text.replace(text.find("primitives: 3"), 13, "primitives: 1");
  const size_t first = text.find("primID: 0");
  text.erase(first, text.find("primID: 0", first + 1) - first);
  CHECK_THROWS_WITH(headingFree(parse(text), {}),
                    Contains("a.mprim: no primitive begins in heading bin 0"));
}

TEST_CASE("primitives on a lattice have whole costs and the cells that their poses pass") {
  const auto actions = onLattice(parse(kPrimitives), {0.3, 1.0});
  REQUIRE(actions.size() == 3);
  CHECK(actions[0].start_bin == 0);
  CHECK(actions[0].cost == 1667);                                             // 1666.7 ms
  CHECK(actions[0].cells == std::vector<CellIndex>{{0, 0}, {1, 0}, {1, 0}});  // and the end's
  CHECK(actions[1].start_bin == 0);
  CHECK(actions[1].cost == 3 * 3079);  // 0.9236 m
  // 0.25 + 0.3 m is beyond the first cell's border at 0.5 m.
  CHECK(actions[1].cells == std::vector<CellIndex>{{0, 0}, {1, 0}, {1, 1}, {1, 1}});
  CHECK(actions[2].start_bin == 3);
  CHECK(actions[2].file_id == 0);
  CHECK(actions[2].poses.back().yaw == 0.0);
  CHECK(actions[2].cells == std::vector<CellIndex>{{0, 0}, {0, 1}, {0, 1}});
  CHECK(onLattice(parse(kPrimitives), {10.0, 1.0})[1].cost == 3 * 2000);  // the turn
}

TEST_CASE("recorded primitives on a recorded map cost what an exact search found") {
  if (recorded("sbpl/env1.cfg").empty()) {
    WARN("skipped: the planning scenarios are not here (TREAD_RECORDINGS)");
    return;
  }
  const MapFile map = readMap(recorded("sbpl/env1.cfg"));
  const auto cost = [&](const std::string& name) {
    const PrimitiveFile file = readPrimitives(recorded("sbpl/" + name + ".mprim"));
    return LatticeOracle(map, file).cost();
  };
  CHECK(cost("pr2") == 8348);
  CHECK(cost("all_file") == 527);
  CHECK(cost("mprim_unic_sideback") == 575);
  CHECK(cost("unicycle_noturninplace") == -1);
}

TEST_CASE("recorded primitives have as many for heading 0 as was published") {
  if (recorded("sbpl/env1.cfg").empty()) {
    WARN("skipped: the planning scenarios are not here (TREAD_RECORDINGS)");
    return;
  }
  const std::map<std::string, size_t> published{{"pr2", 7},
                                                {"unicycle_noturninplace", 5},
                                                {"mprim_unic_sideback", 11},
                                                {"all_file", 13},
                                                {"pr2_10cm", 16},
                                                {"non_uniform_res0025_rad1_err005", 10},
                                                {"pr2_unicycle_10cm", 5}};
  for (const auto& [name, count] : published) {
    CAPTURE(name);
    const PrimitiveFile file = readPrimitives(recorded("sbpl/" + name + ".mprim"));
    CHECK(file.primitives.size() == 16 * count);
    const auto free = headingFree(file, {1.0, 20.0});
    CHECK(free.size() == count);
    for (const SearchPrimitive& primitive : free) CHECK(primitive.duration > 0.0);
  }
}
