// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <limits>

#include <catch2/catch.hpp>

#include "modules/planner/core/execution/way_back.hpp"

using namespace tread;
using namespace tread::planner;

namespace {

/// A robot on its way east, observed ten times per second.
struct Walk {
  WayBack way_back;
  LinkReading link;
  std::optional<Goal> goal;

  Walk() {
    link.armed = true;
    link.good = true;
    link.T_map_body = Pose2{};
  }
  void stay(double seconds) { drive(seconds, 0.0); }
  void drive(double seconds, double speed) {
    for (double t = 0.0; t < seconds - 0.05; t += 0.1) {
      link.now += 100'000;
      link.T_map_body->x += 0.1 * speed;
      goal = way_back.update(link);
    }
  }
  void lose() {
    link.good = false;
    link.lost = true;
  }
  /// Drives to the given place, if any, and returns it.
  std::optional<double> follow() {
    if (!goal) return std::nullopt;
    link.T_map_body->x = goal->T_map_goal.x;
    return goal->T_map_goal.x;
  }
};

}  // namespace

TEST_CASE("the operator is lost: the robot stands for 3 s, then returns to the last good link") {
  Walk walk;
  walk.stay(3.0);
  walk.drive(5.0, 1.0);
  walk.link.good = false;  // the link gets bad before it is lost
  walk.drive(4.0, 1.0);
  CHECK_FALSE(walk.goal);
  walk.lose();
  walk.stay(2.9);
  CHECK_FALSE(walk.goal);
  walk.stay(0.3);
  REQUIRE(walk.goal);
  CHECK(walk.goal->id < 0);
  CHECK(walk.goal->T_map_goal.x == Approx(5.0).margin(0.6));
}

TEST_CASE(
    "nobody is heard there: back along the way that it came, to where it began, then it stays") {
  Walk walk;
  walk.stay(3.0);
  walk.drive(10.0, 1.0);
  walk.lose();
  walk.stay(3.2);
  std::vector<double> places;
  for (int i = 0; i < 10; ++i) {
    const std::optional<double> place = walk.follow();
    if (!place) break;
    places.push_back(*place);
    walk.stay(3.3);
  }
  REQUIRE(places.size() >= 4);
  for (size_t i = 1; i < places.size(); ++i) CHECK(places[i] < places[i - 1]);
  CHECK(places.back() == 0.0);
  CHECK(walk.way_back.state().words ==
        "the operator is lost, and the return has ended: it is where its path began, and "
        "there is no operator");
}

TEST_CASE("an operator who is back ends the return, and so does a robot that is not armed") {
  for (const bool disarmed : {false, true}) {
    Walk walk;
    walk.stay(3.0);
    walk.drive(10.0, 1.0);
    walk.lose();
    walk.stay(4.0);
    REQUIRE(walk.goal);
    (disarmed ? walk.link.armed : walk.link.lost) = false;
    walk.stay(0.1);
    CHECK_FALSE(walk.goal);
    CHECK(walk.way_back.state().empty());
  }
}

TEST_CASE("a return that was stopped does not go on by itself, another loss may return again") {
  Walk walk;
  walk.stay(3.0);
  walk.drive(10.0, 1.0);
  walk.lose();
  walk.stay(4.0);
  REQUIRE(walk.goal);
  const int64_t first = walk.goal->id;
  walk.way_back.giveUp("MAP is 600 ms old");
  walk.stay(60.0);
  CHECK_FALSE(walk.goal);
  CHECK(walk.way_back.state().words ==
        "the operator is lost, and the return has ended: MAP is 600 ms old");
  walk.link.lost = false;
  walk.stay(0.5);
  walk.link.lost = true;
  walk.stay(4.0);
  REQUIRE(walk.goal);
  CHECK(walk.goal->id != first);
}

TEST_CASE("no return without a place, and none on a position that has become uncertain") {
  Walk nowhere;
  nowhere.link.good = false;
  nowhere.drive(5.0, 1.0);
  nowhere.lose();
  nowhere.stay(10.0);
  CHECK_FALSE(nowhere.goal);
  Walk walk;
  walk.link.position_std = 0.1;
  walk.stay(3.0);
  walk.drive(10.0, 1.0);
  walk.lose();
  walk.stay(4.0);
  REQUIRE(walk.goal);
  walk.link.position_std = GENERATE(1.3, std::numeric_limits<double>::quiet_NaN());
  walk.stay(0.1);
  CHECK_FALSE(walk.goal);
  walk.link.position_std = 0.1;
  walk.stay(5.0);
  CHECK_FALSE(walk.goal);
}
