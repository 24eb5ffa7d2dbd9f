// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Drivers of binary messages with emulated devices, written independently of each other.
#include <catch2/catch.hpp>

#include <algorithm>
#include <memory>
#include <random>

#include "modules/ins_driver/novatel/novatel_ins.hpp"
#include "modules/ins_driver/ublox/ublox_ins.hpp"
#include "modules/ins_driver/vectornav/vectornav_ins.hpp"
#include "modules/ins_driver/xsens/xsens_ins.hpp"
#include "modules/simulator/emulators/novatel/novatel_emulator.hpp"
#include "modules/simulator/emulators/ublox/ublox_emulator.hpp"
#include "modules/simulator/emulators/vectornav/vectornav_emulator.hpp"
#include "modules/simulator/emulators/xsens/xsens_emulator.hpp"

namespace tread::ins::binary {
namespace {

constexpr int64_t kPeriodUs = 20'000;
constexpr int64_t kLatencyUs = 20'000;
constexpr double kTurn = 0.4;  // [rad/s]
const Eigen::Vector3d kArm(0.6, 0.2, 1.1);
constexpr double kMountedYaw = 0.3;

struct Truth {
  Eigen::Vector3d p_map;
  double yaw;
};

/// The body on a left-hand circle of 3 m radius, level.
Truth truthAt(int64_t utime) {
  const double yaw = 3.0 + kTurn * static_cast<double>(utime) * 1e-6;
  return {{40.0 + 3.0 * std::sin(yaw), -25.0 - 3.0 * std::cos(yaw), 0.5}, yaw};
}

/// Measurement of a device at kArm, rotated by kMountedYaw.
sim::InsMeasurement sampleAt(int64_t utime) {
  const Truth truth = truthAt(utime);
  const Eigen::AngleAxisd R_map_body(truth.yaw, Eigen::Vector3d::UnitZ());
  sim::InsMeasurement sample;
  sample.utime = utime;
  sample.p_map = truth.p_map + R_map_body * kArm;
  sample.yaw = truth.yaw + kMountedYaw;
  const Eigen::Vector3d v_point =
      Eigen::Vector3d(3.0 * kTurn, 0.0, 0.0) + Eigen::Vector3d(0.0, 0.0, kTurn).cross(kArm);
  sample.v_body = Eigen::AngleAxisd(-kMountedYaw, Eigen::Vector3d::UnitZ()) * v_point;
  sample.rate_body.z() = kTurn;
  return sample;
}

InsConfig deviceConfig() {
  const sim::MapOnEarth map;
  InsConfig config;
  config.origin = GeoOrigin{{map.origin_latitude * kPi / 180.0, map.origin_longitude * kPi / 180.0},
                            map.origin_height - map.geoid_separation,
                            0.0};
  config.geoid_separation = map.geoid_separation;
  config.latency_us = kLatencyUs;
  config.p_body_antenna = kArm;
  config.body_device.yaw = kMountedYaw;
  return config;
}

struct Device {
  std::unique_ptr<BinaryIns> driver;
  std::unique_ptr<sim::BinaryInsEmulator> emulator;
};

Device deviceOf(const std::string& name, const InsConfig& config = deviceConfig()) {
  const sim::MapOnEarth map;
  if (name == "novatel")
    return {std::make_unique<NovatelIns>(config), std::make_unique<sim::NovatelEmulator>(map, 5)};
  if (name == "ublox")
    return {std::make_unique<UbloxIns>(config), std::make_unique<sim::UbloxEmulator>(map, 5)};
  if (name == "xsens")
    return {std::make_unique<XsensIns>(config), std::make_unique<sim::XsensEmulator>(map, 5)};
  return {std::make_unique<VectornavIns>(config), std::make_unique<sim::VectornavEmulator>(map, 5)};
}

struct Worst {
  double position = 0.0, yaw = 0.0, velocity = 0.0, rate = 0.0;
  int64_t poses = 0, rates = 0;
};

void compare(const InsEstimate& ins, Worst& worst) {
  if (ins.status & (InsStatus::kNoPosition | InsStatus::kNoHeading)) return;
  const Truth truth = truthAt(ins.utime);
  ++worst.poses;
  worst.position = std::max(worst.position, (ins.p_map_body - truth.p_map).norm());
  const double yaw = yawPitchRoll(ins.R_map_body).yaw;
  worst.yaw = std::max(worst.yaw, std::abs(wrapAngle(yaw - truth.yaw)));
  const Eigen::Vector2d v(3.0 * kTurn, 0.0);
  // The first heading has no rate yet for correcting the arm's motion.
  if (!(ins.status & InsStatus::kNoVelocity) && worst.poses > 1)
    worst.velocity = std::max(worst.velocity, (ins.v_body.head<2>() - v).norm());
  if (!std::isfinite(ins.rate_body.z())) return;
  ++worst.rates;
  worst.rate = std::max(worst.rate, std::abs(ins.rate_body.z() - kTurn));
}

/// Drives from one time to another [s].
Worst drive(Device& device, double from, double to) {
  Worst worst;
  for (int64_t utime = std::llround(from * 1e6); utime < std::llround(to * 1e6);
       utime += kPeriodUs) {
    device.emulator->add(sampleAt(utime));
    const int64_t arrival = utime + kLatencyUs;
    device.driver->push(device.emulator->transmit(arrival), arrival);
    while (const auto ins = device.driver->next(arrival + 15'000)) compare(*ins, worst);
  }
  return worst;
}

/// Position resolution of a device [m].
double grainOf(const std::string& name) {
  return name == "ublox" ? 0.015 : 2e-3;
}

const char* const kDevices[] = {"novatel", "ublox", "vectornav", "xsens"};

}  // namespace

TEST_CASE("what a device of binary messages measures comes out as the body's motion") {
  for (const std::string name : kDevices) {
    Device device = deviceOf(name);
    const Worst worst = drive(device, 1.0, 61.0);
    CAPTURE(name, worst.position, worst.yaw, worst.velocity, worst.rate, device.driver->refusals());
    CHECK(worst.poses == 3000);
    CHECK(worst.position < grainOf(name));
    CHECK(worst.yaw < 1e-5);
    CHECK(worst.velocity < 2e-3);
    CHECK(worst.rates > 2900);  // NovAtel's are available once its samples per second are known
    CHECK(worst.rate < 1e-4);
    CHECK(device.driver->framer().refusals().empty());
    CHECK(device.driver->framer().strayBytes() == 0);
    CHECK(device.driver->assembler().counts().jumps == 0);
  }
}

TEST_CASE("dropped bytes, wrong checksums, half messages and garbage never make a wrong pose") {
  for (const std::string name : kDevices) {
    Device device = deviceOf(name);
    sim::BinaryInsFaults faults;
    faults.drop_share = faults.corrupt_share = faults.cut_share = faults.garbage_share = 0.03;
    device.emulator->setFaults(faults);
    const Worst worst = drive(device, 1.0, 61.0);
    CAPTURE(name, worst.position, worst.yaw, worst.velocity, device.driver->refusals());
    CHECK(worst.poses > 2300);
    CHECK(worst.position < grainOf(name) + 2e-3);  // extrapolated for 150 ms at most, in a curve
    CHECK(worst.yaw < 1e-4);
    CHECK(device.driver->reasons().at("wrong checksum") > 50);
    CHECK(device.driver->framer().waiting() < kMaxFrame);
  }
}

TEST_CASE("a stall is a gap, and a reboot says nothing until the device is aligned") {
  for (const std::string name : kDevices) {
    Device device = deviceOf(name);
    drive(device, 1.0, 10.0);
    sim::BinaryInsFaults faults;
    faults.silent = true;
    device.emulator->setFaults(faults);
    CHECK(drive(device, 10.0, 12.0).poses == 0);
    device.emulator->setFaults({});
    CHECK(drive(device, 12.0, 15.0).poses > 140);
    CHECK(device.driver->assembler().counts().gaps >= 1);
    device.emulator->reboot(15'000'000);
    CHECK(drive(device, 15.0, 17.9).poses == 0);
    const Worst after = drive(device, 18.0, 25.0);
    CAPTURE(name, after.position, device.driver->refusals());
    CHECK(after.poses > 330);
    CHECK(after.position < grainOf(name));
  }
}

TEST_CASE("a device without a fix is told from one without a line") {
  for (const std::string name : kDevices) {
    Device device = deviceOf(name);
    sim::BinaryInsFaults faults;
    faults.no_fix = true;
    device.emulator->setFaults(faults);
    CAPTURE(name);
    CHECK(drive(device, 1.0, 3.0).poses == 0);
    CHECK(device.driver->lastMessage());
    CHECK_FALSE(device.driver->advice().no_position.empty());
  }
}

TEST_CASE("random and mutated bytes neither crash, nor grow, nor make a pose without a checksum") {
  for (const std::string name : kDevices) {
    Device device = deviceOf(name);
    std::mt19937_64 random(11);
    for (int i = 0; i < 50; ++i) device.emulator->add(sampleAt(4'000'000 + i * kPeriodUs));
    const std::string good = device.emulator->transmit(0);
    int64_t now = 10'000'000;
    int64_t fed = 0;
    while (fed < 1'000'000) {
      std::string chunk = good.substr(random() % good.size(), 1 + random() % 900);
      // Each byte is altered with probability 1/30: a message of 60 bytes rarely survives.
      for (size_t at = random() % 30; at < chunk.size(); at += 1 + random() % 60)
        chunk[at] = static_cast<char>(random() & 0xFF);
      if (random() % 4 == 0) {
        for (char& byte : chunk) byte = static_cast<char>(random() & 0xFF);
      }
      device.driver->push(chunk, now += 5'000);
      fed += static_cast<int64_t>(chunk.size());
      while (const auto ins = device.driver->next(now)) {
        CHECK(ins->utime <= now);
        if (!(ins->status & InsStatus::kNoPosition)) CHECK(ins->p_map_body.norm() < 100.0);
      }
      CHECK(device.driver->framer().waiting() < kMaxFrame);
    }
    CAPTURE(name, device.driver->refusals());
    CHECK(device.driver->reasons().at("wrong checksum") > 100);
    // It still receives: a whole second is decoded after the garbage.
    device.driver->interrupt();
    const int64_t before = device.driver->frames();
    device.driver->push(good, now + 1'000'000);
    device.driver->interrupt();
    CHECK(device.driver->frames() - before >= 49);
  }
}

}  // namespace tread::ins::binary
