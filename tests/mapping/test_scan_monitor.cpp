// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <algorithm>
#include <limits>

#include "tests/mapping/scan_drive.hpp"

using namespace tread;
using namespace tread::mapping;
using Catch::Contains;

namespace {

/// Posts and walls without symmetry.
sim::WorldDescription yard() {
  sim::WorldDescription world;
  world.bounds = {{-20.0, -20.0}, {20.0, 20.0}};
  const double at[][3] = {{3, 3.5, .3}, {-4, 5, .6}, {6, -4, .4}, {-7, -3, .5}, {1, -7, .2},
                          {9, 2, .7},   {-2, 8, .3}, {4, 9, .4},  {-9, 4, .2},  {-13, -6, .5}};
  for (const auto& [x, y, r] : at) world.obstacles.push_back(sim::discObstacle({x, y}, r, 1.5));
  world.obstacles.push_back(sim::boxObstacle({-3.0, -5.5, 0.3}, 5.0, 0.4, 1.5));
  world.obstacles.push_back(sim::boxObstacle({11.0, 0.5, 1.3}, 6.0, 0.4, 1.5));
  return world;
}

/// Old scans with any time stamps, but distinct content.
class Past {
 public:
  void show(scan_t& scan, size_t ago) {
    past_.push_back(scan.ranges);
    scan.ranges = past_[past_.size() - 1 - std::min(ago, past_.size() - 1)];
    for (float& range : scan.ranges) range += 1e-6F * static_cast<float>(past_.size());
  }

 private:
  std::vector<std::vector<float>> past_;
};

void turnBeams(scan_t& scan, double angle) {
  scan.angle_first += angle;  // the same as rotated, without beams outside of the view
}

/// Drives on under a lie from now on; returns the distance until it is named.
struct Named {
  double seconds = 1e9, way = 0.0, turn = 0.0;
  ScanDefect defect = ScanDefect::kNone;
  std::string words;
};
Named drivenUntilNamed(ScanDrive& drive, double v_x, double omega, double at_most = 3.0) {
  const double since = drive.seconds(), way = drive.travelled, turn = drive.turned;
  while (drive.monitor.verdict() == ScanDefect::kNone && drive.seconds() < since + at_most)
    drive.drive(v_x, omega, 0.05);
  return {drive.seconds() - since, drive.travelled - way, drive.turned - turn,
          drive.monitor.verdict(), drive.monitor.words()};
}

}  // namespace

TEST_CASE("a range finder that repeats its last frame is named within half a second of motion") {
  for (const auto& [v_x, omega] : {std::pair(1.0, 0.0), std::pair(0.5, 0.3), std::pair(0.0, 0.4)}) {
    CAPTURE(v_x, omega);
    ScanDrive drive(yard());
    drive.drive(v_x, omega, 2.0);
    std::vector<float> last;
    drive.disturb = [&](scan_t& scan) {
      if (last.empty()) last = scan.ranges;
      scan.ranges = last;
    };
    const Named named = drivenUntilNamed(drive, v_x, omega);
    CHECK(named.defect == ScanDefect::kFrozen);
    CHECK(named.seconds < 0.55);
    CHECK_THAT(named.words, Contains("it repeats bit for bit"));
    // Also as long as it lasts, and while the robot stands.
    drive.drive(0.0, 0.0, 5.0);
    CHECK(drive.monitor.verdict() == ScanDefect::kFrozen);
    drive.disturb = nullptr;
    drive.drive(0.0, 0.0, 2.0);
    CHECK(drive.monitor.verdict() == ScanDefect::kNone);
  }
}

TEST_CASE("a few frames in turn are frozen, too, and a standing robot's are not") {
  ScanDrive drive(yard());
  drive.drive(0.0, 0.0, 1.0);
  std::vector<std::vector<float>> ring;
  size_t next = 0;
  drive.disturb = [&](scan_t& scan) {
    if (ring.size() < 4) return ring.push_back(scan.ranges);
    scan.ranges = ring[next++ % 4];
  };
  drive.drive(0.0, 0.0, 3.0);
  CHECK(drive.monitor.verdict() == ScanDefect::kNone);
  const Named named = drivenUntilNamed(drive, 0.8, 0.0);
  CHECK(named.defect == ScanDefect::kFrozen);
  CHECK(named.seconds < 0.6);
}

