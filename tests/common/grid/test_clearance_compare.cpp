// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <limits>
#include <random>

#include "common/grid/clearance.hpp"
#include "tests/common/grid/worlds.hpp"
#include "tests/helpers.hpp"

using namespace tread;

namespace {

using Verdict = ClearanceField::Verdict;

/// Calls visit(field, point) for points inside and around random grids.
template <class Visit>
void visitPoints(uint64_t seed, const Visit& visit) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> share(-0.2, 1.2);
  for (int i = 0; i < testing::effort(60); ++i) {
    const Grid grid = randomGrid(random, {-17, 9}, 40, 31, i % 5 == 0 ? 0.0 : 0.004 * (i % 7),
                                 i % 3 == 0 ? 0.01 : 0.0);
    const ClearanceField field(grid, i % 2 == 0);
    for (int k = 0; k < 400; ++k) {
      const Eigen::Vector2d p(grid.cellSize() * (grid.lower().x + share(random) * grid.width()),
                              grid.cellSize() * (grid.lower().y + share(random) * grid.height()));
      visit(field, grid, p, random);
    }
  }
}

}  // namespace

TEST_CASE("a comparison says what the bounds say, for every distance") {
  int verdicts[3] = {0, 0, 0};
  visitPoints(1, [&](const ClearanceField& field, const Grid&, const Eigen::Vector2d& p,
                     std::mt19937_64& random) {
    const ClearanceField::Bounds bounds = field.bounds(p);
    const double around = std::isfinite(bounds.lower) ? bounds.lower : 1.0;
    // Mostly near the bounds, where the decision is made.
    const double off = std::normal_distribution<double>(0.0, 0.08)(random);
    const auto distance = static_cast<float>(std::max(0.0, around + off));
    const Verdict verdict = field.compare(p.x(), p.y(), distance);
    const bool at_least = field.at(p) >= static_cast<double>(distance);
    REQUIRE((verdict == Verdict::kAtLeast) == at_least);
    if (verdict == Verdict::kLess) REQUIRE(bounds.upper < static_cast<double>(distance));
    if (verdict == Verdict::kUnsure) REQUIRE(bounds.upper >= static_cast<double>(distance));
    ++verdicts[static_cast<int>(verdict)];
  });
  for (const int count : verdicts) CHECK(count > 100);
}

TEST_CASE("a disc that is free has room by the upper bound, and where all is far off it is free") {
  int counts[2] = {0, 0};
  visitPoints(3, [&](const ClearanceField& field, const Grid&, const Eigen::Vector2d& p,
                     std::mt19937_64& random) {
    const auto radius = std::uniform_real_distribution<float>(0.0F, 0.6F)(random);
    const bool is_free = field.discFree(p.x(), p.y(), radius);
    ++counts[is_free ? 1 : 0];
    const ClearanceField::Bounds bounds = field.bounds(p);
    if (is_free) REQUIRE(bounds.upper >= static_cast<double>(radius));
    const bool is_inside = std::isfinite(bounds.upper);
    if (is_inside && bounds.lower >= 1.5 * static_cast<double>(radius)) REQUIRE(is_free);
  });
  CHECK(counts[0] > testing::effort(1000));
  CHECK(counts[1] > testing::effort(1000));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const ClearanceField open(Grid(0.1, {0, 0}, 20, 20), false);
  CHECK(open.discFree(1.0, 1.0, 1e30F));
  CHECK_FALSE(open.discFree(nan, 1.0, 0.1F));
  CHECK_FALSE(open.discFree(-0.5, 1.0, 0.1F));
}

TEST_CASE("compared with two distances, each verdict is certain of its own") {
  visitPoints(2, [](const ClearanceField& field, const Grid&, const Eigen::Vector2d& p,
                    std::mt19937_64& random) {
    const ClearanceField::Bounds bounds = field.bounds(p);
    std::uniform_real_distribution<float> draw(0.0F, 1.0F);
    const float near = draw(random);
    const float far = near + 0.3F * draw(random);
    const Verdict verdict = field.compare(p.x(), p.y(), near, far);
    if (verdict == Verdict::kAtLeast) REQUIRE(bounds.lower >= static_cast<double>(far));
    if (verdict == Verdict::kLess) REQUIRE(bounds.upper < static_cast<double>(near));
    if (bounds.lower >= static_cast<double>(far)) REQUIRE(verdict == Verdict::kAtLeast);
  });
}

TEST_CASE("the quick clearance is that of the cell's centre, nothing outside") {
  visitPoints(3, [](const ClearanceField& field, const Grid& grid, const Eigen::Vector2d& p,
                    std::mt19937_64&) {
    const CellIndex cell = grid.indexOf(p);
    const double quick = field.quick(p.x(), p.y());
    if (!grid.contains(cell)) {
      REQUIRE(quick == 0.0);
      return;
    }
    REQUIRE(quick == Approx(field.at(grid.centre(cell))).margin(1e-6));
    REQUIRE(quick ==
            static_cast<double>(field.row(cell.y - grid.lower().y)[cell.x - grid.lower().x]));
    const ClearanceField::Bounds bounds = field.bounds(p);
    if (std::isfinite(quick)) {
      REQUIRE(quick <= bounds.upper + 1e-6);
      REQUIRE(quick >= bounds.lower - 1e-6);
    }
  });
}

TEST_CASE("a point that is none is never far enough from anything") {
  std::mt19937_64 random(4);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const bool unknown_blocks : {true, false}) {
    const ClearanceField field(randomGrid(random, {0, 0}, 20, 20, 0.1, 0.0), unknown_blocks);
    for (const Eigen::Vector2d& p : {Eigen::Vector2d(nan, 0.5), Eigen::Vector2d(0.5, nan)}) {
      CHECK(field.compare(p.x(), p.y(), 0.1F) != Verdict::kAtLeast);
      CHECK(field.quick(p.x(), p.y()) == 0.0);
    }
  }
}
