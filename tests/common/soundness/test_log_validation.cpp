// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <random>

#include "common/soundness/core/log_validation.hpp"

using namespace tread;
using namespace tread::gap;

namespace {

struct Made {
  double length = 200.0;    ///< [s]
  double gyro_scale = 1.0;  ///< gyro value relative to the true one
  double gyro_bias = 0.0;   ///< [rad/s]
  double pose_lag = 0.0;    ///< [s]
  double gyro_lag = 0.0;    ///< [s]
  double turn_sign = 1.0;   ///< of the motion relative to the command
  double forward_sign = 1.0;
  double turning = 1.0;                  ///< [rad/s] at most
  double mirror = 1.0;                   ///< of the map's y
  double jump_time = 1e9;                ///< [s] from which INS times are late
  double jump = 0.0;                     ///< [s] delay
  double noise = 0.01;                   ///< [m] and half of it [rad]
  double from = 1e9, to = 1e9;           ///< [s] interval with a fault of the INS:
  bool frozen = false, flipped = false;  ///< it repeats itself, its gyro has the other sign,
  double turned = 0.0;                   ///< its heading is rotated [rad],
  /// or left and right, or forwards and backwards are exchanged
  bool swapped = false, reversed = false;
  bool stands_first = true;  ///< for 5 s
  bool alternates = false;   ///< the same turn and speed alternately
};

/// A command that changes every 1.5 s, and a first-order vehicle that follows it.
Drive makeDrive(const Made& made) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::normal_distribution<double> normal;
  Drive drive;
  drive.name = "made";
  Segment segment;
  Pose2 T_map_body;
  double v = 0.0, omega = 0.0, v_wanted = 0.0, omega_wanted = 0.0;
  std::vector<std::pair<double, Pose2>> past;
  std::vector<double> turned;
  const auto ticks = static_cast<int>(made.length / 0.02);
  for (int i = 0; i < ticks; ++i) {
    const double time = 0.02 * i;
    if (i % 75 == 0 && !(made.stands_first && time < 5.0)) {
      v_wanted = uniform(random);
      omega_wanted = made.turning * uniform(random);
    }
    if (made.alternates) {
      v_wanted = i / 75 % 2 == 0 ? 0.5 : -0.5;
      omega_wanted = -v_wanted;
    }
    if (i % 75 == 0)
      segment.commands.push_back(
          {time, {v_wanted - 0.5 * omega_wanted, v_wanted + 0.5 * omega_wanted}});
    const bool other = time >= made.from && time < made.to;
    v += 0.1 * ((other && made.reversed ? -1.0 : 1.0) * made.forward_sign * v_wanted - v);
    omega += 0.1 * ((other && made.swapped ? -1.0 : 1.0) * made.turn_sign * omega_wanted - omega);
    T_map_body = T_map_body * integrate({v, 0.0, omega}, 0.02);
    past.push_back({time, T_map_body});
    turned.push_back(omega);
    if (i % 5 != 0) continue;
    const auto late = static_cast<size_t>(std::lround(made.pose_lag / 0.02));
    Pose2 seen = past[past.size() > late ? past.size() - 1 - late : 0].second;
    seen.x += made.noise * normal(random);
    seen.y = made.mirror * seen.y + made.noise * normal(random);
    seen.yaw += 0.5 * made.noise * normal(random);
    const auto old = static_cast<size_t>(std::lround(made.gyro_lag / 0.02));
    InsSample sample;
    sample.time = time + (time > made.jump_time ? made.jump : 0.0);
    sample.T_map_body = seen;
    sample.omega = made.gyro_scale * turned[turned.size() > old ? turned.size() - 1 - old : 0] +
                   made.gyro_bias;
    const bool wrong = time >= made.from && time < made.to;
    if (wrong && made.flipped) sample.omega = -sample.omega;
    if (wrong) sample.T_map_body.yaw += made.turned;
    if (wrong && made.frozen) {
      const double stamp = sample.time;
      sample = segment.ins.back();
      sample.time = stamp;
    }
    segment.ins.push_back(sample);
  }
  segment.end = made.length + std::max(0.0, made.jump);
  drive.segments.push_back(segment);
  return drive;
}

std::string fatal(const Drive& drive) {
  for (const LogNote& note : validateLog(drive))
    if (note.isFatal()) return note.what;
  return "";
}

