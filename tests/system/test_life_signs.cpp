// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The signs of life that each real program sends to systemd or another parent.
#include <algorithm>
#include <csignal>
#include <functional>
#include <memory>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/system/robot_run.hpp"
#include "tests/system/starter.hpp"
#include "tests/system/worlds.hpp"

namespace tread::testing {
namespace {

/// A program with its life signs, on its own bus.
struct Life {
  std::string name;
  Process& process;
  int beats = 0;  ///< at the last check
};

/// Checks programs in parallel; `pass_a_moment` lets some 50 ms pass.
class Lives {
 public:
  Lives(Starter& starter, std::vector<Life> lives, std::function<void()> pass_a_moment)
      : starter_(starter), lives_(std::move(lives)), pass_a_moment_(std::move(pass_a_moment)) {}

  void check() {
    for (int i = 0; i < 200 && !allReady(); ++i) pass(0.05);
    forEach([&](Life& life) { REQUIRE(count(life, "READY=1") == 1); });
    pass(2.0);
    forEach([&](Life& life) {
      const int in_two_seconds = newBeats(life);
      CHECK(in_two_seconds >= 4);
      CHECK(in_two_seconds <= 12);
      CHECK(count(life, "READY=1") == 1);
      CHECK(count(life, "STATUS=") >= 1);
      CHECK(starter_.longestSilence(life.process.pid()) < 1.0);
      life.process.signal(SIGSTOP);
    });
    pass(0.2);
    forEach([&](Life& life) { newBeats(life); });
    pass(1.0);
    forEach([&](Life& life) {
      CHECK(newBeats(life) == 0);
      life.process.signal(SIGCONT);
    });
    pass(0.7);
    forEach([&](Life& life) {
      CHECK(newBeats(life) > 0);
      CHECK(count(life, "STOPPING=1") == 0);
      life.process.signal(SIGINT);
    });
    for (int i = 0; i < 100 && anyRuns(); ++i) pass(0.05);
    forEach([&](Life& life) {
      CHECK_FALSE(life.process.running());
      CHECK(life.process.exitCode() == 0);
      CHECK(count(life, "STOPPING=1") == 1);
    });
  }

 private:
  int count(const Life& life, const std::string& start) {
    return starter_.count(life.process.pid(), start);
  }
  int newBeats(Life& life) {
    const int before = life.beats;
    life.beats = count(life, "WATCHDOG=1");
    return life.beats - before;
  }
  bool allReady() {
    const bool ready = std::all_of(lives_.begin(), lives_.end(),
                                   [&](const Life& life) { return count(life, "READY=1") > 0; });
    if (ready) forEach([&](Life& life) { newBeats(life); });
    return ready;
  }
  bool anyRuns() {
    return std::any_of(lives_.begin(), lives_.end(),
                       [](const Life& life) { return life.process.running(); });
  }
  void forEach(const std::function<void(Life& life)>& look) {
    for (Life& life : lives_) {
      INFO(life.name);
      look(life);
    }
  }
  void pass(double seconds) {
    const int64_t end = hostNow() + static_cast<int64_t>(seconds * 1e6);
    while (hostNow() < end) {
      pass_a_moment_();
      starter_.count(0, "");  // its queue holds ten
    }
  }

  Starter& starter_;
  std::vector<Life> lives_;
  std::function<void()> pass_a_moment_;
};

}  // namespace

TEST_CASE(
    "each process, and the logger, tells its starter when it is ready, that it lives, how it is, "
    "and its end") {
  Starter starter;
  std::vector<std::unique_ptr<RobotRun>> runs;
  std::vector<Life> lives;
  for (const std::string& name : RobotRun::names()) {
    runs.push_back(std::make_unique<RobotRun>(kYard, "[-6, 0, 0]"));
    runs.back()->start(name);
    lives.push_back({name, runs.back()->process(name)});
  }
  const std::string folder = runs.front()->folder() + "/log";
  Process logger("tread-logger", {folder + "/x.lcmlog", "--lcm-url", ownLcmUrl()});
  lives.push_back({"logger", logger});
  Lives(starter, std::move(lives), [&] {
    for (const auto& run : runs) run->wait(0.005);
  }).check();
}

TEST_CASE("a process that cannot start never says that it is ready") {
  Starter starter;
  Process bridge("tread-motor-bridge", {"--lcm-url", "tcpq://127.0.0.1:9"});
  REQUIRE(bridge.waitFor(10.0));
  CHECK(bridge.exitCode() == 1);
  CHECK(starter.count(bridge.pid(), "") == 0);
}

}  // namespace tread::testing
