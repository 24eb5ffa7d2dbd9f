// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <vector>

#include <CLI/CLI.hpp>

#include "common/seal/key_file.hpp"
#include "tests/bench/attacks/attacker.hpp"
#include "tests/system/robot_run.hpp"
#include "tests/system/worlds.hpp"

namespace {

using namespace tread;
using namespace tread::testing;

/// A key for this run only.
struct Key {
  Key() : path("/tmp/tread_attack_" + std::to_string(getpid()) + ".key") { writeNewKey(path); }
  ~Key() { std::filesystem::remove(path); }
  Key(const Key&) = delete;
  Key& operator=(const Key&) = delete;
  const std::string path;
};

/// Statistics of motor-bridge messages.
struct Period {
  double median = 0.0;  ///< [ms] between two MOTOR messages, by their time stamps
  double p99 = 0.0;     ///< [ms]
  double longest = 0.0;
  double step = 0.0;  ///< [ms] longest step of the bridge
};

class AttackBench {
 public:
  AttackBench(double rate, double seconds, uint64_t seed)
      : run_(kField, "[-20, 0, 0]", key_.path),
        attacker_(run_.url(), rate, seed),
        seconds_(seconds) {
    run_.bus().subscribe<motor_t>(kMotor, [this](const motor_t& motor) { note(motor); });
    run_.startAll();
  }

  int measure(int stops) {
    print("driving, undisturbed", drive());
    stop();
    attacker_.attack(true);
    mustStand("E-stopped under attack", motor_t::STATE_ESTOP);
    attacker_.attack(false);
    call({"--clear"});
    attacker_.attack(true);
    mustStand("disarmed under attack", motor_t::STATE_DISARMED);
    print("driving under attack", drive());
    double longest = 0.0;
    int moving = 0;
    for (int i = 0; i < stops; ++i) {
      drive(2.0);
      if (!run_.driving()) {
        std::printf("  before tread-stop %d it stands: %s; %s\n", i + 1,
                    run_.motor().message().state_reason.c_str(),
                    run_.plan().message().reason.c_str());
      }
      moving += run_.driving() ? 1 : 0;
      const double zero = stop();
      longest = std::max(longest, zero);
      if (zero < 0.0) ++broken_;
      std::printf("  tread-stop %d: motors at zero %.0f ms after its start\n", i + 1, 1e3 * zero);
      std::fflush(stdout);
      attacker_.attack(false);
      call({"--clear"});
      attacker_.attack(true);
    }
    std::printf("%d stops under attack, %d of them while it drove, longest %.0f ms\n", stops,
                moving, 1e3 * longest);
    attacker_.attack(false);
    return conclude();
  }

 private:
  void note(const motor_t& motor) {
    if (last_ > 0) intervals_.push_back(1e-3 * static_cast<double>(motor.utime - last_));
    last_ = motor.utime;
    const auto planner = run_.health().find("planner");
    if (motor.motor_run_id == 0 || planner == run_.health().end()) return;
    foreign_ += motor.motor_run_id != planner->second.boot_id;
  }

  /// Drives back and forth for `seconds`; arms again after a stall of the machine.
  Period drive(double seconds = 0.0) {
    run_.setGoal(side_ * 20.0, 0.0);
    const int again = run_.armedAgain();
    run_.untilDriving(30.0, [this] { return run_.driving(); });
    intervals_.clear();
    double step = 0.0;
    const double whole = seconds > 0.0 ? seconds : seconds_;
    const int64_t end = run_.now() + static_cast<int64_t>(1e6 * whole);
    while (run_.now() < end)
      run_.untilDriving(0.3, [&] {
        if (run_.plan().message().plan_status == plan_t::PLAN_ARRIVED)
          run_.setGoal((side_ = -side_) * 20.0, 0.0);
        const auto bridge = run_.health().find("motor_bridge");
        if (bridge != run_.health().end()) step = std::max(step, 1e-3 * bridge->second.cycle_max);
        return run_.now() >= end;
      });
    if (seconds == 0.0) std::printf("armed %d times more; ", run_.armedAgain() - again);
    return period(step);
  }

