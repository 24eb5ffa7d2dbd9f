// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "modules/planner/core/execution/goal_watch.hpp"

using namespace tread;
using namespace tread::planner;

namespace {

Goal goal(int64_t id) {
  Goal goal;
  goal.id = id;
  return goal;
}

const GoalWatch::StoodFor kNobody = [](int64_t) { return false; };
const GoalWatch::StoodFor kEverybody = [](int64_t) { return true; };

}  // namespace

TEST_CASE("a goal counts once an operator stands for it, and after a second without one is dead") {
  GoalWatch watch;
  CHECK(watch.take(goal(1), 0));
  watch.update(500'000, std::nullopt, kNobody);
  CHECK_FALSE(watch.goal());
  watch.update(600'000, std::nullopt, kEverybody);
  REQUIRE(watch.goal());
  CHECK(watch.take(goal(2), 700'000));
  watch.update(800'000, std::nullopt, [](int64_t id) { return id == 1; });
  CHECK(watch.goal()->id == 1);
  watch.update(1'800'000, std::nullopt, [](int64_t id) { return id == 1; });
  CHECK(watch.goal()->id == 1);
  CHECK_FALSE(watch.take(goal(2), 1'900'000));
  CHECK(watch.take(goal(3), 2'000'000));
  watch.update(2'000'000, std::nullopt, kEverybody);
  CHECK(watch.goal()->id == 3);
}

TEST_CASE("arming ends the goals that were given before it, and none that is given later") {
  GoalWatch watch;
  watch.take(goal(1), 1'000'000);
  watch.update(1'000'000, std::nullopt, kEverybody);
  REQUIRE(watch.goal());
  watch.update(2'050'000, 2'000'000, kEverybody);
  CHECK_FALSE(watch.goal());
  CHECK(watch.lost().words == "the goal was given before the arming: give it again");
  watch.take(goal(2), 2'100'000);
  watch.update(2'100'000, 2'000'000, kEverybody);
  REQUIRE(watch.goal());
  CHECK(watch.lost().empty());
  // The robot was disarmed and armed again.
  watch.update(3'000'000, std::nullopt, kEverybody);
  CHECK(watch.goal());
  watch.update(4'000'000, 3'900'000, kEverybody);
  CHECK_FALSE(watch.goal());
}

TEST_CASE("a goal that is taken back leaves no complaint and is dead") {
  GoalWatch watch;
  watch.take(goal(1), 0);
  watch.update(0, std::nullopt, kEverybody);
  watch.cancel();
  CHECK_FALSE(watch.goal());
  CHECK(watch.lost().empty());
  CHECK_FALSE(watch.take(goal(1), 100'000));
}