std::string lineWith(const Drive& drive, const std::string& part) {
  for (const LogNote& note : validateLog(drive))
    if (note.what.find(part) != std::string::npos) return note.what;
  return "";
}

}  // namespace

TEST_CASE("a sound drive is described and nothing in it is fatal") {
  const Drive drive = makeDrive({});
  REQUIRE(fatal(drive) == "");
  REQUIRE(lineWith(drive, "gyro and heading agree").find("turns 1.0") != std::string::npos);
  REQUIRE(lineWith(drive, "of standstill").find("3 s of standstill: gyro 0.0000") == 0);
  REQUIRE(lineWith(drive, "driven 200 s in 1 segments").find("reversals") != std::string::npos);
  REQUIRE(lineWith(drive, "new poses every 0.10 s") != "");
}

TEST_CASE("a gyro with a flipped sign is fatal, one with a bias or another scale is not") {
  Made flipped;
  flipped.gyro_scale = -1.0;
  REQUIRE(fatal(makeDrive(flipped)).find("flipped sign: the gyro turns against the heading") == 0);
  Made scaled;
  scaled.gyro_scale = 0.8;
  scaled.gyro_bias = 0.06;
  const Drive drive = makeDrive(scaled);
  REQUIRE(fatal(drive) == "");
  REQUIRE(lineWith(drive, "gyro and heading agree").find("turns 1.2") != std::string::npos);
  REQUIRE(lineWith(drive, "of standstill").find("gyro 0.06") != std::string::npos);
}

TEST_CASE("the heading's lag behind the gyro is found, and told by the fit alone") {
  Made made;
  made.pose_lag = 0.4;
  const auto match = headingBesideGyro(makeDrive(made));
  REQUIRE(match);
  REQUIRE(match->lag == Approx(0.4).margin(0.03));
  REQUIRE(match->slope == Approx(1.0).margin(0.02));
  REQUIRE(lineWith(makeDrive(made), "the fit determines the delay of the heading (INS latency)") !=
          "");
  REQUIRE(lineWith(makeDrive(made), "0.4") == "");
  made.pose_lag = 0.0;
  made.gyro_lag = 0.16;
  REQUIRE(lineWith(makeDrive(made), "the heading is ahead of the gyro") != "");
}

TEST_CASE("motion against the commands is named as what it is") {
  Made turned;
  turned.turn_sign = -1.0;
  REQUIRE_THAT(fatal(makeDrive(turned)), Catch::Contains("left and right are swapped"));
  Made backwards;
  backwards.forward_sign = -1.0;
  REQUIRE_THAT(fatal(makeDrive(backwards)), Catch::Contains("the heading is turned half round"));
  turned.forward_sign = -1.0;
  REQUIRE_THAT(fatal(makeDrive(turned)), Catch::Contains("both commands have the other sign"));
}

TEST_CASE("commands that alternate evenly are not taken for a flipped sign") {
  Made made;
  made.alternates = true;
  REQUIRE(fatal(makeDrive(made)) == "");
}

TEST_CASE("a mirrored map does not fit its headings") {
  Made mirrored;
  mirrored.mirror = -1.0;
  REQUIRE_THAT(fatal(makeDrive(mirrored)), Catch::Contains("y (or x) is inverted"));
}

TEST_CASE("a clock of the INS that leaves that of MOTOR is found, and from when to when") {
  Made jumped;
  jumped.jump_time = 100.0;
  jumped.jump = 4.0;
  REQUIRE(fatal(makeDrive(jumped)).find("clock jump between INS and MOTOR: from") == 0);
  Made early;
  early.jump_time = 0.0;
  early.jump = -2.0;
  Drive drive = makeDrive(early);
  REQUIRE(fatal(drive).find("the motion precedes its commands by 1.9") == 0);
  Made late;
  late.pose_lag = 0.6;
  REQUIRE(fatal(makeDrive(late)) == "");
}

TEST_CASE("few pose jumps are noted, many are fatal") {
  Drive drive = makeDrive({});
  auto& ins = drive.segments[0].ins;
  for (size_t i = 100; i < ins.size(); i += 500) ins[i].T_map_body.x += 3.0;
  REQUIRE(fatal(drive) == "");
  REQUIRE(lineWith(drive, "pose jumps faster than 8 m/s").find("8 pose jumps") == 0);
  for (size_t i = 101; i < ins.size(); i += 10) ins[i].T_map_body.x += 3.0;
  REQUIRE(fatal(drive).find("too many for one robot's INS") != std::string::npos);
}

