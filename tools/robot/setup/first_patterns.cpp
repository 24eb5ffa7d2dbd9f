// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/setup/first_patterns.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/geometry/degrees.hpp"
#include "common/messages/ins_messages.hpp"
#include "common/report/text.hpp"
#include "modules/pattern_recorder/recorder_node.hpp"
#include "tools/robot/operator/calls.hpp"

namespace tread::setup {
namespace {

constexpr double kPeriod = 0.05;  // [s] of a pattern's commands
constexpr double kShareOfMarking = 0.6;
constexpr double kReverseShare = 0.6;                // of the cruising command
constexpr double kTurnLevel = 0.4;                   // beyond the dead power
constexpr int kExecutions = 4;                       // of each pattern
constexpr double kRecordingRoom = 4.5;               // [m]
constexpr int64_t kStep = 50'000;                    // [us]
constexpr int64_t kRecordingPatience = 900'000'000;  // [us]
constexpr int64_t kStopped = 4'000'000;              // [us] that a stop lasts before it is told
constexpr size_t kMostStops = 3;                     // of one drive; the fourth ends it
constexpr int64_t kMapMade = 3'000'000;              // [us]
constexpr int64_t kGoalPatience = 180'000'000;       // [us]
const std::string kOperator = "setup";

double wholePeriods(double seconds) {
  return kPeriod * std::ceil(seconds / kPeriod - 1e-6);
}

/// Patterns as text, commanded in shares of the weaker side's speed.
class Recipe {
 public:
  explicit Recipe(const RobotFindings& findings) : model_(modelOf(findings).vehicle) {
    const WiringReport& wiring = findings.wiring;
    least_ = wiring.fullSpeed();
    left_ = least_ / wiring.full_left.value;
    right_ = least_ / wiring.full_right.value;
    dead_ = wiring.dead_power.value;
    hold_ = wholePeriods(3.0 * model_.settlingLag() + model_.commandDelay());
    // From standstill through the longest curve to standstill, at full speed.
    const double longest = least_ * (3.0 * hold_ + 1.5);
    cruise_ = std::min(1.0, kShareOfMarking * findings.marking_range / longest);
    text_ = "# Made by tread-setup-robot from what it measured.\nname: " + model_.name +
            "\nperiod: 0.05\nclasses:\n" + classText("rest", 0.0) + classText("cruise", cruise_) +
            classText("reverse", -kReverseShare * cruise_) + "patterns:\n";
  }

  std::string text() {
    const double back = -kReverseShare * cruise_;
    pattern("straight", "cruise", "cruise", {{1, 1, std::max(1.0, hold_)}});
    curve("left", "right", 0.8, 1.0);
    curve("hard_left", "hard_right", 0.55, 1.0);
    curve("nudge_left", "nudge_right", 0.9, 0.4);
    pattern("short_straight", "cruise", "cruise", {{1, 1, hold_}});
    pattern("start", "rest", "cruise", {{0.6, 0.6, 0.2}, {1, 1, hold_ + 0.1}});
    pattern("stop", "cruise", "rest", {{0, 0, hold_ + 0.2}});
    pattern("step_forward", "rest", "rest", {{0.6, 0.6, 0.5}, {0, 0, hold_}});
    pattern("step_back", "rest", "rest", {{-0.6, -0.6, 0.9}, {0, 0, hold_}});
    turn(15);
    turn(45);
    turn(90);
    const double reverse = back / cruise_;
    pattern("reverse_start", "rest", "reverse", {{reverse, reverse, hold_ + 0.1}});
    pattern("reverse", "reverse", "reverse", {{reverse, reverse, std::max(1.0, hold_)}});
    pattern("reverse_stop", "reverse", "rest", {{0, 0, hold_ + 0.1}});
    return text_;
  }

 private:
  struct Held {
    double left, right, seconds;  // shares of the cruising speed
  };

