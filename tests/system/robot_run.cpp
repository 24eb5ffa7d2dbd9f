// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/system/robot_run.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>

#include "common/messages/pattern_messages.hpp"
#include "common/seal/key_file.hpp"

namespace tread::testing {
namespace {

namespace fs = std::filesystem;

std::string ownFolder() {
  static int count = 0;
  return fs::temp_directory_path() /
         ("tread_robot_" + std::to_string(::getpid()) + "_" + std::to_string(count++));
}

int ownPort() {
  static int count = 0;
  return 40000 + (::getpid() * 3 + count++) % 20000;
}

}  // namespace

RobotRun::RobotRun(const std::string& world, const std::string& start_pose, const std::string& key,
                   const std::string& url)
    : folder_(ownFolder()),
      url_(url.empty() ? ownLcmUrl() + "&recv_buf_size=2097152" : url),
      laser_port_(ownPort()),
      start_pose_(start_pose),
      key_(key),
      bus_(BusAccess{url_, hostSealer(key)}, TimeSource::kHost),
      motor_(bus_, kMotor),
      plan_(bus_, kPlan),
      program_(bus_, kProgram),
      ins_(bus_, kIns),
      beacon_(bus_, "test") {
  fs::create_directories(folder_);
  std::ofstream(folder_ + "/world.yaml") << world;
  bus_.subscribe<health_t>(kHealth, [this](const health_t& m) { health_[m.process] = m; });
  bus_.subscribe<pattern_set_part_t>(
      kPatternSet, [this](const pattern_set_part_t& m) { last_set_ = m.set_version; });
}

RobotRun::~RobotRun() {
  endAll();
  std::error_code none;
  fs::remove_all(folder_, none);
}

const std::vector<std::string>& RobotRun::names() {
  static const std::vector<std::string> kNames{"simulator", "ins_driver", "lidar_driver", "mapping",
                                               "planner",   "learner",    "motor_bridge"};
  return kNames;
}

std::vector<std::string> RobotRun::argumentsOf(const std::string& name) const {
  const std::string robot = std::string(TREAD_SOURCE_DIR) + "/config/robots/teodor/";
  std::vector<std::string> words{"--lcm-url", url_, "--with-parent"};
  if (!key_.empty()) words.insert(words.end(), {"--key", key_});
  const auto set = [&words](const std::string& key, const std::string& value) {
    words.insert(words.end(), {"--set", key + "=" + value});
  };
  const auto device = [this](const std::string& line) { return folder_ + "/devices/" + line; };
  const std::string laser = std::to_string(laser_port_);
  const auto others = settings_.find(name);
  if (others != settings_.end())
    for (const std::string& setting : others->second) words.insert(words.end(), {"--set", setting});
  if (name == "simulator") {
    set("world", folder_ + "/world.yaml");
    set("robot", robot + "robot.yaml");
    set("dynamics", robot + "dynamics.yaml");
    set("start", start_pose_);
    set("ins", "pty:" + device("ins"));
    set("motor", "pty:" + device("motor"));
    set("laser", laserAddress());
    set("record", folder_ + "/truth.csv");
    return words;
  }
  words.insert(words.end(), {"--config", robot + name + ".yaml"});
  if (name == "ins_driver") set("address", "tty:" + device("ins") + "?baud=460800");
  if (name == "motor_bridge") set("address", "tty:" + device("motor") + "?baud=115200");
  if (name == "lidar_driver") set("address", "tcp:127.0.0.1:" + laser);
  if (name == "ins_driver" || name == "learner" || name == "planner") set("store", state(name));
  return words;
}

std::string RobotRun::output(const std::string& name) const {
  std::ostringstream text;
  text << std::ifstream(folder_ + "/" + name + ".log").rdbuf();
  return text.str();
}

void RobotRun::startBehind(const std::vector<std::string>& wrapper, const std::string& name) {
  std::string program = std::string(TREAD_BIN_DIR) + "/tread-" + name;
  std::replace(program.end() - static_cast<std::ptrdiff_t>(name.size()), program.end(), '_', '-');
  std::vector<std::string> words = wrapper;
  words.push_back(program);
  for (const std::string& word : argumentsOf(name)) words.push_back(word);
  const std::string first = words.front();
  words.erase(words.begin());
  processes_[name] = std::make_unique<Process>(first, words, folder_ + "/" + name + ".log");
}

void RobotRun::startAll() {
  for (const std::string& name : names()) start(name);
}

void RobotRun::signal(const std::string& name, int number) {
  processes_.at(name)->signal(number);
  if (number == SIGKILL) processes_.at(name)->waitFor(5.0);
}

bool RobotRun::running(const std::string& name) {
  const auto found = processes_.find(name);
  return found != processes_.end() && found->second->running();
}

int RobotRun::end(const std::string& name, int number) {
  Process& process = *processes_.at(name);
  process.signal(number);
  return process.waitFor(5.0) ? process.exitCode() : -1;
}

void RobotRun::endAll() {
  for (auto& [name, process] : processes_)
    if (process->running()) process->signal(SIGINT);
  for (auto& [name, process] : processes_) process->waitFor(5.0);
  processes_.clear();
}

bool RobotRun::until(double seconds, const std::function<bool()>& condition) {
  const int64_t deadline = now() + static_cast<int64_t>(seconds * 1e6);
  while (!condition()) {
    if (now() >= deadline) return false;
    if (operates_) beacon_.step(now());
    if (now() >= next_goal_) sendGoal();
    bus_.handle(5);
  }
  return true;
}

bool RobotRun::arm(double seconds) {
  calls_.push_back(std::make_unique<operators::ArmCall>(
      bus_, operators::Requester{"test", "a test", "test"}, operators::ArmOptions{}, seconds));
  operators::CallResult result = operators::CallResult::kPending;
  until(seconds + 1.0, [&] {
    result = calls_.back()->step(now());
    return result != operators::CallResult::kPending;
  });
  if (result != operators::CallResult::kDone) return false;
  calls_.back()->letGo(now());
  // An earlier goal is void.
  if (goal_.goal_id != 0) renewGoal();
  return true;
}

void RobotRun::setGoal(double x, double y) {
  goal_.goal_id = 1;
  goal_.goal_pose[0] = x;
  goal_.goal_pose[1] = y;
  goal_.position_tolerance = 0.6;
  goal_.yaw_tolerance = kPi;
  renewGoal();
}

void RobotRun::leaveTo(double x, double y, const std::vector<std::string>& behind) {
  std::vector<std::string> words = behind;
  words.push_back(std::string(TREAD_BIN_DIR) + "/tread-goal");
  for (const std::string& word : {std::to_string(x), std::to_string(y), std::string("--operator"),
                                  std::string("test"), std::string("--lcm-url"), url_})
    words.push_back(word);
  if (!key_.empty()) words.insert(words.end(), {"--key", key_});
  const std::string program = words.front();
  words.erase(words.begin());
  processes_["operator"] = std::make_unique<Process>(program, words, folder_ + "/operator.log");
  const int64_t before = plan_.message().goal_id;
  until(10.0, [&] { return plan_.message().goal_id != before && plan_.message().goal_id != 0; });
  operates_ = false;
  next_goal_ = INT64_MAX;
  goal_.goal_id = 0;
  beacon_.letGo(now());
}

void RobotRun::takeBack() {
  if (processes_.count("operator") > 0) processes_.at("operator")->signal(SIGKILL);
  processes_.erase("operator");
  operates_ = true;
}

void RobotRun::renewGoal() {
  goal_.goal_id = now();
  beacon_.standFor(goal_.goal_id);
  beacon_.step(now());
  sendGoal();
}

void RobotRun::sendGoal() {
  goal_.utime = now();
  ++goal_.seq;
  bus_.publish(kGoal, goal_);
  next_goal_ = now() + 1'000'000;
}

bool RobotRun::armed() const {
  return motor_.any() && mayDrive(motor_.message().bridge_state);
}

bool RobotRun::untilDriving(double seconds, const std::function<bool()>& condition) {
  const int64_t deadline = now() + static_cast<int64_t>(seconds * 1e6);
  while (now() < deadline) {
    if (until(0.2, condition)) return true;
    if (motor_.any() && !armed() && arm()) ++armed_again_;
  }
  return false;
}

bool RobotRun::driving() const {
  return motor_.any() && motor_.message().bridge_state == motor_t::STATE_DRIVING;
}

}  // namespace tread::testing
