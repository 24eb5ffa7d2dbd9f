// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The multiple-model filter: what it remembers, recognises and forgets, its reports of changes
// and of its own errors, and that it is never much worse than no learning.
#include <catch2/catch.hpp>

#include <algorithm>
#include <numeric>
#include <set>

#include <Eigen/LU>

#include "tests/helpers.hpp"
#include "tests/learner/drawn_ground.hpp"

using namespace tread;
using namespace tread::learner;
using namespace tread::learner::samples;
using tread::testing::effort;

namespace {

/// The configuration's expectation for one execution, scaled.
EffectSpread usual(double times = 1.0) {
  return {0.03 * times, 0.08 * times, 0.03 * times};
}

Pupil multiModel(const GroundConfig& ground = {}) {
  RuleConfig config = ruleConfig("multi_model");
  config.ground = ground;
  return {config, richSet()};
}

/// Mean change probability over the next executions.
double changeSeen(Pupil& pupil, const GroundEffect& ground, int executions,
                  std::mt19937_64& random) {
  double sum = 0.0;
  for (int i = 0; i < executions; ++i)
    sum += driveAny(pupil, ground, usual(), 1, random).change_probability;
  return sum / executions;
}

Eigen::Matrix3d endCovariance(const Pupil& pupil, size_t pattern) {
  const PoseCovariance c = *Pupil(pupil).rule().endCovariance(pattern);
  Eigen::Matrix3d matrix;
  matrix << c[0], c[1], c[2], c[1], c[3], c[4], c[2], c[4], c[5];
  return matrix;
}

/// Area of the standard ellipse of an end.
double uncertainty(const Pupil& pupil, size_t pattern) {
  return std::sqrt(endCovariance(pupil, pattern).topLeftCorner<2, 2>().determinant());
}

double median(std::vector<double> numbers) {
  std::sort(numbers.begin(), numbers.end());
  return numbers[numbers.size() / 2];
}

/// Error of predicted ends relative to that of `off`.
double overOff(const Pupil& pupil, const DrawnWorld& world, const DrawnGround& ground,
               std::mt19937_64& random) {
  double learned = 0.0;
  double shipped = 0.0;
  for (int i = 0; i < 4; ++i)
    for (size_t p = 0; p < world.patterns(); ++p) {
      const Pose2 end = world.execution(ground, p, random).back();
      learned += distance(end, pupil.end(p));
      shipped += distance(end, pupil.shipped(p).back());
    }
  return learned / shipped;
}

/// A surface's expected velocity of a twist over a whole pattern, relative to the shipped one.
double gainOf(const GroundModel& model, const Surface& surface, size_t pattern, Eigen::Index axis) {
  const PatternPart& whole = model.whole(pattern);
  return 1.0 + (whole.toBody() * surface.correction().added(whole))[axis] / whole.mean[axis];
}

}  // namespace

TEST_CASE(
    "without a measurement the shipped set is predicted, on ground that is the first surface") {
  Pupil pupil = multiModel();
  for (size_t p = 0; p < pupil.patterns(); ++p) {
    const std::vector<Pose2> predicted = pupil.prediction(p);
    for (size_t t = 0; t < predicted.size(); ++t) {
      REQUIRE(distance(predicted[t], pupil.shipped(p)[t]) < 1e-12);
      REQUIRE(predicted[t].yaw == Approx(pupil.shipped(p)[t].yaw).margin(1e-12));
    }
  }
  REQUIRE(pupil.rule().remembered() == 1);
  std::mt19937_64 random(1);
  const RuleNote note = driveAny(pupil, kMeadow, usual(), 10, random);
  REQUIRE(note.surface == 1);
  REQUIRE(pupil.rule().reason(note).find("as shipped") == 0);
  REQUIRE(pupil.rule().remembered() == 1);
}

TEST_CASE("exact measurements of all patterns on changed ground: predictions become the truth") {
  const GroundEffect ground{1.1, 1.3, 0.1, 0.03};
  Pupil pupil = multiModel();
  const double at_first = meanEndError(pupil, ground);
  const double yaw_at_first = meanYawError(pupil, ground);
  const auto round = [&] {
    for (size_t p = 0; p < pupil.patterns(); ++p) pupil.learn(p, under(ground, pupil.shipped(p)));
  };
  round();
  REQUIRE(meanEndError(pupil, ground) < 0.2 * at_first);
  REQUIRE(meanYawError(pupil, ground) < 0.2 * yaw_at_first);
  for (int i = 0; i < 40; ++i) round();
  REQUIRE(meanEndError(pupil, ground) < 0.01 * at_first);
  REQUIRE(meanYawError(pupil, ground) < 0.01 * yaw_at_first);
}