TEST_CASE("all zero, and all far where something stood, are named within half a second") {
  for (const bool far : {true, false}) {
    ScanDrive drive(yard());
    drive.drive(0.7, 0.1, 2.0);
    drive.disturb = [&](scan_t& scan) {
      std::fill(scan.ranges.begin(), scan.ranges.end(),
                far ? std::numeric_limits<float>::infinity() : 0.0F);
    };
    const Named named = drivenUntilNamed(drive, 0.7, 0.1);
    CHECK(named.defect == (far ? ScanDefect::kSeesThrough : ScanDefect::kEmpty));
    CHECK(named.seconds < 0.5);
    drive.drive(0.0, 0.0, 5.0);
    CHECK(drive.monitor.verdict() != ScanDefect::kNone);
  }
}

TEST_CASE("an open field where nothing is seen is no lie, nor is a corridor", "[statistics]") {
  sim::WorldDescription field;
  field.bounds = {{-60.0, -60.0}, {60.0, 60.0}};
  field.obstacles.push_back(sim::discObstacle({5.0, 3.0}, 0.2, 1.5));
  sim::WorldDescription corridor = field;
  corridor.obstacles = {sim::boxObstacle({0.0, 1.4, 0.0}, 200.0, 0.2, 2.0),
                        sim::boxObstacle({0.0, -1.4, 0.0}, 200.0, 0.2, 2.0)};
  for (const auto& world : {field, corridor}) {
    ScanDrive drive(world);
    drive.drive(1.0, 0.0, 60.0);
    drive.wander(240.0);
    CAPTURE(drive.told);
    CHECK(drive.verdicts == 0);
    CHECK(drive.suspected == 0);
  }
}

TEST_CASE("a steep hillside that shows only ground as the robot rolls is no lie", "[statistics]") {
  // Slopes up to 0.52 rad to both sides: objects above the robot's own ground are below it later.
  sim::WorldDescription world;
  world.base_surface = "grass";
  world.bounds = {{-30.0, -60.0}, {120.0, 60.0}};
  for (const double x : {18.0, 25.0, 32.0}) {
    world.terrain.bumps.push_back({{x, 8.0}, 1.55, 6.0});
    world.terrain.bumps.push_back({{x, -8.0}, -1.55, 6.0});
  }
  int verdicts = 0;
  // Each of these once had a false verdict; of seeds 1 to 200 none has today.
  for (const uint64_t seed : {2, 31, 34, 37}) {
    ScanDrive drive(world, 541, seed);
    drive.pose = {8.0, 0.0, 0.0};
    std::uniform_real_distribution<double> turn(-0.25, 0.25);
    while (drive.pose.x < 45.0 && drive.seconds() < 60.0) {
      // A slalom along the hill.
      const double home = -0.3 * drive.pose.yaw - 0.05 * drive.pose.y;
      drive.drive(1.0, home + turn(drive.random), 1.0);
    }
    verdicts += drive.verdicts;
    UNSCOPED_INFO("seed " << seed << ": " << drive.told);
  }
  CHECK(verdicts == 0);
}

TEST_CASE("a mirrored scan is named at once, and one that always was when the robot turns") {
  const auto mirror = [](scan_t& scan) { std::reverse(scan.ranges.begin(), scan.ranges.end()); };
  ScanDrive drive(yard());
  drive.drive(0.8, 0.2, 2.0);
  drive.disturb = mirror;
  const Named sudden = drivenUntilNamed(drive, 0.8, 0.2);
  CHECK(sudden.defect == ScanDefect::kMirrored);
  CHECK(sudden.seconds < 0.5);
  ScanDrive always(yard());
  always.disturb = mirror;
  always.drive(0.0, 0.0, 2.0);
  CHECK(always.suspected == 0);
  const Named turning = drivenUntilNamed(always, 0.5, 0.5);
  CHECK(turning.defect == ScanDefect::kMirrored);
  CHECK(turning.seconds < 0.75);
  CHECK_THAT(turning.words, Contains("upside down"));
}

