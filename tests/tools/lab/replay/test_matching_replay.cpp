// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>
#include <cstdio>

#include "tests/helpers.hpp"
#include "tests/scan_matching/simulated_drive.hpp"
#include "tools/lab/replay/mapping_recording.hpp"
#include "tools/lab/replay/matching_replay.hpp"

namespace tread::scan_matching {
namespace {

TrackComparison compared(const SimulatedDrive& drive) {
  return compareTracks(drive.poses, [&](int64_t utime) { return drive.trueAt(utime); });
}

double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / std::max(1.0, static_cast<double>(values.size())));
}

double median(std::vector<double> values) {
  REQUIRE_FALSE(values.empty());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// A scan about every metre, 1 s apart, with 80 m range: little is known in between.
ScanMatchingConfig campusConfig() {
  ScanMatchingConfig config;
  config.matcher.points.range_max = 50.0;
  config.matcher.min_points = 15;
  config.matcher.max_position_std = 1.0;
  config.matcher.max_yaw_std = 0.5;
  return config;
}

sim::MotorPower ahead(double t) {
  return t < 1.0 ? sim::MotorPower{0.0, 0.0} : sim::MotorPower{0.8, 0.8};
}

/// Position error along x of the last pose with a published position [m].
double lastKnownError(const SimulatedDrive& drive) {
  double error = 0.0;
  for (const MatchedPose& pose : drive.poses)
    if (const auto truth = drive.trueAt(pose.utime); truth && pose.position_known)
      error = std::abs(pose.T_map_body.x - truth->x);
  return error;
}

}  // namespace

TEST_CASE(
    "in a yard the motion is measured to 2 cm and 5 mrad in 2 s, and the deviations are honest") {
  const SimulatedDrive driven = drive(yard(), {-8.0, 0.0, 0.1}, 25.0, everything);
  const TrackComparison comparison = compared(driven);
  INFO(reportOf(comparison));
  CHECK(driven.count(MatchOutcome::kMatched) >= 245);
  CHECK(comparison.unknown == 0);
  CHECK(rms(comparison.per_2s.position) < 0.02);
  CHECK(rms(comparison.per_2s.yaw) < 0.005);
  CHECK(rms(comparison.per_metre.position) < 0.02);
  CHECK(comparison.per_2s.normalized_position < 1.3);
  CHECK(comparison.per_2s.normalized_yaw < 1.3);
  CHECK(comparison.end_position < 2.0 * comparison.end_position_std + 0.01);
}

TEST_CASE(
    "in a corridor without an end in sight the way along it becomes unknown, the heading not") {
  const SimulatedDrive driven = drive(corridor(), {-60.0, 0.2, 0.0}, 12.0, ahead);
  INFO(reportOf(compared(driven)));
  CHECK(driven.count(MatchOutcome::kUndetermined) >= 115);
  CHECK(driven.count(MatchOutcome::kMatched) <= 1);
  const MatchedPose& last = driven.poses.back();
  CHECK_FALSE(last.position_known);
  CHECK(last.heading_known);
  const Pose2 truth = *driven.trueAt(last.utime);
  CHECK(std::abs(last.T_map_body.yaw - truth.yaw) < 0.02);
  CHECK(std::abs(last.T_map_body.y - truth.y) < 0.05);
  CHECK(last.covariance(0, 0) > 100.0 * last.covariance(1, 1));
  // Earlier errors were within the published uncertainty.
  CHECK(lastKnownError(driven) < 0.6);
}

TEST_CASE("a corridor with an end in sight determines the way along it") {
  sim::WorldDescription world = corridor();
  world.obstacles.push_back(sim::boxObstacle({10.0, 0.0, 0.0}, 0.4, 3.0, 2.0));
  const SimulatedDrive driven = drive(std::move(world), {-2.0, 0.2, 0.0}, 8.0, ahead);
  const TrackComparison comparison = compared(driven);
  INFO(reportOf(comparison));
  CHECK(driven.count(MatchOutcome::kUndetermined) <= 2);
  CHECK(comparison.unknown == 0);
  CHECK(comparison.end_position < 0.03);
}

TEST_CASE("in an open field nothing is claimed") {
  const SimulatedDrive driven = drive({}, {0.0, 0.0, 0.0}, 5.0, ahead);
  CHECK(driven.count(MatchOutcome::kTooFew) == static_cast<int>(driven.poses.size()));
  for (const MatchedPose& pose : driven.poses)
    CHECK_FALSE((pose.position_known || pose.heading_known));
}

