// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Five machines without descriptions: from finding their ports to the first goal, with a file of
// answers.
#include <catch2/catch.hpp>

#include <algorithm>
#include <filesystem>
#include <random>

#include "tests/helpers.hpp"
#include "tests/tools/called_program.hpp"
#include "tests/tools/robot/setup/virtual_site.hpp"
#include "tools/robot/setup/discovery.hpp"
#include "tools/robot/setup/setup.hpp"
#include "tools/robot/setup/trials.hpp"

using namespace tread;
using namespace tread::setup;
using namespace tread::commissioning;
using tread::samples::OwnFolder;

namespace {

constexpr const char* kAnswers = R"(name: mole
front: 0.65
rear: 0.65
half_width: 0.34
height: 1.2
range_finder_x: 0.25
range_finder_z: 0.5
wheels_up: yes
watchdog_stopped: yes
wheels_down: yes
record: yes
go: yes
)";

/// A walled yard with a few boulders outside of the free circle.
sim::WorldDescription yard(const std::string& surface) {
  sim::WorldDescription world;
  world.name = "yard";
  world.base_surface = surface;
  world.bounds = {{-30.0, -30.0}, {30.0, 30.0}};
  for (const double side : {-1.0, 1.0}) {
    world.obstacles.push_back(sim::boxObstacle({side * 17.0, 0.0, 0.0}, 0.4, 34.0, 2.0));
    world.obstacles.push_back(sim::boxObstacle({0.0, side * 17.0, 0.0}, 34.0, 0.4, 2.0));
  }
  world.obstacles.push_back(sim::discObstacle({8.0, 9.0}, 0.4, 1.5));
  world.obstacles.push_back(sim::discObstacle({-9.0, -8.0}, 0.4, 1.5));
  return world;
}

HiddenMachine machine(const std::string& controller, const std::string& surface, uint64_t seed) {
  HiddenMachine hidden;
  hidden.settings.robot =
      sim::readSimulatedRobot(std::string(TREAD_SOURCE_DIR) + "/config/robots/teodor");
  hidden.settings.robot.seed = seed;
  hidden.settings.controller = controller;
  hidden.settings.device = "sick_cola";
  hidden.settings.robot.laser.range_max = 20.0;
  hidden.world = yard(surface);
  hidden.ins_port = "tty:/dev/ttyUSB1";
  hidden.ins_baud = 460800;
  hidden.motor_port = "tty:/dev/ttyACM0";
  hidden.motor_baud = 115200;
  hidden.laser_port = "tcp:192.168.0.1:2111";
  hidden.empty_ports = {"tty:/dev/ttyUSB0", "udp:2368"};
  return hidden;
}

SetupResult brought(const HiddenMachine& hidden, const std::string& answers,
                    const OwnFolder& folder) {
  VirtualSite site(hidden);
  VirtualPerson person(site, kAnswers + answers);
  SetupResult result = setUp(site, person, folder.path("robots"));
  UNSCOPED_INFO(person.heard());
  return result;
}

}  // namespace

TEST_CASE("swapped sides behind a Roboteq: from its ports to the first goal") {
  OwnFolder folder;
  HiddenMachine hidden = machine("roboteq", "grass", 3);
  hidden.settings.robot.wiring.left_channel = 2;
  const SetupResult result =
      brought(hidden, "first_track: right\nfirst_direction: forward\n", folder);
  CHECK(result.problem == "");
  CHECK(result.goal.arrived);
  CHECK(result.minutes < 30.0);
  CHECK(result.findings.wiring.has(FaultKind::kSwapped));
  CHECK(result.findings.robot.drive.left_channel == 2);
}

TEST_CASE("a weak track behind swapped VESCs, a NovAtel INS in a corner: to the first goal") {
  OwnFolder folder;
  HiddenMachine hidden = machine("vesc", "gravel", 5);
  hidden.settings.source = "novatel";
  hidden.settings.robot.vehicle.left_power = 0.75;
  hidden.settings.robot.wiring.left_channel = 2;
  hidden.settings.robot.ins.mounting.p_body = {-0.4, 0.2, 0.9};
  const SetupResult result =
      brought(hidden, "first_track: right\nfirst_direction: forward\n", folder);
  CHECK(result.problem == "");
  CHECK(result.goal.arrived);
  CHECK(result.minutes < 30.0);
  CHECK(result.findings.wiring.has(FaultKind::kSwapped));
  CHECK(result.findings.wiring.has(FaultKind::kWeak, Side::kLeft));
  CHECK(result.findings.wiring.has(FaultKind::kInsElsewhere));
  CHECK(std::abs(result.findings.robot.ins.p_body.x() + 0.4) < 0.15);
}

