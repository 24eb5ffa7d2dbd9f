// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "core_rig.hpp"
#include "modules/identification/core/end_errors.hpp"

using namespace tread;
using namespace tread::gap;
using samples::Values;

namespace {

ExecutionError errorWith(double position, double yaw) {
  ExecutionError error;
  error.position = position;
  error.yaw = yaw;
  return error;
}

/// A vehicle with zero commands that the INS measures as moving at 0.1 m/s and turning, with ten
/// fixes per second.
Drive driftingDrive(double seconds, double yaw_rate) {
  Drive drive;
  Segment segment;
  segment.commands.push_back({0.0, {}});
  segment.end = seconds;
  for (int i = 0; 0.1 * i < seconds; ++i) {
    InsSample sample;
    sample.time = 0.1 * i;
    sample.T_map_body = {0.1 * sample.time, 0.0, yaw_rate * sample.time};
    segment.ins.push_back(sample);
  }
  drive.segments.push_back(std::move(segment));
  return drive;
}

std::vector<ExecutionError> errorsOf(const Drive& drive) {
  const std::vector<Drive> drives{drive};
  return endErrors(Observations(drives, {}), syntheticVehicle());
}

}  // namespace

TEST_CASE("a summary is the median and the root mean square of the errors that count") {
  const std::vector<ExecutionError> errors{errorWith(4.0, 0.3), errorWith(1.0, 0.1),
                                           errorWith(2.0, 0.2), errorWith(9.0, 0.5)};
  const EndErrors all = summaryOf(errors);
  CHECK(all.executions == 4);
  CHECK(all.position.median == Approx(3.0));
  CHECK(all.position.rms == Approx(std::sqrt((16.0 + 1.0 + 4.0 + 81.0) / 4.0)));
  CHECK(all.yaw.median == Approx(0.25));
  const EndErrors none = summaryOf({});
  CHECK(none.executions == 0);
  CHECK(none.position.rms == 0.0);
}

TEST_CASE("medians of two models scatter by the blocks in which they differ, in pairs") {
  std::vector<ExecutionError> one;
  std::vector<ExecutionError> alike;
  std::vector<ExecutionError> other;
  for (int block = 0; block < 20; ++block)
    for (int i = 0; i < 5; ++i) {
      one.push_back(errorWith(1.0 + 0.1 * (block % 7) + 0.01 * i, 0.1));
      one.back().block = block;
      alike.push_back(one.back());
      alike.back().position += 0.5;
      other.push_back(one.back());
      other.back().position += block % 2 == 0 ? 0.5 : -0.5;
    }
  const MedianChance same_everywhere = chanceOfMedians(one, alike);
  CHECK(same_everywhere.position == Approx(0.0).margin(1e-12));
  CHECK(same_everywhere.yaw == 0.0);
  CHECK(chanceOfMedians(one, other).position > 0.1);
  CHECK(chanceOfMedians({}, {}).position == 0.0);
}

TEST_CASE("the model that made a drive ends where the drive ends, another one does not") {
  SyntheticNoise noise;
  noise.gyro = noise.fix = noise.heading = noise.ground = 0.0;
  const samples::Rig rig({{"slip_ratio.slip", 0.1}}, 60.0, 1, noise);
  const ModelDocument truth = samples::vehicleWith({{"slip_ratio.slip", 0.1}});
  const EndErrors right = summaryOf(endErrors(rig.data, truth));
  CHECK(right.executions >= 29);
  CHECK(right.position.rms < 2e-3);
  CHECK(right.yaw.rms < 2e-3);
  CHECK(summaryOf(endErrors(rig.data, syntheticVehicle())).position.rms > 0.05);
  const auto motions = rig.data.simulate(truth.vehicle);
  const EndErrors same = summaryOf(endErrors(rig.data, motions, truth.measurement));
  CHECK(same.position.rms == right.position.rms);
}

