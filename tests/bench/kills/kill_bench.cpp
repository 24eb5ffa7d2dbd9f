// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <random>

#include <CLI/CLI.hpp>

#include "tests/system/robot_run.hpp"
#include "tests/system/two_hosts.hpp"
#include "tests/system/worlds.hpp"
#include "tools/robot/launch/stall_watch.hpp"

namespace {

using namespace tread;
using namespace tread::testing;

constexpr int64_t kLease = 200'000;            // [us] of a PROGRAM
constexpr int64_t kOperatorLease = 1'000'000;  // [us]
constexpr int64_t kHold = 1'000'000;           // [us] for which the motors must stay at zero
constexpr double kBudget = 0.25;  // [s] from the end of lease or series, or from the kill

/// Instead of a signal: disconnects the operator's host.
constexpr int kCutOff = 0;

const char* toWords(int signal) {
  return signal == SIGKILL ? "killed" : signal == SIGSTOP ? "frozen" : "cut off";
}

/// Result of one kill.
struct Kill {
  std::string process;
  int signal = SIGKILL;
  double stands = -1.0;        ///< [s] from the reference to motors at zero; -1 = never
  double from_kill = -1.0;     ///< [s] the same from the kill itself
  double stall = 0.0;          ///< [s] of the machine's own stalls meanwhile
  double bridge_stall = 0.0;   ///< [s] longest time between two MOTOR messages until then
  std::string reason;          ///< reason of standing, from the bridge
  bool moved_unasked = false;  ///< before it was armed again
  bool set_lost = false;       ///< the set's version went back
};

/// A robot that drives back and forth on a field while its processes are killed.
class KillBench {
 public:
  explicit KillBench(uint64_t seed) : run_(kField, "[-20, 0, 0]", "", hosts_.url()), random_(seed) {
    run_.bus().subscribe<motor_t>(kMotor, [this](const motor_t& motor) {
      longest_gap_ = std::max(longest_gap_, seconds(last_motor_, motor.utime));
      last_motor_ = motor.utime;
    });
    run_.startAll();
    nextGoal();
  }

  Kill kill(const std::string& process, int signal) {
    Kill kill;
    kill.process = process;
    kill.signal = signal;
    driveOff();
    if (process == "operator") leave();
    const int64_t set = run_.lastSet();
    const launch::StallWatch watch;
    longest_gap_ = 0.0;
    if (signal == kCutOff)
      hosts_.plug(false);
    else
      run_.signal(process, signal);
    const int64_t killed = run_.now();
    run_.wait(0.05);  // receive its earlier messages now
    const int64_t reference = referenceOf(process, killed);
    std::optional<int64_t> zero;
    run_.until(10.0, [&] {
      run_.wait(0.2);
      zero = zeroAfter(run_.truth(), killed, kHold);
      return zero.has_value();
    });
    if (zero) {
      kill.from_kill = seconds(killed, *zero);
      kill.stands = std::max(0.0, seconds(reference, *zero));
    }
    kill.stall = watch.longest();
    kill.bridge_stall = longest_gap_;
    kill.reason = run_.motor().message().state_reason;
    run_.forgetSet();
    if (signal == kCutOff) hosts_.plug(true);
    if (process == "operator")
      run_.signal(process, SIGCONT);
    else if (signal == SIGKILL)
      run_.start(process);
    else
      run_.signal(process, SIGCONT);
    const int64_t restarted = run_.now();
    run_.wait(2.5);
    for (const sim::TruthRow& row : run_.truth())
      kill.moved_unasked |= row.utime > restarted && !row.motorsAtZero();
    run_.until(10.0, [this] { return run_.lastSet() != 0; });
    if (process == "operator") {
      run_.takeBack();
      nextGoal();
    }
    kill.set_lost = run_.lastSet() < set;
    return kill;
  }

 private:
  static double seconds(int64_t from, int64_t to) { return static_cast<double>(to - from) * 1e-6; }

  void nextGoal() {
    side_ = -side_;
    run_.setGoal(20.0 * side_, 0.0);
  }

  /// Until it has driven at speed for a while.
  void driveOff() {
    const auto fast = [this] {
      const motor_t& motor = run_.motor().message();
      if (run_.plan().message().plan_status == plan_t::PLAN_ARRIVED) nextGoal();
      if (!run_.driving() && motor.bridge_state != motor_t::STATE_ARMED) run_.arm(5.0);
      return run_.driving() && motor.command[0] > 0.3F && motor.command[1] > 0.3F;
    };
    std::uniform_real_distribution<double> more(0.2, 1.2);
    for (int i = 0; i < 20; ++i) {
      run_.until(20.0, fast);
      run_.wait(more(random_));
      if (run_.driving()) return;
    }
    throw std::runtime_error("the robot does not drive: " + run_.plan().message().reason);
  }