  /// The command that makes a share of the weaker side's full speed.
  double command(double share, double side) const {
    if (share == 0.0) return 0.0;
    const double speed = std::abs(share) * side * (1.0 - dead_) + dead_;
    return std::copysign(std::round(1000.0 * std::min(1.0, speed)) / 1000.0, share);
  }
  std::string pair(double left, double right) const {
    return fixed(command(left, left_), 3) + ", " + fixed(command(right, right_), 3);
  }
  std::string classText(const std::string& name, double share) const {
    return "  - name: " + name + "\n    steady: [" + pair(share, share) + "]\n";
  }
  void pattern(const std::string& name, const std::string& entry, const std::string& exit,
               const std::vector<Held>& commands) {
    text_ +=
        "  - name: " + name + "\n    entry: " + entry + "\n    exit: " + exit + "\n    commands: [";
    for (size_t i = 0; i < commands.size(); ++i)
      text_ += (i > 0 ? ", [" : "[") +
               pair(cruise_ * commands[i].left, cruise_ * commands[i].right) + ", " +
               fixed(wholePeriods(commands[i].seconds), 2) + "]";
    text_ += "]\n";
  }
  void curve(const std::string& left, const std::string& right, double inner, double seconds) {
    pattern(left, "cruise", "cruise", {{inner, 1, seconds}, {1, 1, hold_}});
    pattern(right, "cruise", "cruise", {{1, inner, seconds}, {1, 1, hold_}});
  }
  void turn(double degrees) {
    const double level = std::min(1.0, kTurnLevel / cruise_);
    const double rate = 2.0 * cruise_ * level * least_ / model_.gauge;
    const double seconds = std::max(kPeriod, toRadians(degrees) / rate);
    const std::string angle = fixed(degrees, 0);
    pattern("turn_left_" + angle, "rest", "rest", {{-level, level, seconds}, {0, 0, hold_}});
    pattern("turn_right_" + angle, "rest", "rest", {{level, -level, seconds}, {0, 0, hold_}});
  }

