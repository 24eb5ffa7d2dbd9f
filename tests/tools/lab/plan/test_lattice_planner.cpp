// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <map>
#include <queue>
#include <random>
#include <tuple>

#include "tests/helpers.hpp"
#include "tools/lab/plan/lattice_planner.hpp"

using namespace tread;
using namespace tread::plan;
using planner::PathAnswer;
using planner::PathEnd;
using planner::PathQuery;

namespace {

constexpr double kCell = 0.5;
constexpr int kBins = 4;

std::vector<uint8_t> randomCosts(std::mt19937_64& random, int count, int blocked_percent) {
  std::uniform_int_distribution<int> percent(0, 99);
  std::vector<uint8_t> costs;
  for (int i = 0; i < count; ++i)
    costs.push_back(
        static_cast<uint8_t>(percent(random) < blocked_percent ? 250 : percent(random) / 20));
  return costs;
}

/// A lattice of quarter turns: one and three cells ahead, and turns to both sides.
std::vector<SearchPrimitive> quarterLattice() {
  std::vector<SearchPrimitive> primitives;
  for (int bin = 0; bin < kBins; ++bin) {
    const CellIndex ahead{bin == 0 ? 1 : bin == 2 ? -1 : 0, bin == 1 ? 1 : bin == 3 ? -1 : 0};
    for (const int cells : {1, 3}) {
      SearchPrimitive primitive;
      primitive.id = static_cast<int>(primitives.size());
      for (int k = 1; k <= cells; ++k) {
        primitive.poses.push_back({k * kCell, 0.0, 0.0});
        primitive.cells.push_back({k * ahead.x, k * ahead.y});
      }
      primitive.duration = cells;
      primitive.cost = cells == 1 ? 1.0 : 2.5;
      primitive.start_bin = bin;
      primitives.push_back(primitive);
    }
    for (const double turn : {kPi / 2.0, -kPi / 2.0}) {
      SearchPrimitive primitive;
      primitive.id = static_cast<int>(primitives.size());
      primitive.poses = {{0.0, 0.0, turn}};
      primitive.duration = primitive.cost = 1.5;
      primitive.start_bin = bin;
      primitives.push_back(primitive);
    }
  }
  return primitives;
}

/// Cheapest plan between two cells and headings; infinite if there is none.
double bruteForce(const CellCosts& costs, const std::vector<SearchPrimitive>& primitives,
                  CellIndex from, int from_bin, CellIndex to, int to_bin) {
  using State = std::tuple<int, int, int>;
  using Entry = std::pair<double, State>;
  std::map<State, double> settled;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  open.push({0.0, {from.x, from.y, from_bin}});
  while (!open.empty()) {
    const auto [cost, state] = open.top();
    open.pop();
    if (!settled.emplace(state, cost).second) continue;
    const auto [x, y, bin] = state;
    if (x == to.x && y == to.y && bin == to_bin) return cost;
    for (const SearchPrimitive& primitive : primitives) {
      if (primitive.start_bin != bin) continue;
      int worst = costs.at({x, y});
      bool blocked = false;
      for (const CellIndex& cell : primitive.cells) {
        const int here = costs.at({x + cell.x, y + cell.y});
        blocked = blocked || here < 0;
        worst = std::max(worst, here);
      }
      if (blocked) continue;
      const CellIndex end = primitive.cells.empty() ? CellIndex{} : primitive.cells.back();
      const int turned = static_cast<int>(std::lround(primitive.poses.back().yaw / (kPi / 2.0)));
      open.push({cost + primitive.cost * (worst + 1),
                 {x + end.x, y + end.y, (bin + turned + kBins) % kBins}});
    }
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace

TEST_CASE("a cell's cost is what was given, blocked cells and all outside have none") {
  const CellCosts costs(3, 2, {0, 1, 2, 99, 100, 255}, 100);
  CHECK(costs.at({0, 0}) == 0);
  CHECK(costs.at({2, 0}) == 2);
  CHECK(costs.at({0, 1}) == 99);
  CHECK(costs.at({1, 1}) == -1);
  CHECK(costs.at({2, 1}) == -1);
  for (const CellIndex outside : {CellIndex{-1, 0}, {3, 0}, {0, -1}, {0, 2}, {1 << 30, 1 << 30}})
    CHECK(costs.at(outside) == -1);
}

TEST_CASE("the worst of some cells is the dearest of them and of where they begin") {
  const CellCosts costs(3, 2, {7, 1, 2, 3, 100, 5}, 100);
  CHECK(costs.worst({1, 0}, {}) == 1);
  CHECK(costs.worst({1, 0}, {{1, 0}}) == 2);
  CHECK(costs.worst({0, 0}, {{1, 0}, {2, 0}}) == 7);
  CHECK(costs.worst({1, 0}, {{-1, 1}, {1, 1}}) == 5);
  CHECK(costs.worst({1, 0}, {{0, 1}, {1, 0}}) == -1);
  CHECK(costs.worst({2, 0}, {{1, 0}}) == -1);
  CHECK(costs.worst({1, 1}, {{1, 0}}) == -1);
  CHECK(costs.worst({-1, 0}, {{1, 0}}) == -1);
}

TEST_CASE("on a lattice with costs the plan is as cheap as brute force finds it") {
  std::mt19937_64 random(7);
  const std::vector<SearchPrimitive> primitives = quarterLattice();
  int solved = 0;
  int unreachable = 0;
  for (int i = 0; i < testing::effort(400); ++i) {
    constexpr int kWidth = 14;
    constexpr int kHeight = 11;
    const CellCosts costs(kWidth, kHeight, randomCosts(random, kWidth * kHeight, 10 + i % 40), 200);
    const auto draw = [&random](int count) {
      return std::uniform_int_distribution<int>(0, count - 1)(random);
    };
    const CellIndex from{draw(kWidth), draw(kHeight)};
    const CellIndex to{draw(kWidth), draw(kHeight)};
    const int from_bin = draw(kBins);
    const int to_bin = draw(kBins);
    // Anywhere in the cell: the planner moves both to the centre.
    const PathQuery query{{(from.x + 0.3) * kCell, (from.y + 0.8) * kCell, from_bin * kPi / 2.0},
                          {(to.x + 0.6) * kCell, (to.y + 0.1) * kCell, to_bin * kPi / 2.0}};
    LatticePlanner lattice(costs, kCell, kBins, primitives);
    const PathAnswer answer = lattice.answer(query, [](int) { return false; });
    INFO("map " << i << ": " << answer.reason);
    if (costs.at(from) < 0 || costs.at(to) < 0) {
      CHECK(answer.end == PathEnd::kUnreachable);
      CHECK(answer.reason ==
            (costs.at(from) < 0 ? "the start lies on obstacles" : "the goal lies on obstacles"));
      continue;
    }
    const double expected = bruteForce(costs, primitives, from, from_bin, to, to_bin);
    if (std::isinf(expected)) {
      ++unreachable;
      CHECK(answer.end == PathEnd::kUnreachable);
      continue;
    }
    ++solved;
    REQUIRE(answer.end == PathEnd::kSolved);
    CHECK(answer.search.cost == Approx(expected).epsilon(1e-4).margin(1e-4));
  }
  CHECK(solved >= testing::effort(100));
  CHECK(unreachable >= testing::effort(10));
}
