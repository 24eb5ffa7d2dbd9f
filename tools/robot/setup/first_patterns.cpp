// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/setup/first_patterns.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/messages/ins_messages.hpp"
#include "common/recordings/average.hpp"
#include "common/report/text.hpp"
#include "modules/pattern_recorder/recorder_node.hpp"
#include "tools/robot/operator/calls.hpp"
#include "tools/robot/patterns/recipe_text.hpp"

namespace tread::setup {
namespace {

constexpr double kShareOfMarking = 0.6;
constexpr double kRoomInGap = 0.3;                   // [m] in addition to the footprint
constexpr int kPatterns = 32;                        // a person waits while they are driven
constexpr int kExecutions = 4;                       // of each pattern
constexpr double kRecordingRoom = 4.5;               // [m]
constexpr int64_t kStep = 50'000;                    // [us]
constexpr int64_t kRecordingPatience = 900'000'000;  // [us]
constexpr int64_t kStopped = 4'000'000;         // [us] of standstill after which it is reported
constexpr size_t kMostStops = 3;                // stops in one drive; the next one ends it
constexpr int64_t kMapMade = 3'000'000;         // [us]
constexpr int64_t kGoalPatience = 180'000'000;  // [us]
const std::string kOperator = "setup";

/// Arms for the setup; throws std::runtime_error if the bridge refuses. The call subscribes to the
/// bus: keep it as long as the bus is handled.
std::unique_ptr<operators::ArmCall> arm(RobotSession& robot, const std::string& why,
                                        const std::function<void()>& meanwhile) {
  Bus& bus = robot.bus();
  auto call = std::make_unique<operators::ArmCall>(
      bus, operators::Requester{kOperator, why, kOperator}, operators::ArmOptions{}, 15.0);
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

/// Current pose from the INS.
Pose2 presentPose(RobotSession& robot, Latest<ins_t>& ins) {
  for (int i = 0; i < 400; ++i) {
    if (ins.any() && ins.age(robot.bus().now()) < 500'000)
      if (const auto pose = planarPose(ins.message())) return *pose;
    robot.pass(kStep);
  }
  throw std::runtime_error("ins_driver gives no pose; look at the INS's fix");
}

}  // namespace

std::string recipeFor(const RobotFindings& findings) {
  const ModelDocument model = modelOf(findings);
  patterns::RecipeWish wish;
  wish.name = model.vehicle.name;
  wish.max_command = findings.robot.drive.max_command;
  wish.max_steering = findings.robot.drive.max_steering;
  wish.patterns = kPatterns;
  wish.gap = 2.0 * findings.robot.footprint.half_width + kRoomInGap;
  wish.room = kShareOfMarking * findings.marking_range;
  return patterns::recipeText(patterns::designRecipe(model.vehicle, wish),
                              "# Made by tread-setup-robot from what it measured.\n");
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
  // The model's prediction may be far off.
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
    // Something stopped the robot: the person decides again.
    person.say("stopped: " + recorder.reason());
    person.confirm("record");
    armed.push_back(arm(*robot, "recording continues", step));
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
  // Calls must live as long as the bus is handled.
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
