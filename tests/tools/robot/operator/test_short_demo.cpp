// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include <catch2/catch.hpp>

#include "tests/system/process.hpp"

namespace tread::testing {
namespace {

namespace fs = std::filesystem;

/// A user's desk: programs with output and exit code, in a temporary folder.
class Desk {
 public:
  Desk() { fs::create_directories(folder); }
  ~Desk() {
    launch.reset();
    std::error_code none;
    fs::remove_all(folder, none);
  }

  struct Answer {
    int code = -1;
    std::string words;
  };
  Answer type(const std::string& program, const std::vector<std::string>& arguments,
              double seconds = 60.0) {
    const std::string file = folder + "/answer.txt";
    fs::remove(file);
    Process process(program, arguments, file);
    process.waitFor(seconds);
    return {process.exitCode(), read(file)};
  }
  Answer call(const std::string& program, std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--lcm-url", url});
    return type(program, arguments);
  }
  void start() {
    const std::string file = std::string(TREAD_SOURCE_DIR) + "/config/launch/simulated.yaml";
    const int port = 40000 + ::getpid() % 20000;
    launch = std::make_unique<Process>(
        "tread-launch",
        std::vector<std::string>{file, "--run", run, "--lcm-url", url, "--set",
                                 "laser_port=" + std::to_string(port), "--set",
                                 "record=" + folder + "/truth.csv"},
        folder + "/launch.txt");
    for (int i = 0; i < 1000 && read(folder + "/launch.txt").find("starting") == std::string::npos;
         ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  int stop() {
    launch->signal(SIGINT);
    return launch->waitFor(20.0) ? launch->exitCode() : -1;
  }
  static std::string read(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  }

  std::string folder = fs::temp_directory_path() / ("tread_desk_" + std::to_string(::getpid()));
  std::string run = folder + "/run";
  std::string url = launchedLcmUrl() + "&recv_buf_size=2097152";
  std::unique_ptr<Process> launch;
};

}  // namespace

TEST_CASE("the short demo: launch, arm, drive, stop, go on, arrive, report, replay") {
  Desk desk;
  desk.start();
  const auto armed = desk.call("tread-arm", {"--why", "test", "--timeout", "30"});
  INFO(armed.words << Desk::read(desk.folder + "/launch.txt"));
  REQUIRE(armed.code == 0);
  CHECK_THAT(armed.words, Catch::Contains("tread-arm: armed"));

  // An emergency stop on the way; the goal is cancelled when its sender gives up.
  const auto cut = desk.call("tread-goal", {"-9.8", "-2.8", "--timeout", "3"});
  CHECK(cut.code == 1);
  CHECK_THAT(cut.words, Catch::Contains("driving") && Catch::Contains("out of time"));
  const auto stopped = desk.call("tread-stop", {"--why", "test"});
  CHECK(stopped.code == 0);
  const auto refused = desk.call("tread-arm", {"--timeout", "2"});
  CHECK(refused.code == 1);
  CHECK_THAT(refused.words, Catch::Contains("not armed; the motor bridge says:"));
  CHECK(desk.call("tread-stop", {"--clear"}).code == 0);
  REQUIRE(desk.call("tread-arm", {"--timeout", "30"}).code == 0);

  const auto arrived = desk.call("tread-goal", {"-9.8", "-2.8", "--timeout", "60"});
  INFO(arrived.words);
  CHECK(arrived.code == 0);
  CHECK_THAT(arrived.words, Catch::Contains("to go") && Catch::Contains("arrived"));
  CHECK(desk.stop() == 0);

  const std::string log = desk.run + "/log/robot.lcmlog.0";
  const std::string picture = desk.folder + "/drive.png";
  const auto report =
      desk.type("tread-report",
                {log, "--truth", desk.folder + "/truth.csv", "--world",
                 std::string(TREAD_SOURCE_DIR) + "/config/worlds/demo.yaml", "--picture", picture});
  INFO(report.words);
  CHECK(report.code == 0);
  CHECK_THAT(report.words, Catch::StartsWith("arrived after ") && Catch::Contains("contacts 0"));
  CHECK(fs::file_size(picture) > 10000);

  // Learning and plans of the robot are reproduced from its log.
  for (const std::string process : {"learner", "planner"}) {
    const auto replayed = desk.type("tread-replay", {process, log});
    INFO(process << ": " << replayed.words);
    CHECK(replayed.code == 0);
  }
}

TEST_CASE("without a robot the operator's commands say who is missing") {
  Desk desk;
  desk.url = ownLcmUrl();
  const auto armed = desk.call("tread-arm", {"--timeout", "1"});
  CHECK(armed.code == 1);
  CHECK_THAT(armed.words, Catch::Contains("is tread-motor-bridge running on this LCM URL?"));
  const auto stopped = desk.call("tread-stop", {"--timeout", "1"});
  CHECK(stopped.code == 1);
  CHECK_THAT(stopped.words, Catch::Contains("NOBODY CONFIRMS THE STOP"));
  const auto sent = desk.call("tread-goal", {"1", "2", "--timeout", "1"});
  CHECK(sent.code == 1);
  CHECK_THAT(sent.words, Catch::Contains("no MOTOR message"));
  CHECK(desk.type("tread-goal", {"1"}).code == 2);
  CHECK(desk.type("tread-goal", {"1", "2", "--tolerance", "-1"}).code == 2);
}

}  // namespace tread::testing
