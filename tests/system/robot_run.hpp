// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/bus/lcm_bus.hpp"
#include "common/geometry/se2.hpp"
#include "tests/system/process.hpp"
#include "tests/system/zero_after.hpp"
#include "tools/robot/operator/calls.hpp"

namespace tread::testing {

/// The complete robot as real processes on a separate bus, in a separate folder, with the simulator
/// at its device lines; the test listens and operates.
class RobotRun {
 public:
  /// `world` is a world file's text, `key` a key file or empty, `url` that of an existing bus, or
  /// empty. It starts nothing.
  RobotRun(const std::string& world, const std::string& start_pose, const std::string& key = "",
           const std::string& url = "");
  ~RobotRun();
  RobotRun(const RobotRun&) = delete;
  RobotRun& operator=(const RobotRun&) = delete;

  /// Names of the processes, in the order of startAll().
  static const std::vector<std::string>& names();
  void start(const std::string& name) { startBehind({}, name); }
  /// Sets a value in a process's configuration, for its next start.
  void set(const std::string& name, const std::string& key, const std::string& value) {
    settings_[name].push_back(key + "=" + value);
  }
  /// The same, started by another command that ends in exec.
  void startBehind(const std::vector<std::string>& wrapper, const std::string& name);
  void startAll();
  /// Sends a signal; for SIGKILL it waits for the end.
  void signal(const std::string& name, int number);
  bool running(const std::string& name);
  pid_t pid(const std::string& name) const { return processes_.at(name)->pid(); }
  Process& process(const std::string& name) { return *processes_.at(name); }
  /// Ends a process by a signal and returns its exit code; -1 if it does not end within 5 s.
  int end(const std::string& name, int number = SIGINT);
  void endAll();

  /// Handles messages until a condition holds; false on timeout.
  bool until(double seconds, const std::function<bool()>& condition);
  void wait(double seconds) {
    until(seconds, [] { return false; });
  }
  /// Arms like tread-arm; false on timeout.
  bool arm(double seconds = 10.0);
  /// From now on sends the goal each second, first at once.
  void setGoal(double x, double y);
  /// From now on tread-goal operates, as process "operator", instead of the test. `behind`: words
  /// of another command that ends in exec.
  void leaveTo(double x, double y, const std::vector<std::string>& behind = {});
  /// The test operates again, with its own next goal.
  void takeBack();
  int64_t now() const { return bus_.now(); }
  LcmBus& bus() { return bus_; }

  /// Latest messages.
  const Latest<motor_t>& motor() const { return motor_; }
  const Latest<plan_t>& plan() const { return plan_; }
  const Latest<program_t>& program() const { return program_; }
  const Latest<ins_t>& ins() const { return ins_; }
  bool driving() const;
  /// Version of the last published set; after forgetSet() 0 until the next one.
  int64_t lastSet() const { return last_set_; }
  void forgetSet() { last_set_ = 0; }
  /// Whether the robot is permitted to drive.
  bool armed() const;
  /// Waits for a condition, and arms again when a stall of a busy machine has disarmed the robot,
  /// which is counted.
  bool untilDriving(double seconds, const std::function<bool()>& condition);
  int armedAgain() const { return armed_again_; }
  /// Newest HEALTH by process name.
  const std::map<std::string, health_t>& health() const { return health_; }
  std::vector<sim::TruthRow> truth() const { return sim::readTruthRecord(folder_ + "/truth.csv"); }
  const std::string& folder() const { return folder_; }
  const std::string& url() const { return url_; }
  std::string laserAddress() const { return "tcp-server:127.0.0.1:" + std::to_string(laser_port_); }
  /// Folder of a process's state.
  std::string state(const std::string& process) const { return folder_ + "/state/" + process; }
  std::string output(const std::string& name) const;

 private:
  std::vector<std::string> argumentsOf(const std::string& name) const;
  void sendGoal();
  void renewGoal();

  std::string folder_;
  std::string url_;
  int laser_port_;
  std::string start_pose_;
  std::string key_;
  std::map<std::string, std::vector<std::string>> settings_;  ///< KEY=VALUE by process
  LcmBus bus_;
  Latest<motor_t> motor_;
  Latest<plan_t> plan_;
  Latest<program_t> program_;
  Latest<ins_t> ins_;
  std::map<std::string, health_t> health_;
  int64_t last_set_ = 0;
  int armed_again_ = 0;
  std::map<std::string, std::unique_ptr<Process>> processes_;
  std::vector<std::unique_ptr<operators::Call>> calls_;  ///< the bus refers to them until its end
  OperatorBeacon beacon_;
  bool operates_ = true;
  goal_t goal_{};
  int64_t next_goal_ = INT64_MAX;
};

}  // namespace tread::testing