TEST_CASE("who drives out of a yard into an open field says so within a second") {
  sim::WorldDescription world;
  world.obstacles = {sim::boxObstacle({-4.0, 2.0, 0.5}, 3.0, 1.0, 2.0),
                     sim::boxObstacle({-3.0, -3.0, -0.3}, 3.0, 1.0, 2.0),
                     sim::discObstacle({0.0, 1.5}, 0.4, 2.0)};
  const SimulatedDrive driven = drive(std::move(world), {-4.0, 0.0, 0.0}, 30.0, ahead);
  CHECK(driven.poses[30].position_known);
  CHECK_FALSE(driven.poses.back().position_known);
  CHECK_FALSE(driven.poses.back().heading_known);
  int64_t last_match = 0;
  for (const MatchedPose& pose : driven.poses) {
    if (pose.outcome == MatchOutcome::kMatched) last_match = pose.utime;
    if (pose.utime > last_match + testing::kSecond) CHECK_FALSE(pose.position_known);
  }
}

TEST_CASE("an MBot that drives a square is measured back to its start") {
  const std::string path = testing::recorded("lcmlogs/mbot2017_sweep/sweep_drive_square.log");
  if (path.empty()) {
    WARN("skipped: the MBot's log is not here (TREAD_RECORDINGS)");
    return;
  }
  const MatchingReplay replay = replayMatching(readMappingRecording(path), {});
  INFO(reportOf(replay));
  CHECK(replay.outcomes.at("matched") >= 123);
  // The whole path, starting and ending at rest: 4.2 m and three quarters of a turn.
  CHECK(replay.comparison.end_position < 0.08);
  CHECK(replay.comparison.end_yaw < 0.03);
}

TEST_CASE("on the Freiburg campus 300 scans a metre apart are matched to 3 cm and 3 mrad a metre") {
  const std::string path = testing::recorded("lidar/carmen/freiburg-campus-corrected.log.gz");
  if (path.empty()) {
    WARN("skipped: the Freiburg log is not here (TREAD_RECORDINGS)");
    return;
  }
  MappingRecording recording = readMappingRecording(path);
  recording.scans.erase(recording.scans.begin(), recording.scans.begin() + 1300);
  recording.scans.resize(300);
  const MatchingReplay replay = replayMatching(recording, campusConfig());
  INFO(reportOf(replay));
  CHECK(replay.outcomes.at("matched") >= 285);
  CHECK(median(replay.comparison.per_metre.position) < 0.03);
  CHECK(median(replay.comparison.per_metre.yaw) < 0.003);
  CHECK(replay.comparison.per_metre.within_two > 0.4);
  // Independent of the reference's own errors.
  CHECK(replay.closure.yaw.size() >= 200);
  CHECK(replay.closure.normalized_position < 1.5);
  CHECK(replay.closure.normalized_yaw < 1.5);
  CHECK(replay.closure.within_two > 0.9);
}

// Not part of the tests: the figures of RESULTS.md.
TEST_CASE("figures of simulated drives", "[.figures]") {
  const auto say = [](const char* name, const SimulatedDrive& driven) {
    std::printf(
        "%s: %zu scans, %d matched, %d undetermined, %d too few, %d do not fit, %.2f ms each, at "
        "most %.2f\n%s",
        name, driven.poses.size(), driven.count(MatchOutcome::kMatched),
        driven.count(MatchOutcome::kUndetermined), driven.count(MatchOutcome::kTooFew),
        driven.count(MatchOutcome::kNoFit),
        driven.cpu_ms / static_cast<double>(driven.poses.size()), driven.most_ms,
        reportOf(compared(driven)).c_str());
  };
  say("yard", drive(yard(), {-8.0, 0.0, 0.1}, 25.0, everything));
  say("corridor", drive(corridor(), {-60.0, 0.2, 0.0}, 30.0, ahead));
  say("open field", drive({}, {0.0, 0.0, 0.0}, 10.0, ahead));
  sim::WorldDescription hills = yard();
  hills.terrain.waves = {{0.15, {0.21, 0.05}, 0.4}, {0.08, {-0.10, 0.30}, 1.1}};
  say("yard on the demo's hills", drive(std::move(hills), {-8.0, 0.0, 0.1}, 25.0, everything));
}

}  // namespace tread::scan_matching
