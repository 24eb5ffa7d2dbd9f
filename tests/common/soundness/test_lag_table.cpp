// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>

#include "common/soundness/core/lag_table.hpp"

using namespace tread;
using namespace tread::gap;

namespace {

constexpr double kStep = 0.02;  // [s]

/// A rate with two periods, and its integral.
double rateAt(double time) {
  return std::cos(0.9 * time) + 0.5 * std::cos(2.3 * time + 1.0);
}
double integralAt(double time) {
  return std::sin(0.9 * time) / 0.9 + 0.5 * std::sin(2.3 * time + 1.0) / 2.3;
}

/// One segment with a heading delayed against the gyro, as slope * rate + offset.
Drive followingDrive(double lag, double slope, double offset, double seconds = 100.0) {
  Drive drive;
  Segment segment;
  segment.commands.push_back({0.0, {}});
  segment.end = seconds;
  for (int i = 0; i * kStep < seconds; ++i) {
    InsSample sample;
    sample.time = i * kStep;
    sample.omega = rateAt(sample.time);
    sample.T_map_body.yaw = slope * integralAt(sample.time - lag) + offset * sample.time;
    segment.ins.push_back(sample);
  }
  drive.segments.push_back(std::move(segment));
  return drive;
}

LagTable tableOf(const Drive& drive, const std::vector<double>& lags) {
  const auto increments = poseIncrements(drive);
  std::vector<double> rates;
  for (const PoseIncrement& increment : increments) rates.push_back(increment.omega());
  return {increments, rates, gyroSums(drive), lags};
}

InsSample fix(double time, const Pose2& T_map_body) {
  InsSample sample;
  sample.time = time;
  sample.T_map_body = T_map_body;
  return sample;
}

}  // namespace

TEST_CASE("a running sum has the mean of its rates over any interval that it knows") {
  RunningSum sum;
  sum.add(0.0, 1.0, 2.0);
  sum.add(1.0, 3.0, -1.0);
  sum.add(3.0, 4.0, 5.0);
  CHECK(sum.mean(0.0, 4.0).value() == Approx((2.0 - 2.0 + 5.0) / 4.0));
  CHECK(sum.mean(0.5, 2.0).value() == Approx((1.0 - 1.0) / 1.5).margin(1e-12));
  CHECK(sum.mean(3.25, 3.5).value() == Approx(5.0));
  // Means over neighbouring intervals add up to that of both.
  for (double middle = 0.3; middle < 3.9; middle += 0.37)
    CHECK(middle * sum.mean(0.0, middle).value() + (4.0 - middle) * sum.mean(middle, 4.0).value() ==
          Approx(5.0));
}

TEST_CASE("a running sum says nothing before it begins, after it ends and over a pause") {
  RunningSum sum;
  CHECK_FALSE(sum.mean(0.0, 1.0));
  sum.add(1.0, 2.0, 3.0);
  sum.add(4.0, 5.0, 3.0);
  CHECK(sum.mean(1.0, 2.0));
  CHECK(sum.mean(4.2, 5.0));
  CHECK_FALSE(sum.mean(0.9, 2.0));
  CHECK_FALSE(sum.mean(4.0, 5.1));
  CHECK_FALSE(sum.mean(1.5, 4.5));
  CHECK_FALSE(sum.mean(2.5, 3.5));
}

TEST_CASE("what is no rate or lies in the past is not added to a running sum") {
  RunningSum sum;
  sum.add(0.0, 2.0, 1.0);
  sum.add(2.0, 3.0, kNotMeasured);
  sum.add(2.0, 2.0, 1.0);
  sum.add(3.0, 2.5, 1.0);
  sum.add(1.0, 1.5, 100.0);
  CHECK_FALSE(sum.mean(0.0, 2.1));
  CHECK(sum.mean(0.0, 2.0).value() == Approx(1.0));
}

TEST_CASE("the gyro's sum is exact for a rate that changes evenly, and ends where it is silent") {
  Drive drive;
  Segment segment;
  for (int i = 0; i <= 100; ++i) {
    InsSample sample;
    sample.time = 0.1 * i;
    sample.omega = 0.3 * sample.time;
    if (i > 50 && i < 58) sample.omega = kNotMeasured;
    segment.ins.push_back(sample);
  }
  drive.segments = {segment, Segment{}};
  const RunningSums sums = gyroSums(drive);
  REQUIRE(sums.size() == 2);
  CHECK(sums[0].mean(1.0, 5.0).value() == Approx(0.3 * 3.0));
  CHECK(sums[0].mean(6.0, 10.0).value() == Approx(0.3 * 8.0));
  CHECK_FALSE(sums[0].mean(4.5, 6.0));
  CHECK_FALSE(sums[1].mean(0.0, 1.0));
}