TEST_CASE("the end that a rule states alone is the last pose that it predicts") {
  for (const Rule& rule : ruleNames()) {
    Pupil pupil(ruleConfig(rule), richSet());
    std::mt19937_64 random(8);
    for (int i = 0; i < 30; ++i) {
      driveAny(pupil, {1.1, 1.2, 0.1, 0.0}, usual(), 1, random);
      for (size_t p = 0; p < pupil.patterns(); ++p) {
        const Pose2 last = pupil.prediction(p).back();
        REQUIRE(distance(pupil.end(p), last) < 1e-12);
        REQUIRE(pupil.end(p).yaw == Approx(last.yaw).margin(1e-12));
      }
    }
  }
}

TEST_CASE("one execution of left corrects right about as much") {
  for (const GroundEffect& ground :
       {GroundEffect{1.0, 1.4, 0.0, 0.0}, GroundEffect{0.9, 1.2, 0.1, 0.0},
        GroundEffect{1.0, 0.7, 0.0, 0.0}, GroundEffect{1.0, 1.0, 0.2, 0.0}}) {
    Pupil pupil = multiModel();
    pupil.learn(kTurnLeft, under(ground, pupil.shipped(kTurnLeft)));
    const auto corrected = [&](size_t p) {
      const std::vector<Pose2> truth = under(ground, pupil.shipped(p));
      return 1.0 -
             distance(pupil.end(p), truth.back()) / distance(pupil.shipped(p).back(), truth.back());
    };
    INFO(ground.forward << " " << ground.yaw << " left " << corrected(kTurnLeft) << " right "
                        << corrected(kTurnRight));
    // Measured: a left turn is corrected by .37 to .68 of its error, by .11 if it only slips; a
    // change of ground is not yet certain.
    REQUIRE(corrected(kTurnLeft) > 0.08);
    REQUIRE(corrected(kTurnRight) > 0.6 * corrected(kTurnLeft));
    REQUIRE(corrected(kTurnRight) <= corrected(kTurnLeft) + 1e-9);
  }
}

TEST_CASE("new ground is remembered after ten executions on it, the shipped one from the start") {
  Pupil pupil = multiModel();
  std::mt19937_64 random(1);
  RuleNote note = driveAny(pupil, kMud, kCalm, 9, random);
  REQUIRE(pupil.rule().remembered() == 1);
  REQUIRE(note.surface == 0);
  REQUIRE(note.surface_probability > 0.9);
  REQUIRE(pupil.rule().reason(note).find("unknown ground") == 0);
  int executions = 9;
  while (!note.surface_stored && executions < 20) {
    note = driveAny(pupil, kMud, kCalm, 1, random);
    ++executions;
  }
  REQUIRE(executions <= 11);
  REQUIRE(note.surface == 2);
  REQUIRE(pupil.rule().reason(note) == "remembered as surface 2 from now on");
  REQUIRE(pupil.rule().remembered() == 2);
  note = driveAny(pupil, kMud, kCalm, 1, random);
  REQUIRE_FALSE(note.surface_stored);
  REQUIRE(note.surface == 2);
}

TEST_CASE("surfaces do not collapse: eight grounds stay eight, also after a very rough one",
          "[statistics]") {
  // Moderate differences compared with the scatter. Measured over 30 seeds: 7.0 grounds remembered,
  // 5.9 of 7 recognized when they return, 13 % taken for the rough one. A narrower prior of grounds
  // distinguishes more (7.6, 6.6, 3 %), but learns very different grounds ten times slower.
  const GroundEffect grounds[] = {{1.0, 1.0, 0.0, 0.0},     {1.05, 1.12, 0.03, 0.0},
                                  {0.95, 0.91, 0.0, 0.012}, {1.0, 1.21, 0.06, 0.0},
                                  {0.91, 1.06, 0.0, 0.0},   {1.09, 0.88, -0.03, 0.0},
                                  {0.97, 0.94, 0.09, 0.0},  {0.91, 0.85, -0.06, 0.0}};
  const double noises[] = {8.0, 1.0, 0.5, 1.0, 0.7, 1.2, 0.6, 1.0};
  const int seeds = 30;
  double remembered = 0.0;
  double apart = 0.0;
  double swallowed = 0.0;
  for (int seed = 1; seed <= seeds; ++seed) {
    std::mt19937_64 random(static_cast<uint64_t>(seed));
    Pupil pupil = multiModel();
    const int rough = driveAny(pupil, grounds[0], usual(noises[0]), 40, random).surface;
    for (size_t i = 1; i < 8; ++i) driveAny(pupil, grounds[i], usual(noises[i]), 40, random);
    remembered += pupil.rule().remembered();
    std::set<int> met;
    for (size_t i = 1; i < 8; ++i) {
      const int surface = driveAny(pupil, grounds[i], usual(noises[i]), 20, random).surface;
      met.insert(surface);
      swallowed += surface == rough ? 1.0 / 7.0 : 0.0;
    }
    apart += static_cast<double>(met.size());
  }
  CAPTURE(remembered / seeds, apart / seeds, swallowed / seeds);
  REQUIRE(remembered / seeds > 6.5);
  REQUIRE(apart / seeds > 5.5);
  REQUIRE(swallowed / seeds < 0.18);
}