TEST_CASE("a turned scan is named at once, and one that always was when the robot drives") {
  for (const double degrees : {20.0, 90.0, -90.0, 180.0}) {
    CAPTURE(degrees);
    const auto turn = [&](scan_t& scan) { turnBeams(scan, degrees * kPi / 180.0); };
    ScanDrive drive(yard());
    drive.drive(0.8, 0.2, 2.0);
    drive.disturb = turn;
    const Named sudden = drivenUntilNamed(drive, 0.8, 0.2);
    CHECK(sudden.defect == ScanDefect::kTurned);
    CHECK(sudden.seconds < 0.5);
    if (std::abs(degrees) < 45.0) continue;
    ScanDrive always(yard());
    always.disturb = turn;
    always.drive(0.0, 0.0, 2.0);
    CHECK(always.suspected == 0);
    const Named driving = drivenUntilNamed(always, 0.9, 0.0);
    CHECK(driving.defect == ScanDefect::kTurned);
    CHECK(driving.way < 0.9);
  }
}

TEST_CASE("a turned scan is named where a wall is all that is seen, also by a robot that stands") {
  sim::WorldDescription wall;
  wall.bounds = {{-20.0, -20.0}, {20.0, 20.0}};
  wall.obstacles.push_back(sim::boxObstacle({6.0, 0.3, 1.4}, 5.0, 0.3, 1.5));
  for (const double v_x : {0.0, 0.8}) {
    CAPTURE(v_x);
    ScanDrive drive(wall);
    drive.drive(v_x, 0.0, 1.5);
    drive.disturb = [](scan_t& scan) { turnBeams(scan, -50.0 * kPi / 180.0); };
    const Named named = drivenUntilNamed(drive, v_x, 0.0);
    CHECK(named.defect == ScanDefect::kTurned);
    CHECK(named.seconds < 0.5);
  }
}

TEST_CASE("old scans under new times are named as such") {
  for (const size_t ago : {3U, 5U, 10U})
    for (const auto& [v_x, omega] : {std::pair(1.0, 0.0), std::pair(0.3, 0.6)}) {
      CAPTURE(ago, v_x, omega);
      Past past;
      size_t lag = 0;
      ScanDrive drive(yard());
      drive.disturb = [&](scan_t& scan) { past.show(scan, lag); };
      drive.drive(v_x, omega, 2.0);
      CHECK(drive.suspected == 0);
      lag = ago;
      const Named named = drivenUntilNamed(drive, v_x, omega);
      CHECK(named.defect == ScanDefect::kDelayed);
      CHECK(named.seconds < 0.5);
      CHECK_THAT(named.words, Contains("old ones under new times"));
    }
}

TEST_CASE(
    "nothing in sight is no proof that a range finder is good again, wherever the robot turned") {
  ScanDrive drive(yard());
  drive.drive(0.7, 0.1, 2.0);
  drive.disturb = [](scan_t& scan) {
    std::fill(scan.ranges.begin(), scan.ranges.end(), std::numeric_limits<float>::infinity());
  };
  drivenUntilNamed(drive, 0.7, 0.1);
  // Somebody arms again and drives away from the place of the last good scan.
  for (int i = 0; i < 8; ++i) {
    drive.drive(0.3, 0.6, 1.0);
    REQUIRE(drive.monitor.verdict() == ScanDefect::kSeesThrough);
  }
  drive.disturb = nullptr;
  drive.drive(0.0, 0.0, 2.0);
  CHECK(drive.monitor.verdict() == ScanDefect::kNone);
}

TEST_CASE("who was named a moment ago is named at the first scan that shows it again") {
  ScanDrive drive(yard());
  Past past;
  size_t lag = 0;
  drive.disturb = [&](scan_t& scan) { past.show(scan, lag); };
  drive.drive(0.8, 0.2, 2.0);
  lag = 5;
  const Named first = drivenUntilNamed(drive, 0.8, 0.2);
  REQUIRE(first.defect == ScanDefect::kDelayed);
  // Old scans of a standing robot are as good as new ones.
  drive.drive(0.0, 0.0, 4.0);
  REQUIRE(drive.monitor.verdict() == ScanDefect::kNone);
  const Named again = drivenUntilNamed(drive, 0.8, 0.2);
  CAPTURE(first.way, again.way);
  CHECK(again.defect != ScanDefect::kNone);
  CHECK(again.way < 0.4);
}
