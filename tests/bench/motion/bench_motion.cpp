// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Counts the motor bridge's false alarms about the motion in hours of faultless driving in
// virtual time.
#include <cmath>
#include <cstdio>
#include <map>
#include <random>

#include <CLI/CLI.hpp>

#include "common/config/command_line.hpp"
#include "common/link/make_link.hpp"
#include "common/messages/operator_beacon.hpp"
#include "modules/simulator/simulator_node.hpp"
#include "tests/motor_bridge/endless_planner.hpp"
#include "tests/motor_bridge/messages.hpp"
#include "tools/lab/missions/robot_system.hpp"

namespace {

using namespace tread;

struct Arguments {
  double hours = 1.0;
  uint64_t seed = 1;
};

/// One drive, with the same world for the same seed.
constexpr double kDrive = 600.0;  // [s]
constexpr double kReach = 120.0;  // [m] extent of the patches of ground around the start
constexpr int kPatches = 60;
constexpr double kSteepest = 0.18;         // [1] slope of the ground in half of the worlds
constexpr int64_t kArmAgain = 2'000'000;   // [us] of standing
constexpr int kDisarmed = 600;             // one in so many steps of 50 ms
constexpr const char* kName = "somebody";  // the operator

/// Patches of all kinds of ground; wavy in half of the worlds.
sim::WorldDescription patchwork(uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto draw = [&](double from, double to) {
    return std::uniform_real_distribution(from, to)(random);
  };
  const char* const surfaces[] = {"grass", "cinder", "tarmac", "gravel"};
  sim::WorldDescription world;
  world.name = "patchwork";
  world.bounds = {{-kReach, -kReach}, {kReach, kReach}};
  world.base_surface = surfaces[random() % 4];
  for (int i = 0; i < kPatches; ++i) {
    const Eigen::Vector2d at(draw(-kReach, kReach), draw(-kReach, kReach));
    const Eigen::Vector2d along = Eigen::Rotation2Dd(draw(0.0, 3.1)) * Eigen::Vector2d::UnitX();
    world.regions.push_back(sim::stripRegion(surfaces[random() % 4], at,
                                             at + draw(5.0, 40.0) * along, draw(3.0, 15.0)));
  }
  for (int i = 0; i < 3 && seed % 2 == 0; ++i) {
    const double length = draw(4.0, 40.0);
    const Eigen::Vector2d along = Eigen::Rotation2Dd(draw(0.0, 6.3)) * Eigen::Vector2d::UnitX();
    const Eigen::Vector2d k = 2.0 * M_PI / length * along;
    world.terrain.waves.push_back({draw(0.0, kSteepest / 3.0) / k.norm(), k, draw(0.0, 6.3)});
  }
  return world;
}

/// Replaces the planner: executes patterns drawn from those that may follow.
class Wanderer : public Node {
 public:
  Wanderer(Bus& bus, const PatternSet& set, uint64_t seed)
      : bus_(bus), set_(set), random_(seed), planner_(bus.bootId()), rest_(restOf(set)) {
    class_ = rest_;
    planner_.slots = [this](int64_t id) { return next(id); };
    bus_.subscribe<execution_t>(kExecution, [this](const execution_t& message) {
      last_ = motor::newest(message);
      const bool aborted = last_ && last_->outcome == ExecutionOutcome::kAborted;
      if (aborted) class_ = rest_;
    });
  }
  int64_t period() const override { return 50'000; }
  void step(int64_t utime) override {
    bus_.publish(kProgram, motor::toMessage(planner_.plan(utime, last_)));
  }

 private:
  static std::string restOf(const PatternSet& set) {
    for (const MotionClass& one : set.content().classes)
      if (one.steady == Command{}) return one.name;
    return set.content().classes.front().name;
  }
  motor::ProgramSlot next(int64_t id) {
    const std::vector<const MotionPattern*> may = set_.startingIn(class_);
    const MotionPattern& pattern = *may[random_() % may.size()];
    class_ = pattern.exit_class;
    motor::ProgramSlot slot;
    slot.execution_id = id;
    slot.pattern_id = pattern.id;
    slot.set_version = set_.version();
    slot.kinds = kindsOf(set_.content().channels);
    slot.period_us = set_.content().period_us;
    slot.series = pattern.commands;
    return slot;
  }

  Bus& bus_;
  const PatternSet& set_;
  std::mt19937_64 random_;
  motor::EndlessPlanner planner_;
  std::string rest_, class_;
  std::optional<ExecutionRecord> last_;
};

struct Counts {
  double moving = 0.0;  ///< [s] with non-zero commands
  double metres = 0.0;
  std::map<std::string, int> stops;  ///< by reason
};

/// Devices, INS driver and motor bridge with the shipped configuration, driven by a Wanderer.
void drive(const missions::RobotConfig& robot, uint64_t seed, Counts& counts) {
  VirtualBus bus(seed);
  auto [ins_line, ins_device] = makePipe();
  auto [motor_line, motor_device] = makePipe();
  sim::SimulatorSettings settings;
  settings.robot = robot.simulated;
  settings.robot.start_utime = bus.now();
  settings.robot.seed = seed;
  sim::SimulatedDevices devices(std::make_shared<const sim::World>(patchwork(seed)), settings);
  MemoryStore store;
  bus.addNode("simulator", [&, &ins = *ins_device, &motors = *motor_device](Bus& end) {
    return std::make_unique<sim::SimulatorNode>(devices, end, sim::DeviceLines{ins, motors});
  });
  bus.addNode("ins_driver", [&, &line = *ins_line](Bus& end) {
    return std::make_unique<ins::InsDriverNode>(robot.ins_driver, end, line, store);
  });
  bus.addNode("motor_bridge", [&, &line = *motor_line](Bus& end) {
    return std::make_unique<motor::MotorBridgeNode>(robot.motor_bridge, end, line);
  });
  bus.addNode("planner", [&](Bus& end) {
    return std::make_unique<Wanderer>(end, robot.learner.shipped, seed);
  });
  std::mt19937_64 random(seed);
  OperatorBeacon beacon(bus.outside(), kName);
  motor_t motor{};
  int16_t was = motor_t::STATE_DISARMED;
  int64_t stood_since = bus.now();
  bus.outside().subscribe<motor_t>(kMotor, [&](const motor_t& message) {
    const bool by_us = message.state_reason.rfind("disarmed by", 0) == 0;
    if (was == motor_t::STATE_DRIVING && message.bridge_state == motor_t::STATE_DISARMED && !by_us)
      ++counts.stops[message.state_reason];
    was = message.bridge_state;
    motor = message;
  });
  const double period = 0.05;
  const int64_t end = bus.now() + static_cast<int64_t>(kDrive * 1e6);
  while (bus.now() < end) {
    bus.runUntil(bus.now() + static_cast<int64_t>(period * 1e6));
    beacon.step(bus.now());
    const bool moves = motor.command[0] != 0.0F || motor.command[1] != 0.0F;
    if (was != motor_t::STATE_DISARMED) stood_since = bus.now();
    // Also in the middle of a pattern; the next one then begins at rest.
    const bool disarms = random() % kDisarmed == 0;
    if (disarms || bus.now() - stood_since > kArmAgain) {
      arm_t arm{};
      arm.utime = bus.now();
      arm.armed = !disarms;
      arm.armed_by = kName;
      bus.outside().publish(kArm, arm);
    }
    counts.moving += moves ? period : 0.0;
  }
  counts.metres += devices.robot().truth().distance;
}

int run(const Arguments& arguments) {
  const missions::RobotConfig robot = missions::readRobot(TREAD_CONFIG_DIR "/robots/teodor");
  Counts counts;
  uint64_t seed = arguments.seed;
  for (; counts.moving < 3600.0 * arguments.hours; ++seed) {
    const std::map<std::string, int> before = counts.stops;
    drive(robot, seed, counts);
    for (const auto& [reason, count] : counts.stops) {
      const auto found = before.find(reason);
      if (found == before.end() || found->second != count)
        std::printf("seed %llu: %s\n", static_cast<unsigned long long>(seed), reason.c_str());
    }
    std::fflush(stdout);
  }
  int stops = 0;
  for (const auto& [reason, count] : counts.stops) stops += count;
  const double hours = counts.moving / 3600.0;
  std::printf(
      "%.1f h of motion, %.0f km in %llu drives, seeds %llu to %llu: stopped %d times, %.2f an "
      "hour (0 of n: below %.2f with 95 %% confidence)\n",
      hours, 1e-3 * counts.metres, static_cast<unsigned long long>(seed - arguments.seed),
      static_cast<unsigned long long>(arguments.seed), static_cast<unsigned long long>(seed - 1),
      stops, stops / hours, 3.0 / hours);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Drives for hours without faults and counts the stops of the motor bridge.",
               "bench-motion"};
  Arguments arguments;
  app.add_option("--hours", arguments.hours, "of motion")->check(CLI::Range(0.01, 10000.0));
  app.add_option("--seed", arguments.seed, "seed of the first drive; the others count up from it");
  if (const auto code = parseCommandLine(app, argc, argv)) return *code;
  return runProgram("bench-motion", [&] { return run(arguments); });
}
