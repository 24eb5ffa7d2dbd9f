// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <stdexcept>

#include "tools/robot/launch/launch_file.hpp"

using namespace tread::launch;
using Catch::Contains;

namespace {

SupervisedProcess process(const std::string& name) {
  SupervisedProcess supervised;
  supervised.process.name = name;
  supervised.command = {"/bin/" + name, "100%", "a b"};
  return supervised;
}

}  // namespace

TEST_CASE("the supervisor gets its own socket, pid and logs below the run folder") {
  SupervisedProcess second = process("second");
  second.process.stop_signal = "TERM";
  second.process.stop_time = 9;
  const std::string text = supervisorConfig("robot", {process("first"), second}, true);
  for (const char* line : {"file=./supervisor.sock\n", "pidfile=./supervisord.pid\n",
                           "logfile=./log/supervisord.log\n", "nodaemon=true\n", "user=root\n",
                           "serverurl=unix://./supervisor.sock\n"})
    CHECK_THAT(text, Contains(line));
  CHECK_THAT(text, Contains("[program:first]\n"
                            "command=/bin/first 100%% a' 'b\n"
                            "priority=10\n"
                            "autorestart=true\n"
                            "startsecs=1\n"
                            "startretries=1000000\n"
                            "stopsignal=INT\n"
                            "stopwaitsecs=5\n"
                            "killasgroup=true\n"
                            "redirect_stderr=true\n"
                            "stdout_logfile=./log/first.log\n"
                            "stdout_logfile_maxbytes=5MB\n"));
  CHECK_THAT(text, Contains("[program:second]\n") && Contains("priority=20\n") &&
                       Contains("stopsignal=TERM\n") && Contains("stopwaitsecs=9\n"));
  CHECK_THAT(supervisorConfig("robot", {process("first")}, false), !Contains("user="));
}

TEST_CASE("words survive the supervisor's percent signs, quotes and comments") {
  CHECK(supervisorCommand({"a", "", "x #y", "50%", "it's;", "z "}) ==
        "a '' x' '\\#y 50%% it\\'s\\; z' '");
}

TEST_CASE("the supervisor's log is told in a few plain lines") {
  LaunchProgress progress("robot", 2);
  std::string told;
  int ends = 0;
  for (const char* line :
       {"2026-01-01 10:00:00,000 INFO spawned: 'planner' with pid 12",
        "2026-01-01 10:00:01,000 INFO success: planner entered RUNNING state, process has stayed "
        "up for > than 1 seconds (startsecs)",
        "2026-01-01 10:00:01,000 INFO success: learner entered RUNNING state, process has",
        "2026-01-01 10:00:02,000 WARN exited: planner (terminated by SIGKILL; not expected)",
        "2026-01-01 10:00:03,000 WARN exited: planner (exit status 1; not expected)",
        "2026-01-01 10:00:04,000 WARN exited: planner (exit status 1; not expected)",
        "2026-01-01 10:00:06,000 INFO success: planner entered RUNNING state, process has",
        "2026-01-01 10:00:07,000 WARN killing 'learner' (12) with SIGKILL",
        "2026-01-01 10:00:08,000 WARN stopped: learner (terminated by SIGKILL)",
        "2026-01-01 10:00:08,000 INFO RPC interface 'supervisor' initialized"}) {
    told += progress.lineFor(line, 1.62).value_or("-") + "\n";
    ends += LaunchProgress::isEnd(line) ? 1 : 0;
  }
  CHECK(told ==
        "-\n-\nrobot: all 2 processes run after 1.6 s\n"
        "robot: planner ended (terminated by SIGKILL; not expected)\n"
        "robot: planner ended again (exit status 1; not expected); the pauses before it is started "
        "grow, see log/planner.log\n"
        "-\n"
        "robot: planner runs again\n"
        "robot: learner did not stop in time and is killed\n"
        "-\n"
        "-\n");
  CHECK(ends == 3);
}
