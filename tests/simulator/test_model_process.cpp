// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// A model file in the real simulator process, measured by the real INS driver process.
#include <fstream>
#include <thread>

#include <catch2/catch.hpp>

#include <tread/config_t.hpp>

#include "common/link/make_link.hpp"
#include "common/messages/ins_messages.hpp"
#include "common/vehicle/kernel.hpp"
#include "common/vehicle/model_file.hpp"
#include "tests/system/robot_run.hpp"
#include "tests/system/worlds.hpp"

namespace tread::testing {
namespace {

const std::string kHidden =
    "name: hidden\nkind: power\nfull_speed: 1.1\ngauge: 0.6\nlag: 0.15\n"
    "effects:\n  turn_power_limit: {limit: 0.5}\n"
    "measurement:\n  lever_arm_x: {offset: 0.5}\n  ins_latency: {latency: 0.3}\n"
    "envelope: {v: 0.3, omega: 3, v_omega: 3}\n";

/// A model's prediction for the actual motor powers, every 2 ms.
std::vector<MotionSample> predicted(const ModelDocument& model,
                                    const std::vector<sim::TruthRow>& truth) {
  constexpr double kStep = 0.002;
  VehicleKernel kernel(model.vehicle, EntryState{});
  std::vector<MotionSample> motion{{0.0, {}, 0.0}};
  const auto span = static_cast<double>(truth.back().utime - truth.front().utime) * 1e-6;
  for (size_t row = 0; motion.back().time < span;) {
    const double time = motion.back().time;
    while (row + 1 < truth.size() &&
           static_cast<double>(truth[row + 1].utime - truth.front().utime) * 1e-6 <= time)
      ++row;
    kernel.step({truth[row].power[0], truth[row].power[1]}, kStep);
    motion.push_back({time + kStep, kernel.pose(), kernel.twist().omega});
  }
  return measure(motion, model.measurement);
}

}  // namespace

TEST_CASE("a model file in the simulator's process is what the robot's INS driver tells of") {
  RobotRun run(kField, "[0, 0, 0]");
  std::ofstream(run.folder() + "/model.yaml") << kHidden;
  run.set("simulator", "model", run.folder() + "/model.yaml");
  std::vector<std::pair<int64_t, Pose2>> said;
  std::string config;
  run.bus().subscribe<ins_t>(kIns, [&](const ins_t& ins) {
    if (const auto T_map_body = planarPose(ins)) said.emplace_back(ins.utime, *T_map_body);
  });
  run.bus().subscribe<config_t>(kConfig, [&](const config_t& message) {
    if (message.config_process == "simulator") config = message.config_text;
  });
  run.start("simulator");
  REQUIRE(run.until(10.0, [&] { return !config.empty(); }));
  CHECK_THAT(config, Catch::Contains("model: \"hidden\""));
  run.start("ins_driver");
  REQUIRE(run.until(10.0, [&] { return said.size() > 5; }));
  const auto motor = makeLink("tty:" + run.folder() + "/devices/motor?baud=115200");
  for (int i = 0; i < 120; ++i) {
    if (!motor->isOpen()) motor->reopen(run.now());
    const std::string line = i < 40 ? "!M 700 700\r" : i < 80 ? "!M 300 900\r" : "!M 0 0\r";
    motor->write(reinterpret_cast<const uint8_t*>(line.data()), line.size());
    run.wait(0.05);
  }
  CHECK(run.health().at("simulator").health_state == health_t::HEALTH_DEGRADED);
  CHECK_THAT(run.output("simulator"), Catch::Contains("model hidden: speed up to "));
  CHECK(run.end("simulator") == 0);
  const std::vector<sim::TruthRow> truth = run.truth();
  const ModelDocument model = parseModelDocument(kHidden, "m");
  const std::vector<MotionSample> wanted = predicted(model, truth);
  ModelDocument plain = model;
  plain.vehicle.effects = {};
  plain.measurement = {};
  const std::vector<MotionSample> without = predicted(plain, truth);
  double largest = 0.0, largest_yaw = 0.0, largest_without = 0.0;
  for (const auto& [utime, T_map_body] : said) {
    const double time = static_cast<double>(utime - truth.front().utime) * 1e-6;
    if (time < 0.0 || time > wanted.back().time) continue;
    const Pose2 there = poseAt(wanted, time), elsewhere = poseAt(without, time);
    largest = std::max(largest, (T_map_body.position() - there.position()).norm());
    largest_yaw = std::max(largest_yaw, std::abs(wrapAngle(T_map_body.yaw - there.yaw)));
    largest_without =
        std::max(largest_without, (T_map_body.position() - elsewhere.position()).norm());
  }
  // The INS has its own noise: 3 mm and 1 mrad per sample, and biases of 2 cm and 2 mrad.
  CAPTURE(largest, largest_yaw);
  CHECK(largest < 0.1);
  CHECK(largest_yaw < 0.02);
  CHECK(largest_without > 0.5);
  CHECK(truth.back().T_map_body.x > 1.0);
}

}  // namespace tread::testing
