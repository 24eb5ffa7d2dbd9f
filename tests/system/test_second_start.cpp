// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// A second process is started with the same device or the same state.
#include <filesystem>
#include <fstream>
#include <iterator>

#include <pty.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include "tests/system/process.hpp"
#include "tests/system/starter.hpp"

namespace tread::testing {
namespace {

namespace fs = std::filesystem;

/// A temporary folder.
struct OwnPlace {
  OwnPlace() : path(fs::temp_directory_path() / ("tread_second_" + std::to_string(::getpid()))) {
    fs::create_directories(path);
  }
  ~OwnPlace() { fs::remove_all(path); }
  OwnPlace(const OwnPlace&) = delete;
  OwnPlace& operator=(const OwnPlace&) = delete;
  std::string text(const std::string& name) const {
    std::ifstream file(path / name);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  fs::path path;
};

const std::string kRobot = std::string(TREAD_SOURCE_DIR) + "/config/robots/teodor/";

/// Starts a program, waits for `begun`, and starts it again with the same arguments: the second one
/// must end with code 1 and a line with these words, the first must run on.
template <class Begun>
void checkSecond(const OwnPlace& place, const std::string& program,
                 const std::vector<std::string>& arguments, const Begun& begun,
                 const std::string& words) {
  Process first(program, arguments, (place.path / "first.txt").string());
  for (int i = 0; i < 1000 && !begun(first); ++i) ::usleep(10'000);
  REQUIRE(begun(first));
  Process second(program, arguments, (place.path / "second.txt").string());
  REQUIRE(second.waitFor(20.0));
  const std::string said = place.text("second.txt");
  INFO(said);
  CHECK(second.exitCode() == 1);
  CHECK(said.find(program + ": ") == 0);
  CHECK(said.find(words) != std::string::npos);
  CHECK(said.find('\n') == said.size() - 1);
  CHECK(first.running());
}

}  // namespace

TEST_CASE("a second learner with the same state is refused at its start") {
  const OwnPlace place;
  const std::string state = (place.path / "learner").string();
  checkSecond(
      place, "tread-learner",
      {"--config", kRobot + "learner.yaml", "--set", "store=" + state, "--lcm-url", "memq://"},
      [&](Process&) { return fs::exists(state + "/learner_versions"); },
      "the folder " + state + " is in use by another process; end that one first");
}

TEST_CASE("a second motor bridge or INS driver on the same line is refused at its start") {
  const auto [program, config] =
      GENERATE(std::make_pair(std::string("tread-motor-bridge"), std::string("motor_bridge.yaml")),
               std::make_pair(std::string("tread-ins-driver"), std::string("ins_driver.yaml")));
  int master = -1;
  int slave = -1;
  char name[128];
  REQUIRE(::openpty(&master, &slave, name, nullptr, nullptr) == 0);
  const OwnPlace place;
  const std::string address = std::string("tty:") + name + "?baud=115200";
  Starter starter;
  std::vector<std::string> arguments{"--config",           kRobot + config, "--set",
                                     "address=" + address, "--lcm-url",     "memq://"};
  if (program == "tread-ins-driver")
    arguments.insert(arguments.end(), {"--set", "store=" + (place.path / "ins").string()});
  checkSecond(
      place, program, arguments,
      [&](Process& first) { return starter.count(first.pid(), "READY=1") > 0; },
      address + ": in use by another program");
  ::close(slave);
  ::close(master);
}

}  // namespace tread::testing
