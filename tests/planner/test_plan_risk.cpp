// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The probability of contact in plans, compared with many drives with random errors.
#include <catch2/catch.hpp>

#include <cmath>
#include <random>

#include "modules/planner/core/search/plan_risk.hpp"
#include "tests/planner/kit/playground.hpp"
#include "tests/planner/kit/sample_patterns.hpp"
#include "tests/planner/kit/vehicle.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

namespace {

constexpr double kCell = 0.05;
constexpr double kLong = 10.0;  // [s] of reaction: covers the whole plan

/// The lattice's patterns with the covariance of `errors` at their ends.
PatternSet lattice(const Eigen::Vector3d& errors) {
  PatternSetContent content = latticePatterns().content();
  for (MotionPattern& pattern : content.patterns)
    pattern.end_covariance = {errors.x() * errors.x(), 0.0, 0.0,
                              errors.y() * errors.y(), 0.0, errors.z() * errors.z()};
  std::string why;
  return *PatternSet::make(std::move(content), why);
}

/// Walls along the x axis at this distance from the vehicle's sides, with faces in the middle of
/// cells.
Playground corridor(double room) {
  Playground ground;
  for (const double side : {-1.0, 1.0}) {
    const double face = kVehicle.half_width + room;
    const double y = side * ((std::floor(face / kCell) + 0.5) * kCell + 0.1);
    ground.addWall({-4.0, y}, {6.0, y});
  }
  return ground;
}

/// A plan straight ahead on some ground.
struct Ahead {
  Ahead(const Grid& grid, const Eigen::Vector3d& errors, int count)
      : around(grid, kVehicle, {}), table(lattice(errors), usualSweep(), {}) {
    for (int i = 0; i < count; ++i)
      steps.push_back(stepAfter(steps.empty() ? start : steps.back(), *table.find(1)));
  }
  PlanRisk risk(double reaction) const { return riskOf({around, table, start, steps, reaction}); }

  CollisionChecker around;
  PatternTable table;
  PlanStep start;
  std::vector<PlanStep> steps;
};

Grid painted(const Playground& ground) {
  return ground.paint(kCell, {-4.0, -3.0}, {6.0, 3.0});
}

/// Share of drives over one metre with random errors that touch a wall.
double touched(const Playground& ground, const Eigen::Vector3d& errors) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0.0, 1.0);
  constexpr int kDrives = 20000;
  int count = 0;
  for (int i = 0; i < kDrives; ++i) {
    const Eigen::Vector3d off =
        errors.cwiseProduct(Eigen::Vector3d(normal(random), normal(random), normal(random)));
    bool touches = false;
    for (const double t : {0.25, 0.5, 0.75, 1.0}) {
      const Eigen::Vector3d now = std::sqrt(t) * off;
      touches = touches || ground.clearance(kVehicle, {t + now.x(), now.y(), now.z()}) <= 0.0;
    }
    count += touches ? 1 : 0;
  }
  return static_cast<double>(count) / kDrives;
}

}  // namespace

TEST_CASE("The risk of a pattern is the share of drives with drawn errors that touch something") {
  const double room = GENERATE(0.06, 0.11, 0.16);
  const Eigen::Vector3d errors =
      GENERATE(Eigen::Vector3d(0.05, 0.05, 0.0), Eigen::Vector3d(0.02, 0.04, 0.05));
  const Playground ground = corridor(room);
  const Ahead ahead(painted(ground), errors, 1);
  const double true_share = touched(ground, errors);
  INFO(room << " m, " << errors.transpose() << ": " << true_share);
  // For each side its worst point counts, although a turn may bring the other end closer; and an
  // obstacle may be anywhere in its cell.
  CHECK(ahead.risk(kLong).touch > 0.65 * true_share);
  CHECK(ahead.risk(kLong).touch < 1.35 * true_share + 0.01);
}

TEST_CASE("Only errors along what lies there count: no wall ahead is touched by errors sideways") {
  Playground ground;
  ground.addWall({1.0 + kVehicle.front + 0.2, -2.0}, {1.0 + kVehicle.front + 0.2, 2.0});
  const Ahead sideways(painted(ground), {0.0, 0.1, 0.0}, 1);
  const Ahead lengthwise(painted(ground), {0.1, 0.0, 0.0}, 1);
  CHECK(sideways.risk(kLong).touch < 1e-6);
  CHECK(lengthwise.risk(kLong).touch > 0.05);
}

TEST_CASE("What is noticed in time does not count, and each pattern adds to the risk") {
  const Eigen::Vector3d errors(0.03, 0.04, 0.02);
  const Ahead one(painted(corridor(0.11)), errors, 1);
  const Ahead three(painted(corridor(0.11)), errors, 3);
  CHECK(one.risk(0.2).touch < 0.3 * one.risk(kLong).touch);
  const PlanRisk of_one = one.risk(0.9);
  const PlanRisk of_three = three.risk(0.9);
  CHECK(of_three.first == of_one.first);
  CHECK(of_three.touch > 2.5 * of_one.touch);
  CHECK(of_three.touch < 4.5 * of_one.touch);
  CHECK(of_three.per_metre == Approx(of_three.touch / 3.0));
  // Errors of earlier patterns count if they are noticed late.
  CHECK(three.risk(kLong).touch > of_three.touch);
}

TEST_CASE("Nothing is touched where nothing is, or only unknown ground, and nothing is no plan") {
  const Eigen::Vector3d errors(0.05, 0.05, 0.05);
  Grid open = painted(Playground());
  CHECK(Ahead(open, errors, 3).risk(kLong).touch == 0.0);
  for (int x = -80; x < 120; ++x) open.set({x, 8}, kUnknown);
  CHECK(Ahead(open, errors, 3).risk(kLong).touch == 0.0);
  CHECK(std::isnan(Ahead(open, errors, 0).risk(kLong).touch));
  CHECK(std::isnan(Ahead(open, errors, 0).risk(kLong).per_metre));
}

TEST_CASE("Who stands on an obstacle touches it, and a turn on the spot has no risk per metre") {
  Grid grid = painted(Playground());
  grid.set(grid.indexOf({0.9, 0.0}), kObstacle);
  const Ahead ahead(grid, {0.05, 0.05, 0.05}, 1);
  CHECK(ahead.risk(kLong).touch == 1.0);
  const PlanStep turn = stepAfter(ahead.start, *ahead.table.find(2));
  const PlanRisk on_the_spot = riskOf({ahead.around, ahead.table, ahead.start, {turn}, kLong});
  CHECK(on_the_spot.touch > 0.0);
  CHECK(std::isnan(on_the_spot.per_metre));
}
