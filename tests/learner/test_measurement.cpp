// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>
#include <functional>

#include "common/execution/measurement.hpp"
#include "tests/helpers.hpp"
#include "tests/learner/samples.hpp"

using namespace tread;
using namespace tread::learner;
using namespace tread::learner::samples;

namespace {

constexpr int64_t kStart = 10'000'000;
using tread::testing::kSecond;
constexpr int64_t kPeriod = 50'000;

/// A robot that cruises at 1 m/s until kStart and then turns left, measured by an INS at 50 Hz.
struct Drive {
  Pose2 T_map_start{3.0, -2.0, 2.9};  // the turn passes +-pi
  Twist2 cruise{1.0, 0.0, 0.0};
  Twist2 turn{0.9, 0.0, 0.5};
  double inclination = 0.02;
  int64_t from = kStart - kSecond;
  int64_t until = kStart + 2 * kSecond;
  std::function<bool(int64_t)> heard = [](int64_t) { return true; };

  Pose2 at(int64_t utime) const {
    const double t = static_cast<double>(utime - kStart) * 1e-6;
    return T_map_start * integrate(t < 0.0 ? cruise : turn, t);
  }
  TrackHistory history() const {
    TrackHistory made(60 * kSecond);
    for (int64_t utime = from; utime <= until; utime += 20'000) {
      Pose2 pose = at(utime);
      pose.yaw = wrapAngle(pose.yaw);
      if (heard(utime)) made.push(utime, pose, Tilt{inclination}, false);
    }
    return made;
  }
};

ExecutionCut completed() {
  ExecutionCut cut;
  cut.started = kStart;
  cut.ended = kStart + kSecond;
  cut.outcome = ExecutionOutcome::kCompleted;
  return cut;
}

MeasurementLimits limits() {
  MeasurementLimits made;
  made.max_speed = 1.1;
  return made;
}

Measurement measured(const Drive& drive, const ExecutionCut& cut = completed(),
                     const MeasurementLimits& limit = limits(), int id = kLeft) {
  const PatternSet set = smallSet();
  return measure(drive.history(), cut, *set.find(id), set.classNamed("cruise"), kPeriod, limit);
}

}  // namespace

TEST_CASE("an execution is cut at its start and interpolated at the pattern's sample times") {
  const Measurement result = measured({});
  REQUIRE(result.reason.empty());
  REQUIRE(result.fair());
  REQUIRE(result.complete());
  const auto truth = arc({0.9, 0.0, 0.5});
  REQUIRE(result.trajectory.size() == truth.size());
  for (size_t t = 0; t < truth.size(); ++t) {
    REQUIRE(result.trajectory[t].x == Approx(truth[t].x).margin(1e-9));
    REQUIRE(result.trajectory[t].y == Approx(truth[t].y).margin(1e-9));
    REQUIRE(result.trajectory[t].yaw == Approx(truth[t].yaw).margin(1e-9));
  }
  REQUIRE(result.context.entry.v_x == Approx(1.0));
  REQUIRE(result.context.tilt.inclination == Approx(0.02));
  REQUIRE(result.path_length == Approx(0.9).epsilon(1e-3));
}

TEST_CASE("yaw is unwrapped along a pattern that turns more than once around") {
  Drive drive;
  drive.turn = {0.0, 0.0, 7.0};
  const Measurement result = measured(drive, completed(), limits(), kSpin);
  REQUIRE(result.trajectory.back().yaw == Approx(7.0));
}

TEST_CASE("an execution that was aborted is refused with its reason") {
  ExecutionCut cut = completed();
  cut.outcome = ExecutionOutcome::kAborted;
  cut.reason = {StopReason::kProgramLate, "lease expired"};
  const Measurement result = measured({}, cut);
  REQUIRE(result.gate == Gate::kAborted);
  REQUIRE(result.reason == "aborted: lease expired");
}

TEST_CASE("an execution whose motors got other commands is refused") {
  ExecutionCut cut = completed();
  cut.unexpected_command = "command 3 was another";
  REQUIRE(measured({}, cut).gate == Gate::kCommands);
}

