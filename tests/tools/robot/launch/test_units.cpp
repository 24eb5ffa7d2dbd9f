// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// systemd's units as installed by cmake --install. systemd-analyze verify only warns of unknown
// keys, so only empty output passes.
#include <catch2/catch.hpp>

#include <algorithm>
#include <regex>
#include <set>

#include "tests/tools/robot/launch/launched.hpp"
#include "tools/robot/launch/host.hpp"
#include "tools/robot/launch/launch_file.hpp"

using namespace tread;
using namespace tread::testing;
using namespace tread::launch;
namespace fs = std::filesystem;

namespace {

/// Configuration and units, installed into a temporary folder together with the programs.
class Installed {
 public:
  Installed()
      : prefix(fs::temp_directory_path() / ("tread_units_" + std::to_string(getpid()))),
        units(prefix / "lib/systemd/system") {
    fs::remove_all(prefix);
    fs::create_directories(prefix);
    const CommandOutcome outcome = runCommand({"cmake", "--install", TREAD_BUILD_DIR, "--prefix",
                                               prefix.string(), "--component", "config"},
                                              60.0);
    INFO(outcome.output);
    REQUIRE(outcome.code == 0);
    fs::create_symlink(TREAD_BIN_DIR, prefix / "bin");
  }
  ~Installed() { fs::remove_all(prefix); }
  Installed(const Installed&) = delete;
  Installed& operator=(const Installed&) = delete;

  CommandOutcome verify() const {
    std::vector<std::string> words{"systemd-analyze", "verify", "--man=no"};
    for (const auto& entry : fs::directory_iterator(units)) words.push_back(entry.path().string());
    words.push_back((units / "tread@planner.service").string());
    return runCommand(words, 60.0);
  }
  void replace(const std::string& unit, const std::string& old_text,
               const std::string& new_text) const {
    std::string text = contentOf(units / unit);
    const size_t at = text.find(old_text);
    REQUIRE(at != std::string::npos);
    std::ofstream(units / unit) << text.replace(at, old_text.size(), new_text);
  }

  const fs::path prefix;
  const fs::path units;
};

std::set<std::string> processesOf(const std::string& file) {
  ConfigReader reader = ConfigReader::fromFile(file);
  std::set<std::string> names;
  for (const LaunchProcess& process :
       readLaunchFile(reader, {file, "/run/tread", TREAD_BIN_DIR, "", {}}).processes)
    names.insert(process.name);
  return names;
}

const std::string kLaunch = std::string(TREAD_SOURCE_DIR) + "/config/launch/";

}  // namespace

TEST_CASE("systemd has nothing to say against the installed units") {
  const Installed installed;
  const CommandOutcome outcome = installed.verify();
  CHECK(outcome.code == 0);
  CHECK(outcome.output.empty());
}

TEST_CASE(
    "stopped in the reverse order of their start, the motors are the first and the log the last") {
  const Installed installed;
  const auto unit = [&](const std::string& name) { return contentOf(installed.units / name); };
  CHECK_THAT(unit("tread@.service"), Catch::Contains("\nAfter=tread-route.service tread-logger") &&
                                         Catch::Contains("\nBefore=tread-motor-bridge.service\n"));
  CHECK_THAT(unit("tread-motor-bridge.service"),
             Catch::Contains("\nAfter=tread-route.service tread-logger.service\n") &&
                 Catch::Contains("--only motor-bridge\n"));
}

TEST_CASE("a process that hangs is aborted, leaves a core, and is started again however often") {
  const Installed installed;
  for (const auto& [unit, seconds] :
       std::map<std::string, std::string>{{"tread@.service", "2"},
                                          {"tread-motor-bridge.service", "2"},
                                          {"tread-logger.service", "10"}}) {
    CAPTURE(unit);
    CHECK_THAT(contentOf(installed.units / unit),
               Catch::Contains("\nType=notify\n") &&
                   Catch::Contains("\nWatchdogSec=" + seconds + "\nWatchdogSignal=SIGABRT\n") &&
                   Catch::Contains("\nLimitCORE=infinity\n") &&
                   Catch::Contains("\nTimeoutStartSec=30\nRestart=always\n") &&
                   Catch::Contains("\nStartLimitIntervalSec=0\n"));
  }
}

TEST_CASE("no unit talks to another host, and LCM's datagrams come from an address that may") {
  const Installed installed;
  for (const char* unit :
       {"tread@.service", "tread-motor-bridge.service", "tread-logger.service"}) {
    CAPTURE(unit);
    CHECK_THAT(contentOf(installed.units / unit),
               Catch::Contains("\nIPAddressDeny=any\nIPAddressAllow=localhost 239.255.76.67\n"));
  }
  CHECK_THAT(contentOf(installed.units / "tread-route.service"),
             Catch::Contains("route replace 224.0.0.0/4 dev lo src 127.0.0.1\n"));
}

TEST_CASE("a misspelt key, a wrong value and a missing program in a unit are caught") {
  const Installed installed;
  SECTION("key") {
    installed.replace("tread@.service", "Restart=", "Restrat=");
    CHECK_THAT(installed.verify().output, Catch::Contains("Restrat"));
  }
  SECTION("value") {
    installed.replace("tread-logger.service", "TimeoutStopSec=5", "TimeoutStopSec=five");
    CHECK_THAT(installed.verify().output, Catch::Contains("five"));
  }
  SECTION("program") {
    installed.replace("tread-logger.service", "/bin/tread-launch", "/bin/tread-lunch");
    CHECK_THAT(installed.verify().output, Catch::Contains("tread-lunch"));
  }
}

TEST_CASE("the target starts the processes of robot.yaml, each of them") {
  const std::string text =
      contentOf(std::string(TREAD_SOURCE_DIR) + "/config/systemd/tread.target.in");
  const std::regex wants("Wants=tread[@-]([a-z-]+)\\.service");
  std::set<std::string> names;
  for (std::sregex_iterator match(text.begin(), text.end(), wants), end; match != end; ++match)
    names.insert((*match)[1]);
  CHECK(names == processesOf(kLaunch + "robot.yaml"));
}

TEST_CASE("the simulated robot has the robot's processes and the simulator") {
  std::set<std::string> names = processesOf(kLaunch + "robot.yaml");
  names.insert("simulator");
  CHECK(names == processesOf(kLaunch + "simulated.yaml"));
}
