// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// A model file behind the serial lines: the node on the virtual bus, its bytes decoded by the
// driver's core, compared with simulate() and measure() of the same file.
#include <cmath>
#include <map>
#include <memory>

#include <catch2/catch.hpp>

#include <tread/health_t.hpp>

#include "common/bus/virtual_bus.hpp"
#include "common/geometry/se3.hpp"
#include "common/link/make_link.hpp"
#include "common/vehicle/kernel.hpp"
#include "common/vehicle/model_file.hpp"
#include "modules/ins_driver/nmea/nmea_ins.hpp"
#include "modules/simulator/model_vehicle.hpp"
#include "modules/simulator/simulator_node.hpp"
#include "tests/simulator/shipped_robot.hpp"

namespace tread::sim {
namespace {

constexpr int64_t kStart = 1'000'000;
constexpr int64_t kSlice = 2000;  // [us] step of the node

const std::string kPlain =
    "name: m\nkind: power\nfull_speed: 1.1\ngauge: 0.6\nlag: 0.15\ndelay: 0.05\n"
    "forward_gain: 1.046\nyaw_gain: 1.223\n";
const std::string kHidden = kPlain +
                            "effects:\n  turn_power_limit: {limit: 0.6}\n"
                            "  centrifugal_drift: {time: 0.15}\n"
                            "measurement:\n  lever_arm_x: {offset: 0.3}\n"
                            "  ins_latency: {latency: 0.2}\n";
const std::string kOfSpeeds =
    "name: m\nkind: track_speed\ngauge: 0.6\nlag: 0.15\ndelay: 0.05\nyaw_gain: 0.8\n";
constexpr double kTopSpeed = 1.4;  // [m/s] of a controller with speed loops
const std::string kEverythingOff = kPlain +
                                   "effects:\n  turn_power_limit: {inverse_limit: 0}\n"
                                   "  centrifugal_drift: {time: 0}\n"
                                   "measurement:\n  lever_arm_x: {offset: 0}\n"
                                   "  ins_latency: {latency: 0}\n";

/// Instruments without noise: the remaining error is their resolution.
SimulatorSettings settingsOf(bool motion_noise, std::optional<double> top_speed) {
  SimulatorSettings settings;
  settings.robot = shippedRobot();
  InsParameters& ins = settings.robot.ins;
  ins.position_noise = ins.position_bias = ins.height_noise = ins.heading_noise = 0.0;
  ins.heading_bias = ins.attitude_noise = ins.velocity_noise = ins.rate_noise = 0.0;
  settings.robot.start_utime = kStart;
  settings.robot.start = {2.0, 3.0, 0.5};
  settings.robot.motion_noise = motion_noise;
  settings.robot.wiring.top_speed = top_speed;
  return settings;
}

ins::InsConfig driverOf(const SimulatorSettings& settings) {
  ins::InsConfig config;
  config.origin = ins::GeoOrigin{};
  config.origin->point = {settings.ins.origin_latitude * kPi / 180.0,
                          settings.ins.origin_longitude * kPi / 180.0};
  config.origin->altitude = settings.ins.origin_height - settings.ins.geoid_separation;
  config.latency_us = settings.robot.ins.latency_us;
  return config;
}

/// Straight, both turns, a turn on the spot, reverse: per mille for two seconds each.
std::array<int, 2> commandAt(int64_t since_start) {
  static const std::array<std::array<int, 2>, 6> kCommands{
      {{800, 800}, {300, 1000}, {1000, 500}, {-400, 400}, {-600, -600}, {0, 0}}};
  return kCommands[static_cast<size_t>(since_start / 2'000'000) % kCommands.size()];
}

/// A simulator that runs a model on a virtual bus, with the drivers' line ends in the test.
class Bench {
 public:
  explicit Bench(const std::string& model, bool motion_noise = false, WorldDescription world = {},
                 std::optional<double> top_speed = {})
      : settings_(settingsOf(motion_noise, top_speed)),
        document_(parseModelDocument(model, "m.yaml")),
        bus_(1),
        devices_(std::make_shared<const World>(std::move(world)), settings_,
                 partsOf(document_, settings_.robot)),
        driver_(driverOf(settings_)) {
    std::tie(ins_, ins_device_) = makePipe();
    std::tie(motor_, motor_device_) = makePipe();
    bus_.addNode("simulator", [this](Bus& bus) {
      return std::make_unique<SimulatorNode>(
          devices_, bus, DeviceLines{*ins_device_, *motor_device_}, nullptr,
          [this](const std::string& line) { said.push_back(line); });
    });
    bus_.outside().subscribe<health_t>(kHealth,
                                       [this](const health_t& message) { health = message; });
  }

