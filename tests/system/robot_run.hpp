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

/// The whole robot as real processes on a bus of its own, in a folder of its own, with the
/// simulator at the other end of its lines; and a test that listens and operates.
class RobotRun {
 public:
  /// `world` is a world file's text, `key` a key file or empty, `url` that of a bus that is there
  /// already, or empty. Nothing is started yet.
  RobotRun(const std::string& world, const std::string& start_pose, const std::string& key = "",
           const std::string& url = "");
  ~RobotRun();
  RobotRun(const RobotRun&) = delete;
  RobotRun& operator=(const RobotRun&) = delete;

  /// Names of the processes, as they are started by startAll().
  static const std::vector<std::string>& names();
  void start(const std::string& name) { startBehind({}, name); }
  /// Another value in a process's configuration, for the next time that it is started.
  void set(const std::string& name, const std::string& key, const std::string& value) {
    settings_[name].push_back(key + "=" + value);
  }
  /// The same as the last word of another command, which must become it (exec).
  void startBehind(const std::vector<std::string>& wrapper, const std::string& name);
  void startAll();
  /// Sends a signal; SIGKILL waits for the end.
  void signal(const std::string& name, int number);
  bool running(const std::string& name);
  pid_t pid(const std::string& name) const { return processes_.at(name)->pid(); }
  Process& process(const std::string& name) { return *processes_.at(name); }
  /// Ends a process by a signal and returns its exit code; -1 if it does not end within 5 s.
  int end(const std::string& name, int number = SIGINT);
  void endAll();

  /// Handles messages until a condition holds; false after so many seconds.
  bool until(double seconds, const std::function<bool()>& condition);
  void wait(double seconds) {
    until(seconds, [] { return false; });
  }
  /// Arms as tread-arm does; false if the robot does not show it in time.
  bool arm(double seconds = 10.0);
  /// Sends the goal each second from now on, whatever else is waited for; at once the first time.
  void setGoal(double x, double y);
  /// From now on tread-goal operates, a process of the name "operator", and the test no more.
  /// `behind`: words of another command, which must become it (exec).
  void leaveTo(double x, double y, const std::vector<std::string>& behind = {});
  /// The test operates again; the next goal is its own.
  void takeBack();
  int64_t now() const { return bus_.now(); }
  LcmBus& bus() { return bus_; }

  /// Latest messages.
  const Latest<motor_t>& motor() const { return motor_; }
  const Latest<plan_t>& plan() const { return plan_; }
  const Latest<program_t>& program() const { return program_; }
  const Latest<ins_t>& ins() const { return ins_; }
  bool driving() const;
  /// Version of the set that was published last; 0 after forgetSet() until the next one comes.
  int64_t lastSet() const { return last_set_; }
  void forgetSet() { last_set_ = 0; }
  /// Whether the permission to drive is there.
  bool armed() const;
  /// Until a condition holds, arming again whenever a busy machine's stall has disarmed the robot;
  /// each time is counted.
  bool untilDriving(double seconds, const std::function<bool()>& condition);
  int armedAgain() const { return armed_again_; }
  /// Health by process name, newest.
  const std::map<std::string, health_t>& health() const { return health_; }
  std::vector<sim::TruthRow> truth() const { return sim::readTruthRecord(folder_ + "/truth.csv"); }
  const std::string& folder() const { return folder_; }
  const std::string& url() const { return url_; }
  std::string laserAddress() const { return "tcp-server:127.0.0.1:" + std::to_string(laser_port_); }
  /// Where a process keeps its state.
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
  std::vector<std::unique_ptr<operators::Call>> calls_;  ///< the bus knows them to its end
  OperatorBeacon beacon_;
  bool operates_ = true;
  goal_t goal_{};
  int64_t next_goal_ = INT64_MAX;
};

}  // namespace tread::testing
