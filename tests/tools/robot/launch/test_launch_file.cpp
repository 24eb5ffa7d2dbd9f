// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "tools/robot/launch/launch_file.hpp"

using namespace tread;
using namespace tread::launch;

namespace {

const LaunchSettings kSettings{"/etc/robots/launch/r.yaml", "/run/r", "/opt/tread/bin", "", {}};

LaunchFile read(const std::string& text, const LaunchSettings& settings = kSettings) {
  ConfigReader reader = ConfigReader::fromText(text, "r.yaml");
  return readLaunchFile(reader, settings);
}

/// The error line for a faulty file.
std::string mistake(const std::string& text, const LaunchSettings& settings = kSettings) {
  try {
    read(text, settings);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no mistake found";
}

using Catch::Contains;
using Catch::StartsWith;
using Words = std::vector<std::string>;

}  // namespace

TEST_CASE("a launch file becomes processes in its order, with placeholders and paths put in") {
  const LaunchFile launch = read(R"(
name: robot
values: {robot: ../robots/teodor}
processes:
  - {name: logger, program: lcm-logger, external: true, stop_time: 9,
     arguments: ["--lcm-url={lcm_url}", "{run}/log/x"]}
  - {name: planner, program: tread-planner, config: "{robot}/planner.yaml",
     stop_signal: TERM}
  - {name: own, program: ../tools/own}
)");
  CHECK(launch.name == "robot");
  CHECK(launch.lcm_url == "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=2097152");
  REQUIRE(launch.processes.size() == 3);
  const LaunchProcess& logger = launch.processes[0];
  CHECK(logger.external);
  CHECK(logger.stop_signal == "INT");
  CHECK(logger.stop_time == 9);
  CHECK(logger.arguments == Words{"--lcm-url=" + launch.lcm_url, "/run/r/log/x"});
  const LaunchProcess& planner = launch.processes[1];
  CHECK(planner.config == "/etc/robots/robots/teodor/planner.yaml");
  CHECK(planner.stop_signal == "TERM");
  CHECK(launch.processes[2].program == "/etc/robots/tools/own");
}

TEST_CASE("the command line replaces the address and the values of a launch file") {
  LaunchSettings settings = kSettings;
  settings.lcm_url = "udpm://239.255.76.67:9000?ttl=0";
  settings.values = {{"robot", "/mine"}};
  const std::string text =
      "name: r\nlcm_url: udpm://239.255.76.67:1?ttl=0\nvalues: {robot: x}\n"
      "processes: [{name: p, program: p, config: \"{robot}/p.yaml\"}]";
  const LaunchFile launch = read(text, settings);
  CHECK(launch.lcm_url == settings.lcm_url);
  CHECK(launch.processes[0].config == "/mine/p.yaml");
  settings.values = {{"robbot", "/mine"}};
  CHECK(mistake(text, settings) ==
        "/etc/robots/launch/r.yaml: has no value 'robbot' to set; there is robot");
}

TEST_CASE("one choice of the robot reaches every process of a shipped launch, the simulator too") {
  const std::string source = TREAD_SOURCE_DIR;
  const std::string small = source + "/tests/data/robots/small";
  for (const char* name : {"robot", "recording", "simulated", "simulated_recording"}) {
    LaunchSettings settings = kSettings;
    settings.file = source + "/config/launch/" + name + ".yaml";
    settings.values = {{"robot", "../../tests/data/robots/small"}};
    ConfigReader reader = ConfigReader::fromFile(settings.file);
    for (const LaunchProcess& process : readLaunchFile(reader, settings).processes) {
      CAPTURE(name, process.name);
      if (process.name == "logger") continue;
      const Words& words = process.arguments;
      if (process.name == "simulator")
        CHECK(std::count(words.begin(), words.end(), "--set=robot=" + small + "/robot.yaml") == 1);
      else
        CHECK_THAT(process.config, StartsWith(small + "/"));
    }
  }
}

TEST_CASE("mistakes in a launch file are named with file and line") {
  CHECK_THAT(mistake("name: r\n"), StartsWith("r.yaml:") && Contains("processes"));
  CHECK_THAT(mistake("name: r\nprocesses: []\n"), StartsWith("r.yaml:2: processes: is empty"));
  CHECK_THAT(mistake("name: R 2\nprocesses: []\n"), StartsWith("r.yaml:1: name: 'R 2' is no name"));
  CHECK_THAT(mistake("name: r\nprocesses:\n  - name: p\n"), Contains("program"));
  CHECK_THAT(mistake("name: r\nprocesses:\n  - name: p\n    program: x\n    restrat: true\n"),
             StartsWith("r.yaml:5:") && Contains("restrat"));
  CHECK_THAT(mistake("name: r\nprocesses:\n  - {name: p, program: x}\n  - {name: p, program: y}\n"),
             StartsWith("r.yaml:4:") && Contains("'p' is taken"));
  CHECK_THAT(mistake("name: r\nprocesses:\n  - name: p\n    program: x\n    stop_time: 900\n"),
             StartsWith("r.yaml:5:") && Contains("1..60 s"));
  CHECK_THAT(mistake("name: r\nprocesses:\n  - name: p\n    program: x\n    stop_signal: SIGINT\n"),
             StartsWith("r.yaml:5:") && Contains("INT, TERM"));
  CHECK_THAT(mistake("name: r\nprocesses:\n  - name: p\n    program: \"{rnu}/x\"\n"),
             StartsWith("r.yaml:4:") && Contains("'{rnu}' stands for nothing; known are {bin}"));
  CHECK_THAT(mistake("name: r\nprocesses:\n  - name: p\n    program: x{\n"),
             StartsWith("r.yaml:4:") && Contains("stands for nothing"));
  CHECK_THAT(mistake("name: r\nvalues:\n  run: /x\nprocesses: [{name: p, program: p}]"),
             StartsWith("r.yaml:3:") && Contains("is a built-in placeholder"));
  CHECK_THAT(mistake("name: r\nprocesses:\n  - {name: p, program: x, external: true, config: y}\n"),
             StartsWith("r.yaml:3:") && Contains("give it to an external one in arguments"));
  CHECK_THAT(mistake("name: r\nprocesses:\n  - {name: supervisor, program: x}\n"),
             Contains("is taken"));
}

TEST_CASE("the key of a launch file is a path from its folder, and never an empty one") {
  const std::string processes = "processes: [{name: p, program: p}]";
  CHECK(read("name: r\n" + processes).key == "/run/r/key");
  CHECK(read("name: r\n" + processes).makes_key);
  for (const char* without : {"simulated: true\n", "key: none\n"}) {
    CHECK(read("name: r\n" + std::string(without) + processes).key.empty());
    CHECK_FALSE(read("name: r\n" + std::string(without) + processes).makes_key);
  }
  CHECK_FALSE(read("name: r\nkey: ../robot.key\n" + processes).makes_key);
  CHECK(read("name: r\nkey: ../robot.key\n" + processes).key == "/etc/robots/robot.key");
  CHECK(read("name: r\nkey: \"{run}/key\"\n" + processes).key == "/run/r/key");
  CHECK_THAT(mistake("name: r\nkey: \"\"\n" + processes),
             StartsWith("r.yaml:2:") && Contains("is empty; name a file"));
  CHECK_THAT(mistake("name: r\nvalues: {k: \"\"}\nkey: \"{k}\"\n" + processes),
             Contains("is empty; name a file"));
}

TEST_CASE("our programs watch their parent by themselves, external ones with setpriv") {
  LaunchProcess process;
  process.config = "/c.yaml";
  process.arguments = {"--set", "a=b"};
  CHECK(startCommand(process, "/bin/p", "udpm://") == Words{"/bin/p", "--config", "/c.yaml",
                                                            "--lcm-url", "udpm://", "--with-parent",
                                                            "--set", "a=b"});
  CHECK(checkCommand(process, "/bin/p", "udpm://") ==
        Words{"/bin/p", "--config", "/c.yaml", "--lcm-url", "udpm://", "--check", "--set", "a=b"});
  CHECK(startCommand(process, "/bin/p", "udpm://", "/key") ==
        Words{"/bin/p", "--config", "/c.yaml", "--lcm-url", "udpm://", "--with-parent", "--key",
              "/key", "--set", "a=b"});
  process.external = true;
  process.config.clear();
  CHECK(startCommand(process, "/bin/p", "udpm://", "/key") ==
        startCommand(process, "/bin/p", "udpm://"));
  CHECK(startCommand(process, "/bin/p", "udpm://") ==
        Words{"setpriv", "--pdeathsig", "INT", "--", "/bin/p", "--set", "a=b"});
  CHECK(checkCommand(process, "/bin/p", "udpm://").empty());
}

TEST_CASE("a process's start time and watchdog are read, and what makes no sense is refused") {
  const auto one = [](const std::string& keys) {
    return "name: r\nprocesses: [{name: p, program: p, " + keys + "}]";
  };
  const LaunchProcess usual = read(one("stop_time: 5")).processes[0];
  CHECK(usual.start_time == 30.0);
  CHECK(usual.watchdog == 2.0);
  const LaunchProcess own = read(one("start_time: 60, watchdog: 0")).processes[0];
  CHECK(own.start_time == 60.0);
  CHECK(own.watchdog == 0.0);
  CHECK_THAT(mistake(one("watchdog: 0.3")),
             Contains("watchdog: is 0.3 s; allowed 0 (not watched) or from 1 s on"));
  CHECK_THAT(mistake(one("start_time: 0")), Contains("start_time"));
  CHECK_THAT(mistake(one("watchdog: 5, external: true")),
             Contains("an external one sends no signs of life"));
  CHECK_THAT(mistake(one("watch_dog: 5")), Contains("watch_dog"));
}
