// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <limits>
#include <string>

#include <catch2/catch.hpp>

#include "common/recordings/average.hpp"
#include "tests/common/recordings/samples.hpp"
#include "tests/helpers.hpp"

using namespace tread;
using namespace tread::recordings;

namespace {

using tread::testing::kNan;

/// A set of one pattern and executions with these twists.
struct OnePattern {
  PatternSet set;
  SurfaceRecordings recordings;

  OnePattern(const std::vector<Twist2>& twists, size_t samples)
      : set(samples::setOf({samples::pattern(1, "turn", {0.5, 0.0, 0.0}, samples)})),
        recordings{"clay", {{}}} {
    for (const Twist2& twist : twists)
      recordings.executions[0].push_back(samples::arc(twist, samples));
  }
};

PatternSet averaged(const OnePattern& one, std::vector<AverageNote>& notes,
                    const AverageLimits& limits = {}) {
  return averageSet(one.set, one.recordings, limits, notes);
}

}  // namespace

TEST_CASE("The average of a weak turn is the mean of its poses, with the spread of the ends") {
  const OnePattern one({{0.4, 0.0, 0.1}, {0.5, 0.0, 0.1}, {0.6, 0.0, 0.1}}, 10);
  std::vector<AverageNote> notes;
  const MotionPattern mean = averaged(one, notes).patterns()[0];
  CHECK_FALSE(notes[0].by_twist);
  CHECK(notes[0].used == 3);
  CHECK(mean.end().x == Approx(integrate({0.5, 0.0, 0.1}, 1.0).x));
  CHECK(mean.end().yaw == Approx(0.1));
  const Pose2 unit = integrate({0.1, 0.0, 0.1}, 1.0);  // ends differ by one of these
  CHECK(mean.end_covariance[0] == Approx(unit.x * unit.x));
  CHECK(mean.end_covariance[1] == Approx(unit.x * unit.y));
  CHECK(mean.end_covariance[3] == Approx(unit.y * unit.y));
  CHECK(mean.end_covariance[5] == Approx(0.0).margin(1e-15));
}

TEST_CASE("The average of a strong turn keeps its length: mean twists, not mean poses") {
  const OnePattern one({{0.5, 0.0, 0.7}, {0.5, 0.0, 1.5}, {0.5, 0.0, 2.3}}, 10);
  std::vector<AverageNote> notes;
  const MotionPattern mean = averaged(one, notes).patterns()[0];
  CHECK(notes[0].by_twist);
  CHECK(mean.end().yaw == Approx(1.5));
  CHECK(mean.end().x == Approx(integrate({0.5, 0.0, 1.5}, 1.0).x));
  CHECK(mean.pathLength() == Approx(0.5).epsilon(2e-3));
  AverageLimits never;
  never.strong_turn = 10.0;
  const MotionPattern by_pose = averaged(one, notes, never).patterns()[0];
  CHECK(by_pose.pathLength() < 0.99 * mean.pathLength());
}

TEST_CASE("A turn that comes back to its heading is strong, too") {
  OnePattern one({{0.5, 0.0, 1.0}, {0.5, 0.0, 1.1}, {0.5, 0.0, 1.2}}, 10);
  for (Execution& poses : one.recordings.executions[0])
    for (size_t t = 5; t < 10; ++t)
      poses[t] = poses[t - 1] * integrate({0.5, 0.0, -poses[4].yaw / 0.5}, 0.1);
  std::vector<AverageNote> notes;
  averaged(one, notes);
  CHECK(notes[0].by_twist);
}

TEST_CASE("Executions that are no fair ones are left out, each with its reason") {
  OnePattern one(std::vector<Twist2>(7, {0.5, 0.0, 0.1}), 10);
  std::vector<Execution>& executions = one.recordings.executions[0];
  executions[1][4].y = kNan;
  executions[2].pop_back();
  executions[4][7].x += 3.0;
  for (size_t t = 6; t < 10; ++t) executions[5][t].yaw -= 2.0 * kPi;
  std::vector<AverageNote> notes;
  const MotionPattern mean = averaged(one, notes).patterns()[0];
  CHECK(notes[0].used == 3);
  REQUIRE(notes[0].rejected.size() == 4);
  CHECK(notes[0].rejected[0] == "execution 2: sample 5 is not finite");
  CHECK(notes[0].rejected[1] == "execution 3: 9 poses, the pattern has 10 commands");
  CHECK(notes[0].rejected[2].find("execution 5: it moves at 30") == 0);
  CHECK(notes[0].rejected[3].find("execution 6: its yaw jumps") == 0);
  CHECK(mean.end().x == Approx(integrate({0.5, 0.0, 0.1}, 1.0).x));
}

TEST_CASE("A pattern that only turns on the spot is not judged by its own noise") {
  const PatternSet set = samples::setOf({samples::pattern(1, "spin", {0.0, 0.0, 0.4}, 5)});
  SurfaceRecordings recordings{"clay", {{}}};
  for (int e = 0; e < 5; ++e)
    recordings.executions[0].push_back(samples::arc({0.01 * e, 0.0, 0.4}, 5));
  std::vector<AverageNote> notes;
  averageSet(set, recordings, {}, notes);
  CHECK(notes[0].used == 5);
}

TEST_CASE("Too few fair executions are refused with pattern, surface and why") {
  OnePattern one(std::vector<Twist2>(3, {0.5, 0.0, 0.1}), 10);
  one.recordings.executions[0][0][9].x = kNan;
  std::vector<AverageNote> notes;
  CHECK_THROWS_WITH(averaged(one, notes),
                    "surface 'clay': pattern 'turn' has 2 fair executions of 3 (execution 1: "
                    "sample 10 is not finite); at least 3 are needed, record more");
  AverageLimits single;
  single.min_executions = 1;
  one.recordings.executions[0].resize(2);
  CHECK(std::isnan(averaged(one, notes, single).patterns()[0].end_covariance[0]));
}