TEST_CASE("executions of two grounds are never blended into one remembered surface",
          "[statistics]") {
  // The ground changes within the first ten executions. Ten executions later the earlier rule
  // predicted the mean of both grounds rather than the present one in 34, 39 and 25 of 100.
  const GroundEffect before{0.9, 1.2, 0.0, 0.0};
  const GroundEffect behind{1.1, 0.85, 0.05, 0.0};
  const GroundEffect blend{1.0, 1.025, 0.025, 0.0};
  const GroundModel model(GroundConfig{}, richSet());
  int blended = 0;
  int surfaces = 0;
  int wrong = 0;
  const int seeds = effort(100);
  for (const int change_at : {3, 5, 7})
    for (int seed = 1; seed <= seeds; ++seed) {
      std::mt19937_64 random(static_cast<uint64_t>(seed));
      Pupil pupil = multiModel();
      driveAny(pupil, before, usual(), change_at, random);
      driveAny(pupil, behind, usual(), 10, random);
      blended += meanEndError(pupil, blend) < meanEndError(pupil, behind) ? 1 : 0;
      driveAny(pupil, behind, usual(), 30, random);
      for (int k = 1; k < pupil.rule().remembered(); ++k) {
        const Surface& surface = asMultiModel(pupil).surface(static_cast<size_t>(k));
        const double yaw = gainOf(model, surface, kHardLeft, 2);
        const double forward = gainOf(model, surface, kAhead, 0);
        // In units of half the difference between the grounds.
        const double from_behind = std::hypot((yaw - 0.85) / 0.175, (forward - 1.1) / 0.1);
        const double from_before = std::hypot((yaw - 1.2) / 0.175, (forward - 0.9) / 0.1);
        const double from_blend = std::hypot((yaw - 1.025) / 0.175, (forward - 1.0) / 0.1);
        wrong += from_blend < std::min(from_behind, from_before) ? 1 : 0;
        ++surfaces;
      }
    }
  REQUIRE(surfaces > 2 * seeds);
  REQUIRE(blended <= 0.03 * 3 * seeds + 1);
  REQUIRE(wrong <= 0.03 * surfaces + 1);
}

TEST_CASE("a change of ground is seen in the execution in which it happens", "[statistics]") {
  // Measured over 200 seeds: .80, .73, .77, and .95, .87, .96 when the known ground returns. The
  // earlier rule: .10, .05, .06 at the changes, .05 at the return.
  const int seeds = 200;
  for (const GroundEffect& ground :
       {GroundEffect{0.7, 1.5, 0.0, 0.0}, GroundEffect{0.8, 1.3, 0.0, 0.0},
        GroundEffect{1.2, 0.6, 0.1, 0.0}}) {
    double seen = 0.0;
    double returned = 0.0;
    for (int seed = 1; seed <= seeds; ++seed) {
      std::mt19937_64 random(static_cast<uint64_t>(seed));
      Pupil pupil = multiModel();
      driveAny(pupil, kMeadow, usual(), 40, random);
      seen += changeSeen(pupil, ground, 1, random) / seeds;
      driveAny(pupil, ground, usual(), 40, random);
      returned += changeSeen(pupil, kMeadow, 1, random) / seeds;
    }
    REQUIRE(seen > 0.6);
    REQUIRE(returned > 0.6);
  }
}

TEST_CASE("over unchanged ground no more changes are suspected than are expected beforehand",
          "[statistics]") {
  const DrawnWorld world;
  // A change is expected every 12 m: its probability in a pattern.
  double expected = 0.0;
  for (size_t p = 0; p < world.patterns(); ++p)
    expected += (1.0 - std::exp(-std::max(0.05, world.model().whole(p).metres) / 12.0)) / 7.0;
  REQUIRE(expected == Approx(0.058).margin(0.001));
  double suspected = 0.0;
  const int seeds = 100;
  for (int seed = 1; seed <= seeds; ++seed) {
    std::mt19937_64 random(static_cast<uint64_t>(seed));
    Pupil pupil = multiModel();
    driveAny(pupil, kMeadow, usual(), 40, random);
    suspected += 0.5 / seeds * changeSeen(pupil, kMeadow, 40, random);
    const DrawnGround ground = world.ground(random);
    world.drive(pupil, ground, 40, random);
    for (int i = 0; i < 40; ++i)
      suspected += 0.5 / seeds / 40 * world.drive(pupil, ground, 1, random).change_probability;
  }
  // Measured .040 over 100 seeds, .085 in the worst 40 executions of 200.
  REQUIRE(suspected < 1.2 * expected);
}