TEST_CASE("four wheels, each with a VESC, of which one side is reversed: to the first goal") {
  OwnFolder folder;
  HiddenMachine hidden = machine("vesc", "grass", 11);
  hidden.settings.source = "xsens";
  hidden.settings.robot.wiring.four_motors = true;
  hidden.settings.robot.wiring.invert_left = true;
  const SetupResult result =
      brought(hidden, "first_track: left\nfirst_direction: backward\n", folder);
  CHECK(result.problem == "");
  CHECK(result.goal.arrived);
  CHECK(result.minutes < 30.0);
  CHECK(result.findings.robot.drive.layout == DriveLayout::kSkidSteer4);
  CHECK(result.findings.robot.drive.invert_left);
  CHECK_FALSE(result.findings.robot.drive.invert_right);
}

TEST_CASE("a line protocol and an INS upside down, so that it is mirrored: to the first goal") {
  OwnFolder folder;
  HiddenMachine hidden = machine("line_protocol", "tarmac", 7);
  hidden.settings.source = "ublox";
  hidden.settings.robot.ins.mounting.angles.roll = kPi;
  hidden.settings.robot.wiring.invert_right = true;
  const std::string description =
      std::string(TREAD_SOURCE_DIR) + "/tests/data/controllers/mole.yaml";
  const SetupResult result = brought(
      hidden, "first_track: left\nfirst_direction: forward\nline_protocols: " + description + "\n",
      folder);
  CHECK(result.problem == "");
  CHECK(result.goal.arrived);
  CHECK(result.minutes < 30.0);
  CHECK(result.findings.wiring.has(FaultKind::kReversed, Side::kRight));
  CHECK(std::abs(std::abs(result.findings.robot.ins.angles.roll) - kPi) < 0.05);
}

TEST_CASE("front and rear exchanged for the INS, both motors reversed: to the first goal") {
  OwnFolder folder;
  HiddenMachine hidden = machine("roboteq", "cinder", 9);
  hidden.settings.source = "vectornav";
  hidden.settings.robot.ins.mounting.angles.yaw = kPi;
  hidden.settings.robot.wiring.invert_left = hidden.settings.robot.wiring.invert_right = true;
  hidden.settings.device = "velodyne";
  hidden.laser_port = "udp:2368";
  hidden.empty_ports = {"tty:/dev/ttyUSB0", "tcp:192.168.0.10:2111"};
  const SetupResult result =
      brought(hidden, "first_track: left\nfirst_direction: backward\n", folder);
  CHECK(result.problem == "");
  CHECK(result.goal.arrived);
  CHECK(result.minutes < 30.0);
  CHECK(result.findings.wiring.has(FaultKind::kReversed, Side::kLeft));
  CHECK(result.findings.wiring.has(FaultKind::kReversed, Side::kRight));
  CHECK(result.findings.wiring.has(FaultKind::kInsTurned));
}

