// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The INS: its noise in a fit, and its faults with the field's signs.
#include <catch2/catch.hpp>

#include <cmath>

#include "tests/study/hide/blind_bench.hpp"

using namespace tread;
using namespace tread::blind;

namespace {

/// A vehicle at rest for some minutes.
Track standing(double minutes) {
  const auto count = static_cast<size_t>(minutes * 60e6 / Track::kStepUs) + 1;
  Track track;
  track.T_map_body.resize(count);
  track.v_body.resize(count);
  track.pitch.resize(count);
  track.roll.resize(count);
  track.height.resize(count);
  return track;
}

/// Deviation of means of `count` samples, in the samples' unit.
double deviationOfMeans(const std::vector<double>& values, size_t count) {
  double square = 0.0;
  size_t means = 0;
  for (size_t i = 0; i + count <= values.size(); i += count, ++means) {
    double mean = 0.0;
    for (size_t k = i; k < i + count; ++k) mean += values[k] / static_cast<double>(count);
    square += mean * mean;
  }
  return std::sqrt(square / static_cast<double>(means));
}

struct Said {
  std::vector<double> x, yaw, rate;
};

Said saidStanding(const NoiseLevel& noise) {
  Said said;
  for (const sim::InsMeasurement& sample : measure(standing(20.0), {}, noise, 3, 0)) {
    said.x.push_back(sample.p_map.x());
    said.yaw.push_back(sample.yaw);
    said.rate.push_back(sample.rate_body.z());
  }
  return said;
}

constexpr double kV = 0.8;      // [m/s]
constexpr double kOmega = 0.6;  // [rad/s]

/// Body velocity according to the INS on a steady circle, over a short time.
Twist2 toldOnCircle(const InstrumentFault& fault) {
  std::vector<Pose2> circle;
  for (int i = 0; i < 1000; ++i) {
    const double yaw = kOmega * i * 0.01;
    circle.push_back({kV / kOmega * std::sin(yaw), kV / kOmega * (1.0 - std::cos(yaw)), yaw});
  }
  constexpr double kShort = 0.01;
  const Pose2 moved =
      between(sensedPose(circle, fault, 5.0), sensedPose(circle, fault, 5.0 + kShort));
  return {moved.x / kShort, moved.y / kShort, moved.yaw / kShort};
}

/// The same with a hidden effect, relative to the truth, and the size in the truth file.
struct Told {
  Twist2 more;
  double size = 0.0;
};

Told toldOf(const std::string& effect) {
  const std::vector<Hidden> hidden = makeHidden({effect}, 2.0, 600.0, 4);
  const Twist2 with = toldOnCircle(faultOf(hidden)), without = toldOnCircle({});
  return {{with.v_x - without.v_x, with.v_y - without.v_y, with.omega - without.omega},
          hidden.front().hider.equivalent.front().value};
}

}  // namespace

TEST_CASE("noise is that of its level, as one pose has it and as a fit of increments sees it") {
  for (const char* level : {"low", "mid", "high"}) {
    CAPTURE(level);
    const NoiseLevel noise = *noiseLevel(level);
    const Said said = saidStanding(noise);
    CHECK(deviationOfMeans(said.rate, 13) == Approx(noise.gyro_bin).epsilon(0.05));
    CHECK(deviationOfMeans(said.x, 1) == Approx(noise.fix).epsilon(0.05));
    CHECK(deviationOfMeans(said.yaw, 1) == Approx(noise.heading).epsilon(0.05));
    // Differences of means over 0.1 s that are 0.4 s apart.
    std::vector<double> increments;
    for (size_t i = 0; i + 26 <= said.x.size(); i += 20) {
      double from = 0.0, to = 0.0;
      for (size_t k = 0; k < 6; ++k) from += said.x[i + k] / 6.0, to += said.x[i + 20 + k] / 6.0;
      increments.push_back(to - from);
    }
    const double seen = deviationOfMeans(increments, 1) / std::sqrt(2.0);
    CHECK(seen > 0.8 * noise.fix);
    CHECK(seen < noise.fix);
  }
}

TEST_CASE("nothing in the noise lasts: means over 20 s are right, of positions and of headings") {
  for (const char* level : {"low", "mid", "high"}) {
    CAPTURE(level);
    const NoiseLevel noise = *noiseLevel(level);
    const Said said = saidStanding(noise);
    CHECK(deviationOfMeans(said.x, 1000) < 0.2 * noise.fix);
    CHECK(deviationOfMeans(said.yaw, 1000) < 0.2 * noise.heading);
  }
}

TEST_CASE("a late heading is heading(t - T_h) beside position(t): it looks like a drift inwards") {
  const Told told = toldOf("heading_latency");
  CHECK(told.size > 0.0);
  CHECK(told.more.v_y == Approx(told.size * kV * kOmega).epsilon(0.02));
  CHECK(told.more.omega == Approx(0.0).margin(1e-6));
  InstrumentFault fault;
  fault.heading_latency = 0.1;
  std::vector<Pose2> turning;
  for (int i = 0; i < 300; ++i) turning.push_back({0.0, 0.0, 0.5 * i * 0.01});
  CHECK(sensedPose(turning, fault, 2.0).yaw == Approx(0.5 * 1.9));
}

TEST_CASE("a lever arm ahead takes from the sideways speed as a centre of rotation ahead does") {
  const Told along = toldOf("lever_arm_x");
  CHECK(along.more.v_y == Approx(-along.size * kOmega).epsilon(0.01));
  CHECK(along.more.v_x == Approx(0.0).margin(1e-3));
  const Told across = toldOf("lever_arm_y");
  CHECK(across.more.v_x == Approx(across.size * kOmega).epsilon(0.01));
}

TEST_CASE("an INS askew gives sideways speed in proportion to speed, a scale speed") {
  const Told askew = toldOf("heading_misalignment");
  CHECK(askew.more.v_y == Approx(askew.size * kV).epsilon(0.02));
  const Told scale = toldOf("position_scale");
  CHECK(scale.more.v_x == Approx(scale.size * kV).epsilon(0.01));
}

TEST_CASE("a vehicle that crabs looks like an INS askew") {
  const std::vector<Hidden> crab = makeHidden({"crab"}, 2.0, 600.0, 4);
  const Twist2 slid = crab.front().hider.slide({}, {kV, 0.0, kOmega});
  const Told askew = toldOf("heading_misalignment");
  CHECK(slid.v_y == Approx(crab.front().hider.equivalent.front().value * kV).epsilon(0.001));
  CHECK(slid.v_y == Approx(askew.more.v_y).epsilon(0.02));
}