  /// Sends commands, and records powers and INS.
  void drive(double seconds) {
    const int64_t end = bus_.now() + static_cast<int64_t>(seconds * 1e6);
    while (bus_.now() < end) {
      const int64_t now = bus_.now();
      if (now % 20000 == 0) {
        const std::array<int, 2> command = commandAt(now - kStart);
        say("!M " + std::to_string(command[0]) + " " + std::to_string(command[1]) + "\r");
      }
      const MotorValues power = devices_.motor().output(now);
      powers.push_back({power[0], power[1]});
      bus_.runUntil(now + kSlice);
      hear(*motor_);
      const std::string bytes = hear(*ins_);
      ins_bytes += bytes;
      driver_.push(bytes, bus_.now());
      while (const auto estimate = driver_.next(bus_.now())) estimates.push_back(*estimate);
    }
  }

  /// Result of simulate() and measure() for the same commands with a model file.
  std::vector<MotionSample> predicted(const std::string& model) const {
    const ModelDocument document = parseModelDocument(model, "m.yaml");
    std::vector<MotionSample> motion{{0.0, settings_.robot.start, 0.0}};
    std::vector<TrackCommand> commands = powers;
    const double full = settings_.robot.wiring.top_speed.value_or(1.0);
    for (TrackCommand& each : commands) each = {full * each.left, full * each.right};
    const std::vector<Pose2> poses =
        simulate(document.vehicle, commands, 1e-6 * kSlice, EntryState{});
    for (const Pose2& T_start_body : poses) {
      const Pose2 T_map_body = settings_.robot.start * T_start_body;
      const double turned = T_map_body.yaw - motion.back().T_map_body.yaw;
      const double time = 1e-6 * kSlice * static_cast<double>(motion.size());
      motion.push_back({time, T_map_body, turned / (1e-6 * kSlice)});
    }
    return measure(motion, document.measurement);
  }

  /// Largest differences of the INS from a prediction: m, rad, rad/s.
  std::array<double, 3> apartFrom(const std::vector<MotionSample>& said_by_ins) const {
    std::array<double, 3> apart{};
    for (const ins::InsEstimate& estimate : estimates) {
      const double time = 1e-6 * static_cast<double>(estimate.utime - kStart);
      if (time < 0.5) continue;
      const Pose2 wanted = poseAt(said_by_ins, time);
      const Eigen::Vector2d p_map = estimate.p_map_body.head<2>();
      const double yaw = yawPitchRoll(estimate.R_map_body).yaw;
      apart[0] = std::max(apart[0], (p_map - wanted.position()).norm());
      apart[1] = std::max(apart[1], std::abs(wrapAngle(yaw - wanted.yaw)));
      apart[2] = std::max(apart[2],
                          std::abs(estimate.rate_body.z() - yawRateAt(said_by_ins, time - 0.005)));
    }
    return apart;
  }

  const RobotTruth& truth() const { return devices_.robot().truth(); }
  SimulatedDevices& devices() { return devices_; }

  std::vector<TrackCommand> powers;
  std::vector<ins::InsEstimate> estimates;
  std::string ins_bytes;
  std::vector<std::string> said;
  health_t health{};

 private:
  void say(const std::string& line) {
    motor_->write(reinterpret_cast<const uint8_t*>(line.data()), line.size());
  }
  static std::string hear(Link& line) {
    std::string bytes;
    uint8_t buffer[4096];
    if (!line.isOpen()) line.reopen(0);
    while (const auto count = line.read(buffer, sizeof buffer)) {
      if (*count == 0) break;
      bytes.append(reinterpret_cast<const char*>(buffer), *count);
    }
    return bytes;
  }

