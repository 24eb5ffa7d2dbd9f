// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// A surface's estimates from its measurements.
#include <catch2/catch.hpp>

#include <memory>

#include <Eigen/Cholesky>

#include "modules/learner/core/rules/ground_scales.hpp"
#include "tests/helpers.hpp"
#include "tests/learner/drawn_ground.hpp"

using namespace tread;
using namespace tread::learner;
using namespace tread::learner::samples;
using tread::testing::effort;

namespace {

struct Fixture {
  explicit Fixture(const GroundConfig& changed = {})
      : config(changed), model(std::make_shared<GroundModel>(changed, richSet())) {
    prior.centre = SetCorrection::none(model->patterns());
    prior.velocity = velocityScalesOfNewGround(1.0);
    prior.yaw = yawScalesOfNewGround(model->scale().lever, 1.0);
    prior.scatter = Eigen::Matrix3Xd::Ones(3, static_cast<Eigen::Index>(model->patterns()));
  }
  Surface surface() const { return {model, config, prior}; }
  /// An execution on the shipped ground, with a variance relative to the expected one.
  TwistSample sample(size_t pattern, double noise, std::mt19937_64& random) const {
    const PatternPart& part = model->whole(pattern);
    Eigen::Vector3d by_chance = (noise * part.noise).cwiseSqrt();
    for (double& number : by_chance) number *= chanceOf(random);
    return {part, part.mean + part.toBody() * by_chance};
  }

  GroundConfig config;
  std::shared_ptr<const GroundModel> model;
  SurfacePrior prior;
};

/// The same for executions with the known scatter: one factor on the noise.
Fixture ofKnownNoise() {
  Fixture fixture;
  const auto keep = [](auto& scales) {
    double total = 0.0;
    for (auto each = scales.begin(); each != scales.end();)
      each = each->noise == 1.0 ? each + 1 : scales.erase(each);
    for (const auto& scale : scales) total += scale.weight;
    for (auto& scale : scales) scale.weight /= total;
  };
  keep(fixture.prior.velocity);
  keep(fixture.prior.yaw);
  return fixture;
}

}  // namespace

TEST_CASE("the order in which the same was measured does not matter but for the noise's step") {
  const Fixture f;
  std::mt19937_64 random(2);
  std::vector<TwistSample> samples;
  for (int i = 0; i < 40; ++i)
    samples.push_back(f.sample(random() % f.model->patterns(), 1.0, random));
  Surface forwards = f.surface();
  Surface backwards = f.surface();
  for (const TwistSample& sample : samples) forwards.add(f.config, sample);
  std::reverse(samples.begin(), samples.end());
  for (const TwistSample& sample : samples) backwards.add(f.config, sample);
  const SetCorrection &one = forwards.correction(), &other = backwards.correction();
  REQUIRE((one.common - other.common).cwiseAbs().maxCoeff() < 2e-3);
  REQUIRE((one.own - other.own).cwiseAbs().maxCoeff() < 2e-3);
  REQUIRE((forwards.noise() - backwards.noise()).cwiseAbs().maxCoeff() < 0.02);
}

TEST_CASE("a surface learns its own noise, calm or rough, each velocity for itself",
          "[statistics]") {
  const Fixture f = ofKnownNoise();
  for (const double factor : {0.25, 1.0, 4.0, 12.0}) {
    INFO("variance " << factor << " times the expected one");
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    const int seeds = 40;
    for (int seed = 1; seed <= seeds; ++seed) {
      std::mt19937_64 random(static_cast<uint64_t>(seed));
      Surface surface = f.surface();
      for (int i = 0; i < 100; ++i) {
        TwistSample sample = f.sample(random() % f.model->patterns(), factor, random);
        // Across its path each pattern scatters as expected.
        Eigen::Vector3d apart = sample.deviation();
        apart[1] = std::sqrt(sample.part.noise[1]) * chanceOf(random);
        sample.mean_twist = sample.part.mean + sample.part.toBody() * apart;
        surface.add(f.config, sample);
      }
      mean += surface.noise() / seeds;
    }
    // 100 executions, and the expected noise counts as 5.
    const double expected = (100.0 * factor + 5.0) / 105.0;
    REQUIRE(mean[0] == Approx(expected).epsilon(0.15));
    REQUIRE(mean[2] == Approx(expected).epsilon(0.15));
    REQUIRE(mean[1] == Approx(1.0).epsilon(0.15));
  }
}

TEST_CASE("executions beyond the longest memory fade, so that a surface may change slowly") {
  GroundConfig config;
  config.longest_memory = 20.0;
  const Fixture f(config);
  Surface surface = f.surface();
  TwistSample sample{f.model->whole(kAhead), f.model->whole(kAhead).mean};
  for (int i = 0; i < 500; ++i) surface.add(f.config, sample);
  REQUIRE(surface.executions() == 20.0);
  sample.mean_twist[0] *= 1.1;
  for (int i = 0; i < 60; ++i) surface.add(f.config, sample);
  REQUIRE(surface.executions() == 20.0);
  // 20 of 20 decay by 20/21 each: .95 of the given value.
  REQUIRE(surface.correction().added(sample.part)[0] == Approx(0.1).epsilon(0.15));
}