TEST_CASE("nine in ten executions end within the region that is stated for nine in ten",
          "[statistics]") {
  // In a world that matches the rule's expectations: a vehicle with its own deviation on all
  // grounds but the shipped one, which it is on every other time; the next metres may bring another
  // ground.
  constexpr double kQuantile = 6.251;  // chi^2, three degrees of freedom
  const DrawnWorld world;
  const double change = 1.0 - std::exp(-1.5 / 12.0);
  int within_all = 0;
  int all_of_all = 0;
  for (const int learned : {0, 3, 10}) {
    int within = 0;
    int all = 0;
    for (int seed = 1; seed <= 500; ++seed) {
      std::mt19937_64 random(static_cast<uint64_t>(seed));
      const DrawnGround vehicle = world.ground(random, 0.5);
      const DrawnGround shipped = world.ground(random, 0.05);
      const auto any = [&] {
        return random() % 2 == 0 ? shipped : world.ground(random, 0.5, vehicle);
      };
      DrawnGround ground = any();
      Pupil pupil = multiModel();
      world.drive(pupil, ground, learned, random);
      if (std::uniform_real_distribution<double>(0.0, 1.0)(random) < change) ground = any();
      for (size_t p = 0; p < world.patterns(); ++p) {
        const Pose2 end = world.execution(ground, p, random).back();
        const Pose2 predicted = pupil.end(p);
        const Eigen::Vector3d apart(end.x - predicted.x, end.y - predicted.y,
                                    wrapAngle(end.yaw - predicted.yaw));
        within += apart.dot(endCovariance(pupil, p).inverse() * apart) < kQuantile ? 1 : 0;
        ++all;
      }
    }
    INFO(learned << " executions: " << within << " of " << all);
    // Measured over 500 seeds 1.000, .984, .955: very different grounds are expected, too.
    CHECK(within > 0.86 * all);
    CHECK((learned < 10 || within < 0.97 * all));
    within_all += within;
    all_of_all += all;
  }
  REQUIRE(within_all > 0.87 * all_of_all);
}

TEST_CASE(
    "the covariance shrinks where the ground is known and grows where a change is suspected") {
  std::vector<double> settled;
  std::vector<double> suspected;
  std::vector<double> sure;
  for (int seed = 1; seed <= effort(50); ++seed) {
    std::mt19937_64 random(static_cast<uint64_t>(seed));
    Pupil pupil = multiModel();
    const double at_first = uncertainty(pupil, kHardLeft);
    driveAny(pupil, kMeadow, usual(), 40, random);
    const double known = uncertainty(pupil, kHardLeft);
    settled.push_back(known / at_first);
    pupil.learn(kTurnLeft, under({0.75, 0.7, 0.0, 0.0}, pupil.shipped(kTurnLeft)));
    suspected.push_back(uncertainty(pupil, kHardLeft) / known);
    driveAny(pupil, {0.75, 0.7, 0.0, 0.0}, usual(), 30, random);
    sure.push_back(uncertainty(pupil, kHardLeft) / known);
  }
  // Measured: a fifth of the former, five times that at the change, 1.5 times after it.
  REQUIRE(median(settled) < 0.4);
  REQUIRE(median(suspected) > 2.0);
  REQUIRE(median(sure) < 0.6 * median(suspected));
}

TEST_CASE("end covariances are symmetric, positive definite and finite, whatever was learned") {
  Pupil pupil = multiModel();
  std::mt19937_64 random(5);
  for (int i = 0; i < effort(400); ++i) {
    const EffectSpread wild{0.5, 0.8, 0.5};
    driveAny(pupil, kMeadow, i % 3 == 0 ? wild : usual(), 1, random);
    for (size_t p = 0; p < pupil.patterns(); ++p) {
      const Eigen::Matrix3d covariance = endCovariance(pupil, p);
      REQUIRE(covariance.allFinite());
      REQUIRE(covariance.llt().info() == Eigen::Success);
    }
  }
}

TEST_CASE("rules that know no covariance say so") {
  for (const Rule rule : {"off", "single", "collective", "telescoping"})
    REQUIRE_FALSE(Pupil(ruleConfig(rule), richSet()).rule().endCovariance(0));
}

TEST_CASE("the covariance of a remembered rough surface has its own noise") {
  const auto spread = [](double forward_noise) {
    Pupil pupil = multiModel();
    std::mt19937_64 random(6);
    driveAny(pupil, kMeadow, {forward_noise, 0.05, 0.02}, 200, random);
    return std::sqrt((*pupil.rule().endCovariance(kAhead))[0]);
  };
  // Forward by 3 and 9 % of a metre.
  REQUIRE(spread(0.03) == Approx(0.03).epsilon(0.3));
  REQUIRE(spread(0.09) == Approx(0.09).epsilon(0.3));
}

TEST_CASE("after a change of ground learning does no harm from the second execution on",
          "[statistics]") {
  // Measured over 200 seeds, relative to the error of `off`: 1.21, 1.01, .97, .91, .88, .84 after 0
  // to 5; both contain the unpredictable scatter of executions.
  const DrawnWorld world;
  std::vector<std::vector<double>> ratios(6);
  for (int seed = 1; seed <= 200; ++seed) {
    std::mt19937_64 random(static_cast<uint64_t>(seed));
    Pupil pupil = multiModel();
    world.drive(pupil, world.ground(random), 30, random);
    const DrawnGround ground = world.ground(random);
    for (std::vector<double>& after : ratios) {
      after.push_back(overOff(pupil, world, ground, random));
      world.drive(pupil, ground, 1, random);
    }
  }
  REQUIRE(median(ratios[1]) < 1.05);
  for (size_t n = 2; n < ratios.size(); ++n) {
    INFO(n << " executions");
    REQUIRE(median(ratios[n]) < 1.0);
  }
  REQUIRE(median(ratios[5]) < 0.88);
}