TEST_CASE("a gyro that hangs while the heading turns is fatal, one at standstill is not") {
  Drive drive = makeDrive({});
  auto& ins = drive.segments[0].ins;
  for (InsSample& sample : ins)
    if (sample.time < 5.0) sample.omega = 0.0;
  REQUIRE(fatal(drive) == "");
  for (InsSample& sample : ins)
    if (sample.time > 80.0 && sample.time < 120.0) sample.omega = 0.01;
  REQUIRE(fatal(drive).find("the gyro is frozen") == 0);
}

TEST_CASE("nothing, nonsense and missing numbers never break the checks") {
  REQUIRE(fatal(Drive{}).find("no motion with known commands") == 0);
  Drive drive = makeDrive({});
  drive.segments.push_back(Segment{{{300.0, {}}}, 301.0, {}, std::nullopt, {}});
  const double odd[] = {kNotMeasured, std::numeric_limits<double>::infinity(), 1e300, -1e300};
  auto& ins = drive.segments[0].ins;
  for (size_t i = 0; i < ins.size(); i += 7) {
    ins[i].T_map_body.x = odd[i % 4];
    ins[i].omega = odd[(i + 1) % 4];
    ins[i].pitch = odd[(i + 2) % 4];
  }
  for (const LogNote& note : validateLog(drive)) REQUIRE(note.what.size() < 2000);
  for (InsSample& sample : ins) sample.T_map_body.yaw = sample.omega = kNotMeasured;
  REQUIRE(fatal(drive).find("no motion with known commands") == 0);
  Drive still = makeDrive({});
  for (CommandSample& sample : still.segments[0].commands) sample.command = {};
  for (InsSample& sample : still.segments[0].ins) {
    sample.T_map_body = {};
    sample.omega = 0.0;
  }
  REQUIRE(fatal(still) == "");
}

TEST_CASE("a step of a recording in a wrong frame is found among the others and taken out") {
  Made gentle;
  gentle.turning = 0.4;
  const Drive whole = makeDrive(gentle);
  Drive steps;
  const Segment& all = whole.segments[0];
  for (int n = 1; n < 30; ++n) {
    Segment step;
    step.end = 6.0 * n + 6.0;
    for (const CommandSample& sample : all.commands)
      if (sample.time >= 6.0 * n && sample.time < step.end) step.commands.push_back(sample);
    for (const InsSample& sample : all.ins)
      if (sample.time >= 6.0 * n && sample.time < step.end) step.ins.push_back(sample);
    steps.segments.push_back(step);
    steps.executions.push_back({static_cast<size_t>(n - 1), 6.0 * n + 1.0, 6.0 * n + 3.0});
  }
  REQUIRE(brokenSegments(steps).empty());
  for (InsSample& sample : steps.segments[4].ins) {
    const Pose2 pose = sample.T_map_body;
    sample.T_map_body = Pose2{0.0, 0.0, 1.2} * pose;
    sample.T_map_body.yaw = pose.yaw;
  }
  for (InsSample& sample : steps.segments[9].ins)
    if (sample.time > 63.0) sample.T_map_body.yaw += 1.5;
  REQUIRE(brokenSegments(steps) == std::vector<size_t>{4, 9});
  removeSegments({4, 9}, steps);
  REQUIRE(steps.segments.size() == 27);
  REQUIRE(steps.executions.size() == 27);
  for (const Execution& execution : steps.executions) {
    REQUIRE(execution.begin >= steps.segments[execution.segment].begin());
    REQUIRE(execution.end <= steps.segments[execution.segment].end);
  }
}

