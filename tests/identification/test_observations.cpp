// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "core_rig.hpp"
#include "modules/identification/core/pruning.hpp"

using namespace tread;
using namespace tread::gap;
using samples::vehicleWith;

TEST_CASE("what data should be does not depend on the pieces of the simulation") {
  const ModelDocument model = vehicleWith({{"yaw_inertia.lag", 0.03}, {"body_inertia.lag", 0.03}});
  const std::vector<Drive> drives{syntheticDrive(model, 60.0, 1)};
  ObservationSettings fine;
  fine.piece = 0.002;
  const Eigen::VectorXd exact = Observations(drives, fine).predict(model);
  const Eigen::VectorXd usual = Observations(drives, {}).predict(model);
  REQUIRE(usual.size() == exact.size());
  // Rates of up to 1 m/s and 1.7 rad/s; interpolation within the pieces would be off by .01.
  CHECK((usual - exact).cwiseAbs().maxCoeff() < 2e-3);
}

TEST_CASE("a delay is exact, however coarse the pieces of the simulation are") {
  const std::vector<Drive> drives{syntheticDrive(syntheticVehicle(), 60.0, 1)};
  ObservationSettings fine;
  fine.piece = 0.002;
  for (const double delay : {-0.02, 0.013, 0.22, 0.7}) {
    const ModelDocument model = vehicleWith({{"command_delay.delay", delay}});
    const Eigen::VectorXd exact = Observations(drives, fine).predict(model);
    const Eigen::VectorXd usual = Observations(drives, {}).predict(model);
    INFO(delay);
    CHECK((usual - exact).cwiseAbs().maxCoeff() < 5e-3);
  }
}

namespace {

/// A vehicle with zero commands and given INS values.
Drive saidDrive(double seconds, double period, const std::function<InsSample(double)>& said) {
  Drive drive;
  Segment segment;
  segment.commands.push_back({0.0, {}});
  segment.end = seconds;
  for (int i = 0; period * i < seconds - 1e-9; ++i) {
    InsSample sample = said(period * i);
    sample.time = period * i;
    segment.ins.push_back(sample);
  }
  drive.segments.push_back(std::move(segment));
  return drive;
}

InsSample nothingSaid(double) {
  InsSample sample;
  sample.T_map_body = {kNotMeasured, kNotMeasured, kNotMeasured};
  return sample;
}

}  // namespace

TEST_CASE("a drive without measurements has no rows, and nothing of it breaks") {
  for (const Drive& drive : {Drive{}, saidDrive(60.0, 0.1, nothingSaid)}) {
    const std::vector<Drive> drives{drive};
    const Observations data(drives, {});
    CHECK(data.all().empty());
    CHECK(data.predict(syntheticVehicle()).size() == 0);
    CHECK(data.measuredBlocks() == 0);
    CHECK(tooLittleDriving(data).find("too little to tell chance from cause") != std::string::npos);
  }
  const std::vector<Drive> none;
  CHECK(Observations(none, {}).blocks() == 0);
}

TEST_CASE("what is needed to tell chance from cause is 200 s of driving that was measured") {
  const std::vector<Drive> enough{syntheticDrive(syntheticVehicle(), 200.0, 1)};
  CHECK(tooLittleDriving(Observations(enough, {})).empty());
  const std::vector<Drive> brief{syntheticDrive(syntheticVehicle(), 100.0, 1)};
  CHECK(tooLittleDriving(Observations(brief, {})).find("only 100 s of measured driving") == 0);
  std::vector<Drive> half = enough;
  for (InsSample& sample : half[0].segments[0].ins)
    if (sample.time > 100.0) {
      sample.T_map_body.x = kNotMeasured;
      sample.omega = kNotMeasured;
    }
  const Observations measured(half, {});
  CHECK(measured.blocks() == 10);
  CHECK(measured.measuredBlocks() == 5);
  CHECK(tooLittleDriving(measured).find("only 100 s of measured driving") == 0);
}

TEST_CASE("a minute has ten short blocks, which count less than usual ones") {
  const auto cut = [](const std::vector<Drive>& drives) {
    return Observations(drives, fromOneMinute());
  };
  const std::vector<Drive> minute{syntheticDrive(syntheticVehicle(), 60.0, 1)};
  CHECK(cut(minute).measuredBlocks() == 10);
  CHECK(cut(minute).isBrief());
  CHECK(cut(minute).dependence() == Approx(std::pow(20.0 / 6.0, 0.25)));
  CHECK(tooLittleDriving(cut(minute)).empty());
  const std::vector<Drive> longer{syntheticDrive(syntheticVehicle(), 100.0, 1)};
  CHECK(cut(longer).dependence() == Approx(std::pow(2.0, 0.25)));
  const std::vector<Drive> usual{syntheticDrive(syntheticVehicle(), 200.0, 1)};
  CHECK_FALSE(cut(usual).isBrief());
  CHECK(cut(usual).dependence() == 1.0);
  CHECK(cut(usual).blockLength() == Observations(usual, {}).blockLength());
  const std::vector<Drive> brief{syntheticDrive(syntheticVehicle(), 40.0, 1)};
  CHECK(tooLittleDriving(cut(brief)) ==
        "only 40 s of measured driving, too little to tell chance from cause: drive at least 60 s");
}