TEST_CASE("from the shipped ground to another learning never does harm", "[statistics]") {
  // Measured over 200 seeds: 1.00, .97, .94, .90, .88, .86 after 0 to 5.
  const DrawnWorld world;
  std::vector<std::vector<double>> ratios(6);
  for (int seed = 1; seed <= 200; ++seed) {
    std::mt19937_64 random(static_cast<uint64_t>(seed));
    Pupil pupil = multiModel();
    world.drive(pupil, world.shipped(), 30, random);
    const DrawnGround ground = world.ground(random);
    for (std::vector<double>& after : ratios) {
      after.push_back(overOff(pupil, world, ground, random));
      world.drive(pupil, ground, 1, random);
    }
  }
  REQUIRE(median(ratios[0]) < 1.02);
  REQUIRE(median(ratios[1]) < 1.0);
  for (size_t n = 2; n < ratios.size(); ++n) REQUIRE(median(ratios[n]) < 0.97);
  REQUIRE(median(ratios[5]) < 0.9);
}

TEST_CASE("on unchanged shipped ground the error is within 2 percent of the omniscient one",
          "[statistics]") {
  // Measured 1.7 %. The earlier rule: 3.6 %.
  const DrawnWorld world;
  double learned = 0.0;
  double omniscient = 0.0;
  for (int seed = 1; seed <= 100; ++seed) {
    std::mt19937_64 random(static_cast<uint64_t>(seed));
    Pupil pupil = multiModel();
    world.drive(pupil, world.shipped(), 50, random);
    for (int i = 0; i < 200; ++i) {
      const size_t p = random() % world.patterns();
      const std::vector<Pose2> measured = world.execution(world.shipped(), p, random);
      learned += distance(measured.back(), pupil.end(p));
      omniscient += distance(measured.back(), pupil.shipped(p).back());
      pupil.learn(p, measured);
    }
  }
  REQUIRE(learned < 1.02 * omniscient);
}

TEST_CASE("what a vehicle does on every ground it is expected to do on the next, too",
          "[statistics]") {
  // It turns 1.3 times the shipped yaw on every ground; grounds differ in everything else.
  const GroundEffect grounds[] = {{1.0, 1.3, 0.0, 0.0}, {0.92, 1.3, 0.08, 0.0}};
  const GroundEffect third{1.25, 1.3, -0.06, 0.0};
  constexpr size_t kTurns[] = {kTurnLeft, kTurnRight, kHardLeft, kHardRight, kTurning};
  const auto yaw_over_off = [&](const Pupil& pupil) {
    double learned = 0.0;
    double shipped = 0.0;
    for (const size_t p : kTurns) {
      const double yaw = under(third, pupil.shipped(p)).back().yaw;
      learned += std::abs(yaw - pupil.end(p).yaw);
      shipped += std::abs(yaw - pupil.shipped(p).back().yaw);
    }
    return learned / shipped;
  };
  std::vector<double> first;
  std::vector<double> changed;
  for (int seed = 1; seed <= 100; ++seed) {
    std::mt19937_64 random(static_cast<uint64_t>(seed));
    Pupil pupil = multiModel();
    for (const GroundEffect& ground : grounds) driveAny(pupil, ground, usual(), 30, random);
    first.push_back(yaw_over_off(pupil));
    // Straight on the third ground: it is another one, and nothing is known about turns.
    RuleNote note;
    for (int i = 0; i < 2; ++i)
      note = pupil.learn(kAhead, under(drawn(third, usual(), random), pupil.shipped(kAhead)));
    REQUIRE(note.surface == 0);
    changed.push_back(yaw_over_off(pupil));
  }
  // Measured .10 and .51 of the error of `off`.
  CAPTURE(median(first), median(changed));
  REQUIRE(median(first) < 0.25);
  REQUIRE(median(changed) < 0.6);
}