TEST_CASE("every contradiction is one fatal line that names the log and ends in no line break") {
  std::vector<Made> damaged(6);
  damaged[0].gyro_scale = -1.0;
  damaged[1].turn_sign = -1.0;
  damaged[2].forward_sign = -1.0;
  damaged[3].mirror = -1.0;
  damaged[4].jump_time = 100.0;
  damaged[4].jump = 4.0;
  damaged[5].jump_time = 0.0;
  damaged[5].jump = -2.0;
  for (size_t i = 0; i < damaged.size(); ++i) {
    INFO("damage " << i);
    Drive drive = makeDrive(damaged[i]);
    drive.name = "field_7.lcm";
    size_t fatal_lines = 0;
    for (const LogNote& note : validateLog(drive)) {
      CHECK(note.log == "field_7.lcm");
      CHECK_FALSE(note.what.empty());
      CHECK(note.what.find('\n') == std::string::npos);
      CHECK(note.what.find("nan") == std::string::npos);
      fatal_lines += note.isFatal();
    }
    CHECK(fatal_lines >= 1);
    CHECK(fatal_lines <= 2);
  }
}

TEST_CASE("what effects of the catalogue do to a drive is never fatal") {
  std::vector<Made> sound(6);
  sound[0].gyro_scale = 1.2;
  sound[1].gyro_bias = -0.1;
  sound[2].pose_lag = 0.5;
  sound[3].noise = 0.05;
  sound[4].turning = 0.2;
  sound[5].stands_first = false;
  for (const Made& made : sound) CHECK(fatal(makeDrive(made)) == "");
}

TEST_CASE("checks look at motion and not at the place, the direction or the time of a drive") {
  const Drive drive = makeDrive({});
  Drive moved = drive;
  for (InsSample& sample : moved.segments[0].ins) {
    sample.T_map_body = Pose2{1000.0, -500.0, 1.3} * sample.T_map_body;
    sample.time += 64.0;
  }
  for (CommandSample& sample : moved.segments[0].commands) sample.time += 64.0;
  moved.segments[0].end += 64.0;
  const auto here = validateLog(drive);
  const auto there = validateLog(moved);
  REQUIRE(here.size() == there.size());
  for (size_t i = 0; i < here.size(); ++i) {
    CHECK(here[i].isFatal() == there[i].isFatal());
    CHECK(here[i].what.substr(0, 5) == there[i].what.substr(0, 5));
  }
}

TEST_CASE("there is no heading beside a gyro that is missing, or where nothing was driven") {
  Drive silent = makeDrive({});
  for (InsSample& sample : silent.segments[0].ins) sample.omega = kNotMeasured;
  CHECK_FALSE(headingBesideGyro(silent));
  CHECK_FALSE(headingBesideGyro(Drive{}));
  CHECK(lineWith(silent, "no gyro to compare with the heading") != "");
  CHECK(fatal(silent) == "");
}

TEST_CASE("few segments do not tell which of them is broken") {
  Made gentle;
  gentle.turning = 0.4;
  const Drive whole = makeDrive(gentle);
  Drive steps;
  for (int n = 1; n < 9; ++n) {
    Segment step;
    step.end = 6.0 * n + 6.0;
    step.commands.push_back({6.0 * n, {}});
    for (const InsSample& sample : whole.segments[0].ins)
      if (sample.time >= 6.0 * n && sample.time < step.end) step.ins.push_back(sample);
    steps.segments.push_back(step);
  }
  for (InsSample& sample : steps.segments[3].ins) sample.T_map_body.yaw *= -3.0;
  CHECK(brokenSegments(steps).empty());
  CHECK(brokenSegments(Drive{}).empty());
}

TEST_CASE("segments that are taken out take their executions along and no others") {
  Drive drive;
  for (size_t i = 0; i < 5; ++i) {
    Segment segment;
    segment.commands.push_back({10.0 * static_cast<double>(i), {}});
    segment.end = segment.begin() + 10.0;
    drive.segments.push_back(segment);
    drive.executions.push_back({i, segment.begin() + 1.0, segment.begin() + 3.0});
    drive.executions.push_back({i, segment.begin() + 3.0, segment.begin() + 5.0});
  }
  Drive same = drive;
  removeSegments({}, same);
  CHECK(same.segments.size() == 5);
  CHECK(same.executions.size() == 10);
  removeSegments({0, 3}, drive);
  REQUIRE(drive.segments.size() == 3);
  REQUIRE(drive.executions.size() == 6);
  CHECK(drive.segments[2].begin() == 40.0);
  for (const Execution& execution : drive.executions)
    CHECK(std::floor(execution.begin / 10.0) * 10.0 == drive.segments[execution.segment].begin());
  removeSegments({0, 1, 2}, drive);
  CHECK(drive.segments.empty());
  CHECK(drive.executions.empty());
}

