// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>
#include <random>

#include "modules/planner/core/map/heading_aware_heuristic.hpp"
#include "tests/helpers.hpp"
#include "tests/planner/kit/random_ground.hpp"
#include "tests/planner/kit/vehicle.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

namespace {

const FootprintSize kSize = kVehicle;
constexpr double kBin = 2.0 * kPi / FreeConfigurations::kHeadings;

/// A ground and its free configurations, with and without shortcuts.
struct ConfigurationBench {
  explicit ConfigurationBench(std::mt19937_64& random, bool unknown_blocks)
      : ground(shape(random)),
        unknown(unknown_blocks),
        around(ground.draw(random), kSize, Margins{}, unknown_blocks),
        configurations(around, kSize.half_width) {}

  static RandomGround shape(std::mt19937_64& random) {
    RandomGround ground;
    ground.lower = {drawn(random, -90, 40), drawn(random, -90, 40)};
    ground.cell_size = drawn(random, 0, 1) == 0 ? 0.1 : 0.07;
    ground.what = drawn(random, 0, 3) == 0 ? kUnknown : kObstacle;
    return ground;
  }
  bool isFree(const Pose2& pose) const {
    const Footprint exact(kSize, 0.0);
    return exact.blockedCells(around.grid(), pose, unknown) == 0;
  }
  /// Number of cell centres in a square where the footprint is free, and of all.
  std::pair<int, int> freeCentres(int column, int row, int heading) const {
    const Grid& grid = around.grid();
    const int side = static_cast<int>(std::lround(configurations.size() / grid.cellSize()));
    std::pair<int, int> count{0, 0};
    for (int y = row * side; y < std::min(grid.height(), (row + 1) * side); ++y) {
      for (int x = column * side; x < std::min(grid.width(), (column + 1) * side); ++x) {
        const Eigen::Vector2d p = grid.centre({grid.lower().x + x, grid.lower().y + y});
        count.first += isFree({p.x(), p.y(), heading * kBin}) ? 1 : 0;
        ++count.second;
      }
    }
    return count;
  }

  RandomGround ground;
  bool unknown;
  CollisionChecker around;
  FreeConfigurations configurations;
};

}  // namespace

TEST_CASE("a square is free in a heading only if the footprint has room at one of its cells") {
  std::mt19937_64 random(1);
  int free = 0;
  int blocked = 0;
  for (int i = 0; i < testing::effort(20); ++i) {
    ConfigurationBench bench(random, i % 2 == 0);
    FreeConfigurations& configurations = bench.configurations;
    for (int k = 0; k < 500; ++k) {
      const int column = drawn(random, 0, configurations.width() - 1);
      const int row = drawn(random, 0, configurations.height() - 1);
      const int heading = drawn(random, 0, FreeConfigurations::kHeadings - 1);
      const auto [room, all] = bench.freeCentres(column, row, heading);
      const size_t square = configurations.number(column, row);
      const bool is_free = configurations.isFree(square, heading);
      REQUIRE(configurations.isFree(square, heading) == is_free);  // cached as computed
      if (is_free) REQUIRE(room > 0);
      if (room == all) REQUIRE(is_free);
      if (room > 0) REQUIRE(configurations.passable(square));
      ++(is_free ? free : blocked);
    }
  }
  CHECK(free > testing::effort(1000));
  CHECK(blocked > testing::effort(1000));
}

TEST_CASE("wherever the footprint is free, the square is passable") {
  std::mt19937_64 random(2);
  int free = 0;
  for (int i = 0; i < testing::effort(40); ++i) {
    const ConfigurationBench bench(random, i % 2 == 0);
    for (int k = 0; k < 500; ++k) {
      const Pose2 pose = bench.ground.pose(random);
      if (!bench.isFree(pose)) continue;
      ++free;
      const FreeConfigurations& configurations = bench.configurations;
      REQUIRE(configurations.passable(
          configurations.number(configurations.column(pose.x), configurations.row(pose.y))));
    }
  }
  CHECK(free > testing::effort(2000));
}

TEST_CASE(
    "a point lies in the square that is asked for, and beyond the map's rim nothing is free") {
  std::mt19937_64 random(3);
  for (int i = 0; i < testing::effort(20); ++i) {
    ConfigurationBench bench(random, false);
    FreeConfigurations& configurations = bench.configurations;
    for (int k = 0; k < 100; ++k) {
      const Pose2 pose = bench.ground.pose(random);
      const Eigen::Vector2d centre =
          configurations.centre(configurations.column(pose.x), configurations.row(pose.y));
      REQUIRE((centre - pose.position()).cwiseAbs().maxCoeff() <=
              0.5 * configurations.size() + 1e-9);
    }
    for (int row = -FreeConfigurations::kRim;
         row < configurations.height() + FreeConfigurations::kRim; ++row) {
      for (int column = -FreeConfigurations::kRim;
           column < configurations.width() + FreeConfigurations::kRim; ++column) {
        if (column >= 0 && row >= 0 && column < configurations.width() &&
            row < configurations.height())
          continue;
        const size_t square = configurations.number(column, row);
        REQUIRE(square < configurations.count());
        REQUIRE_FALSE(configurations.passable(square));
        for (int heading = 0; heading < FreeConfigurations::kHeadings; ++heading)
          REQUIRE_FALSE(configurations.isFree(square, heading));
      }
    }
  }
}

TEST_CASE("a map smaller than a square, and one with no cells, make places all the same") {
  Grid one(0.1, {-5, 3}, 1, 1);
  one.set({-5, 3}, kFree);
  const CollisionChecker open(one, kSize, Margins{}, false);
  FreeConfigurations single(open, kSize.half_width);
  CHECK(single.width() == 1);
  CHECK(single.height() == 1);
  CHECK(single.isFree(single.number(0, 0), 5));
  const CollisionChecker closed(one, kSize, Margins{}, true);
  FreeConfigurations none_free(closed, kSize.half_width);
  CHECK_FALSE(none_free.passable(none_free.number(0, 0)));
  const CollisionChecker nowhere(Grid{}, kSize, Margins{}, true);
  const FreeConfigurations none(nowhere, kSize.half_width);
  CHECK(none.width() == 0);
  CHECK(none.height() == 0);
}
