// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cstdlib>
#include <filesystem>
#include <optional>

#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include "tools/robot/launch/running_robots.hpp"

using namespace tread::launch;

namespace {

namespace fs = std::filesystem;

/// A separate folder for announcements, and no default URL.
class OwnFolder {
 public:
  OwnFolder() {
    fs::create_directories(path_);
    setenv("XDG_RUNTIME_DIR", path_.c_str(), 1);
    unsetenv("LCM_DEFAULT_URL");
  }
  ~OwnFolder() {
    fs::remove_all(path_);
    unsetenv("XDG_RUNTIME_DIR");
  }

 private:
  std::string path_ = fs::temp_directory_path() / ("tread_found_" + std::to_string(getpid()));
};

}  // namespace

TEST_CASE("the only robot that runs is found, and an address that is given goes before it") {
  const OwnFolder folder;
  CHECK(findRobot("", "").lcm_url.empty());
  std::optional<Announcement> robot;
  robot.emplace(RunningRobot{"simulated", "udpm://239.255.76.67:7668?ttl=0", "/run/key", false});
  CHECK(findRobot("", "").key == "/run/key");
  CHECK(findRobot("", "").here);
  CHECK_FALSE(findRobot("memq://", "").here);
  CHECK(findRobot("", "/my/key").key == "/my/key");
  CHECK(findRobot("", "").lcm_url == "udpm://239.255.76.67:7668?ttl=0");
  CHECK(findRobot("memq://", "").lcm_url == "memq://");
  setenv("LCM_DEFAULT_URL", "memq://", 1);
  CHECK(findRobot("", "").lcm_url.empty());
  unsetenv("LCM_DEFAULT_URL");
  // With the address of a robot that runs here its key need not be given.
  for (const bool by_variable : {false, true}) {
    const std::string url = "udpm://239.255.76.67:7668?ttl=0";
    if (by_variable) setenv("LCM_DEFAULT_URL", url.c_str(), 1);
    const RunningRobot named = findRobot(by_variable ? "" : url, "");
    CHECK(named.key == "/run/key");
    CHECK(named.here);
    CHECK(named.lcm_url == url);
    unsetenv("LCM_DEFAULT_URL");
  }
  robot.reset();
  CHECK(findRobot("", "").lcm_url.empty());
}

TEST_CASE("of two robots neither is guessed, and a killed launch is no robot") {
  const OwnFolder folder;
  const Announcement here({"one", "udpm://239.255.76.67:7001", "", false});
  const pid_t child = fork();
  if (child == 0) {
    const Announcement there({"two", "udpm://239.255.76.67:7002", "", false});
    pause();
    _exit(0);
  }
  for (int i = 0; i < 500 && runningRobots().size() < 2; ++i) usleep(10'000);
  CHECK_THROWS_WITH(findRobot("", ""),
                    Catch::Contains("several robots run here") &&
                        Catch::Contains("two: --lcm-url 'udpm://239.255.76.67:7002'"));
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  CHECK(findRobot("", "").lcm_url == "udpm://239.255.76.67:7001");
}