  VehicleModel model_;
  double left_ = 1.0, right_ = 1.0, dead_ = 0.0;
  double least_ = 0.0;   // [m/s] full speed of the weaker side
  double hold_ = 0.0;    // [s]
  double cruise_ = 1.0;  // share of the weaker side's full speed
  std::string text_;
};

/// Arms for the setup; throws std::runtime_error where the bridge does not. The call listens to the
/// bus: keep it as long as that is handled.
std::unique_ptr<operators::ArmCall> arm(RunningRobot& robot, const std::string& why,
                                        const std::function<void()>& meanwhile) {
  Bus& bus = robot.bus();
  auto call = std::make_unique<operators::ArmCall>(
      bus, operators::Requester{kOperator, why, kOperator}, operators::ArmRequest{}, 15.0);
  operators::CallResult result = operators::CallResult::kPending;
  while (result == operators::CallResult::kPending) {
    robot.pass(kStep);
    meanwhile();
    result = call->step(bus.now());
  }
  if (result != operators::CallResult::kDone)
    throw std::runtime_error("the robot cannot be armed: " + call->describe(bus.now()));
  return call;
}

/// Where the INS says that it is.
Pose2 presentPose(RunningRobot& robot, Latest<ins_t>& ins) {
  for (int i = 0; i < 400; ++i) {
    if (ins.any() && ins.age(robot.bus().now()) < 500'000)
      if (const auto pose = planarPose(ins.message())) return *pose;
    robot.pass(kStep);
  }
  throw std::runtime_error("ins_driver gives no pose; look at the INS's fix");
}

}  // namespace

std::string recipeFor(const RobotFindings& findings) {
  return findings.robot.drive.isCar() ? carRecipeFor(findings) : Recipe(findings).text();
}

RecordedPatterns recordPatterns(Site& site, Interview& person, const std::string& folder,
                                const PatternSet& predicted) {
  const auto robot = site.start(folder, Processes::kRecording);
  Bus& bus = robot->bus();
  Latest<ins_t> ins(bus, kIns);
  presentPose(*robot, ins);
  pattern_recorder::RecordingConfig how;
  how.executions = kExecutions;
  how.room = kRecordingRoom;
  how.operator_name = kOperator;
  // What the model foretells may be far off.
  how.limits.entry_speed = how.limits.entry_yaw_rate = 1.0;
  pattern_recorder::RecorderNode recorder(predicted, how, bus,
                                          [&](const std::string& line) { person.say(line); });
  const auto step = [&] { recorder.step(bus.now()); };
  for (int i = 0; i < 20; ++i) {
    robot->pass(kStep);
    step();
  }
  std::vector<std::unique_ptr<operators::ArmCall>> armed;
  armed.push_back(arm(*robot, "recording of patterns", step));
  using State = pattern_recorder::RecorderNode::State;
  int64_t drove = bus.now();
  for (const int64_t end = bus.now() + kRecordingPatience;
       recorder.state() == State::kRunning && bus.now() < end;) {
    robot->pass(kStep);
    step();
    if (recorder.reason().empty()) drove = bus.now();
    if (bus.now() - drove < kStopped) continue;
    if (armed.size() > kMostStops) break;
    // Something has stopped it: a person decides anew.
    person.say("stopped: " + recorder.reason());
    person.confirm("record");
    armed.push_back(arm(*robot, "recording goes on", step));
    drove = bus.now();
  }
  recorder.shutdown(bus.now());
  robot->pass(kStep);
  if (recorder.state() != State::kDone)
    throw std::runtime_error("the patterns were not all driven: " + recorder.reason());
  RecordedPatterns recorded{predicted, {"setup", recorder.recorded()}, 0.0};
  std::vector<recordings::AverageNote> notes;
  recorded.patterns = recordings::averageSet(predicted, recorded.recordings, {}, notes);
  for (size_t i = 0; i < predicted.patterns().size(); ++i)
    recorded.worst_before = std::max(
        recorded.worst_before,
        distanceBetween(predicted.patterns()[i].end(), recorded.patterns.patterns()[i].end()));
  return recorded;
}

GoalDrive driveAhead(Site& site, Interview& person, const std::string& folder, double ahead) {
  const auto robot = site.start(folder, Processes::kAll);
  Bus& bus = robot->bus();
  Latest<ins_t> ins(bus, kIns);
  GoalDrive drive;
  presentPose(*robot, ins);
  robot->pass(kMapMade);
  operators::GoalRequest request;
  request.T_map_goal = presentPose(*robot, ins) * Pose2{ahead, 0.0, 0.0};
  // Calls listen to the bus as long as it is handled.
  std::vector<std::unique_ptr<operators::ArmCall>> armed;
  std::vector<std::unique_ptr<operators::GoalCall>> calls;
  while (!drive.arrived && calls.size() <= kMostStops) {
    if (!calls.empty()) {
      person.say("stopped: " + drive.words);
      person.confirm("go");
    }
    armed.push_back(arm(*robot, "first goal", [] {}));
    calls.push_back(
        std::make_unique<operators::GoalCall>(bus, request, kOperator, bus.now(), nullptr));
    operators::GoalCall& call = *calls.back();
    operators::CallResult result = operators::CallResult::kPending;
    for (const int64_t end = bus.now() + kGoalPatience;
         result == operators::CallResult::kPending && bus.now() < end;) {
      robot->pass(kStep);
      result = call.step(bus.now());
      if (!ins.any()) continue;
      if (const auto pose = planarPose(ins.message())) drive.track.push_back(*pose);
    }
    drive.words = call.describe(bus.now());
    drive.arrived = result == operators::CallResult::kDone;
    if (result == operators::CallResult::kPending) call.cancel(bus.now());
    call.letGo(bus.now());
  }
  robot->pass(kStep);
  if (!drive.track.empty())
    drive.distance = distanceBetween(drive.track.back(), request.T_map_goal);
  person.say("goal " + fixed(ahead, 0) + " m ahead: " + drive.words);
  return drive;
}

}  // namespace tread::setup
