// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Estimates of grip from starts, stops and slides.
#include <catch2/catch.hpp>

#include <cmath>
#include <functional>
#include <random>

#include "modules/learner/core/grip.hpp"
#include "tests/learner/samples.hpp"

using namespace tread;
using namespace tread::learner;
using namespace tread::learner::samples;

namespace {

constexpr double kSampling = 0.05;  // [s]
const MotionClass kRest{"rest", {0.0, 0.0, 0.0}, {0.0, 0.0}};
const MotionClass kFast{"fast", {2.0, 0.0, 0.0}, {1.0, 1.0}};

/// Twist as a function of time [s].
using TwistAt = std::function<Twist2(double)>;

std::vector<Pose2> driven(const TwistAt& twist, double seconds) {
  constexpr int kFine = 50;
  std::vector<Pose2> poses;
  Pose2 pose;
  for (int t = 0; t < static_cast<int>(std::lround(seconds / kSampling)); ++t) {
    for (int i = 0; i < kFine; ++i) {
      const double dt = kSampling / kFine;
      pose = pose * integrate(twist((t + (i + 0.5) / kFine) * kSampling), dt);
    }
    poses.push_back(pose);
  }
  return poses;
}

/// A speed that approaches `to` with a lag.
TwistAt lagging(double from, double to, double lag) {
  return [=](double t) { return Twist2{to + (from - to) * std::exp(-t / lag), 0.0, 0.0}; };
}
/// A speed with limited acceleration.
TwistAt limited(double from, double to, double acceleration) {
  return [=](double t) {
    const double most = acceleration * t;
    return Twist2{from + std::clamp(to - from, -most, most), 0.0, 0.0};
  };
}

MotionPattern patternOf(const TwistAt& twist, double seconds = 1.0) {
  return samples::pattern(1, "asked", {1.0, 1.0}, driven(twist, seconds));
}

Measurement drivenOn(const TwistAt& twist, double seconds = 1.0) {
  Measurement measurement = fair(driven(twist, seconds));
  measurement.context.entry = twist(0.0);
  return measurement;
}

std::optional<GripSign> signOf(const TwistAt& wanted, const MotionClass& entry,
                               const TwistAt& given) {
  return gripSign(drivenOn(given), patternOf(wanted), entry, kSampling);
}

}  // namespace

TEST_CASE("A start that comes as asked says that the ground holds at least that") {
  const TwistAt start = lagging(0.0, 2.0, 0.2);
  const auto sign = signOf(start, kRest, start);
  REQUIRE(sign);
  CHECK_FALSE(sign->gave_way);
  CHECK(sign->acceleration > 3.0);
  CHECK(sign->acceleration == Approx(sign->asked));
}

TEST_CASE("A start and a stop on ice say what the ice gives") {
  const double ice = GENERATE(0.4, 0.6, 0.8);
  for (const auto& [entry, from, to] : {std::tuple(kRest, 0.0, 2.0), std::tuple(kFast, 2.0, 0.0)}) {
    const auto sign = signOf(lagging(from, to, 0.2), entry, limited(from, to, ice));
    REQUIRE(sign);
    CHECK(sign->gave_way);
    CHECK(sign->acceleration == Approx(ice).epsilon(0.05));
  }
}

TEST_CASE("Ground that only leaves a part of the speed does not count as slippery") {
  // The four known real grounds keep 40 to 79 % of the commanded speed.
  const double share = GENERATE(0.4, 0.55, 0.79);
  const auto sign = signOf(lagging(0.0, 2.0, 0.2), kRest, lagging(0.0, 2.0 * share, 0.2));
  REQUIRE(sign);
  CHECK_FALSE(sign->gave_way);
  CHECK(sign->acceleration < 1.1 * sign->asked * share);
}

TEST_CASE("A vehicle that enters with another speed than its class is asked for another change") {
  // A stop from a tenth of the speed gives no information on the ground.
  CHECK_FALSE(signOf(lagging(2.0, 0.0, 0.2), kFast, limited(0.15, 0.0, 5.0)));
  // One from a higher speed, reached because the ground gave way before, does.
  const auto sign = signOf(lagging(0.0, 2.0, 0.2), kRest, limited(0.4, 2.0, 0.6));
  REQUIRE(sign);
  CHECK(sign->gave_way);
  CHECK(sign->acceleration == Approx(0.6).epsilon(0.05));
}

