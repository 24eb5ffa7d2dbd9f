// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/robot/launch/launch_file.hpp"

namespace tread::launch {

/// State of the processes and the next actions: starting in order, restarting, stopping in reverse
/// order.
/** Pure: times [s] are arguments. A process that ran for 1 s and ends is restarted at once; one
 * that ended earlier is restarted after a pause, which grows by 1 s each time, up to 60 s. At a
 * stop each process is asked to end, and killed after its stop time, before the next one is asked.
 * */
class ProcessTable {
 public:
  ProcessTable(std::string launch, std::vector<LaunchProcess> processes);

  struct Task {
    enum Kind { kStart, kAskToEnd, kKill } kind;
    size_t process;  ///< index in the launch file
    int pid;         ///< 0: to be started
  };
  /// Actions that are due; each is returned once.
  std::vector<Task> due(double now);
  /// A process was started; no pid: starting failed.
  void started(size_t process, std::optional<int> pid, double now);
  /// A child has ended with a status of waitpid(2); returns its index, nullopt for other children.
  std::optional<size_t> ended(int pid, int status, double now);
  /// From now on all processes are stopped.
  void stop() { stopping_ = true; }
  /// Whether all have ended after stop().
  bool done() const;

  /// An event since the last call.
  struct Event {
    std::string log;   ///< line for the supervisor's log
    std::string told;  ///< line for the terminal; empty where people need not know
  };
  std::vector<Event> takeEvents();
  /// State of the processes, one per line.
  std::string status() const;

 private:
  struct Entry {
    enum State { kWaits, kStarting, kRuns, kStopping, kStopped } state = kWaits;
    LaunchProcess process;
    int pid = 0;
    double since = 0.0;  ///< start of the state; kWaits: time of the next start
    int ends = 0;        ///< consecutive ends without running for 1 s
    bool ran = false;    ///< has run for 1 s at least once
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
