// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <random>

#include "modules/identification/core/end_errors.hpp"

using namespace tread;
using namespace tread::gap;

namespace {

/// Two minutes of changing speeds: it drifts outwards in turns by 0.2 s v omega; ground speed is
/// 0.9 of the encoders', the gyro reads 1.05 times the truth minus 0.02 rad/s, poses are 0.3 s late
/// with `noise` [m].
Drive makeDrive(double noise) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::normal_distribution<double> normal;
  Drive drive;
  Segment segment;
  segment.end = 120.0;
  Pose2 T_map_body;
  std::vector<Pose2> past;
  double v = 0.0, omega = 0.0, v_wanted = 0.0, omega_wanted = 0.0;
  for (int i = 0; i < 6000; ++i) {
    const double time = 0.02 * i;
    if (i % 100 == 0) {
      v_wanted = uniform(random);
      omega_wanted = uniform(random);
      segment.commands.push_back({time, {v_wanted, v_wanted + omega_wanted}});
    }
    v += 0.05 * (v_wanted - v);
    omega += 0.05 * (omega_wanted - omega);
    past.push_back(T_map_body);
    InsSample sample;
    sample.time = time;
    sample.omega = 1.05 * omega - 0.02;
    sample.T_map_body = {kNotMeasured, kNotMeasured, kNotMeasured};
    if (i % 5 == 0) {
      sample.T_map_body = past[past.size() > 15 ? past.size() - 16 : 0];
      sample.T_map_body.x += noise * normal(random);
    }
    segment.ins.push_back(sample);
    if (i % 3 == 0)
      drive.encoders.push_back({time, {v / 0.9 - 0.1 * omega, v / 0.9 + 0.1 * omega}});
    T_map_body = T_map_body * integrate({v, -0.2 * v * omega, omega}, 0.02);
  }
  drive.segments.push_back(std::move(segment));
  for (int n = 1; n < 58; ++n) drive.executions.push_back({0, 2.0 * n, 2.0 * n + 2.0});
  return drive;
}

}  // namespace

TEST_CASE("scales and lags of encoders and gyro are found") {
  const auto fit = fitReckoning(makeDrive(0.002));
  REQUIRE(fit);
  REQUIRE(fit->speed == Approx(0.9).margin(0.01));
  REQUIRE(fit->turning == Approx(1.0 / 1.05).margin(0.01));
  REQUIRE(fit->drift == Approx(0.02 / 1.05).margin(0.003));
  REQUIRE(fit->turning_lag == Approx(0.3).margin(0.03));
  REQUIRE(fit->sideways == Approx(-0.2).margin(0.02));
  REQUIRE(fit->speed_lag == Approx(0.3).margin(0.05));
}

TEST_CASE("the floor is as low as the poses are noisy") {
  const auto quiet = deadReckoningFloor({makeDrive(0.0)});
  REQUIRE(quiet);
  REQUIRE(quiet->executions == 57);
  REQUIRE(quiet->position.rms < 0.03);
  REQUIRE(quiet->yaw.rms < 0.02);
  const auto noisy = deadReckoningFloor({makeDrive(0.0), makeDrive(0.1)});
  REQUIRE(noisy->executions == 114);
  REQUIRE(noisy->position.rms == Approx(0.1).margin(0.03));
}

TEST_CASE("there is no floor without encoders, without a gyro or without poses") {
  REQUIRE_FALSE(deadReckoningFloor({}));
  REQUIRE_FALSE(deadReckoningFloor({Drive{}}));
  Drive no_encoders = makeDrive(0.0);
  no_encoders.encoders.clear();
  REQUIRE_FALSE(deadReckoningFloor({no_encoders}));
  Drive no_gyro = makeDrive(0.0);
  for (InsSample& sample : no_gyro.segments[0].ins) sample.omega = kNotMeasured;
  REQUIRE_FALSE(deadReckoningFloor({no_gyro}));
  Drive no_poses = makeDrive(0.0);
  for (InsSample& sample : no_poses.segments[0].ins) sample.T_map_body.x = kNotMeasured;
  REQUIRE_FALSE(deadReckoningFloor({no_poses}));
}

TEST_CASE("the floor does not depend on where in the world a drive was driven, nor on when") {
  const Drive drive = makeDrive(0.05);
  Drive moved = drive;
  const Pose2 T_world_map{250.0, -70.0, 2.1};
  for (InsSample& sample : moved.segments[0].ins) {
    sample.T_map_body = T_world_map * sample.T_map_body;
    sample.time += 1000.0;
  }
  for (CommandSample& sample : moved.segments[0].commands) sample.time += 1000.0;
  for (EncoderSample& sample : moved.encoders) sample.time += 1000.0;
  for (Execution& execution : moved.executions) {
    execution.begin += 1000.0;
    execution.end += 1000.0;
  }
  moved.segments[0].end += 1000.0;
  const auto here = deadReckoningFloor({drive});
  const auto there = deadReckoningFloor({moved});
  REQUIRE(here);
  REQUIRE(there);
  CHECK(there->executions == here->executions);
  CHECK(there->position.rms == Approx(here->position.rms).epsilon(0.05));
  CHECK(there->yaw.median == Approx(here->yaw.median).margin(0.001));
}

TEST_CASE("an execution where encoders, gyro or poses are missing has no error") {
  const Drive whole = makeDrive(0.0);
  Drive gyro = whole;
  for (InsSample& sample : gyro.segments[0].ins)
    if (sample.time > 60.0 && sample.time < 66.0) sample.omega = kNotMeasured;
  Drive poses = whole;
  for (InsSample& sample : poses.segments[0].ins)
    if (sample.time > 60.0 && sample.time < 66.0) sample.T_map_body.x = kNotMeasured;
  Drive encoders = whole;
  auto& speeds = encoders.encoders;
  speeds.erase(
      std::remove_if(speeds.begin(), speeds.end(),
                     [](const EncoderSample& e) { return e.time > 60.0 && e.time < 66.0; }),
      speeds.end());
  for (const Drive& drive : {gyro, poses, encoders}) {
    const auto floor = deadReckoningFloor({drive});
    REQUIRE(floor);
    CHECK(floor->executions <= 57 - 2);
    CHECK(floor->executions >= 57 - 5);
    CHECK(floor->position.rms < 0.03);
  }
}

TEST_CASE("scales are those of most of the drive: a few wild fixes do not move them") {
  const auto clean = fitReckoning(makeDrive(0.0));
  Drive wild = makeDrive(0.0);
  auto& ins = wild.segments[0].ins;
  for (size_t i = 500; i < ins.size(); i += 1000) ins[i].T_map_body.x += 0.5;
  const auto fit = fitReckoning(wild);
  REQUIRE(clean);
  REQUIRE(fit);
  CHECK(fit->speed == Approx(clean->speed).epsilon(0.02));
  CHECK(fit->turning == Approx(clean->turning).epsilon(0.02));
  CHECK(fit->sideways == Approx(clean->sideways).margin(0.03));
}