TEST_CASE("the sums of commands are of right less left and of their mean, until the segment ends") {
  Drive drive;
  Segment segment;
  segment.commands = {{1.0, {0.2, 0.6}}, {3.0, {-0.5, 0.5}}};
  segment.end = 4.0;
  drive.segments.push_back(segment);
  const RunningSums turn = turnCommandSums(drive);
  const RunningSums forward = driveCommandSums(drive);
  CHECK(turn[0].mean(1.0, 3.0).value() == Approx(0.4));
  CHECK(turn[0].mean(1.0, 4.0).value() == Approx((2.0 * 0.4 + 1.0) / 3.0));
  CHECK(forward[0].mean(1.0, 3.0).value() == Approx(0.4));
  CHECK(forward[0].mean(3.0, 4.0).value() == Approx(0.0).margin(1e-12));
  CHECK_FALSE(turn[0].mean(1.0, 4.1));
}

TEST_CASE("increments last .4 to 1.2 s, follow one another and lead together from first to last") {
  const Drive drive = followingDrive(0.0, 1.0, 0.0, 20.0);
  const auto increments = poseIncrements(drive);
  REQUIRE(increments.size() > 30);
  Pose2 T_first_last;
  for (size_t i = 0; i < increments.size(); ++i) {
    CHECK(increments[i].duration() >= 0.4 - 1e-9);
    CHECK(increments[i].duration() <= 1.2 + 1e-9);
    if (i > 0) CHECK(increments[i].begin == increments[i - 1].end);
    T_first_last = T_first_last * increments[i].T_begin_end;
  }
  CHECK(T_first_last.yaw ==
        Approx(integralAt(increments.back().end) - integralAt(increments.front().begin)));
}

TEST_CASE("no increment bridges a silence, a segment's end or a pose with a number missing") {
  Drive drive;
  Segment segment;
  segment.ins = {fix(0.0, {}),
                 fix(0.3, {0.3, 0.0, 0.0}),
                 fix(0.5, {0.5, 0.0, 0.0}),
                 fix(0.95, {0.9, kNotMeasured, 0.0}),
                 fix(1.0, {1.0, 0.0, 0.1}),
                 fix(2.3, {2.3, 0.0, 0.0}),
                 fix(2.8, {2.8, 0.0, 0.0})};
  Segment other;
  other.ins = {fix(3.2, {3.2, 0.0, 0.0})};
  drive.segments = {segment, other};
  const auto increments = poseIncrements(drive);
  REQUIRE(increments.size() == 3);
  CHECK(increments[0].end == 0.5);
  CHECK(increments[0].v() == Approx(1.0));
  CHECK(increments[1].begin == 0.5);
  CHECK(increments[1].end == 1.0);
  CHECK(increments[1].omega() == Approx(0.2));
  CHECK(increments[2].begin == 2.3);
  CHECK(poseIncrements(Drive{}).empty());
}

TEST_CASE("a lag grid has equal steps and both ends") {
  const std::vector<double> lags = lagGrid(-0.3, 0.8, 0.02);
  REQUIRE(lags.size() == 56);
  CHECK(lags.front() == -0.3);
  CHECK(lags.back() == Approx(0.8));
  for (size_t i = 1; i < lags.size(); ++i) CHECK(lags[i] - lags[i - 1] == Approx(0.02));
  CHECK(lagGrid(1.0, 1.0, 0.1) == std::vector<double>{1.0});
}

TEST_CASE("the best match has the lag, slope and offset with which one rate follows the other") {
  for (const double lag : {0.0, 0.137, 0.4, 0.73}) {
    const Drive drive = followingDrive(lag, 0.8, 0.05);
    const LagTable table = tableOf(drive, lagGrid(-0.5, 1.0, 0.05));
    const auto match = table.best(0, table.increments());
    REQUIRE(match);
    INFO("lag " << lag);
    CHECK(match->lag == Approx(lag).margin(0.01));  // also between the grid's lags
    CHECK(match->correlation > 0.995);
    CHECK(match->slope == Approx(0.8).epsilon(0.01));
    CHECK(match->offset == Approx(0.05).margin(0.01));
  }
}