TEST_CASE("rows of the gyro are means over quarters of a second") {
  const std::vector<Drive> drives{saidDrive(10.0, 0.01, [](double time) {
    InsSample sample = nothingSaid(time);
    sample.omega = 0.1 * time;
    return sample;
  })};
  const Observations data(drives, {});
  REQUIRE(data.all().size() == 40);
  for (const Observation& row : data.all()) {
    CHECK(row.channel == ObservedRate::kYawRate);
    CHECK(row.end - row.begin == Approx(0.25));
    CHECK(row.measured == Approx(0.05 * (row.begin + row.end)));  // at the middle
  }
}

TEST_CASE("rows of poses take turns, last within their limits and together lead all the way") {
  const samples::Rig rig({}, 60.0, 2);
  double turned = 0.0;
  double first = kNotMeasured;
  double last = 0.0;
  for (size_t i = 0; i < rig.data.all().size(); ++i) {
    const Observation& row = rig.data.all()[i];
    if (row.channel != ObservedRate::kHeading) continue;
    CHECK(row.end - row.begin >= 0.3);
    CHECK(row.end - row.begin <= 1.2);
    REQUIRE(rig.data.all().at(i + 2).channel == ObservedRate::kAcross);
    CHECK(rig.data.all()[i + 1].channel == ObservedRate::kAlong);
    CHECK(rig.data.all()[i + 2].begin == row.begin);
    if (std::isnan(first)) first = row.begin;
    CHECK((last == 0.0 || row.begin == last));
    last = row.end;
    turned += row.measured * (row.end - row.begin);
  }
  CHECK(first < 0.2);
  CHECK(last > 59.0);
  const auto& ins = rig.drives[0].segments[0].ins;
  const double yaw = ins.back().T_map_body.yaw - ins.front().T_map_body.yaw;
  CHECK(turned == Approx(yaw).margin(1.5));  // except for the last part of a second
}

TEST_CASE("every row lies in a block of its own drive, and blocks go on in time") {
  const std::vector<Drive> drives{syntheticDrive(syntheticVehicle(), 90.0, 1),
                                  syntheticDrive(syntheticVehicle(), 50.0, 2)};
  const Observations data(drives, {});
  CHECK(data.blocks() == 4 + 2);
  CHECK(data.blockLength() >= 20.0);
  for (const Observation& row : data.all()) {
    CHECK(row.block >= (row.drive == 0 ? 0 : 4));
    CHECK(row.block < (row.drive == 0 ? 4 : 6));
    CHECK(row.block == data.blockAt(row.drive, row.segment, 0.5 * (row.begin + row.end)));
  }
  int last = 0;
  for (double time = 0.0; time < 90.0; time += 0.5) {
    CHECK(data.blockAt(0, 0, time) >= last);
    last = data.blockAt(0, 0, time);
  }
  CHECK(last == 3);
}

TEST_CASE("a short segment lies in one block as a whole") {
  std::vector<Drive> drives(1);
  for (int n = 0; n < 30; ++n) {
    Drive part = syntheticDrive(syntheticVehicle(), 6.0, static_cast<uint64_t>(n + 1));
    drives[0].segments.push_back(part.segments[0]);
  }
  const Observations data(drives, {});
  CHECK(data.blocks() == 9);
  std::vector<int> block_of(30, -1);
  for (const Observation& row : data.all()) {
    int& block = block_of[row.segment];
    CHECK((block < 0 || block == row.block));
    block = row.block;
  }
}

TEST_CASE("segments that are not simulated have rows of 0, and change no bit of the others") {
  std::vector<Drive> drives(1);
  for (uint64_t seed : {1U, 2U, 3U})
    drives[0].segments.push_back(syntheticDrive(syntheticVehicle(), 6.0, seed).segments[0]);
  const ModelDocument model = vehicleWith({{"ins_latency.latency", 0.2}});
  const Observations data(drives, {});
  std::vector<char> mask(data.all().size(), 0);
  for (size_t i = 0; i < mask.size(); i += 7) mask[i] = data.all()[i].segment != 1;
  const std::vector<char> segments = data.segmentsOf(mask);
  CHECK(segments == std::vector<char>{1, 0, 1});
  const Eigen::VectorXd all = data.predict(model);
  const Eigen::VectorXd some =
      data.predict(data.simulate(model.vehicle, segments), model.measurement);
  double left_out = 0.0;
  for (size_t i = 0; i < data.all().size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const bool simulated = data.all()[i].segment != 1;
    CHECK(some[at] == (simulated ? all[at] : 0.0));
    if (!simulated) left_out += std::abs(all[at]);
  }
  CHECK(left_out > 0.1);
}

TEST_CASE("without noise the model that made a drive predicts its rows") {
  SyntheticNoise noise;
  noise.gyro = noise.fix = noise.heading = noise.ground = 0.0;
  const samples::Values truth{{"ins_latency.latency", 0.3},
                              {"lever_arm_y.offset", 0.2},
                              {"gyro_bias.rate", 0.02},
                              {"slip_ratio.slip", 0.1}};
  const samples::Rig rig(truth, 60.0, 4, noise);
  const auto miss = [&](const ModelDocument& model) {
    return rig.data.residuals(rig.data.predict(model)).cwiseAbs().mean();
  };
  CHECK(miss(vehicleWith(truth)) < 5e-3);
  for (const auto& [path, value] : truth) {
    samples::Values without = truth;
    for (auto& [other, number] : without)
      if (other == path) number = 0.0;
    INFO(path);
    CHECK(miss(vehicleWith(without)) > 2.0 * miss(vehicleWith(truth)));
  }
}