TEST_CASE("a vehicle that follows later than its set does so also in what it has not driven yet",
          "[statistics]") {
  const auto changing = [](const Twist2& from, const Twist2& to) {
    std::vector<Pose2> poses;
    Pose2 at;
    for (int t = 0; t < 20; ++t) {
      const double share = std::min(1.0, 0.1 * (t + 0.5));
      at = at * integrate({from.v_x + share * (to.v_x - from.v_x), 0.0,
                           from.omega + share * (to.omega - from.omega)},
                          0.05);
      poses.push_back(at);
    }
    return poses;
  };
  const Twist2 stands, drives{1.0, 0.0, 0.0}, turns{1.0, 0.0, 0.8};
  PatternSetContent content = richContent();
  content.patterns.push_back(pattern(8, "set_off", {1.0, 1.0}, changing(stands, drives)));
  content.patterns.push_back(pattern(9, "turn_in", {0.5, 1.0}, changing(drives, turns)));
  content.patterns.push_back(pattern(10, "stop", {0.0, 0.0}, changing(drives, stands)));
  content.patterns.push_back(pattern(11, "turn_out", {1.0, 1.0}, changing(turns, drives)));
  constexpr size_t kDriven[] = {kAhead, kTurnLeft, kTurnRight, 7, 8};
  constexpr size_t kStop = 9, kTurnOut = 10;
  const DrawnWorld world(checked(content));
  DrawnGround later = world.shipped();
  later.x.common[TwistCorrection::kLag] = later.x.common[TwistCorrection::kYawLag] = 0.2;
  const double stops = world.expected(later, kStop).back().x;
  const double turned = world.expected(later, kTurnOut).back().yaw;
  const double off = std::abs(stops - world.set().patterns()[kStop].end().x);
  const double yaw_off = std::abs(turned - world.set().patterns()[kTurnOut].end().yaw);
  REQUIRE(off > 0.1);
  REQUIRE(yaw_off > 0.1);
  double left = 0.0, yaw_left = 0.0;
  constexpr int kSeeds = 10;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    std::mt19937_64 random(static_cast<uint64_t>(seed));
    Pupil pupil(ruleConfig("multi_model"), world.set());
    for (int i = 0; i < 10; ++i)
      for (const size_t p : kDriven) pupil.learn(p, world.execution(later, p, random));
    left += std::abs(stops - pupil.end(kStop).x) / kSeeds;
    yaw_left += std::abs(turned - pupil.end(kTurnOut).yaw) / kSeeds;
  }
  CAPTURE(left, off, yaw_left, yaw_off);
  REQUIRE(left < 0.4 * off);
  REQUIRE(yaw_left < 0.5 * yaw_off);
}

TEST_CASE("a surface that comes back is recognised faster than it was learned", "[statistics]") {
  int recognised = 0;
  double at_first = 0.0;
  double again = 0.0;
  const int seeds = 40;
  for (int seed = 1; seed <= seeds; ++seed) {
    std::mt19937_64 random(static_cast<uint64_t>(seed));
    Pupil pupil = multiModel();
    driveAny(pupil, kMud, usual(), 3, random);
    at_first += meanEndError(pupil, kMud) / seeds;
    driveAny(pupil, kMud, usual(), 30, random);
    driveAny(pupil, kRoad, usual(), 30, random);
    const RuleNote note = driveAny(pupil, kMud, usual(), 3, random);
    again += meanEndError(pupil, kMud) / seeds;
    recognised += note.surface == 2 ? 1 : 0;
  }
  // Measured: 35 of 40, and less than half of the error after three executions.
  REQUIRE(recognised >= 0.75 * seeds);
  REQUIRE(again < 0.6 * at_first);
}

TEST_CASE("the first half of a pattern teaches nearly what the whole of it does", "[statistics]") {
  const DrawnWorld world;
  double halves = 0.0;
  double wholes = 0.0;
  int same_way = 0;
  const int seeds = 200;
  for (int seed = 1; seed <= seeds; ++seed) {
    std::mt19937_64 random(static_cast<uint64_t>(seed));
    Pupil pupil = multiModel();
    if (seed % 2 == 0) world.drive(pupil, world.ground(random), 20, random);
    const size_t p = random() % world.patterns();
    const std::vector<Pose2> measured = world.execution(world.ground(random), p, random);
    Pupil half(pupil);
    Pupil whole(pupil);
    half.learn(p, {measured.begin(), measured.begin() + 10});
    whole.learn(p, measured);
    const std::vector<double> before = pupil.everything();
    const std::vector<double> by_half = half.everything();
    const std::vector<double> by_whole = whole.everything();
    double along = 0.0;
    for (size_t i = 0; i < before.size(); ++i) {
      along += (by_half[i] - before[i]) * (by_whole[i] - before[i]);
      halves += (by_half[i] - before[i]) * (by_half[i] - before[i]);
      wholes += (by_whole[i] - before[i]) * (by_whole[i] - before[i]);
    }
    same_way += along > 0.0 ? 1 : 0;
  }
  // Measured: 200 of 200, .91 of the distance.
  REQUIRE(same_way >= 0.98 * seeds);
  REQUIRE(std::sqrt(halves / wholes) > 0.75);
  REQUIRE(std::sqrt(halves / wholes) < 1.05);
}

TEST_CASE("the beginning of a pattern is compared with its own beginning") {
  // A left turn, then a right one: a first half as shipped is no evidence of another ground.
  RuleConfig config = ruleConfig("multi_model");
  Pupil pupil(config, windingSet());
  const size_t last = pupil.patterns() - 1;
  const std::vector<Pose2>& shipped = pupil.shipped(last);
  for (int i = 0; i < 5; ++i) pupil.learn(last, {shipped.begin(), shipped.begin() + 10});
  for (size_t p = 0; p < pupil.patterns(); ++p)
    REQUIRE(distance(pupil.end(p), pupil.shipped(p).back()) < 1e-9);
  const RuleNote note = pupil.learn(last, {shipped.begin(), shipped.begin() + 10});
  INFO(note.surface << ' ' << note.surface_probability << ' ' << note.change_probability);
  REQUIRE(note.change_probability < 0.1);
}

