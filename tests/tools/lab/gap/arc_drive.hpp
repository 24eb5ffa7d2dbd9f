// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <random>
#include <string>

#include "common/log/event_log.hpp"
#include "common/vehicle/kernel.hpp"
#include "common/vehicle/model_file.hpp"
#include "tests/tools/lab/gap/gap_program.hpp"
#include "tests/tools/lab/gap/small_log.hpp"

namespace tread::gap::samples {

/// A log of a model that drives arcs at two speeds: track speeds at 20 Hz, INS at every n-th
/// sample.
inline void writeDrive(const std::string& path, double seconds, double yaw_gain = 0.49,
                       const std::string& note = "", int ins_every = 2) {
  VehicleModel truth = readModelFile(kModels + "warthog_asphalt.yaml");
  truth.yaw_gain = yaw_gain;
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise(0.0, 0.01);
  tread::samples::SmallLog log;
  VehicleKernel kernel(truth, EntryState{});
  constexpr double kPeriod = 0.05;
  int64_t id = 0;
  for (int i = 0; i * kPeriod < seconds; ++i) {
    const double time = i * kPeriod;
    const double turn = i / 40 % 3 * 0.4 - 0.4;
    const double speed = i / 40 % 5 < 2 ? 1.0 : 0.6;
    const TrackCommand command{speed - turn, speed + turn};
    log.motor(time, command);
    Pose2 T_map_body = kernel.pose();
    T_map_body.x += noise(random);
    T_map_body.y += noise(random);
    if (i % ins_every == 0) log.ins(time, T_map_body, kernel.twist().omega + noise(random));
    if (i % 40 == 39) log.execution(++id, time - 1.95, time);
    kernel.step(command, kPeriod);
  }
  config_t config{};
  config.utime = tread::samples::at(0.0);
  config.config_process = "tread-import";
  config.config_text = note;
  if (!note.empty()) log.add(kConfig, config);
  LogWriter writer(path);
  for (const LogEvent& event : log.events)
    writer.write(event.utime, event.channel, event.bytes.data(), event.bytes.size());
}

}  // namespace tread::gap::samples
