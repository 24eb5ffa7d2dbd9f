// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <filesystem>

#include <catch2/catch.hpp>

#include <memory>

#include "common/seal/key_file.hpp"
#include "tests/tools/robot/launch/launched.hpp"
#include "tools/robot/launch/host.hpp"

namespace fs = std::filesystem;

using namespace tread::testing;
using Catch::Contains;
using tread::launch::CommandOutcome;
using tread::launch::runCommand;

namespace {

CommandOutcome call(const Launched& launched, const std::vector<std::string>& more) {
  std::vector<std::string> words{std::string(TREAD_BIN_DIR) + "/tread-launch"};
  for (const std::string& word : launched.arguments(more)) words.push_back(word);
  return runCommand(words, 30.0);
}

}  // namespace

TEST_CASE("processes start, one that is killed comes back, and all are gone after the stop") {
  const Launched launched({"good", "good"}, TREAD_STAND_IN);
  Process launch("tread-launch", launched.arguments(), launched.output());
  REQUIRE(launched.says("trial: all 3 processes run after"));
  CHECK(launched.pids().size() == 3);
  const int first = launched.pidOf("p1.txt");
  REQUIRE(first > 0);
  kill(first, SIGKILL);
  CHECK(within(10, [&] {
    const int now = launched.pidOf("p1.txt");
    return now > 0 && now != first;
  }));
  CHECK(launched.says("trial: p1 ended (terminated by SIGKILL; not expected)"));
  CHECK(launched.says("trial: p1 runs again"));
  launch.signal(SIGINT);
  REQUIRE(launch.waitFor(10));
  CHECK(launch.exitCode() == 0);
  CHECK(launched.says("trial: stopped after"));
  CHECK(launched.pids().empty());
  CHECK_FALSE(std::filesystem::exists(launched.run() / "life.sock"));
  // They were asked to end, last one first, instead of being killed.
  CHECK_THAT(contentOf(launched.run() / "log/p0.log"), Contains("ends by signal 2"));
  const std::string log = contentOf(launched.run() / "log/supervisor.log");
  CHECK(log.find("stopped: p1 (exit status 0)") < log.find("stopped: p0 (exit status 0)"));
}

TEST_CASE(
    "where the wiring is to be tried, it is with a yes, and nothing starts where it is wrong") {
  const Launched unasked({"good"}, TREAD_STAND_IN, "simulated: true\npre_drive: \"{here}\"\n");
  Process launch("tread-launch", unasked.arguments(), unasked.output());
  CHECK(
      unasked.says("trial: wiring not tested: no terminal to ask for permission, see --pre-drive"));
  CHECK(unasked.says("trial: all 2 processes run after"));
  launch.signal(SIGINT);
  REQUIRE(launch.waitFor(10));

  const Launched wrong({"good"}, TREAD_STAND_IN, "simulated: true\npre_drive: \"{here}\"\n");
  const CommandOutcome tried = call(wrong, {"--pre-drive"});
  CHECK(tried.code == 1);
  CHECK_THAT(tried.output, Contains("robot.yaml") && Contains("trial: nothing is started"));
  CHECK(wrong.pids().empty());

  const CommandOutcome nothing = call(Launched({"good"}, TREAD_STAND_IN), {"--pre-drive"});
  CHECK(nothing.code == 1);
  CHECK_THAT(nothing.output, Contains("names no robot under pre_drive"));
}

TEST_CASE("the key goes to every process of ours and to no other, and a bad one starts nothing") {
  const Launched launched({"good"}, TREAD_STAND_IN, "simulated: true\nkey: robot.key\n");
  const std::string key = (launched.folder / "robot.key").string();
  const CommandOutcome absent = call(launched, {});
  CHECK(absent.code == 1);
  REQUIRE(withoutAdvice(absent.output).size() == 1);
  CHECK(withoutAdvice(absent.output).front() ==
        "trial: key " + key +
            ": cannot be read (No such file or directory); fix: check the path, "
            "or make one with tread-key new");
  tread::writeNewKey(key);
  std::filesystem::permissions(key, std::filesystem::perms(0644));
  CHECK_THAT(call(launched, {"--check"}).output, Contains("(mode 0644); fix: chmod 600 " + key));
  std::filesystem::permissions(key, std::filesystem::perms(0600));
  Process launch("tread-launch", launched.arguments(), launched.output());
  REQUIRE(launched.says("trial: all 2 processes run after"));
  CHECK(within(10, [&] {
    return contentOf(launched.run() / "log/p0.log").find("--key " + key) != std::string::npos;
  }));
  CHECK(launched.pidOf(key) == launched.pidOf("p0.txt"));
}