TEST_CASE("a record whose duration is not the pattern's is refused") {
  ExecutionCut cut = completed();
  cut.ended = kStart + 2 * kSecond;
  REQUIRE(measured({}, cut).gate == Gate::kRecord);
  cut.ended = kStart - 1;
  REQUIRE(measured({}, cut).gate == Gate::kRecord);
}

TEST_CASE("without INS at its start an execution cannot be placed") {
  Drive drive;
  drive.from = kStart + 100'000;
  REQUIRE(measured(drive).gate == Gate::kNoTrack);
}

TEST_CASE("an INS gap above 0.3 s is refused, one of 0.3 s is not") {
  Drive drive;
  drive.heard = [](int64_t utime) {
    return utime <= kStart + 400'000 || utime >= kStart + 700'000;
  };
  REQUIRE(measured(drive).fair());
  drive.heard = [](int64_t utime) {
    return utime <= kStart + 400'000 || utime >= kStart + 720'000;
  };
  const Measurement result = measured(drive);
  REQUIRE(result.gate == Gate::kInsGap);
  REQUIRE(result.reason == "INS silent for 0.320 s, allowed 0.300 s");
}

TEST_CASE("below 80 percent of the covered time an execution is refused") {
  Drive drive;
  drive.until = kStart + 780'000;
  const Measurement result = measured(drive);
  REQUIRE(result.gate == Gate::kCoveredTime);
  REQUIRE(result.covered == 15);
}

TEST_CASE("what the INS did not cover moves on as predicted, so that nothing is learned there") {
  Drive drive;
  drive.until = kStart + 820'000;
  drive.turn = {0.8, 0.0, 0.6};
  const Measurement result = measured(drive);
  REQUIRE(result.fair());
  REQUIRE_FALSE(result.complete());
  REQUIRE(result.covered == 16);
  const MotionPattern left = *smallSet().find(kLeft);
  const Pose2 predicted_rest = between(left.trajectory[15], left.trajectory[19]);
  const Pose2 rest = between(result.trajectory[15], result.trajectory[19]);
  REQUIRE(rest.x == Approx(predicted_rest.x));
  REQUIRE(rest.y == Approx(predicted_rest.y));
  REQUIRE(rest.yaw == Approx(predicted_rest.yaw));
}