TEST_CASE("who learns the whole in the place of its beginning has learned the whole alone") {
  const DrawnWorld world;
  std::mt19937_64 random(4);
  Pupil pupil = multiModel();
  world.drive(pupil, world.ground(random), 15, random);
  for (int i = 0; i < 20; ++i) {
    const Pupil before(pupil);
    const size_t p = random() % world.patterns();
    const std::vector<Pose2> measured = world.execution(world.ground(random), p, random);
    for (const std::ptrdiff_t rows : {3, 9, 14})
      pupil.learn(p, {measured.begin(), measured.begin() + rows});
    pupil.rule().assign(Pupil(before).rule());
    REQUIRE(pupil.rule().memory() == Pupil(before).rule().memory());
    Pupil straight(before);
    const RuleNote note = pupil.learn(p, measured);
    REQUIRE(straight.learn(p, measured).change_probability == note.change_probability);
    REQUIRE(straight.everything() == pupil.everything());
    REQUIRE(straight.rule().memory() == pupil.rule().memory());
  }
}

TEST_CASE("a part that is all of a pattern is the whole pattern") {
  const DrawnWorld world;
  std::mt19937_64 random(5);
  Pupil pupil = multiModel();
  Pupil fed = multiModel();
  std::vector<Pose2> measured = world.execution(world.shipped(), kHardLeft, random);
  pupil.learn(kHardLeft, measured);
  measured.resize(20);
  fed.learn(kHardLeft, measured);
  REQUIRE(fed.rule().memory() == pupil.rule().memory());
}

TEST_CASE("parts of a single sample do no harm, even many of them", "[statistics]") {
  const DrawnWorld world;
  double before = 0.0;
  double behind = 0.0;
  double on_shipped = 0.0;
  const int seeds = effort(50);
  const auto begin = [&](Pupil& pupil, const DrawnGround& ground, int parts,
                         std::mt19937_64& random) {
    for (int i = 0; i < parts; ++i) {
      const size_t p = random() % world.patterns();
      Pose2 pose = world.execution(ground, p, random).front();
      // As measured by an INS.
      pose = {pose.x + 0.005 * chanceOf(random), pose.y + 0.005 * chanceOf(random),
              pose.yaw + 0.005 * chanceOf(random)};
      pupil.learn(p, {pose});
    }
  };
  for (int seed = 1; seed <= seeds; ++seed) {
    std::mt19937_64 random(static_cast<uint64_t>(seed));
    Pupil pupil = multiModel();
    const DrawnGround ground = world.ground(random);
    world.drive(pupil, ground, 40, random);
    before += world.endError(pupil, ground) / seeds;
    begin(pupil, ground, 10, random);
    behind += world.endError(pupil, ground) / seeds;
    Pupil shipped = multiModel();
    begin(shipped, world.shipped(), 100, random);
    on_shipped += world.endError(shipped, world.shipped()) / seeds;
  }
  // Measured over 5 seeds: .0231 before and .0278 after ten of them.
  REQUIRE(behind < 1.25 * before + 0.002);
  REQUIRE(on_shipped < 0.03);
}

TEST_CASE("the surface that was met longest ago makes room, never that of the shipped set",
          "[statistics]") {
  GroundConfig config;
  config.capacity = 2;
  int right = 0;
  const int seeds = 100;
  for (int seed = 1; seed <= seeds; ++seed) {
    Pupil pupil = multiModel(config);
    std::mt19937_64 random(static_cast<uint64_t>(seed));
    driveAny(pupil, kMeadow, kCalm, 30, random);
    driveAny(pupil, kMud, kCalm, 30, random);
    bool good = pupil.rule().remembered() == 2;
    driveAny(pupil, {0.7, 0.8, -0.1, 0.0}, kCalm, 30, random);
    good = good && pupil.rule().remembered() == 3;
    driveAny(pupil, kMud, kCalm, 30, random);
    REQUIRE(pupil.rule().remembered() <= 3);
    // Except for the shipped one the third ground was used least recently.
    const RuleNote road = driveAny(pupil, kRoad, kCalm, 30, random);
    REQUIRE(pupil.rule().remembered() <= 3);
    const RuleNote mud = driveAny(pupil, kMud, kCalm, 10, random);
    const RuleNote meadow = driveAny(pupil, kMeadow, kCalm, 10, random);
    right += good && road.surface == 3 && mud.surface == 2 && meadow.surface == 1 ? 1 : 0;
  }
  // Measured over 200 seeds: .91. In the other cases two times of one change, at most one execution
  // apart, stay about equally likely, so that neither is certain in time.
  REQUIRE(right >= 0.85 * seeds);
}