TEST_CASE("a match is the correlation and the regression of the rows at its lag") {
  const Drive drive = followingDrive(0.3, 0.8, 0.05);
  const LagTable table = tableOf(drive, {0.0, 0.2, 0.5});
  const auto increments = poseIncrements(drive);
  const RunningSums gyro = gyroSums(drive);
  // at lag 0.2, from increments that are valid at all lags
  std::vector<std::pair<double, double>> pairs;
  for (const PoseIncrement& increment : increments)
    if (gyro[0].mean(increment.begin - 0.5, increment.end - 0.5) &&
        gyro[0].mean(increment.begin, increment.end))
      pairs.push_back(
          {gyro[0].mean(increment.begin - 0.2, increment.end - 0.2).value(), increment.omega()});
  const auto n = static_cast<double>(pairs.size());
  double x = 0.0, y = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;
  for (const auto& [a, b] : pairs) {
    x += a;
    y += b;
    xx += a * a;
    yy += b * b;
    xy += a * b;
  }
  const double covariance = xy / n - x / n * y / n;
  const double slope = covariance / (xx / n - x / n * x / n);
  const auto match = table.match(1, 0, table.increments());
  REQUIRE(match);
  CHECK(match->rows == pairs.size());
  CHECK(match->slope == Approx(slope));
  CHECK(match->offset == Approx((y - slope * x) / n));
  CHECK(match->correlation ==
        Approx(covariance / std::sqrt((xx / n - x / n * x / n) * (yy / n - y / n * y / n))));
}

TEST_CASE("a rate that goes against the other is the best match of the other sign") {
  const Drive drive = followingDrive(0.3, -1.0, 0.0);
  const LagTable table = tableOf(drive, lagGrid(0.0, 0.6, 0.05));
  const auto against = table.best(0, table.increments(), -1.0);
  REQUIRE(against);
  CHECK(against->lag == Approx(0.3).margin(0.01));
  CHECK(against->correlation < -0.995);
  CHECK(against->slope == Approx(-1.0).epsilon(0.01));
}

TEST_CASE("only lags that were asked for match, and the nearest one is the nearest") {
  const Drive drive = followingDrive(0.4, 1.0, 0.0);
  const LagTable table = tableOf(drive, lagGrid(-0.2, 0.8, 0.1));
  const auto early = table.best(0, table.increments(), 1.0, -0.2, 0.1);
  REQUIRE(early);
  CHECK(early->lag <= 0.1 + 1e-9);
  CHECK_FALSE(table.best(0, table.increments(), 1.0, 2.0, 3.0));
  CHECK(table.near(0.44, 0, table.increments())->lag == Approx(0.4));
  CHECK(table.near(9.0, 0, table.increments())->lag == Approx(0.8));
}

TEST_CASE("nothing matches where few increments speak, or nothing moves") {
  const Drive brief = followingDrive(0.0, 1.0, 0.0, 4.0);
  const LagTable few = tableOf(brief, {0.0});
  REQUIRE(few.increments() < 12);
  CHECK_FALSE(few.match(0, 0, few.increments()));
  CHECK_FALSE(few.best(0, few.increments()));
  const Drive whole = followingDrive(0.0, 1.0, 0.0);
  const LagTable table = tableOf(whole, {0.0});
  CHECK(table.match(0, 0, 20));
  CHECK_FALSE(table.match(0, 0, 0));
  CHECK_FALSE(tableOf(whole, {}).best(0, table.increments()));
  CHECK_FALSE(tableOf(whole, {}).near(0.0, 0, table.increments()));
  Drive still = whole;
  for (InsSample& sample : still.segments[0].ins) sample.omega = 0.0;
  CHECK_FALSE(tableOf(still, {0.0}).match(0, 0, table.increments()));
  Drive rarely = whole;
  for (InsSample& sample : rarely.segments[0].ins)
    if (sample.time > 25.0) sample.omega = kNotMeasured;
  CHECK_FALSE(tableOf(rarely, {0.0}).match(0, 0, table.increments()));
}