TEST_CASE("an INS jump ends the track: the execution across it is not measured") {
  TrackHistory history(60 * kSecond);
  const Drive drive;
  for (int64_t utime = drive.from; utime <= drive.until; utime += 20'000)
    history.push(utime, drive.at(utime), Tilt{}, utime == kStart + 500'000);
  const PatternSet set = smallSet();
  const Measurement result =
      measure(history, completed(), *set.find(kLeft), set.classNamed("cruise"), kPeriod, limits());
  REQUIRE(result.gate == Gate::kCoveredTime);
}

TEST_CASE("a speed above one and a half times the maximum is a jump, not motion") {
  Drive drive;
  drive.turn = {1.7, 0.0, 0.5};
  const Measurement result = measured(drive);
  REQUIRE(result.gate == Gate::kSpeed);
  REQUIRE(result.reason == "measured 1.70 m/s, possible 1.65 m/s");
}

TEST_CASE("poses that are not finite never become part of a track") {
  TrackHistory history(kSecond);
  REQUIRE(history.push(1, {}, Tilt{}, false));
  REQUIRE_FALSE(history.push(2, {kNan, 0.0, 0.0}, Tilt{}, false));
  REQUIRE_FALSE(history.push(3, {0.0, 0.0, kNan}, Tilt{}, true));
  REQUIRE(history.newest() == 1);
}

TEST_CASE("a robot that did not move although it should have is refused") {
  Drive drive;
  drive.turn = {0.01, 0.0, 0.005};
  REQUIRE(measured(drive).gate == Gate::kNoMotion);
}

TEST_CASE("ice is not an outlier: a tenth of the predicted motion is learned from") {
  Drive drive;
  drive.turn = {0.09, 0.02, 0.05};
  REQUIRE(measured(drive).fair());
}

TEST_CASE("an execution that did not begin in the pattern's class is refused") {
  Drive standing;
  standing.cruise = {0.0, 0.0, 0.0};
  REQUIRE(measured(standing).gate == Gate::kEntryTwist);
  Drive turning;
  turning.cruise = {1.0, 0.0, 0.7};
  const Measurement result = measured(turning);
  REQUIRE(result.gate == Gate::kEntryTwist);
  REQUIRE(result.reason.find("cruise") != std::string::npos);
  Drive slower;
  slower.cruise = {0.75, 0.05, 0.1};
  REQUIRE(measured(slower).fair());
}

TEST_CASE("an entry twist that was not measured is refused, unless any entry is allowed") {
  Drive drive;
  drive.from = kStart - 40'000;
  REQUIRE(measured(drive).gate == Gate::kEntryTwist);
  MeasurementLimits any = limits();
  any.entry_speed = any.entry_yaw_rate = std::numeric_limits<double>::infinity();
  REQUIRE(measured(drive, completed(), any).fair());
}

TEST_CASE("steep ground is refused, ground of unknown slope is not") {
  Drive drive;
  drive.inclination = 0.25;
  REQUIRE(measured(drive).gate == Gate::kSlope);
  drive.inclination = kNan;
  REQUIRE(measured(drive).fair());
}

TEST_CASE("the track keeps its turns where the INS wraps yaw") {
  TrackHistory history(60 * kSecond);
  for (int i = 0; i <= 100; ++i)
    history.push(i * 20'000 + 1, {0.0, 0.0, wrapAngle(0.1 * i)}, Tilt{}, false);
  REQUIRE(history.covering(1)->poses().back().T_map_body.yaw == Approx(10.0));
}

TEST_CASE("the largest speed of a set is that of its fastest class, command or step") {
  REQUIRE(largestSpeed(smallSet()) == Approx(1.0));
  PatternSetContent content = smallContent();
  content.channels = trackChannels(CommandKind::kTrackSpeed);
  content.patterns[0].commands.assign(20, {2.0, 3.0});
  REQUIRE(largestSpeed(checked(content)) == Approx(2.5));
}

TEST_CASE("the beginning of an execution is measured as far as it was driven") {
  ExecutionCut cut = completed();
  cut.outcome = ExecutionOutcome::kAborted;
  cut.beginning = true;
  cut.ended = kStart + 500'000;
  const Measurement result = measured({}, cut);
  INFO(result.reason);
  REQUIRE(result.fair());
  REQUIRE(result.covered == 10);
  REQUIRE_FALSE(result.complete());
  REQUIRE(result.trajectory[9].yaw == Approx(0.25).margin(0.01));
  REQUIRE(result.path_length == Approx(0.45).epsilon(0.02));
}

TEST_CASE("a beginning of less than 0.4 s is refused") {
  ExecutionCut cut = completed();
  cut.beginning = true;
  cut.ended = kStart + 350'000;
  const Measurement result = measured({}, cut);
  REQUIRE(result.gate == Gate::kAborted);
  REQUIRE(result.reason == "only 0.35 s of it were driven, needed 0.40");
}

TEST_CASE("a beginning that the INS has not seen for 0.4 s is refused") {
  Drive drive;
  drive.until = kStart + 320'000;
  ExecutionCut cut = completed();
  cut.beginning = true;
  cut.ended = kStart + 500'000;
  const Measurement result = measured(drive, cut);
  REQUIRE(result.gate == Gate::kCoveredTime);
}

TEST_CASE("where the command before an execution was its class's, any twist is the ground's") {
  Drive drive;
  drive.cruise = {0.3, 0.0, 0.0};  // ice: the class has 1 m/s
  ExecutionCut cut = completed();
  REQUIRE(measured(drive, cut).gate == Gate::kEntryTwist);
  cut.steady_before = true;
  REQUIRE(measured(drive, cut).fair());
}