TEST_CASE("errors are scaled to two seconds, and much shorter or longer executions do not count") {
  Drive drive = driftingDrive(40.0, 0.2);
  for (const double length : {1.6, 2.0, 2.4}) drive.executions.push_back({0, 10.0, 10.0 + length});
  std::vector<ExecutionError> errors = errorsOf(drive);
  REQUIRE(errors.size() == 3);
  for (const ExecutionError& error : errors) {
    CHECK(error.position == Approx(0.2));
    CHECK(error.yaw == Approx(0.4));
  }
  drive.executions = {{0, 10.0, 11.2}, {0, 10.0, 12.9}, {0, 20.0, 22.0}};
  errors = errorsOf(drive);
  REQUIRE(errors.size() == 1);
  CHECK(errors[0].execution.begin == 20.0);
}

TEST_CASE("a heading that is more than half a turn off is so far off") {
  Drive drive = driftingDrive(10.0, 3.0);
  drive.executions.push_back({0, 4.0, 6.0});
  CHECK(errorsOf(drive).at(0).yaw == Approx(6.0));
}

TEST_CASE("an execution counts with fixes within a quarter of a second of both its ends") {
  const Drive whole = driftingDrive(40.0, 0.0);
  const auto countWith = [&](double from, double to) {
    Drive drive = whole;
    drive.executions.push_back({0, 20.0, 22.0});
    for (InsSample& sample : drive.segments[0].ins)
      if (sample.time > from && sample.time < to) sample.T_map_body.x = kNotMeasured;
    return errorsOf(drive).size();
  };
  CHECK(countWith(0.0, 0.0) == 1);
  CHECK(countWith(20.25, 21.75) == 1);
  CHECK(countWith(19.85, 20.15) == 1);
  CHECK(countWith(19.65, 20.35) == 0);
  CHECK(countWith(21.65, 22.35) == 0);
  CHECK(countWith(-1.0, 99.0) == 0);
  CHECK(errorsOf(whole).empty());
}

TEST_CASE("an error lies in the block of the middle of its execution") {
  const samples::Rig rig({}, 200.0, 1);
  for (const ExecutionError& error : endErrors(rig.data, syntheticVehicle())) {
    CHECK(error.block ==
          rig.data.blockAt(0, 0, 0.5 * (error.execution.begin + error.execution.end)));
    CHECK(error.position >= 0.0);
    CHECK(error.yaw >= 0.0);
  }
}

TEST_CASE("an overlay begins where the execution does and ends with both errors") {
  Drive drive = driftingDrive(40.0, 0.0);
  drive.executions.push_back({0, 10.0, 12.0});
  const std::vector<Drive> drives{drive};
  const Observations data(drives, {});
  const auto errors = endErrors(data, syntheticVehicle());
  REQUIRE(errors.size() == 1);
  const OverlayMaker maker(data, syntheticVehicle(), syntheticVehicle());
  const Overlay overlay = maker.of(errors[0]);
  CHECK(overlay.begin == 10.0);
  CHECK(overlay.duration == 2.0);
  REQUIRE(overlay.measured.size() == overlay.after.size());
  REQUIRE(overlay.measured.size() == overlay.before.size());
  CHECK(overlay.measured.front().position().norm() < 1e-12);
  for (size_t i = 0; i < overlay.measured.size(); ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(overlay.measured.size() - 1);
    CHECK(overlay.measured[i].x == Approx(0.2 * share).margin(1e-9));
    CHECK(overlay.after[i].position().norm() < 1e-12);
  }
  CHECK(overlay.error_before == Approx(0.2));
  CHECK(overlay.error_after == Approx(0.2));
  CHECK(maker.middleOf(errors[0]).x() == Approx(1.1));
}

TEST_CASE("a wrong model errs by what it is apart from the right one, beside what that errs") {
  const Values pull{{"yaw_pull.pull", 0.1}};
  const samples::Rig rig(pull, 200.0, 1);
  const ModelDocument right = samples::vehicleWith(pull);
  const double wrong = summaryOf(endErrors(rig.data, syntheticVehicle())).yaw.rms;
  const double least = summaryOf(endErrors(rig.data, right)).yaw.rms;
  const EndErrors two = apart(rig.data, syntheticVehicle(), right);
  CHECK(two.yaw.rms > 0.02);
  CHECK(std::hypot(least, two.yaw.rms) == Approx(wrong).epsilon(0.1));
  CHECK(apart(rig.data, right, right).position.rms == 0.0);
}
