// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The shipped launch files with the real processes.
#include <catch2/catch.hpp>

#include "common/link/make_link.hpp"
#include "tests/tools/robot/launch/launched.hpp"
#include "tools/robot/launch/host.hpp"

using namespace tread::testing;
using Catch::Contains;
using tread::launch::CommandOutcome;
using tread::launch::runCommand;
namespace fs = std::filesystem;

namespace {

const std::string kLaunch = std::string(TREAD_SOURCE_DIR) + "/config/launch/";

/// A temporary folder, a separate bus and a port.
struct Place {
  explicit Place(const std::string& name = "")
      : folder(fs::temp_directory_path() /
               ("tread_launch_robot_" + std::to_string(getpid()) + name)) {
    fs::create_directories(folder);
  }
  ~Place() { fs::remove_all(folder); }
  std::vector<std::string> simulated(const std::string& url = launchedLcmUrl()) const {
    return {kLaunch + "simulated.yaml",
            "--run",
            (folder / "run").string(),
            "--lcm-url",
            url,
            "--set",
            "laser_port=" + std::to_string(port)};
  }
  CommandOutcome checked(const std::string& url = launchedLcmUrl()) const {
    std::vector<std::string> words{std::string(TREAD_BIN_DIR) + "/tread-launch", "--check"};
    for (const std::string& word : simulated(url)) words.push_back(word);
    return runCommand(words, 60.0);
  }
  const int port = 30000 + (getpid() * 7) % 20000;
  const fs::path folder;
};

std::vector<int> workersIn(const fs::path& run) {
  std::vector<int> pids;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    std::error_code gone;
    if (fs::read_symlink(entry.path() / "cwd", gone) == run && !gone)
      pids.push_back(std::stoi(entry.path().filename().string()));
  }
  return pids;
}

}  // namespace

TEST_CASE("the shipped launch files pass the start-up checks, absent instruments are an advice") {
  const Place place;
  // A robot of another size, by its configuration only.
  const CommandOutcome small =
      runCommand({std::string(TREAD_BIN_DIR) + "/tread-launch", kLaunch + "robot.yaml", "--run",
                  (place.folder / "run").string(), "--set",
                  "robot=" + std::string(TREAD_SOURCE_DIR) + "/tests/data/robots/small", "--check"},
                 60.0);
  INFO(small.output);
  CHECK(small.code == 0);
  const CommandOutcome robot =
      runCommand({std::string(TREAD_BIN_DIR) + "/tread-launch", kLaunch + "robot.yaml", "--run",
                  (place.folder / "run").string(), "--check"},
                 60.0);
  INFO(robot.output);
  // Only the host's network may be missing.
  for (const std::string& line : withoutAdvice(robot.output))
    CHECK_THAT(line, Contains("robot: ready to start") || Contains("multicast"));
  const CommandOutcome simulated = place.checked();
  INFO(simulated.output);
  CHECK(simulated.code == 0);
  CHECK_THAT(simulated.output, !Contains("device") && !Contains("without a key"));
  CHECK_THAT(robot.output, !Contains("key"));
  // Checks create nothing.
  CHECK_FALSE(fs::exists(place.folder / "run/key"));
}

TEST_CASE("a mistake in a robot's configuration stops the start with its file and line") {
  const Place place;
  fs::copy(std::string(TREAD_SOURCE_DIR) + "/config/robots/teodor", place.folder / "robot");
  std::ofstream(place.folder / "robot/mapping.yaml", std::ios::app) << "\ncell_sise: 0.1\n";
  const CommandOutcome outcome =
      runCommand({std::string(TREAD_BIN_DIR) + "/tread-launch", kLaunch + "robot.yaml", "--run",
                  (place.folder / "run").string(), "--set",
                  "robot=" + (place.folder / "robot").string(), "--check"},
                 60.0);
  CHECK(outcome.code == 1);
  CHECK_THAT(outcome.output,
             Contains("robot: mapping: ") && Contains("mapping.yaml:") && Contains("cell_sise"));
}

TEST_CASE("a port that is in use is named with its remedy before anything is started") {
  const Place place;
  const std::string laser = "tcp-server:127.0.0.1:" + std::to_string(place.port);
  const std::string relay = "tcp-server:127.0.0.1:" + std::to_string(place.port + 1);
  const auto one = tread::makeLink(laser);
  const auto other = tread::makeLink(relay);
  const CommandOutcome outcome =
      place.checked("tcpq://127.0.0.1:" + std::to_string(place.port + 1));
  INFO(outcome.output);
  CHECK(outcome.code == 1);
  CHECK_THAT(outcome.output, Contains("simulated: simulator: ") && Contains("in use") &&
                                 Contains("end the program that has this port"));
  CHECK_THAT(outcome.output, Contains("or use --lcm-url tcpq://127.0.0.1:PORT"));
  CHECK_FALSE(fs::exists(place.folder / "run/log"));
}

TEST_CASE("the simulated robot starts, records, and leaves no process when its supervisor dies") {
  // Characters that shells and configuration files would expand.
  const Place place("100% \"odd\" %(here)s it's;");
  const fs::path run = place.folder / "run";
  const fs::path output = place.folder / "output.txt";
  const auto says = [&](const std::string& text) {
    return within(30, [&] { return contentOf(output).find(text) != std::string::npos; });
  };
  {
    Process launch("tread-launch", place.simulated(), output);
    REQUIRE(says("simulated: all 8 processes run after"));
    CHECK(within(10, [&] { return fs::exists(run / "devices/motor"); }));
    CHECK(within(20, [&] {
      std::error_code none;
      return fs::file_size(run / "log/robot.lcmlog.0", none) > 20000 && !none;
    }));
    launch.signal(SIGINT);
    REQUIRE(launch.waitFor(20));
    CHECK(launch.exitCode() == 0);
    CHECK(workersIn(run).empty());
  }
  fs::remove(output);
  Process launch("tread-launch", place.simulated(), output);
  REQUIRE(says("simulated: all 8 processes run after"));
  kill(std::stoi(contentOf(run / "supervisor.pid")), SIGKILL);
  CHECK(launch.waitFor(20));
  CHECK(workersIn(run).empty());
  CHECK(fs::exists(run / "log/robot.lcmlog.1"));
}
