// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Ground that proves steeper than permitted for plans.
#include <cmath>

#include <catch2/catch.hpp>

#include "modules/planner/core/execution/slope_guard.hpp"
#include "tests/planner/kit/policy_rig.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;
using Catch::Contains;

namespace {

constexpr double kLimit = 0.26;  // [rad]

PlannerConfig careful() {
  PlannerConfig config = usualPlanner();
  config.max_slope = kLimit;
  config.map.full_speed = 1.0;
  config.map.stopping_time = 0.4;
  return config;
}

/// A pit on the rig's path to (12, 0): its slope by distance from its centre.
struct Pit {
  Eigen::Vector2d centre{6.0, 0.0};
  double steepest = 0.5;  ///< [rad] at 2 m from the centre

  double slopeAt(const Pose2& pose) const {
    const double r = (pose.position() - centre).norm() / 2.0;
    return steepest * r * std::exp(0.5 * (1.0 - r * r));
  }
};

}  // namespace

TEST_CASE("It turns back where the ground falls away, and finds its way around") {
  Rig rig(Playground{}, careful());
  const Pit pit;
  double steepest = 0.0;
  bool told = false;
  for (double t = 0.0; t < 90.0; t += 0.05) {
    const Decision decision = rig.run(0.05, [&](PlannerInputs& s) {
      s.pose->slope = pit.slopeAt(s.pose->T_map_body);
      s.pose->position_std = 0.0;
    });
    steepest = std::max(steepest, pit.slopeAt(rig.pose()));
    told = told || decision.report.reason.words.find("deg, plans allow 15") != std::string::npos;
    if (decision.report.status == PlanStatus::kArrived) break;
  }
  CHECK(told);
  CHECK(steepest < kLimit + 0.05);
  CHECK(rig.run(0.05).report.status == PlanStatus::kArrived);
}

TEST_CASE("The faster it drives on ground that steepens, the earlier it turns back") {
  double before = 1.0;
  for (const double speed : {0.0, 0.5, 1.0}) {
    SlopeGuard guard(kLimit);
    double told_at = 1.0;
    int64_t now = 0;
    for (double x = 0.0; x < 3.0 && told_at == 1.0; x += 0.01)
      if (guard.take({now += 20'000, {x, 0.0, 0.0}, Twist2{speed, 0.0, 0.0}, 0.0, 0.12 * x}))
        told_at = 0.12 * x;
    CHECK(told_at < before);
    CHECK(told_at + 0.12 * 0.5 * speed > kLimit);
    before = told_at - 0.01;
  }
}

TEST_CASE("Without a limit, or without attitude, it drives on") {
  for (const bool limited : {false, true}) {
    Rig rig(Playground{}, limited ? careful() : usualPlanner());
    rig.run(30.0, [&](PlannerInputs& s) {
      s.pose->slope = limited ? std::nan("") : 0.4;
      s.pose->position_std = 0.0;
    });
    CHECK(rig.run(0.05).report.status == PlanStatus::kArrived);
  }
}

TEST_CASE(
    "What is too steep lies where the slope grew, is told once, and again where it is worse") {
  SlopeGuard guard(kLimit);
  int64_t now = 0;
  const auto at = [&](double x, double slope) {
    std::optional<Fence> told;
    for (int i = 0; i < 5; ++i) {
      now += 20'000;
      // It reverses: the slope increases behind it.
      const std::optional<Fence> found =
          guard.take({now, {-x, 0.0, 0.0}, Twist2{-0.5, 0.0, 0.0}, 0.0, slope});
      if (found) {
        CHECK_FALSE(told);
        told = found;
      }
    }
    return told;
  };
  for (double x = 0.0; x < 2.0; x += 0.1) CHECK_FALSE(at(x, 0.1 * x));
  const std::optional<Fence> steep = at(2.0, 0.3);
  REQUIRE(steep);
  CHECK(steep->keep_out);
  CHECK(faultOf(*steep).empty());
  CHECK(roomAt(*steep, Eigen::Vector2d(-3.0, 0.0)) < 0.0);
  CHECK(roomAt(*steep, Eigen::Vector2d(-2.0, 0.0)) > 0.0);
  CHECK(roomAt(*steep, Eigen::Vector2d(-1.0, 0.0)) > 1.0);
  CHECK(guard.words() == "tilts 17 deg, plans allow 15");
  CHECK_FALSE(at(2.0, 0.3));
  CHECK_FALSE(at(1.9, 0.29));
  CHECK(at(2.1, 0.36));
  CHECK_FALSE(at(1.0, 0.1));
  CHECK(at(2.0, 0.3));
  // A single step over a stone is no slope.
  at(0.0, 0.0);
  CHECK_FALSE(guard.take({now += 20'000, {0.0, 0.0, 0.0}, {}, 0.0, 0.5}));
  CHECK_FALSE(guard.take({now += 20'000, {0.0, 0.0, 0.0}, {}, 0.0, 0.1}));
}