  Period period(double step) {
    Period period;
    period.step = step;
    if (intervals_.empty()) return period;
    std::sort(intervals_.begin(), intervals_.end());
    period.median = intervals_[intervals_.size() / 2];
    period.p99 = intervals_[intervals_.size() * 99 / 100];
    period.longest = intervals_.back();
    return period;
  }

  static void print(const char* what, const Period& period) {
    std::printf(
        "%s: MOTOR every %.1f ms (p99 %.1f, longest %.1f), longest step of the bridge %.1f ms\n",
        what, period.median, period.p99, period.longest, period.step);
    std::fflush(stdout);
  }

  bool call(const std::vector<std::string>& more) {
    std::vector<std::string> words{"--lcm-url", run_.url(), "--key", key_.path};
    words.insert(words.end(), more.begin(), more.end());
    Process stop("tread-stop", words, run_.folder() + "/stop.log");
    run_.until(10.0, [&] { return !stop.running(); });
    return stop.waitFor(0.0) && stop.exitCode() == 0;
  }

  /// Runs tread-stop; seconds until the motors are at zero, -1 = never.
  double stop() {
    const int64_t called = run_.now();
    if (!call({})) std::printf("  tread-stop has no answer\n");
    std::optional<int64_t> zero;
    run_.until(5.0, [&] {
      run_.wait(0.2);
      zero = zeroAfter(run_.truth(), called, 1'000'000);
      return zero.has_value();
    });
    return zero ? 1e-6 * static_cast<double>(*zero - called) : -1.0;
  }

  /// Nothing may move, although the operator's program runs and repeats its goal.
  void mustStand(const char* what, int16_t state) {
    run_.wait(1.0);
    const int64_t from = run_.now();
    const int64_t sent = attacker_.sent();
    run_.wait(seconds_);
    int moved = 0;
    for (const sim::TruthRow& row : run_.truth()) moved += row.utime > from && !row.motorsAtZero();
    broken_ += moved > 0 || run_.motor().message().bridge_state != state ? 1 : 0;
    const double passed = 1e-6 * static_cast<double>(run_.now() - from);
    std::printf("%s: %.0f messages/s, state %d, motors %s\n", what,
                static_cast<double>(attacker_.sent() - sent) / passed,
                run_.motor().message().bridge_state, moved > 0 ? "MOVED" : "at zero");
    std::fflush(stdout);
  }

  int conclude() {
    run_.wait(2.0);
    for (const std::string& name : RobotRun::names()) {
      const bool runs = run_.running(name);
      broken_ += runs ? 0 : 1;
      int64_t refused = 0;
      for (const counter_t& counter : run_.health().at(name).counters)
        if (counter.counter_name.rfind("refused: ", 0) == 0) refused += counter.counted;
      std::printf("%-13s %s, %lld refused, %lld failed to be read\n", name.c_str(),
                  runs ? "runs" : "HAS ENDED", static_cast<long long>(refused),
                  static_cast<long long>(run_.health().at(name).undecodable));
    }
    std::printf(
        "%lld messages sent, %lld MOTOR of a planner that is not ours, %d promises broken\n",
        static_cast<long long>(attacker_.sent()), static_cast<long long>(foreign_), broken_);
    return broken_ == 0 && foreign_ == 0 ? 0 : 1;
  }

  Key key_;
  RobotRun run_;
  Attacker attacker_;
  double seconds_;
  double side_ = 1.0;
  int64_t last_ = 0;
  std::vector<double> intervals_;  ///< [ms]
  int64_t foreign_ = 0;
  int broken_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Sends forged, changed and repeated messages to a robot with a key: at rest, driving, and "
      "while it is stopped.",
      "bench-attacks"};
  double rate = 10'000.0;
  double seconds = 15.0;
  int stops = 5;
  uint64_t seed = 1;
  app.add_option("--rate", rate, "messages/s")->check(CLI::Range(1.0, 1e6));
  app.add_option("--seconds", seconds, "of each part")->check(CLI::Range(1.0, 3600.0));
  app.add_option("--stops", stops, "by tread-stop under attack")->check(CLI::Range(0, 1000));
  app.add_option("--seed", seed, "of the messages");
  CLI11_PARSE(app, argc, argv);
  try {
    return AttackBench(rate, seconds, seed).measure(stops);
  } catch (const std::exception& error) {
    std::cerr << "bench-attacks: " << error.what() << std::endl;
    return 1;
  }
}
