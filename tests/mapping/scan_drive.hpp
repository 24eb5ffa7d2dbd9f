// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <random>

#include "common/messages/scan_messages.hpp"
#include "modules/mapping/core/scan_monitor.hpp"
#include "modules/mapping/core/spatial_track.hpp"
#include "modules/simulator/core/instruments.hpp"

namespace tread::mapping {

/// A body in the simulator's worlds with laser and INS, and the monitor of the laser.
class ScanDrive {
 public:
  explicit ScanDrive(sim::WorldDescription world, int beams = 181, uint64_t seed = 1)
      : random(seed),
        world_(std::make_shared<const sim::World>(std::move(world))),
        laser_(laserOf(beams), seed, kStart),
        ins_({}, seed, kStart) {
    while (world_->collision({1.3, 0.68}, pose)) pose.y += 0.2;
  }

  /// Moves for some seconds; counts suspicions.
  void drive(double v_x, double omega, double seconds) {
    const int64_t end = utime_ + std::llround(seconds * 1e6);
    while (utime_ < end) step(v_x, omega);
  }
  /// Like a robot that drives about and turns in front of obstacles.
  void wander(double seconds) {
    const auto draw = [this](double low, double high) {
      return std::uniform_real_distribution(low, high)(random);
    };
    const int64_t end = utime_ + std::llround(seconds * 1e6);
    while (utime_ < end) {
      const double v_x = draw(0.0, 1.0) < 0.2 ? 0.0 : draw(-0.2, 1.1);
      const double omega = draw(0.0, 1.0) < 0.3 ? 0.0 : draw(-1.0, 1.0);
      drive(v_x, omega, draw(0.3, 4.0));
    }
  }

  int64_t utime() const { return utime_; }
  double seconds() const { return static_cast<double>(utime_ - kStart) * 1e-6; }

  Pose2 pose;
  ScanMonitor monitor{{0.65, 0.65, 0.34}, 1.2};
  std::function<void(scan_t&)> disturb;
  std::mt19937_64 random;
  int64_t scans = 0, suspected = 0;
  int verdicts = 0;
  std::string told;                      ///< all verdicts
  double travelled = 0.0, turned = 0.0;  ///< [m, rad] in all
  int64_t named = 0;                     ///< [us] beginning of the last verdict

 private:
  static constexpr int64_t kStart = 1'000'000;
  static constexpr int64_t kStep = 10'000;

  static sim::LaserParameters laserOf(int beams) {
    sim::LaserParameters laser;
    laser.mounting.p_body = {0.25, 0.0, 0.5};
    laser.beams = beams;
    return laser;
  }

  void step(double v_x, double omega) {
    const Pose2 next = pose * integrate({v_x, 0.0, omega}, 1e-6 * kStep);
    const bool free =
        !world_->collision({1.3, 0.68}, next) && next.position().cwiseAbs().maxCoeff() < 100.0;
    const Pose2 turns{pose.x, pose.y, pose.yaw + 0.5 * 1e-6 * kStep};
    const Pose2 to = free ? next : turns;
    travelled += distanceBetween(pose, to);
    turned += std::abs(to.yaw - pose.yaw);
    pose = to;
    utime_ += kStep;
    const sim::Bearing bearing = world_->bearing(pose, {0.5, 0.5, 0.3});
    const sim::BodyPose body = sim::poseOnGround(pose, bearing.height, bearing.gradient);
    if (ins_.due(utime_)) ins_.measure(utime_, {body, pose.yaw, {}, {}});
    for (const sim::InsMeasurement& sample : ins_.takeSamples(utime_))
      track_.push(sample.utime,
                  isometryFrom(sample.p_map, {sample.yaw, sample.pitch, sample.roll}));
    laser_.advanceTo(utime_, *world_, body);
    for (sim::LaserScan& scan : laser_.takeScans()) waiting_.push_back(messageOf(scan));
    while (!waiting_.empty() &&
           waiting_.front().utime + waiting_.front().duration <= track_.newest()) {
      watch(waiting_.front());
      waiting_.pop_front();
    }
  }

  scan_t messageOf(sim::LaserScan& scan) const {
    scan_t message{};
    message.utime = scan.utime;
    for (int i = 0; i < 3; ++i) message.sensor_position[i] = laser_.parameters().mounting.p_body[i];
    message.sensor_orientation[0] = 1.0;
    message.duration = static_cast<int32_t>(scan.sweep_us);
    message.angle_first = scan.angle_min;
    message.angle_step = scan.angle_step;
    message.range_min = laser_.parameters().range_min;
    message.range_max = laser_.parameters().range_max;
    message.num_beams = static_cast<int32_t>(scan.ranges.size());
    message.ranges = std::move(scan.ranges);
    return message;
  }

  void watch(scan_t message) {
    if (disturb) disturb(message);
    std::string refusal;
    const auto received = readScan(message, refusal);
    constexpr int64_t kGap = 100'000;
    if (!received) return;
    const auto first = track_.at(received->first, kGap), last = track_.at(received->last, kGap);
    if (!first || !last) return;
    const Scan scan{received->last, *first, *last, received->T_body_sensor, received->beams};
    const bool had = monitor.verdict() != ScanDefect::kNone;
    const ScanDefect defect = monitor.update({scan, received->fingerprint},
                                             [&](int64_t utime) { return track_.at(utime, kGap); });
    ++scans;
    suspected += defect == ScanDefect::kNone ? 0 : 1;
    if (had || monitor.verdict() == ScanDefect::kNone) return;
    ++verdicts;
    told += std::to_string(seconds()) + " s: " + monitor.words() + "\n";
    named = utime_;
  }

  std::shared_ptr<const sim::World> world_;
  sim::Laser laser_;
  sim::Ins ins_;
  SpatialTrack track_{6'000'000, 10.0};
  std::deque<scan_t> waiting_;
  int64_t utime_ = kStart;
};

}  // namespace tread::mapping