TEST_CASE("what changes its meaning on the way is fatal, with its time") {
  Made made;
  made.from = 80.0;
  made.to = 120.0;
  const auto refused = [](const Made& changed, const char* what) {
    const Drive drive = makeDrive(changed);
    INFO(what << ": " << fatal(drive));
    return lineWith(drive, what) != "" && fatal(drive) != "";
  };
  SECTION("frozen for ten seconds, and to the end") {
    made.frozen = true;
    made.to = 90.0;
    CHECK(refused(made, "the INS is frozen: it repeats the same 101 times from 79.9 to 89.9 s"));
    made.to = 200.0;
    CHECK(refused(made, "the INS is frozen"));
    Drive standing = makeDrive(made);
    for (CommandSample& sample : standing.segments.front().commands) sample.command = {0.0, 0.0};
    CHECK(lineWith(standing, "it repeats the same") == "");
  }
  SECTION("the gyro's sign, for a while, and from the middle to the end") {
    made.flipped = true;
    CHECK(refused(made, "the gyro turns against the heading, elsewhere it does not"));
    made.from = 100.0;
    made.to = 200.0;
    CHECK(refused(made, "flipped sign"));
  }
  SECTION("left and right") {
    made.swapped = true;
    CHECK(refused(made, "s the heading turns against the commands, elsewhere it does not"));
  }
  SECTION("forwards and backwards") {
    made.reversed = true;
    CHECK(refused(made, "s the robot goes against the commands, elsewhere it does not"));
  }
  SECTION("the heading turns by a right angle") {
    made.turned = 1.5708;
    CHECK(refused(made, "the way does not go along the heading, else it does"));
  }
}

TEST_CASE("an INS without noise that stands, and a robot that is held, are not frozen") {
  Made made;
  made.noise = 0.0;
  REQUIRE(fatal(makeDrive(made)) == "");
  Drive drive = makeDrive({});
  for (Segment& segment : drive.segments)
    for (InsSample& sample : segment.ins)
      if (sample.time > 60.0 && sample.time < 80.0) {
        sample.T_map_body = Pose2{};
        sample.omega = 1e-4 * std::sin(1e3 * sample.time);
      }
  REQUIRE(lineWith(drive, "frozen") == "");
}

TEST_CASE("a gyro that says the same while poses go on is not a frozen INS") {
  Made made;
  made.noise = 0.0;
  Drive drive = makeDrive(made);
  for (InsSample& sample : drive.segments[0].ins) {
    if (sample.time < 60.0 || sample.time > 64.0) continue;
    sample.omega = 0.25;
    if (sample.time < 60.2) sample.T_map_body = {kNotMeasured, kNotMeasured, kNotMeasured};
  }
  REQUIRE(lineWith(drive, "the INS is frozen") == "");
}

TEST_CASE("noise while it stands, and turns on the spot with a lever arm, are no flipped sign") {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  Drive drive = makeDrive({});
  Segment& segment = drive.segments[0];
  // Half an hour at standstill; the heading's noise is independent of the gyro's.
  segment.commands.push_back({200.0, {}});
  const Pose2 stand = segment.ins.back().T_map_body;
  for (double time = 200.0; time < 2000.0; time += 0.5) {
    InsSample sample = segment.ins.back();
    sample.time = time;
    sample.omega = 0.002 * normal(random);
    sample.T_map_body = {stand.x + 0.01 * normal(random), stand.y + 0.01 * normal(random),
                         stand.yaw + 0.005 * normal(random)};
    segment.ins.push_back(sample);
  }
  // A minute of turning on the spot, with the measured point half a metre ahead.
  segment.commands.push_back({2000.0, {-0.25, 0.25}});
  for (double time = 2000.0; time < 2060.0; time += 0.5) {
    InsSample sample = segment.ins.back();
    const double yaw = stand.yaw + 0.5 * (time - 2000.0);
    sample.time = time;
    sample.omega = 0.5 + 0.002 * normal(random);
    sample.T_map_body = {stand.x + 0.5 * std::cos(yaw), stand.y + 0.5 * std::sin(yaw), yaw};
    segment.ins.push_back(sample);
  }
  segment.end = 2060.0;
  REQUIRE(lineWith(drive, "flipped") == "");
  REQUIRE(lineWith(drive, "turned; cut") == "");
}
