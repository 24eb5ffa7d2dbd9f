// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The driver with the emulated device: two independent implementations of one protocol.
#include <catch2/catch.hpp>

#include <algorithm>

#include "modules/ins_driver/nmea/nmea_ins.hpp"
#include "modules/simulator/emulators/nmea/nmea_ins_emulator.hpp"

using namespace tread;
using namespace tread::ins;

namespace {

constexpr int64_t kPeriodUs = 20'000;
constexpr int64_t kLatencyUs = 20'000;

/// A left-hand circle on a slope, as the truth at a time.
sim::InsMeasurement truthAt(int64_t utime) {
  const double t = static_cast<double>(utime) * 1e-6;
  sim::InsMeasurement truth;
  truth.utime = utime;
  truth.rate_body.z() = 0.4;
  truth.yaw = 3.0 + 0.4 * t;
  truth.v_body = {1.2, -0.1, 0.0};
  const double c = std::cos(truth.yaw);
  const double s = std::sin(truth.yaw);
  // The integral of the turning velocity.
  truth.p_map = {40.0 + (1.2 * s - 0.1 * c) / 0.4, -25.0 + (-1.2 * c - 0.1 * s) / 0.4, 0.5};
  truth.pitch = 0.1 * std::sin(t);
  truth.roll = -0.05;
  return truth;
}

InsConfig emulatedDevice() {
  const sim::NmeaInsSettings device;
  InsConfig config;
  config.origin =
      GeoOrigin{{device.origin_latitude * kPi / 180.0, device.origin_longitude * kPi / 180.0},
                device.origin_height - device.geoid_separation,
                0.0};
  config.latency_us = kLatencyUs;
  config.last_type = NmeaSentence(Rot{}).index();
  return config;
}

struct Worst {
  double position = 0.0;
  double yaw = 0.0;
  double tilt = 0.0;
  double velocity = 0.0;
  int64_t messages = 0;
};

void compare(const InsEstimate& ins, Worst& worst) {
  const sim::InsMeasurement truth = truthAt(ins.utime);
  ++worst.messages;
  if (!(ins.status & InsStatus::kNoPosition))
    worst.position = std::max(worst.position, (ins.p_map_body - truth.p_map).norm());
  if (!(ins.status & InsStatus::kNoHeading)) {
    const YawPitchRoll angles = yawPitchRoll(ins.R_map_body);
    worst.yaw = std::max(worst.yaw, std::abs(wrapAngle(angles.yaw - truth.yaw)));
    if (!(ins.status & InsStatus::kNoAttitude)) {
      worst.tilt = std::max(
          {worst.tilt, std::abs(angles.pitch - truth.pitch), std::abs(angles.roll - truth.roll)});
    }
  }
  if (!(ins.status & InsStatus::kNoVelocity))
    worst.velocity = std::max(worst.velocity, (ins.v_body - truth.v_body).head<2>().norm());
}

Worst drive(double seconds, const sim::NmeaInsFaults& faults, NmeaIns& ins) {
  sim::NmeaInsEmulator device({}, 7);
  device.setFaults(faults);
  Worst worst;
  const int64_t end = std::llround(seconds * 1e6);
  for (int64_t utime = kPeriodUs; utime < end; utime += kPeriodUs) {
    device.add(truthAt(utime));
    const int64_t arrival = utime + kLatencyUs;
    ins.push(device.transmit(arrival), arrival);
    while (const auto estimate = ins.next(arrival)) compare(*estimate, worst);
    // The line is quiet until the next measurement, which ends an epoch without its last sentence.
    while (const auto estimate = ins.next(arrival + 15'000)) compare(*estimate, worst);
  }
  return worst;
}

}  // namespace

TEST_CASE("what the emulated INS measures comes out of the driver as it went in") {
  NmeaIns ins(emulatedDevice());
  const Worst worst = drive(60.0, {}, ins);
  CAPTURE(worst.position, worst.yaw, worst.tilt, worst.velocity);
  CHECK(worst.messages == 2999);
  CHECK(worst.position < 1e-3);
  CHECK(worst.yaw < 1e-5);  // the device prints .001 deg
  CHECK(worst.tilt < 1e-5);
  CHECK(worst.velocity < 2e-4);
  CHECK(ins.counts().refused.total() == 0);
  CHECK(ins.assembler().counts().jumps == 0);
}

TEST_CASE("a bad line costs sentences but never makes a wrong pose") {
  sim::NmeaInsFaults faults;
  faults.garbage_share = 0.05;
  faults.corrupt_share = 0.05;
  faults.cut_share = 0.02;
  NmeaIns ins(emulatedDevice());
  const Worst worst = drive(120.0, faults, ins);
  CAPTURE(worst.position, worst.yaw, worst.tilt, worst.velocity);
  CHECK(worst.messages > 5500);
  CHECK(worst.position < 2e-3);  // extrapolated straight for 60 ms while it turns
  CHECK(worst.yaw < 2e-5);       // with extrapolation by its rate slightly less accurate
  CHECK(worst.tilt < 7e-3);      // pitch and roll are held for 60 ms at most, here at 0.1 rad/s
  CHECK(worst.velocity < 1e-3);
  CHECK(ins.counts().refused.total() > 1000);
}
