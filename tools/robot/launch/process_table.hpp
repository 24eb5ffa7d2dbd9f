// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/robot/launch/launch_file.hpp"

namespace tread::launch {

/// Which of the processes run, and what is to be done with them: started in their order, started
/// again, stopped in the reverse order.
/** Pure: times [s] are arguments. One that ran for a second and ends is started again at once; one
 * that ended before after a pause, which grows by a second each time, up to a minute. At the stop
 * each is asked to end, and killed after its stop time, before the next one is asked. */
class ProcessTable {
 public:
  ProcessTable(std::string launch, std::vector<LaunchProcess> processes);

  struct Task {
    enum Kind { kStart, kAskToEnd, kKill } kind;
    size_t process;  ///< its place in the launch file
    int pid;         ///< 0 where it is to be started
  };
  /// What is to be done now; each is told once.
  std::vector<Task> due(double now);
  /// A process was started; without a pid it could not be.
  void started(size_t process, std::optional<int> pid, double now);
  /// A child has ended, with a status as of waitpid(2); its place if it is one of these processes.
  std::optional<size_t> ended(int pid, int status, double now);
  /// From now on they are to end.
  void stop() { stopping_ = true; }
  /// They were to end, and all have.
  bool done() const;

  /// What has happened since the last call.
  struct Event {
    std::string log;   ///< for the supervisor's log
    std::string told;  ///< for people; empty where it does not matter to them
  };
  std::vector<Event> takeEvents();
  /// How the processes are, a line each.
  std::string status() const;

 private:
  struct Entry {
    enum State { kWaits, kStarting, kRuns, kStopping, kStopped } state = kWaits;
    LaunchProcess process;
    int pid = 0;
    double since = 0.0;  ///< when the state began; kWaits: when it is to be started
    int ends = 0;        ///< in a row, without having run for a second between them
    bool ran = false;    ///< for a second, at least once
    bool killed = false;
  };

  bool lives(const Entry& entry) const;
  void nowRuns(Entry& entry, double now);
  void restartLater(Entry& entry, const std::string& how, double now);
  std::vector<Task> dueToStop(double now);
  void note(std::string log, const std::string& told = {});

  std::string launch_;
  std::vector<Entry> entries_;
  std::vector<Event> events_;
  std::optional<double> start_;
  bool stopping_ = false;
};

}  // namespace tread::launch