  SimulatorSettings settings_;
  ModelDocument document_;
  std::unique_ptr<Link> ins_, motor_, ins_device_, motor_device_;
  VirtualBus bus_;
  SimulatedDevices devices_;
  ins::NmeaIns driver_;
};

}  // namespace

TEST_CASE("the INS of a simulated model file says what simulate() and measure() make of it") {
  Bench bench(kHidden);
  bench.drive(14.0);
  REQUIRE(bench.estimates.size() > 650);
  const std::array<double, 3> apart = bench.apartFrom(bench.predicted(kHidden));
  CAPTURE(apart[0], apart[1], apart[2]);
  CHECK(apart[0] < 0.003);
  CHECK(apart[1] < 0.002);
  // The effects are really active: without them the same commands lead elsewhere.
  const std::array<double, 3> plain = bench.apartFrom(bench.predicted(kPlain));
  CHECK(plain[0] > 0.5);
  CHECK(plain[1] > 0.5);
}

TEST_CASE("a model of track speeds hears the speeds that its controller holds") {
  Bench bench(kOfSpeeds, false, {}, kTopSpeed);
  bench.drive(14.0);
  REQUIRE(bench.estimates.size() > 650);
  const std::array<double, 3> apart = bench.apartFrom(bench.predicted(kOfSpeeds));
  CAPTURE(apart[0], apart[1], apart[2]);
  CHECK(apart[0] < 0.003);
  CHECK(apart[1] < 0.002);
}

TEST_CASE("effects that are switched off in a model file change no byte of the simulation") {
  Bench plain(kPlain);
  Bench off(kEverythingOff);
  plain.drive(8.0);
  off.drive(8.0);
  CHECK(plain.ins_bytes == off.ins_bytes);
  const std::array<double, 3> apart = plain.apartFrom(plain.predicted(kPlain));
  CAPTURE(apart[0], apart[1], apart[2]);
  CHECK(apart[0] < 0.003);
  CHECK(apart[1] < 0.002);
}

TEST_CASE("each measurement effect of a model file acts in what the INS says") {
  for (const char* effect :
       {"heading_misalignment: {angle: 0.1}", "gyro_bias: {rate: 0.05, heading_share: 1}",
        "lever_arm_y: {offset: 0.4}", "position_scale: {scale: 0.1}",
        "heading_latency: {latency: 0.15}", "ins_latency: {latency: 0.3, gyro_share: 1}"}) {
    const std::string model = kPlain + "measurement:\n  " + effect + "\n";
    Bench bench(model);
    bench.drive(9.0);
    const std::array<double, 3> apart = bench.apartFrom(bench.predicted(model));
    CAPTURE(effect, apart[0], apart[1], apart[2]);
    CHECK(apart[0] < 0.003);
    CHECK(apart[1] < 0.002);
    CHECK(bench.apartFrom(bench.predicted(kPlain))[0] +
              bench.apartFrom(bench.predicted(kPlain))[1] >
          0.05);
  }
}

TEST_CASE("a negative latency looks ahead along the arc of the last samples") {
  const std::string model = kPlain + "measurement:\n  ins_latency: {latency: -0.1}\n";
  Bench bench(model);
  bench.drive(1.99);  // straight at a steady speed by then
  const ins::InsEstimate& newest = bench.estimates.back();
  const double time = 1e-6 * static_cast<double>(newest.utime - kStart);
  const Pose2 now = poseAt(bench.predicted(kPlain), time);
  const double ahead = (newest.p_map_body.head<2>() - now.position()).norm();
  CHECK(ahead == Approx(0.1 * 1.1 * 0.8 * 1.046).margin(0.002));
}

TEST_CASE("the velocity that the INS says is that of the point that it reports") {
  const std::string model = kPlain +
                            "measurement:\n  lever_arm_x: {offset: 0.3}\n"
                            "  heading_misalignment: {angle: 0.1}\n";
  Bench bench(model);
  bench.drive(3.9);  // the end of a steady turn
  const std::vector<MotionSample> said = bench.predicted(model);
  const ins::InsEstimate& newest = bench.estimates.back();
  const double time = 1e-6 * static_cast<double>(newest.utime - kStart);
  const Twist2 v_said = twistTo(between(poseAt(said, time - 0.05), poseAt(said, time + 0.05)), 0.1);
  CHECK(newest.v_body.x() == Approx(v_said.v_x).margin(0.03));
  CHECK(newest.v_body.y() == Approx(v_said.v_y).margin(0.03));
}

TEST_CASE("a model without spread drives the mean, one with spread differs from it and by seed") {
  const std::string spread = kPlain + "spread: {forward: 0.04, yaw: 0.08, crab: 0.01}\n";
  Bench mean(kPlain, true);
  mean.drive(6.0);
  CHECK(mean.apartFrom(mean.predicted(kPlain))[0] < 0.003);
  Bench varied(spread, true);
  Bench again(spread, true);
  Bench still(spread, false);
  for (Bench* bench : {&varied, &again, &still}) bench->drive(6.0);
  CHECK(varied.ins_bytes == again.ins_bytes);
  CHECK(varied.apartFrom(varied.predicted(kPlain))[0] > 0.01);
  CHECK(varied.apartFrom(varied.predicted(kPlain))[0] < 1.0);
  CHECK(still.apartFrom(still.predicted(kPlain))[0] < 0.003);
}

TEST_CASE("out of its model's envelope the simulator says so, once, and in HEALTH from then on") {
  const std::string narrow = kPlain + "envelope: {v: 1.5, omega: 0.7, v_omega: 2}\n";
  Bench bench(narrow);
  bench.drive(1.9);
  CHECK(bench.said.empty());
  CHECK(bench.health.health_state == health_t::HEALTH_OK);
  bench.drive(6.0);
  REQUIRE(bench.said.size() == 1);
  CHECK_THAT(bench.said[0], Catch::Contains("model m: yaw rate up to ") &&
                                Catch::Contains("made from up to 0.7 rad/s"));
  CHECK(bench.health.health_state == health_t::HEALTH_DEGRADED);
  CHECK_THAT(bench.health.health_reason, Catch::Contains("model m: yaw rate"));
  // Largest mean motions: noise may exceed commanded ones.
  Bench mean(kPlain +
                 "spread: {forward: 0.1, yaw: 0.1}\n"
                 "envelope: {v: 0.93, omega: 1.8, v_omega: 1.3}\n",
             true);
  mean.drive(8.0);
  CHECK(mean.said.empty());
}

TEST_CASE("an obstacle stops a model's vehicle, too, and it backs away from it") {
  WorldDescription world;
  world.obstacles = {boxObstacle({3.5, 3.8, 0.5}, 0.5, 4.0, 1.0)};
  Bench bench(kPlain + "effects:\n  body_inertia: {lag: 0.2}\n", false, world);
  bench.drive(3.0);
  REQUIRE(bench.truth().collisions.size() == 1);
  CHECK(bench.truth().collisions[0].penetration < 0.02);
  CHECK((bench.truth().T_map_body.position() - Eigen::Vector2d(2.0, 3.0)).norm() < 1.0);
}

TEST_CASE("a model's vehicle leans with the ground and empties its battery") {
  const std::string model = kPlain + "effects:\n  slope_pitch: {compliance: 0.05}\n";
  WorldDescription hill;
  hill.terrain.waves = {{3.0, {0.05, 0.0}, 0.0}};  // rises along x
  Bench level(model);
  Bench uphill(model, false, hill);
  for (Bench* bench : {&level, &uphill}) bench->drive(1.9);
  CHECK(uphill.truth().distance < level.truth().distance - 0.02);
  CHECK(uphill.truth().body.pitch < -0.05);
  const Battery& battery = level.devices().robot().vehicle().battery();
  CHECK(battery.voltage < 25.6);
  CHECK(battery.voltage > 24.0);
  CHECK(battery.charge < 1.0);
}

TEST_CASE(
    "what the ground takes of the speed draws current, what the drive does not give does not") {
  const auto currentOf = [](const std::string& effects) {
    ModelVehicle vehicle(parseModelDocument(kPlain + effects, "m.yaml"), std::nullopt, 1.0);
    for (int i = 0; i < 3000; ++i) vehicle.step({0.8, 0.8}, {}, 0.001);
    CHECK(vehicle.left().current == Approx(vehicle.right().current));
    return vehicle.left().current;
  };
  const double sound = currentOf("");
  CHECK(sound == Approx(0.8 * 11.0).epsilon(0.01));
  CHECK(currentOf("effects:\n  rolling_resistance: {speed: 0.1}\n") > 2.0 * sound);
  CHECK(currentOf("effects:\n  speed_saturation: {limit: 0.5}\n") < 0.8 * sound);
}

TEST_CASE("the track that is held back draws more than the other one") {
  ModelVehicle vehicle(parseModelDocument(kPlain + "effects:\n  yaw_pull: {pull: 0.2}\n", "m.yaml"),
                       std::nullopt, 1.0);
  for (int i = 0; i < 3000; ++i) vehicle.step({0.8, 0.8}, {}, 0.001);
  CHECK(vehicle.left().current > vehicle.right().current + 10.0);  // it pulls to the left
}

}  // namespace tread::sim
