// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/setup/setup.hpp"

#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "common/config/config_reader.hpp"
#include "common/config/problem_words.hpp"
#include "common/geometry/degrees.hpp"
#include "common/pattern/pattern_file.hpp"
#include "common/report/text.hpp"
#include "common/store/store.hpp"
#include "common/vehicle/model_file.hpp"
#include "tools/robot/patterns/recipe.hpp"
#include "tools/robot/setup/discovery.hpp"
#include "tools/robot/setup/fit_checks.hpp"
#include "tools/robot/setup/setup_report.hpp"

namespace tread::setup {
namespace {

constexpr double kSwing = 0.08;         // [m] of the footprint beyond the outline
constexpr double kAskew = 0.26;         // [rad]: no ground is that steep, so the INS is tilted
constexpr double kAhead = 10.0;         // [m] of the first goal
constexpr double kMarking = 10.0;       // [m]
constexpr double kUsualSteering = 0.5;  // [rad] before it is measured

bool isName(const std::string& name) {
  return !name.empty() &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_-") == std::string::npos;
}

class Setup {
 public:
  Setup(Site& site, Interview& person, const std::string& robots)
      : site_(site), person_(person), robots_(robots), start_(site.now()) {}

  SetupResult run() {
    try {
      describe();
      discover(site_, person_, found());
      person_.say(found().robot.drive.isCar() ? "wheels up: throttle, then steering"
                                              : "wheels up: each track alone");
      result_.lift = tryWheelsUp(site_, person_, driversOf(found()));
      for (const std::string& problem : result_.lift.problems) person_.say(problem);
      levelIns();
      driveOut();
      writeFolder();
      makePatterns();
      result_.checks = checkFit(result_);
      for (const FitCheck& check : result_.checks)
        person_.say((check.good ? "fits: " : "DOES NOT FIT: ") + check.words);
      person_.confirm("go");
      result_.goal = driveAhead(site_, person_, result_.folder, kAhead);
      if (!result_.goal.arrived)
        result_.problem = "the goal was not reached: " + result_.goal.words;
    } catch (const std::exception& error) {
      result_.problem = wordsOf(error);
    }
    result_.minutes = 1e-6 * static_cast<double>(site_.now() - start_) / 60.0;
    if (!result_.folder.empty()) write("setup.html", reportOf(result_));
    return std::move(result_);
  }

 private:
  RobotFindings& found() { return result_.findings; }

  void write(const std::string& file, const std::string& text) const {
    writeText(result_.folder + "/" + file, text);
  }

  void describe() {
    RobotDescription& robot = found().robot;
    robot.name = person_.ask("name");
    if (!isName(robot.name))
      throw ConfigError("name '" + robot.name +
                        "' is not a valid folder name; use small letters, " + "digits, - and _");
    const std::string folder = robots_ + "/" + robot.name;
    if (std::filesystem::exists(folder))
      throw ConfigError(folder + " is there already; choose another name, or take it away");
    constexpr Range kSize{0.05, 10.0}, kPlace{-10.0, 10.0};
    robot.outline = {person_.number("front", kSize), person_.number("rear", kSize),
                     person_.number("half_width", {0.05, 5.0})};
    robot.footprint = robot.outline.widened(kSwing);
    robot.height = person_.number("height", {0.1, 5.0});
    const double wheelbase = person_.number("wheelbase", {0.0, 10.0});
    robot.range_finder.p_body = {person_.number("range_finder_x", kPlace),
                                 person_.number("range_finder_y", kPlace),
                                 person_.number("range_finder_z", kPlace)};
    robot.range_finder.angles.yaw = toRadians(person_.number("range_finder_yaw", {-180.0, 180.0}));
    robot.ins.p_body = {person_.number("ins_x", kPlace), person_.number("ins_y", kPlace),
                        person_.number("ins_z", kPlace)};
    // Estimates until they are measured.
    robot.gauge = 1.5 * robot.outline.half_width;
    robot.drive.full_speed = robot.drive.max_command = 1.0;
    robot.max_speed = 20.0;
    if (wheelbase > 0.0) {
      robot.drive.layout = DriveLayout::kThrottleSteering;
      robot.drive.wheelbase = wheelbase;
      robot.drive.max_steering = kUsualSteering;
    }
    result_.folder = folder;
    std::filesystem::create_directories(folder);
  }

  /// An INS that is mounted upside down or sideways shows it while the robot stands level.
  void levelIns() {
    found().marking_range = std::min(kMarking, 0.9 * found().range);
    person_.confirm("wheels_down");
    if (!found().has_attitude) return;
    YawPitchRoll seen;
    {
      DirectRobot robot(site_, driversOf(found()));
      const std::string problem = robot.begin();
      if (!problem.empty()) throw std::runtime_error(problem);
      seen = robot.attitude();
    }
    if (std::abs(seen.pitch) < kAskew && std::abs(seen.roll) < kAskew) return;
    YawPitchRoll& mounting = found().robot.ins.angles;
    mounting.pitch = seen.pitch;
    mounting.roll = seen.roll;
    person_.say("the INS leans in the robot: pitch " + fixed(toDegrees(seen.pitch), 0) +
                " deg, roll " + fixed(toDegrees(seen.roll), 0) + " deg; taken into its mounting");
  }