TEST_CASE("with room for one surface beside the shipped one it follows the newest") {
  GroundConfig config;
  config.capacity = 1;
  int shipped = 0;
  const int seeds = effort(40);
  for (int seed = 1; seed <= seeds; ++seed) {
    Pupil pupil = multiModel(config);
    std::mt19937_64 random(static_cast<uint64_t>(seed));
    for (const GroundEffect& ground : {kMud, kRoad, kMud, kRoad}) {
      driveAny(pupil, ground, kCalm, 40, random);
      REQUIRE(pupil.rule().remembered() == 2);
      REQUIRE(meanEndError(pupil, ground) < 0.05);
    }
    shipped += driveAny(pupil, kMeadow, kCalm, 10, random).surface == 1 ? 1 : 0;
  }
  // Measured: always. It was one in seven when the unmeasured shipped ground was expected to be
  // noisier than new ground.
  REQUIRE(shipped >= 0.95 * seeds);
}

TEST_CASE("who begins on other ground counts each change from there to the shipped one and back",
          "[statistics]") {
  double changes = 0.0;
  const int seeds = 40;
  for (int seed = 1; seed <= seeds; ++seed) {
    Pupil pupil = multiModel();
    std::mt19937_64 random(static_cast<uint64_t>(seed));
    for (int stay = 0; stay < 10; ++stay)
      driveAny(pupil, stay % 2 == 0 ? kMud : kMeadow, usual(), 20, random);
    changes += pupil.rule().memory()[1] / seeds;
  }
  // Nine, plus the one from the shipped set to the first. Measured 11.2: the estimated time of a
  // change may move with more data. It was 4.9 when both had a common beginning.
  REQUIRE(changes > 9.0);
  REQUIRE(changes < 13.0);
}

TEST_CASE("room for no surface, or surfaces of none, or no moment of change is refused") {
  RuleConfig config = ruleConfig("multi_model");
  config.ground.capacity = 0;
  REQUIRE_THROWS_WITH(makeRule(config, richSet()), Catch::Contains("capacity"));
  config = ruleConfig("multi_model");
  config.ground.settled_after = 0;
  REQUIRE_THROWS_WITH(makeRule(config, richSet()), Catch::Contains("settled_after"));
  config = ruleConfig("multi_model");
  config.ground.moments = 2;
  REQUIRE_THROWS_WITH(makeRule(config, richSet()), Catch::Contains("moments"));
}

TEST_CASE("the ends of all ranges are configurations like others") {
  using Change = void (*)(GroundConfig&);
  const Change changes[] = {
      [](GroundConfig& c) { c.change_metres = 0.1; },
      [](GroundConfig& c) { c.change_metres = 1e5; },
      [](GroundConfig& c) { c.change_prior = 0.1; },
      [](GroundConfig& c) { c.change_prior = 1e9; },
      [](GroundConfig& c) { c.fresh = 0.01; },
      [](GroundConfig& c) { c.fresh = 0.99; },
      [](GroundConfig& c) { c.sure = 0.5; },
      [](GroundConfig& c) { c.sure = 0.999; },
      [](GroundConfig& c) { c.settled_after = 2; },
      [](GroundConfig& c) { c.moments = 3; },
      [](GroundConfig& c) { c.moments = 64; },
      [](GroundConfig& c) { c.longest_memory = 10.0; },
      [](GroundConfig& c) { c.noise_prior = 3.0; },
      [](GroundConfig& c) { c.most_freedom = 4.0; },
      [](GroundConfig& c) { c.noise = {0.001, 0.001, 0.001, 0.0, 0.0, 1e-4, 1e-4, 1e-4}; },
  };
  for (size_t i = 0; i < std::size(changes); ++i) {
    INFO("change " << i);
    GroundConfig config;
    changes[i](config);
    Pupil pupil = multiModel(config);
    std::mt19937_64 random(10);
    for (const GroundEffect& ground :
         {kMud, GroundEffect{0.05, 0.1, 0.0, 0.0}, kRoad, kMeadow, kMud}) {
      for (int n = 0; n < effort(40); ++n) {
        const RuleNote note = driveAny(pupil, ground, usual(), 1, random);
        REQUIRE(note.surface_probability >= 0.0);
        REQUIRE(note.surface_probability <= 1.0 + 1e-9);
        REQUIRE(note.change_probability >= 0.0);
        REQUIRE(note.change_probability <= 1.0 + 1e-9);
        if (note.surface_stored) REQUIRE(note.surface > 0);
      }
      for (const double number : pupil.everything()) REQUIRE(std::isfinite(number));
      for (size_t p = 0; p < pupil.patterns(); ++p)
        REQUIRE(endCovariance(pupil, p).llt().info() == Eigen::Success);
    }
    Pupil second = multiModel(config);
    REQUIRE(second.rule().restore(TrajectoryTable(pupil.set().patterns()), pupil.rule().memory()));
    REQUIRE(second.everything() == pupil.everything());
  }
}
