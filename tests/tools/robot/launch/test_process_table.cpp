// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <csignal>

#include <catch2/catch.hpp>

#include "tools/robot/launch/process_table.hpp"

using namespace tread::launch;

namespace {

using Task = ProcessTable::Task;

constexpr int kExit1 = 1 << 8;  // as in waitpid(2)

std::vector<LaunchProcess> namedProcesses(const std::vector<std::string>& names) {
  std::vector<LaunchProcess> processes;
  for (const std::string& name : names) {
    processes.emplace_back();
    processes.back().name = name;
    processes.back().stop_time = 5;
  }
  return processes;
}

/// The table of a robot whose processes start when due, with increasing pids.
struct TableBench {
  explicit TableBench(const std::vector<std::string>& names)
      : table("robot", namedProcesses(names)) {}

  /// Runs up to a time in steps of 50 ms; returns the due actions as words.
  std::string runTo(double end) {
    std::string done;
    for (; now < end; now += 0.05)
      for (const Task& task : table.due(now)) {
        done += std::string(task.kind == Task::kStart      ? "start "
                            : task.kind == Task::kAskToEnd ? "ask "
                                                           : "kill ") +
                std::to_string(task.process) + "; ";
        if (task.kind == Task::kStart) table.started(task.process, ++pid, now);
      }
    for (const ProcessTable::Event& event : table.takeEvents()) {
      if (!event.told.empty()) told += event.told + "\n";
      log += event.log + "\n";
    }
    return done;
  }

  ProcessTable table;
  double now = 0.0;
  int pid = 10;
  std::string told, log;
};

}  // namespace

TEST_CASE("processes start in their order, and one that ran and ends is started again at once") {
  TableBench bench({"planner", "learner"});
  CHECK(bench.runTo(2.0) == "start 0; start 1; ");
  CHECK(bench.told == "robot: all 2 processes run after 1.0 s\n");
  CHECK(bench.table.status() ==
        "planner                  RUNNING   pid 11\nlearner                  RUNNING   pid 12\n");
  CHECK(bench.table.ended(11, SIGKILL, bench.now) == 0U);
  CHECK(bench.table.ended(4711, 0, bench.now) == std::nullopt);
  CHECK(bench.runTo(2.2) == "start 0; ");
  bench.runTo(4.0);
  CHECK(bench.told ==
        "robot: all 2 processes run after 1.0 s\n"
        "robot: planner ended (terminated by SIGKILL; not expected)\n"
        "robot: planner runs again\n");
  CHECK(bench.log.find("spawned: 'planner' with pid 13\n") != std::string::npos);
}

TEST_CASE("one that ends at once is tried again after pauses that grow, and told twice") {
  TableBench bench({"planner"});
  CHECK(bench.runTo(0.1) == "start 0; ");
  std::vector<double> pauses;
  for (int i = 0; i < 70; ++i) {
    const double ended = bench.now;
    bench.table.ended(bench.pid, kExit1, ended);
    while (bench.runTo(bench.now + 0.05).empty()) {
    }
    pauses.push_back(bench.now - ended);
  }
  CHECK(pauses[0] == Approx(1.0).margin(0.11));
  CHECK(pauses[1] == Approx(2.0).margin(0.11));
  CHECK(pauses[9] == Approx(10.0).margin(0.11));
  CHECK(pauses.back() == Approx(60.0).margin(0.11));
  CHECK(bench.told ==
        "robot: planner ended (exit status 1; not expected)\n"
        "robot: planner ended again (exit status 1; not expected); the pauses between its starts "
        "grow, see log/planner.log\n");
  bench.runTo(bench.now + 2.0);
  CHECK(bench.told.find("robot: all 1 processes run after") != std::string::npos);
  bench.table.ended(bench.pid, kExit1, bench.now);
  CHECK(bench.runTo(bench.now + 0.1) == "start 0; ");
}

TEST_CASE("one that cannot be started is tried again later") {
  ProcessTable table("robot", namedProcesses({"planner"}));
  REQUIRE(table.due(0.0).size() == 1);
  table.started(0, std::nullopt, 0.0);
  CHECK(table.due(0.5).empty());
  CHECK(table.due(1.1).size() == 1);
}

TEST_CASE("they stop in the reverse order, one after the other, and who does not is killed") {
  TableBench bench({"planner", "learner", "bridge"});
  bench.runTo(2.0);
  bench.table.ended(12, kExit1, bench.now);  // it waits for its next start
  bench.table.stop();
  CHECK(bench.runTo(3.0) == "ask 2; ");
  CHECK_FALSE(bench.table.done());
  bench.table.ended(13, 0, bench.now);
  CHECK(bench.runTo(7.8) == "ask 0; ");
  CHECK(bench.runTo(9.0) == "kill 0; ");
  bench.table.ended(11, SIGKILL, bench.now);
  CHECK(bench.runTo(9.1).empty());
  CHECK(bench.table.done());
  CHECK(bench.told.find("robot: planner did not stop in time and is killed\n") !=
        std::string::npos);
  CHECK(bench.log.find("stopped: bridge (exit status 0)\nkilling 'planner' (11) with SIGKILL\n"
                       "stopped: planner (terminated by SIGKILL)\n") != std::string::npos);
}