  /// Lets it drive with its own program.
  void leave() {
    for (int i = 0; i < 20; ++i) {
      run_.leaveTo(20.0 * side_, 1.0, hosts_.atStation());
      run_.wait(0.5);
      if (run_.driving()) return;
      run_.takeBack();
      nextGoal();
      driveOff();
    }
    throw std::runtime_error("the robot does not drive by tread-goal");
  }

  /// End of the permission that the killed process gave.
  int64_t referenceOf(const std::string& process, int64_t killed) const {
    if (process == "operator") return killed + kOperatorLease;
    if (process == "planner") return run_.program().message().utime + kLease;
    return killed;
  }

  TwoHosts hosts_;  ///< first, as the following members open sockets
  RobotRun run_;
  std::mt19937_64 random_;
  double side_ = -1.0;
  int64_t last_motor_ = 0;    ///< [us]
  double longest_gap_ = 0.0;  ///< [s]
};

void print(const std::vector<Kill>& kills) {
  constexpr double kBin = 0.025;
  std::printf(
      "motors at zero after the end of the lease (planner, operator) or the kill (the others)\n");
  for (const char* process : {"planner", "motor_bridge", "ins_driver", "operator"}) {
    std::vector<int> bins(16, 0);
    double largest = 0.0;
    int count = 0;
    for (const Kill& kill : kills) {
      if (kill.process != process) continue;
      ++count;
      largest = std::max(largest, kill.stands);
      const double bin = kill.stands < 0.0 ? 15.0 : std::min(15.0, std::floor(kill.stands / kBin));
      ++bins[static_cast<size_t>(bin)];
    }
    if (count == 0) continue;
    std::printf("\n%s: %d kills, largest %.0f ms\n", process, count, 1e3 * largest);
    for (size_t i = 0; i < bins.size(); ++i) {
      if (bins[i] == 0) continue;
      std::printf("  %3.0f..%3.0f ms %3d %s\n", 25.0 * static_cast<double>(i),
                  25.0 * static_cast<double>(i + 1), bins[i],
                  std::string(static_cast<size_t>(bins[i]), '#').c_str());
    }
  }
}

int judge(const std::vector<Kill>& kills) {
  int late = 0;
  int moved = 0;
  int lost = 0;
  for (const Kill& kill : kills) {
    late += kill.stands < 0.0 || kill.stands > kBudget ? 1 : 0;
    moved += kill.moved_unasked ? 1 : 0;
    lost += kill.set_lost ? 1 : 0;
  }
  std::printf("\n%zu kills: %d later than %.0f ms, %d moved before arming, %d sets lost\n",
              kills.size(), late, 1e3 * kBudget, moved, lost);
  return late + moved + lost == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Kills or freezes processes of the driving robot, or disconnects its operator, and measures "
      "when the motors stop.",
      "bench-kills"};
  int count = 50;
  uint64_t seed = 1;
  app.add_option("--kills", count, "how many")->check(CLI::Range(1, 10000));
  app.add_option("--seed", seed, "of the moments");
  std::string only;
  app.add_option("--only", only, "only this process: planner, motor_bridge, ins_driver, operator");
  CLI11_PARSE(app, argc, argv);
  std::vector<std::pair<std::string, int>> ways;
  for (const int signal : {SIGKILL, SIGSTOP})
    for (const char* process : {"planner", "motor_bridge", "ins_driver", "operator"})
      if (only.empty() || only == process) ways.push_back({process, signal});
  if (only.empty() || only == "operator") ways.push_back({"operator", kCutOff});
  try {
    KillBench bench(seed);
    std::vector<Kill> kills;
    for (int i = 0; i < count; ++i) {
      const auto& [process, signal] = ways[static_cast<size_t>(i) % ways.size()];
      kills.push_back(bench.kill(process, signal));
      const Kill& kill = kills.back();
      std::printf("%3d %-12s %-7s  %4.0f ms after the kill, machine's stall %.0f ms%s%s\n", i + 1,
                  process.c_str(), toWords(signal), 1e3 * kill.from_kill, 1e3 * kill.stall,
                  kill.moved_unasked ? "  MOVED UNASKED" : "", kill.set_lost ? "  SET LOST" : "");
      if (kill.stands < 0.0 || kill.stands > kBudget)
        std::printf("    late: MOTOR was silent for up to %.0f ms; %s\n", 1e3 * kill.bridge_stall,
                    kill.reason.c_str());
      std::fflush(stdout);
    }
    print(kills);
    return judge(kills);
  } catch (const std::exception& error) {
    std::cerr << "bench-kills: " << error.what() << std::endl;
    return 1;
  }
}