TEST_CASE("a surface stays symmetric, positive definite and finite, absurd or not") {
  const Fixture f;
  for (const double scale : {0.05, 3.0, 1e5}) {
    INFO(scale);
    Surface surface = f.surface();
    std::mt19937_64 random(6);
    for (int i = 0; i < effort(3000); ++i) {
      const size_t p = random() % f.model->patterns();
      TwistSample sample{f.model->whole(p), f.model->whole(p).mean};
      for (double& number : sample.mean_twist)
        number += (i % 5 == 0 ? scale : 0.05) * chanceOf(random);
      sample.mean_twist = plausible(sample.mean_twist);
      surface.add(f.config, sample);
      if (i % 50 != 0) continue;
      const Moments moments = surface.expected(sample.part);
      const Eigen::Matrix3d& P = moments.covariance;
      REQUIRE((P - P.transpose()).norm() <= 1e-12 * P.norm());
      REQUIRE((P + 1e-12 * P.norm() * Eigen::Matrix3d::Identity()).llt().info() == Eigen::Success);
      REQUIRE(moments.mean.allFinite());
      REQUIRE(std::isfinite(surface.logDensity(sample, Eigen::Vector3d::Zero())));
      REQUIRE(surface.noise().minCoeff() >= 0.05);
      REQUIRE(surface.noise().maxCoeff() <= kMostNoise);
    }
  }
}

namespace {

/// An execution on the shipped ground with an entry twist that differs from the class's by
/// `beside`, for some seconds.
TwistSample enteredWith(const Fixture& f, size_t pattern, const Eigen::Vector3d& beside,
                        double seconds, std::mt19937_64& random) {
  TwistSample sample = f.sample(pattern, 1.0, random);
  sample.mean_twist += seconds * sample.part.settling * beside;
  sample.entry = beside;
  return sample;
}

Eigen::Vector3d drawnEntry(std::mt19937_64& random) {
  return {0.3 * chanceOf(random), 0.1 * chanceOf(random), 0.5 * chanceOf(random)};
}

}  // namespace

TEST_CASE("what executions were entered with is neither the ground's nor chance") {
  const Fixture f;
  Eigen::Vector3d told = Eigen::Vector3d::Zero(), not_told = told, on_slides = told;
  double explained = 0.0;
  const Eigen::Vector3d kSlide(0.6, 0.3, 0.9);
  constexpr int kSeeds = 20;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    std::mt19937_64 random(static_cast<uint64_t>(seed));
    Surface surface = f.surface(), without = f.surface();
    for (int i = 0; i < 60; ++i) {
      TwistSample sample =
          enteredWith(f, random() % f.model->patterns(), drawnEntry(random), 0.5, random);
      surface.add(f.config, sample);
      sample.entry.setConstant(std::nan(""));
      without.add(f.config, sample);
    }
    told += surface.noise() / kSeeds;
    not_told += without.noise() / kSeeds;
    // The next one, after a slide.
    const TwistSample slide = enteredWith(f, kAhead, kSlide, 0.5, random);
    const TwistSample usual = surface.asUsual(slide);
    on_slides += (usual.deviation() - surface.expected(usual.part).mean).cwiseAbs() / kSeeds;
    explained += (surface.logDensity(slide, Eigen::Vector3d::Zero()) -
                  without.logDensity(slide, Eigen::Vector3d::Zero())) /
                 kSeeds;
  }
  REQUIRE(explained > 2.0);
  const PatternPart& ahead = f.model->whole(kAhead);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    CAPTURE(axis);
    REQUIRE(told[axis] < 0.7 * not_told[axis]);
    // Relative to the effect of such a slide.
    REQUIRE(on_slides[axis] < 0.6 * 0.5 * ahead.settling * kSlide[axis]);
  }
}

TEST_CASE("an entry that is the same every time is what is usual there, and predicted") {
  const Fixture f;
  std::mt19937_64 random(4);
  const Eigen::Vector3d always(0.3, 0.0, 0.0);
  Surface surface = f.surface();
  for (int i = 0; i < 60; ++i)
    surface.add(f.config, enteredWith(f, random() % f.model->patterns(), always, 0.4, random));
  const PatternPart& ahead = f.model->whole(kAhead);
  REQUIRE(surface.expected(ahead).mean[0] == Approx(0.4 * ahead.settling * always[0]).epsilon(0.3));
}

TEST_CASE("a prediction is less sure where what comes before it differs more") {
  const Fixture f;
  std::mt19937_64 random(5);
  Surface calm = f.surface(), slippery = f.surface();
  for (int i = 0; i < 60; ++i) {
    const size_t p = random() % f.model->patterns();
    calm.add(f.config, enteredWith(f, p, Eigen::Vector3d::Zero(), 0.5, random));
    slippery.add(f.config, enteredWith(f, p, drawnEntry(random), 0.5, random));
  }
  const PatternPart& ahead = f.model->whole(kAhead);
  REQUIRE(slippery.executionNoise(ahead)[0] > 2.0 * calm.executionNoise(ahead)[0]);
  REQUIRE(slippery.executionNoise(ahead)[2] > 2.0 * calm.executionNoise(ahead)[2]);
}

TEST_CASE("no measured twist counts as more than a vehicle can drive") {
  REQUIRE(plausible({1e300, -1e300, 99.0}) == Eigen::Vector3d(100.0, -100.0, 99.0));
}