TEST_CASE(
    "a robot makes its key at its first start, keeps it, and drives without one only if told") {
  const Launched robot({"good"}, TREAD_STAND_IN, "");
  const std::string key = (robot.run() / "key").string();
  // If the host refuses the robot's network nothing starts, and there is nothing to test.
  const CommandOutcome check = call(robot, {"--check"});
  if (check.code != 0) {
    CHECK_THAT(check.output, Contains("multicast"));
    return;
  }
  CHECK_FALSE(std::filesystem::exists(key));
  std::string first;
  for (const bool again : {false, true}) {
    Process launch("tread-launch", robot.arguments(), robot.output());
    REQUIRE(robot.says(again ? "fingerprint" : "trial: key " + key + " (made now), fingerprint "));
    REQUIRE(robot.says("trial: all 2 processes run after"));
    CHECK(within(10, [&] {
      return contentOf(robot.run() / "log/p0.log").find("--key " + key) != std::string::npos;
    }));
    CHECK_THAT(robot.said(), Contains(":" + key + " tread.key && export TREAD_KEY="));
    const std::string fingerprint = tread::fingerprint(tread::readKey(key));
    CHECK_THAT(robot.said(), Contains(fingerprint));
    if (again) CHECK(fingerprint == first);
    if (again) CHECK_THAT(robot.said(), !Contains("made now"));
    first = fingerprint;
    launch.signal(SIGINT);
    REQUIRE(launch.waitFor(10));
    std::filesystem::remove(robot.output());
    std::filesystem::remove(robot.run() / "log/p0.log");
  }
  std::filesystem::permissions(key, std::filesystem::perms(0644));
  CHECK_THAT(call(robot, {}).output, Contains("(mode 0644); fix: chmod 600 " + key));
  std::filesystem::permissions(key, std::filesystem::perms(0600));
  std::filesystem::resize_file(key, std::filesystem::file_size(key) / 2);
  const CommandOutcome part = call(robot, {});
  CHECK(part.code == 1);
  CHECK_THAT(part.output, Contains("trial: key " + key + ": holds no key") &&
                              Contains("remove it, then make one with tread-key new " + key));

  const Launched open({"good"}, TREAD_STAND_IN, "key: none\n");
  CHECK_THAT(call(open, {"--check"}).output,
             Contains("trial: advice: without a key every program of this host can arm"));
  CHECK_FALSE(std::filesystem::exists(open.run() / "key"));
}

TEST_CASE("processes that systemd starts at the same time make one key") {
  const Launched robot({"good", "good", "good", "good"}, TREAD_STAND_IN, "");
  const std::string key = (robot.run() / "key").string();
  std::vector<std::unique_ptr<Process>> units;
  for (int i = 0; i < 4; ++i)
    units.push_back(std::make_unique<Process>(
        "tread-launch", robot.arguments({"--only", "p" + std::to_string(i)}), robot.output()));
  REQUIRE(within(10, [&] { return robot.pids().size() == 4; }));
  REQUIRE(within(10, [&] {
    const std::string said = robot.said();
    size_t with_key = 0;
    for (size_t at = 0; (at = said.find("--key " + key, at)) != std::string::npos; ++at) ++with_key;
    return with_key == 4;
  }));
  CHECK(tread::fingerprint(tread::readKey(key)).size() == 19);
}

TEST_CASE("a second launch in the same folder is refused with one line, and the first goes on") {
  const Launched launched({"good"}, TREAD_STAND_IN);
  Process launch("tread-launch", launched.arguments(), launched.output());
  REQUIRE(launched.says("processes run after"));
  const CommandOutcome second = call(launched, {});
  CHECK(second.code == 1);
  CHECK_THAT(second.output, Contains("trial: runs already in " + launched.run().string()));
  CHECK(withoutAdvice(second.output).size() == 1);
  const CommandOutcome status = call(launched, {"--status"});
  CHECK(status.code == 0);
  CHECK_THAT(status.output, Contains("p0") && Contains("RUNNING"));
  const CommandOutcome stop = call(launched, {"--stop"});
  CHECK(stop.code == 0);
  CHECK_THAT(stop.output, Contains("trial: stopped after"));
  CHECK(launch.waitFor(5));
  CHECK(call(launched, {"--status"}).code == 3);
  CHECK_THAT(call(launched, {"--stop"}).output, Contains("nothing runs"));
}

TEST_CASE("the status tells which process is not well, and why") {
  const Launched launched({"good"}, TREAD_STAND_IN);
  Process launch("tread-launch", launched.arguments(), launched.output());
  REQUIRE(launched.says("processes run after"));
  const std::string logger = std::string(TREAD_BIN_DIR) + "/tread-logger";
  std::string url = contentOf(launched.folder / "trial.yaml");
  url = url.substr(url.find("lcm_url: ") + 9);
  url = url.substr(0, url.find('\n'));
  // A recorder whose file cannot grow loses messages: see its own HEALTH.
  Process recorder("/bin/sh", {"-c", "ulimit -f 1; exec \"$0\" \"$@\"", logger,
                               (launched.folder / "x.lcmlog").string(), "--lcm-url", url});
  CHECK(within(20.0, [&] {
    const CommandOutcome status = call(launched, {"--status"});
    return status.output.find("messages are lost") != std::string::npos &&
           status.output.find("p0") != std::string::npos;
  }));
}