  void driveOut() {
    person_.say("wheels down: a minute in the free circle");
    commissioning::WiringExpectation expected;
    expected.seen = result_.lift.seen;
    result_.ground = tryWheelsDown(site_, driversOf(found()), {}, expected, true);
    const commissioning::WiringReport& wiring = found().wiring = result_.ground.wiring;
    for (const commissioning::WiringFault& fault : wiring.faults)
      person_.say("found: " + fault.words);
    if (!result_.ground.problem.empty()) throw std::runtime_error(result_.ground.problem);
    if (!wiring.unsure.empty()) throw std::runtime_error(wiring.unsure);
    for (const commissioning::FaultKind kind :
         {commissioning::FaultKind::kNoMotion, commissioning::FaultKind::kDead,
          commissioning::FaultKind::kInsMirrored, commissioning::FaultKind::kSteeringDead})
      for (const commissioning::WiringFault& fault : wiring.faults)
        if (fault.kind == kind) throw std::runtime_error(fault.words);
    applyWiring(wiring, found());
    proposeLimits(found());
    if (wiring.has(commissioning::FaultKind::kInsElsewhere)) moveIns(wiring);
    verify();
    sayMeasured(wiring);
  }

  void sayMeasured(const commissioning::WiringReport& wiring) {
    const std::string late =
        "; delay " + fixed(wiring.delay.value, 2) + " s, lag " + fixed(wiring.lag.value, 2) + " s";
    if (found().robot.drive.isCar())
      return person_.say(
          "measured: " + saidInterval(wiring.full_left.low, wiring.full_left.high, "m/s") +
          " at full throttle, wheels turn by " + fixed(toDegrees(wiring.steering_left.value), 0) +
          " deg to the left and " + fixed(-toDegrees(wiring.steering_right.value), 0) +
          " deg to the right" + late + ", of the steering " + fixed(wiring.steering_lag.value, 2) +
          " s");
    person_.say("measured: " + saidInterval(wiring.full_left.low, wiring.full_left.high, "m/s") +
                " left, " + saidInterval(wiring.full_right.low, wiring.full_right.high, "m/s") +
                " right at full command" + late + ", as if " + fixed(wiring.gauge.value, 2) +
                " m wide");
  }

  /// The configured position was applied with the heading from before the mounting was known.
  void moveIns(const commissioning::WiringReport& wiring) {
    const double turned =
        wiring.has(commissioning::FaultKind::kInsTurned) ? wiring.mounting_yaw.value : 0.0;
    Eigen::Vector3d& place = found().robot.ins.p_body;
    place.head<2>() = Pose2{wiring.antenna_x.value, wiring.antenna_y.value, turned} *
                      Eigen::Vector2d(place.head<2>());
  }

  /// After the corrections only faults that they cannot fix may remain.
  void verify() {
    commissioning::WiringExpectation brief;
    brief.brief = true;
    const GroundReport again =
        tryWheelsDown(site_, driversOf(found()),
                      commissioning::preDrive(found().robot.drive.isCar()), brief, false);
    if (!again.problem.empty()) throw std::runtime_error(again.problem);
    for (const commissioning::WiringFault& fault : again.wiring.faults)
      if (fault.kind != commissioning::FaultKind::kWeak &&
          fault.kind != commissioning::FaultKind::kInsElsewhere &&
          fault.kind != commissioning::FaultKind::kGauge)
        throw std::runtime_error("after the corrections: " + fault.words);
    person_.say("corrected, and driven again: sides, directions and INS are right");
  }

  void writeFolder() {
    for (const auto& [file, text] : folderOf(found())) write(file, text);
    write("model.yaml", formatModelDocument(modelOf(found())));
    write("recipe.yaml", recipeFor(found()));
  }

  void makePatterns() {
    const PatternSet predicted = patterns::makeSet(
        ConfigReader::fromFile(result_.folder + "/recipe.yaml"), modelOf(found()).vehicle);
    write("patterns.yaml", formatPatterns(predicted));
    person_.confirm("record");
    result_.recorded = recordPatterns(site_, person_, result_.folder, predicted);
    recordings::addSurface(result_.folder + "/recordings", predicted, result_.recorded->recordings);
    write("patterns.yaml", formatPatterns(result_.recorded->patterns));
  }

  Site& site_;
  Interview& person_;
  std::string robots_;
  int64_t start_;
  SetupResult result_;
};

}  // namespace

SetupResult setUp(Site& site, Interview& person, const std::string& robots) {
  return Setup(site, person, robots).run();
}

PreDrive preDriveOf(Site& site, const std::string& folder) {
  ConfigReader beside = ConfigReader::fromText("{}", folder + "/setup");
  commissioning::WiringExpectation expected;
  expected.gauge = readRobot(beside).gauge;
  expected.brief = true;
  const Drivers drivers = driversOf(folder);
  const GroundReport ground =
      tryWheelsDown(site, drivers, commissioning::preDrive(drivers.isCar()), expected, false);
  PreDrive drive;
  drive.problem = !ground.problem.empty() ? ground.problem : ground.wiring.unsure;
  drive.faults = ground.wiring.faults;
  return drive;
}

}  // namespace tread::setup