TEST_CASE("a car whose throttle and steering are reversed: to the first goal") {
  OwnFolder folder;
  HiddenMachine hidden = machine("vesc", "tarmac", 13);
  const sim::LaserParameters laser = hidden.settings.robot.laser;
  hidden.settings.robot =
      sim::readSimulatedRobot(std::string(TREAD_SOURCE_DIR) + "/tests/data/robots/car");
  hidden.settings.robot.seed = 13;
  hidden.settings.robot.laser.range_max = laser.range_max;
  hidden.settings.robot.wiring.invert_left = hidden.settings.robot.wiring.invert_right = true;
  hidden.settings.robot.ins.mounting.angles.yaw = 0.3;
  // The direction that it faces at the end is free for 10 m, as asked in the question.
  hidden.world.obstacles.resize(4);
  VirtualSite site(hidden);
  VirtualPerson person(site, R"(name: beetle
front: 1.15
rear: 0.25
half_width: 0.4
height: 0.9
wheelbase: 0.9
range_finder_x: 1.05
range_finder_z: 0.45
wheels_up: yes
first_direction: backward
first_steering: right
watchdog_stopped: yes
wheels_down: yes
record: yes
go: yes
)");
  const SetupResult result = setUp(site, person, folder.path("robots"));
  UNSCOPED_INFO(person.heard());
  CHECK(result.problem == "");
  CHECK(result.goal.arrived);
  CHECK(result.minutes < 30.0);
  const DriveDescription& drive = result.findings.robot.drive;
  CHECK(drive.isCar());
  CHECK(drive.invert_left);
  CHECK(drive.invert_right);
  CHECK(result.findings.wiring.has(FaultKind::kReversed));
  CHECK(result.findings.wiring.has(FaultKind::kSteeringReversed));
  CHECK(result.findings.wiring.has(FaultKind::kInsTurned));
  CHECK(std::abs(result.findings.robot.ins.angles.yaw - 0.3) < 0.05);
  // With the given servo ends the wheels turn less than possible.
  CHECK(std::abs(drive.max_steering - 0.5 * 0.35 / 0.4) < 0.05);
}

namespace {

RobotFindings described() {
  RobotFindings findings;
  RobotDescription& robot = findings.robot;
  robot.name = "found";
  robot.outline = robot.footprint = {0.7, 0.7, 0.4};
  robot.height = 1.2;
  robot.gauge = 0.6;
  robot.drive.full_speed = robot.drive.max_command = 1.0;
  robot.max_speed = 20.0;
  return findings;
}

}  // namespace

TEST_CASE("a servo that stands askew gets ends that are even to both sides") {
  for (const bool inverted : {false, true}) {
    RobotFindings findings = described();
    findings.robot.drive.layout = DriveLayout::kThrottleSteering;
    findings.robot.drive.wheelbase = 0.9;
    findings.robot.drive.invert_right = inverted;
    findings.controller.kind = "vesc";
    WiringReport wiring;
    // From .15 to .85 the wheels go from .3 rad to the right to .5 to the left, or reversed.
    wiring.steering_left.value = 0.5;
    wiring.steering_right.value = -0.3;
    wiring.steering_straight.value = 0.1;
    wiring.faults.push_back({FaultKind::kSteeringAskew, {}, 0.1, ""});
    applyWiring(wiring, findings);
    findings.wiring = wiring;
    proposeLimits(findings);
    CHECK(findings.robot.drive.max_steering == Approx(0.3));
    // .7 / .8 of its range per radian: straight at .4125, or its mirror image.
    const double to_left = inverted ? findings.servo_right : findings.servo_left;
    const double to_right = inverted ? findings.servo_left : findings.servo_right;
    CHECK(to_left == Approx(inverted ? 0.325 : 0.675));
    CHECK(to_right == Approx(inverted ? 0.85 : 0.15));
    const char* const told = inverted ? "servo_left: 0.85\n" : "servo_left: 0.675\n";
    CHECK(findings.controller.section.find(told) != std::string::npos);
  }
}

TEST_CASE("a range finder that sees nothing around it is told at once, not at the first goal") {
  for (const bool open : {true, false}) {
    HiddenMachine hidden = machine("roboteq", "grass", 3);
    if (open) hidden.world.obstacles.clear();
    VirtualSite site(hidden);
    VirtualPerson person(site, kAnswers);
    RobotFindings findings = described();
    discover(site, person, findings);
    CAPTURE(person.heard());
    CHECK((findings.beams_that_tell < kLeastTelling) == open);
    CHECK((person.heard().find("only 0 % of its beams give") != std::string::npos) == open);
  }
}

TEST_CASE("a Hokuyo is found by its scans, on the network and on a serial line") {
  for (const char* port : {"tcp:192.168.0.10:10940", "tty:/dev/ttyACM1"}) {
    HiddenMachine hidden = machine("roboteq", "grass", 3);
    hidden.settings.device = "hokuyo";
    hidden.laser_port = port;
    VirtualSite site(hidden);
    VirtualPerson person(site, kAnswers);
    RobotFindings findings = described();
    discover(site, person, findings);
    CAPTURE(port, person.heard());
    CHECK(findings.range_finder.kind == "hokuyo");
    CHECK(findings.range_finder.address.rfind(port, 0) == 0);
    CHECK(findings.range == Approx(20.0).margin(0.1));
    CHECK(findings.beams_that_tell > kLeastTelling);
  }
}

