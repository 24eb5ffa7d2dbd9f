// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "modules/learner/core/shock_learner.hpp"

using namespace tread;
using namespace tread::learner;

namespace {

constexpr double kArm = 0.65;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Drives along x over ground with a given slope [1]; the body has the slope under its origin.
struct Driver {
  std::function<double(double)> slope = [](double) { return 0.0; };
  double noise = 0.0;  ///< of the rise, standard deviation [1]
  bool with_velocity = true;
  double x = 0.0;
  int64_t utime = 5'000'000;
  std::mt19937_64 random{3};

  BodyMotion at(double speed) {
    std::normal_distribution<double> normal;
    const double rise = slope(x) + noise * normal(random);
    return {
        utime, {x, 0.0}, rise, with_velocity ? speed : kNan, with_velocity ? speed * rise : kNan};
  }
  /// Calls `take` with measurements at 50 Hz.
  template <class Take>
  void drive(double speed, double seconds, Take&& take) {
    for (double t = 0.0; t < seconds; t += 0.02, utime += 20'000, x += 0.02 * speed)
      take(at(speed));
  }
};

/// Waves of 1.2 m, `height` [m] their amplitude.
std::function<double(double)> waves(double height) {
  return [height](double x) {
    const double k = 2.0 * M_PI / 1.2;
    return height * k * std::cos(k * x);
  };
}

/// RMS of the vertical acceleration of the front end on such waves, analytically.
double trueShock(double height, double speed) {
  const double k = 2.0 * M_PI / 1.2;
  const double origin = height * k * k * speed * speed;               // -sin
  const double pitching = kArm * height * k * k * k * speed * speed;  // -cos
  return std::hypot(origin, pitching) / std::sqrt(2.0);
}

std::vector<FeltSegment> felt(Driver& driver, double speed, double seconds) {
  FeltShock shock(kArm);
  std::vector<FeltSegment> segments;
  driver.drive(0.0, 4.0, [&](const BodyMotion& m) { shock.take(m); });
  driver.drive(speed, seconds, [&](const BodyMotion& m) {
    if (const auto segment = shock.take(m)) segments.push_back(*segment);
  });
  return segments;
}

double meanShock(const std::vector<FeltSegment>& segments) {
  double squares = 0.0;
  for (const FeltSegment& segment : segments) squares += segment.shock * segment.shock;
  return std::sqrt(squares / static_cast<double>(segments.size()));
}

/// A tile of 32 cells of 10 cm with equal cost.
Tile tileOf(int x, Cell cost) {
  return {x, 0, 1, std::vector<Cell>(32 * 32, cost)};
}

}  // namespace

TEST_CASE("felt shock is what the front end's acceleration really is") {
  for (const bool with_velocity : {true, false}) {
    Driver driver;
    driver.slope = waves(0.01);
    driver.noise = 0.001;
    driver.with_velocity = with_velocity;
    const auto segments = felt(driver, 0.6, 60.0);
    REQUIRE(segments.size() > 30);
    CHECK(meanShock(segments) == Approx(trueShock(0.01, 0.6)).epsilon(0.15));
    CHECK(segments[5].speed == Approx(0.6).epsilon(0.02));
    CHECK(segments[5].peak > segments[5].shock);
    CHECK(segments[5].pitch_rate > 0.05);
  }
}

TEST_CASE("what the INS shows while standing is not felt while driving") {
  Driver driver;
  driver.noise = 0.003;
  const auto segments = felt(driver, 1.0, 60.0);
  REQUIRE(segments.size() > 40);
  // Otherwise noise alone would be 0.65 m x sqrt(6 / 5) x 0.003 / (0.1 s)^2 = 0.2 m/s2.
  FeltShock shock(kArm);
  driver.drive(0.0, 20.0, [&](const BodyMotion& m) { shock.take(m); });
  CHECK(std::sqrt(shock.noise()) == Approx(0.21).epsilon(0.25));
  CHECK(meanShock(segments) < 1.5 * std::sqrt(shock.noise()));
}

TEST_CASE("a gap or a lost attitude ends a segment without a shock of its own") {
  FeltShock shock(kArm);
  Driver driver;
  double worst = 0.0;
  int segments = 0;
  const auto take = [&](const BodyMotion& m) {
    if (const auto segment = shock.take(m)) {
      worst = std::max(worst, segment->shock);
      ++segments;
    }
  };
  for (int i = 0; i < 20; ++i) {
    driver.drive(1.0, 2.7, take);
    driver.utime += 700'000;  // on another slope after each gap
    const double slope = i % 2 == 0 ? 0.2 : 0.0;
    driver.slope = [slope](double) { return slope; };
    shock.take({driver.utime, {driver.x, 0.0}, kNan, 1.0, 0.0});
    shock.take({driver.utime - 5'000'000, {driver.x, 0.0}, 0.5, 1.0, 0.0});  // an old one
  }
  CHECK(segments >= 20);
  CHECK(worst < 0.02);
}

TEST_CASE("what is felt teaches what was seen there") {
  ShockLearner learner(kArm);
  // Alternating rough and smooth ground, 6.4 m each: seen as 12 mm and as 1 mm.
  Driver driver;
  driver.x = 0.1;
  driver.slope = [](double x) { return static_cast<int>(x / 6.4) % 2 == 0 ? waves(0.01)(x) : 0.0; };
  const double before = std::sqrt(learner.model().meanSquare(0.012, 0.6));
  driver.drive(0.6, 180.0, [&](const BodyMotion& m) {
    const int ahead = static_cast<int>((m.p_map.x() + 3.0) / 3.2);
    for (const int x : {ahead - 1, ahead})
      REQUIRE(learner.takeTile(tileOf(x, x / 2 % 2 == 0 ? 12 : 1), 0.1, 32));
    learner.take(m);
  });
  CHECK(learner.pairs() > 40);
  const ShockModel model = learner.model();
  const double truth = trueShock(0.01, 0.6);
  CHECK(std::abs(std::log(std::exp(model.mean[0] + model.mean[1] * std::log(1.2)) *
                          model.speedFactor(0.6) / truth)) < 0.25);
  CHECK(model.covariance(0, 0) < 0.2 * ShockModel().covariance(0, 0));
  CHECK(before > 0.0);
}

TEST_CASE("shock felt just now tells the ground where nothing was seen") {
  ShockLearner learner(kArm);
  CHECK(std::isnan(learner.here()));
  Driver driver;
  driver.slope = [](double x) { return x < 30.0 ? waves(0.01)(x) : 0.0; };
  driver.drive(0.6, 45.0, [&](const BodyMotion& m) { learner.take(m); });
  CHECK(learner.pairs() == 0);
  CHECK(learner.here() * learner.model().speedFactor(0.6) ==
        Approx(trueShock(0.01, 0.6)).epsilon(0.3));
  driver.drive(0.6, 30.0, [&](const BodyMotion& m) { learner.take(m); });
  CHECK(learner.here() < 0.15 * trueShock(0.01, 0.6));
  learner.restart();
  CHECK(std::isnan(learner.here()));
}

TEST_CASE("a malformed tile is refused") {
  ShockLearner learner(kArm);
  CHECK_FALSE(learner.takeTile({0, 0, 1, std::vector<Cell>(7, 1)}, 0.1, 32));
  CHECK_FALSE(learner.takeTile(tileOf(0, 1), 0.0, 32));
  CHECK(learner.seenAlong({{0.0, 0.0}}) == 0.0);
}