TEST_CASE("A vehicle that stands where it should start says nothing of the ground") {
  CHECK_FALSE(signOf(lagging(0.0, 2.0, 0.2), kRest, limited(0.0, 2.0, 0.01)));
}

TEST_CASE("A slide to the side says what is left of the turn") {
  const TwistAt turn = [](double) { return Twist2{1.5, 0.0, 1.5}; };
  // The body turns, the velocity hardly does.
  const TwistAt slide = [](double t) {
    const double beside = 1.2 * t;
    return Twist2{1.5 * std::cos(beside), -1.5 * std::sin(beside), 1.5};
  };
  const MotionClass turning{"turning", {1.5, 0.0, 1.5}, {0.5, 1.0}};
  CHECK_FALSE((signOf(turn, turning, turn) && signOf(turn, turning, turn)->gave_way));
  const auto sign = signOf(turn, turning, slide);
  REQUIRE(sign);
  CHECK(sign->gave_way);
  CHECK(sign->acceleration == Approx(1.5 * 0.3).epsilon(0.1));
}

TEST_CASE("INS noise of a centimetre makes no ground slippery") {
  std::mt19937_64 random(11);
  std::normal_distribution<double> noise(0.0, 0.01), turn(0.0, 0.005);
  int gave_way = 0, signs = 0;
  for (int n = 0; n < 400; ++n) {
    const bool starts = n % 2 == 0;
    const TwistAt wanted = starts ? lagging(0.0, 1.1, 0.2) : [](double) {
      return Twist2{1.1, 0.0, 0.4};
    };
    Measurement measurement = drivenOn(wanted);
    for (Pose2& pose : measurement.trajectory)
      pose = Pose2{pose.x + noise(random), pose.y + noise(random), pose.yaw + turn(random)};
    const MotionClass entry{"entry", wanted(0.0), {1.0, 1.0}};
    const auto sign = gripSign(measurement, patternOf(wanted), entry, kSampling);
    signs += sign ? 1 : 0;
    gave_way += sign && sign->gave_way ? 1 : 0;
  }
  CHECK(signs > 150);
  CHECK(gave_way == 0);
}

TEST_CASE("What ends before it shows anything says nothing") {
  Measurement measurement = drivenOn(limited(0.0, 2.0, 0.6));
  measurement.covered = 3;
  CHECK_FALSE(gripSign(measurement, patternOf(lagging(0.0, 2.0, 0.2)), kRest, kSampling));
  measurement.covered = 0;
  CHECK_FALSE(gripSign(measurement, patternOf(lagging(0.0, 2.0, 0.2)), kRest, kSampling));
}

TEST_CASE("Before anything was felt a ground gives little, and lifts no speed limit that it made") {
  const GripEstimator none;
  CHECK(none.grip().deceleration == GripEstimator::kUnseen);
  CHECK_FALSE(none.grip().gave_way);
  CHECK(none.signs() == 0);
}

TEST_CASE("Where the ground gave way the most of the last three is believed") {
  GripEstimator estimator;
  int64_t started = 1;
  for (const double given : {0.2, 0.7, 0.6, 0.65}) estimator.take({given, 3.5, true}, started++);
  CHECK(estimator.grip().gave_way);
  CHECK(estimator.grip().deceleration == Approx(0.7));
  estimator.take({0.5, 3.5, true}, started++);
  CHECK(estimator.grip().deceleration == Approx(0.65));
}

TEST_CASE("A part of an execution and its whole count once") {
  GripEstimator estimator;
  estimator.take({0.3, 3.5, true}, 7);
  estimator.take({0.6, 3.5, true}, 7);
  CHECK(estimator.signs() == 1);
  CHECK(estimator.grip().deceleration == Approx(0.6));
}