TEST_CASE("a Sabertooth that never answers, an INS turned by a quarter: to the first goal") {
  OwnFolder folder;
  HiddenMachine hidden = machine("sabertooth", "sand", 11);
  hidden.settings.robot.ins.mounting.angles.yaw = kPi / 2.0;
  hidden.settings.robot.wiring.left_channel = 2;
  hidden.settings.robot.wiring.invert_left = true;
  hidden.motor_baud = 38400;
  const SetupResult result =
      brought(hidden,
              "first_track: right\nfirst_direction: forward\nsilent_controller: "
              "tty:/dev/ttyACM0?baud=38400\n",
              folder);
  CHECK(result.problem == "");
  CHECK(result.goal.arrived);
  CHECK(result.minutes < 30.0);
  CHECK(result.findings.wiring.has(FaultKind::kSwapped));
  CHECK(result.findings.wiring.has(FaultKind::kReversed, Side::kLeft));
  CHECK(result.findings.wiring.has(FaultKind::kInsTurned));
}

TEST_CASE("machines drawn at random, wired in any way: to the first goal", "[statistics]") {
  std::mt19937_64 random(8);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1.0p-53;
  };
  const auto one = [&](const std::vector<std::string>& of) { return of[random() % of.size()]; };
  int arrived = 0;
  const int machines = 8;
  for (int i = 0; i < machines; ++i) {
    OwnFolder folder;
    HiddenMachine hidden = machine(one({"roboteq", "vesc"}),
                                   one({"grass", "cinder", "gravel", "tarmac", "sand"}), random());
    auto& robot = hidden.settings.robot;
    hidden.settings.source = one({"nmea", "novatel", "ublox", "vectornav"});
    robot.wiring = {1 + static_cast<int>(random() % 2), random() % 2 == 0, random() % 2 == 0, {}};
    robot.ins.mounting.angles.yaw = uniform(-kPi, kPi);
    robot.ins.mounting.p_body = {uniform(-0.4, 0.4), uniform(-0.2, 0.2), 0.8};
    robot.vehicle.gauge *= uniform(0.9, 1.5);
    robot.vehicle.drive.free_speed *= uniform(0.6, 1.6);
    robot.vehicle.drive.power_lag = uniform(0.03, 0.25);
    robot.vehicle.drive.dead_power = uniform(0.0, 0.12);
    robot.vehicle.right_power = uniform(0.8, 1.0);
    const bool left = robot.wiring.left_channel == 1;
    const bool forward = !(left ? robot.wiring.invert_left : robot.wiring.invert_right);
    const std::string answers = std::string("first_track: ") + (left ? "left" : "right") +
                                "\nfirst_direction: " + (forward ? "forward" : "backward") + "\n";
    const SetupResult result = brought(hidden, answers, folder);
    UNSCOPED_INFO(i << ": " << result.problem);
    arrived += result.problem.empty() && result.minutes < 30.0;
  }
  CHECK(arrived == machines);
}

namespace {

/// Result of the ten seconds for a machine with a part changed after the setup.
struct ChangedPart {
  const char* what;
  void (*change)(sim::SimulatorSettings& settings);
  FaultKind named;
  std::optional<Side> side;
};

constexpr double kQuarter = kPi / 2.0;

const ChangedPart kChanges[] = {
    {"swapped", [](auto& machine) { machine.robot.wiring.left_channel = 2; }, FaultKind::kSwapped,
     std::nullopt},
    {"left reversed", [](auto& machine) { machine.robot.wiring.invert_left = true; },
     FaultKind::kReversed, Side::kLeft},
    {"right reversed", [](auto& machine) { machine.robot.wiring.invert_right = true; },
     FaultKind::kReversed, Side::kRight},
    {"left dead", [](auto& machine) { machine.robot.vehicle.left_power = 0.0; }, FaultKind::kDead,
     Side::kLeft},
    {"right dead", [](auto& machine) { machine.robot.vehicle.right_power = 0.0; }, FaultKind::kDead,
     Side::kRight},
    {"nothing moves",
     [](auto& machine) {
       machine.robot.vehicle.left_power = machine.robot.vehicle.right_power = 0.0;
     },
     FaultKind::kNoMotion, std::nullopt},
    {"INS turned", [](auto& machine) { machine.robot.ins.mounting.angles.yaw = -kQuarter; },
     FaultKind::kInsTurned, std::nullopt},
    {"INS behind", [](auto& machine) { machine.robot.ins.mounting.angles.yaw = kPi; },
     FaultKind::kInsTurned, std::nullopt}};

}  // namespace