TEST_CASE("two runs in one folder, one after another") {
  const Launched launched({"good"}, TREAD_STAND_IN);
  for (int i = 0; i < 2; ++i) {
    std::filesystem::remove(launched.output());
    Process launch("tread-launch", launched.arguments(), launched.output());
    REQUIRE(launched.says("trial: all 2 processes run after"));
    launch.signal(SIGTERM);
    REQUIRE(launch.waitFor(10));
    CHECK(launch.exitCode() == 0);
    CHECK(launched.pids().empty());
  }
}

TEST_CASE("under nohup all goes on when the terminal closes") {
  const Launched launched({"good"}, TREAD_STAND_IN);
  std::vector<std::string> words{"-c", "trap '' HUP; exec \"$0\" \"$@\"",
                                 std::string(TREAD_BIN_DIR) + "/tread-launch"};
  for (const std::string& word : launched.arguments()) words.push_back(word);
  Process launch("/bin/sh", words, launched.output());
  REQUIRE(launched.says("processes run after"));
  launch.signal(SIGHUP);
  CHECK_FALSE(launched.says("stopping", 0.5));
  CHECK(launch.running());
  launch.signal(SIGINT);
  REQUIRE(launch.waitFor(10));
  CHECK(launch.exitCode() == 0);
}

TEST_CASE("a process that ends at once is tried again, told twice, and does not stop the others") {
  const Launched launched({"good", "brief"}, TREAD_STAND_IN);
  Process launch("tread-launch", launched.arguments(), launched.output());
  CHECK(launched.says("trial: p1 ended (exit status 4; not expected)"));
  CHECK(launched.says("trial: p1 ended again (exit status 4; not expected)"));
  CHECK(launched.pidOf("p0.txt") > 0);
  launch.signal(SIGTERM);
  CHECK(launch.waitFor(10));
}

TEST_CASE("start-up checks name what is wrong and nothing is started") {
  const Launched launched({"wrong"}, TREAD_STAND_IN);
  const CommandOutcome check = call(launched, {"--check"});
  CHECK(check.code == 1);
  CHECK_THAT(check.output, Contains("trial: p0: planner.yaml:3: lease is 9 s; allowed 0.05..1 s; "
                                    "fix: edit " +
                                    launched.folder.string() + "/p0.txt"));
  CHECK(call(launched, {}).code == 1);
  CHECK_FALSE(std::filesystem::exists(launched.run()));
  std::filesystem::remove(launched.folder / "p0.txt");
  CHECK_THAT(call(launched, {"--check"}).output, Contains("p0.txt cannot be read"));
  std::ofstream(launched.folder / "p0.txt") << "good";
  CHECK(call(launched, {"--no-such-option"}).code == 2);
  const CommandOutcome good = call(launched, {"--check"});
  CHECK(good.code == 0);
  CHECK_THAT(good.output, Contains("trial: ready to start"));
}

TEST_CASE(
    "a machine that keeps a process waiting does not keep real time, and its status says so") {
  const std::string file = TREAD_SOURCE_DIR "/config/launch/simulated.yaml";
  const std::string words =
      fs::temp_directory_path() / ("tread_timing_" + std::to_string(getpid()));
  fs::remove(words);
  Process halted("tread-launch", {file, "--timing", "60"}, words);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  halted.signal(SIGSTOP);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  halted.signal(SIGCONT);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  halted.signal(SIGTERM);
  REQUIRE(halted.waitFor(10.0));
  INFO(contentOf(words));
  CHECK(halted.exitCode() == 3);
  CHECK_THAT(contentOf(words), Catch::Contains("does not keep real time"));
  Process left_alone("tread-launch", {file, "--timing", "0.2", "--longest", "10000"}, words);
  REQUIRE(left_alone.waitFor(10.0));
  CHECK(left_alone.exitCode() == 0);
  fs::remove(words);
}

TEST_CASE("one process alone can be started for systemd") {
  const Launched launched({"good", "good"}, TREAD_STAND_IN);
  Process launch("tread-launch", launched.arguments({"--only", "p1"}), launched.output());
  CHECK(launched.says("runs as"));
  CHECK(launched.pids().size() == 1);
  CHECK(launched.pidOf("p1.txt") > 0);
  launch.signal(SIGINT);
  REQUIRE(launch.waitFor(5));
  CHECK(launch.exitCode() == 0);
  CHECK_THAT(call(launched, {"--only", "p7"}).output, Contains("has no process 'p7'"));
}
