// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "modules/identification/core/gap_watch.hpp"
#include "tests/identification/synthetic_drive.hpp"

namespace {

using namespace tread;
using namespace tread::gap;

constexpr double kStretch = 5.0;

/// Data of a watch at the end of a reading: ten seconds before it, and a little after.
Drive recentPart(const Drive& drive, double from) {
  const Segment& all = drive.segments.front();
  const double begin = from - 10.0, end = from + kStretch + 1.5;
  const auto within = [&](const auto& samples, auto& into) {
    const auto earlier = [](const auto& sample, double time) { return sample.time < time; };
    into.assign(std::lower_bound(samples.begin(), samples.end(), begin, earlier),
                std::lower_bound(samples.begin(), samples.end(), end, earlier));
  };
  Drive part;
  part.name = drive.name;
  part.kind = drive.kind;
  part.segments.emplace_back();
  within(all.commands, part.segments.front().commands);
  within(all.ins, part.segments.front().ins);
  part.segments.front().end = std::min(end, all.end);
  return part;
}

std::vector<NoticedGap> watched(const Drive& drive, const ModelDocument& model) {
  GapWatch watch;
  std::vector<NoticedGap> all;
  for (double t = 10.0; t + kStretch + 1.5 < drive.segments.front().end; t += kStretch)
    if (const auto reading = readChanges(recentPart(drive, t), model, t, t + kStretch))
      if (const auto gap = watch.take(*reading)) all.push_back(*gap);
  return all;
}

/// From a time on, the log's commands exceed those that the simulated vehicle got.
void weaken(Drive& drive, size_t side, double from, double gain) {
  for (CommandSample& sample : drive.segments.front().commands)
    if (sample.time >= from) sample.command[side] /= gain;
}

/// Readings of one part that scatter around a mean, all others around 0.
WatchReading scattered(double begin, size_t part, double mean, std::mt19937_64& random) {
  std::normal_distribution<double> gauss(0.0, 0.03);
  WatchReading reading{begin, begin + kStretch, {}, {}};
  for (size_t w = 0; w < kWatched; ++w) {
    reading.change[w] = gauss(random) + (w == part ? mean : 0.0);
    reading.uncertainty[w] = 0.03;
  }
  return reading;
}

TEST_CASE("a drive that gives less is noticed within minutes, with its size and since when") {
  const ModelDocument model = syntheticVehicle();
  Drive drive = syntheticDrive(model, 900.0, 5);
  weaken(drive, 0, 300.0, 0.92);
  const std::vector<NoticedGap> gaps = watched(drive, model);
  REQUIRE(gaps.size() == 1);
  CHECK(gaps[0].part == ChangedPart::kLeftDrive);
  CHECK(gaps[0].since == Approx(300.0).margin(40.0));
  CHECK(gaps[0].noticed < 300.0 + 300.0);
  CHECK(gaps[0].change == Approx(-0.08).margin(std::max(0.01, 3.0 * gaps[0].uncertainty)));
  CHECK(gaps[0].uncertainty < 0.01);
  CHECK_FALSE(gaps[0].as_model);
}

TEST_CASE("what both drives give less is told as one change of both") {
  const ModelDocument model = syntheticVehicle();
  Drive drive = syntheticDrive(model, 700.0, 6);
  weaken(drive, 0, 200.0, 0.9);
  weaken(drive, 1, 200.0, 0.9);
  const std::vector<NoticedGap> gaps = watched(drive, model);
  REQUIRE(gaps.size() == 1);
  CHECK(gaps[0].part == ChangedPart::kBothDrives);
  CHECK(gaps[0].change == Approx(-0.1).margin(0.02));
}

TEST_CASE("commands that act later are told as that") {
  const ModelDocument model = syntheticVehicle();
  Drive drive = syntheticDrive(model, 600.0, 7);
  ModelDocument prompt = model;
  prompt.vehicle.delay = 0.0;
  for (CommandSample& sample : drive.segments.front().commands) sample.time -= 0.12;
  const std::vector<NoticedGap> gaps = watched(drive, prompt);
  REQUIRE(gaps.size() == 1);
  CHECK(gaps[0].part == ChangedPart::kDelay);
  CHECK(gaps[0].change == Approx(0.12).margin(0.02));
}

TEST_CASE("two hours of a vehicle that is its model give no word") {
  const ModelDocument model = syntheticVehicle();
  CHECK(watched(syntheticDrive(model, 7200.0, 8), model).empty());
}

TEST_CASE("what is as the model says again is told once, too") {
  std::mt19937_64 random(9);
  GapWatch watch;
  std::vector<NoticedGap> gaps;
  for (int i = 0; i < 600; ++i) {
    const double change = i >= 100 && i < 300 ? -0.1 : 0.0;
    if (const auto gap = watch.take(scattered(kStretch * i, 1, change, random)))
      gaps.push_back(*gap);
  }
  REQUIRE(gaps.size() == 2);
  CHECK(gaps[0].part == ChangedPart::kRightDrive);
  CHECK_FALSE(gaps[0].as_model);
  CHECK(gaps[1].part == ChangedPart::kRightDrive);
  CHECK(gaps[1].as_model);
  CHECK(gaps[1].since == Approx(300 * kStretch).margin(50.0));
}

TEST_CASE("a clock that begins anew forgets what was read, not what was said") {
  std::mt19937_64 random(12);
  GapWatch watch;
  std::vector<NoticedGap> gaps;
  const auto drive = [&](int from, int to, double change) {
    for (int i = from; i < to; ++i)
      if (const auto gap = watch.take(scattered(kStretch * i, 0, change, random)))
        gaps.push_back(*gap);
  };
  drive(1000, 1200, -0.1);
  REQUIRE(gaps.size() == 1);
  CHECK_FALSE(watch.asModel());
  watch.restart();
  drive(0, 200, -0.1);
  CHECK(gaps.size() == 1);
  drive(200, 400, 0.0);
  REQUIRE(gaps.size() == 2);
  CHECK(gaps[1].as_model);
  CHECK(gaps[1].since == Approx(200 * kStretch).margin(50.0));
  CHECK(watch.asModel());
}

TEST_CASE("false words are rarer than one in the hours that are asked for", "[statistics]") {
  // A change just below the threshold, for which the test is a fair game, and heavy-tailed
  // readings.
  std::mt19937_64 random(10);
  std::student_t_distribution<double> heavy(3.0);
  WatchLimits limits;
  limits.hours = 1.0;
  constexpr int kHours = 400;
  int words = 0;
  for (int hour = 0; hour < kHours; ++hour) {
    GapWatch watch(limits);
    for (int i = 0; i < 720; ++i) {
      WatchReading reading{kStretch * i, kStretch * (i + 1), {}, {}};
      for (size_t w = 0; w < kWatched; ++w) {
        reading.change[w] = 0.02 * heavy(random) + (w == 0 ? limits.gain : 0.0);
        reading.uncertainty[w] = 0.03;
      }
      if (watch.take(reading)) ++words;
    }
  }
  INFO(words << " false words in " << kHours << " hours");
  CHECK(words <= kHours);
}

TEST_CASE("driving that tells nothing of a drive is no evidence") {
  const ModelDocument model = syntheticVehicle();
  Drive drive = syntheticDrive(model, 60.0, 11);
  for (CommandSample& sample : drive.segments.front().commands) sample.command = {};
  for (InsSample& sample : drive.segments.front().ins) {
    sample.T_map_body = {};
    sample.omega = 0.0;
  }
  const auto reading = readChanges(recentPart(drive, 20.0), model, 20.0, 25.0);
  REQUIRE(reading);
  CHECK(reading->change[0] == Approx(0.0).margin(1e-6));
  CHECK(reading->uncertainty[0] == Approx(0.3).margin(1e-3));
  CHECK_FALSE(readChanges(recentPart(drive, 20.0), model, 200.0, 205.0));
}

}  // namespace