TEST_CASE(
    "before a drive a robot that was set up is right, and every part changed since is named") {
  OwnFolder folder;
  HiddenMachine hidden = machine("roboteq", "grass", 21);
  const std::string robot = folder.path("robots") + "/mole";
  {
    const SetupResult result =
        brought(hidden, "first_track: left\nfirst_direction: forward\n", folder);
    REQUIRE(result.problem == "");
  }
  {
    VirtualSite site(hidden);
    const PreDrive drive = preDriveOf(site, robot);
    CHECK(drive.problem == "");
    for (const WiringFault& fault : drive.faults) UNSCOPED_INFO(fault.words);
    CHECK(drive.faults.empty());
  }
  for (const ChangedPart& part : kChanges) {
    HiddenMachine changed = hidden;
    part.change(changed.settings);
    VirtualSite site(changed);
    const int64_t begun = site.now();
    const PreDrive drive = preDriveOf(site, robot);
    CAPTURE(part.what, drive.problem);
    CHECK(site.robot().truth().distance < 1.0);
    CHECK(site.now() - begun < 20 * tread::testing::kSecond);
    CHECK(std::any_of(drive.faults.begin(), drive.faults.end(), [&](const WiringFault& fault) {
      return fault.kind == part.named && (!part.side || fault.side == part.side);
    }));
  }
}

TEST_CASE("what a setup writes is what the robot's processes and its launch file take") {
  OwnFolder folder;
  const SetupResult result = brought(machine("vesc", "tarmac", 23),
                                     "first_track: left\nfirst_direction: forward\n", folder);
  REQUIRE(result.problem == "");
  const std::string robot = result.folder;
  for (const char* process :
       {"ins-driver", "lidar-driver", "mapping", "learner", "planner", "motor-bridge"}) {
    std::string file = process;
    std::replace(file.begin(), file.end(), '-', '_');
    const auto checked = tread::samples::called(std::string("tread-") + process + " --config " +
                                                robot + "/" + file + ".yaml --check");
    CAPTURE(checked.printed);
    CHECK(checked.status == 0);
  }
  // Devices and network are the host's: the robot's own part must be correct.
  const auto launch = tread::samples::called(
      "tread-launch " TREAD_SOURCE_DIR "/config/launch/robot.yaml --set robot=" + robot +
      " --run " + folder.path("run") + " --check");
  CAPTURE(launch.printed);
  CHECK_FALSE(launch.says("refuses"));
  CHECK_FALSE(launch.says("edit " + robot));
  CHECK_FALSE(launch.says("patterns"));
  const std::string page = tread::testing::contentOf(robot + "/setup.html");
  CHECK(page.find("mole is set up") != std::string::npos);
  CHECK(page.find("<svg") != std::string::npos);
}

TEST_CASE("what a setup cannot go on with is told in one clear line") {
  OwnFolder folder;
  const std::string answers = "first_track: left\nfirst_direction: forward\n";
  HiddenMachine dead = machine("roboteq", "grass", 31);
  dead.settings.robot.vehicle.right_power = 0.0;
  CHECK(brought(dead, answers, folder).problem.find("the right track does not move") == 0);
  std::filesystem::remove_all(folder.path("robots"));
  HiddenMachine unplugged = machine("roboteq", "grass", 31);
  unplugged.motor_baud = 1200;
  CHECK(brought(unplugged, answers, folder).problem.find("no motor controller answers") == 0);
  CHECK(brought(unplugged, answers, folder).problem.find("is there already") != std::string::npos);
  std::filesystem::remove_all(folder.path("robots"));
  HiddenMachine deaf = machine("roboteq", "grass", 31);
  deaf.ins_baud = 1200;
  CHECK(brought(deaf, answers, folder).problem.find("no INS sends") == 0);
  std::filesystem::remove_all(folder.path("robots"));
  CHECK(
      brought(machine("roboteq", "grass", 31), "", folder).problem.find("first_track is missing") !=
      std::string::npos);
}