TEST_CASE("A ground that holds again is believed at once, one that nobody tries again in time") {
  GripEstimator estimator;
  estimator.take({0.6, 3.5, true}, 1);
  // The deceleration of a crawling vehicle is no evidence.
  estimator.take({0.7, 0.8, false}, 2);
  CHECK(estimator.grip().gave_way);
  CHECK(estimator.grip().deceleration == Approx(0.7));
  GripEstimator crawling = estimator;
  crawling.drive(GripEstimator::kForget);
  CHECK(crawling.grip().gave_way);
  CHECK(crawling.grip().deceleration == Approx(0.7 * std::exp(1.0)));
  crawling.drive(GripEstimator::kForget);
  CHECK_FALSE(crawling.grip().gave_way);
  CHECK(crawling.grip().deceleration == GripEstimator::kUnseen);
  estimator.take({3.2, 3.5, false}, 3);
  CHECK_FALSE(estimator.grip().gave_way);
  // One execution may be disturbed: part of the earlier assumption is kept.
  CHECK(estimator.grip().deceleration == Approx((GripEstimator::kUnseen + 3.2) / 2.0));
  estimator.take({0.6, 3.5, true}, 4);
  CHECK(estimator.grip().gave_way);
  CHECK(estimator.grip().deceleration == Approx(0.6));
}

TEST_CASE("A crawl, however long, is no proof that the ground holds again") {
  GripEstimator estimator;
  estimator.take({0.75, 3.5, true}, 1);
  for (int64_t started = 2; started < 60; ++started) estimator.take({0.8, 1.5, false}, started);
  CHECK(estimator.grip().gave_way);
  CHECK(estimator.grip().deceleration == Approx(0.8));
  // The same for a ground that gave way at less: the requested acceleration must have been reached.
  estimator.take({0.5, 1.0, true}, 60);
  estimator.take({0.8, 1.5, false}, 61);
  CHECK(estimator.grip().gave_way);
}

TEST_CASE("What is known of ice hardly changes with INS noise") {
  std::mt19937_64 random(5);
  const double sigma = GENERATE(0.003, 0.01);
  std::normal_distribution<double> noise(0.0, sigma);
  double sum = 0.0;
  int gave_way = 0;
  constexpr int kStarts = 200;
  for (int n = 0; n < kStarts; ++n) {
    Measurement measurement = drivenOn(limited(0.0, 2.0, 0.6));
    for (Pose2& pose : measurement.trajectory)
      pose = Pose2{pose.x + noise(random), pose.y + noise(random), pose.yaw};
    const auto sign = gripSign(measurement, patternOf(lagging(0.0, 2.0, 0.2)), kRest, kSampling);
    REQUIRE(sign);
    sum += sign->acceleration;
    gave_way += sign->gave_way ? 1 : 0;
  }
  CAPTURE(sigma, sum / kStarts);
  CHECK(gave_way > 0.9 * kStarts);
  CHECK(sum / kStarts < 1.0);
  CHECK(sum / kStarts > 0.5);
}

TEST_CASE("A base that is driven sideways and moves less far does not slide") {
  const TwistAt sideways = [](double) { return Twist2{0.0, 0.8, 0.0}; };
  const TwistAt slower = [](double) { return Twist2{0.0, 0.45, 0.0}; };
  const MotionClass entry{"sideways", {0.0, 0.8, 0.0}, {1.0, 1.0}};
  const auto sign = signOf(sideways, entry, slower);
  CHECK_FALSE((sign && sign->gave_way));
}

TEST_CASE("What the gates call impossible, and slopes, say nothing of the ground") {
  Measurement measurement = drivenOn(limited(0.0, 2.0, 0.6));
  const MotionPattern pattern = patternOf(lagging(0.0, 2.0, 0.2));
  for (const Gate gate : {Gate::kSpeed, Gate::kInsGap, Gate::kSlope, Gate::kNotFinite}) {
    measurement.gate = gate;
    CHECK_FALSE(gripSign(measurement, pattern, kRest, kSampling));
  }
  measurement.gate = Gate::kEntryTwist;
  CHECK(gripSign(measurement, pattern, kRest, kSampling));
  measurement.context.tilt.inclination = 0.1;
  CHECK_FALSE(gripSign(measurement, pattern, kRest, kSampling));
}
