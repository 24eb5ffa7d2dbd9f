// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <atomic>
#include <cstdio>
#include <iostream>
#include <thread>

#include <CLI/CLI.hpp>
#include <lcm/lcm-cpp.hpp>

#include "common/bus/host_clock.hpp"
#include "tests/system/robot_run.hpp"
#include "tests/system/worlds.hpp"
#include "tools/robot/report/drive_report.hpp"

namespace {

using namespace tread;
using namespace tread::testing;

/// Receives the whole bus like a logger, and measures LCM itself with its own MARK messages.
class Listener {
 public:
  explicit Listener(const std::string& url) : hears_(url), speaks_(url) {
    hears_.subscribe(".*", &Listener::handle, this);
    thread_ = std::thread([this] {
      int64_t next = hostNow();
      while (!stop_) {
        hears_.handleTimeout(10);
        if (hostNow() < next) continue;
        next = hostNow() + 20'000;
        speak();
      }
    });
  }
  ~Listener() { end(); }
  void end() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }

  const report::Latencies& latencies() const { return latencies_; }
  const report::Durations& lcm() const { return lcm_; }

 private:
  void speak() {
    mark_t mark{};
    mark.seq = ++marks_;
    mark.utime = hostNow();
    speaks_.publish("MARK", &mark);
    hears_.handleTimeout(5);
  }
  void handle(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
    LogEvent event;
    event.utime = hostNow();
    event.channel = channel;
    const auto* bytes = static_cast<const uint8_t*>(buffer->data);
    event.bytes.assign(bytes, bytes + buffer->data_size);
    mark_t mark;
    if (decode(event, kMark, mark))
      lcm_.add(static_cast<double>(event.utime - mark.utime) * 1e-3);
    else
      latencies_.add(event);
  }

  lcm::LCM hears_;
  lcm::LCM speaks_;
  report::Latencies latencies_;
  report::Durations lcm_;
  int64_t marks_ = 0;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

void print(const char* name, const report::Durations& durations) {
  std::printf("%-26s p50 %9.3f ms  p99 %9.3f ms  of %zu\n", name, durations.quantile(0.5),
              durations.quantile(0.99), durations.count());
}

void measure(double seconds) {
  RobotRun run(kField, "[-20, 0, 0]");
  run.startAll();
  run.setGoal(30.0, 0.0);
  if (!run.arm(20.0)) throw std::runtime_error("the robot cannot be armed");
  Listener listener(run.url());
  double side = 1.0;
  run.until(seconds, [&] {
    if (run.plan().message().plan_status == plan_t::PLAN_ARRIVED)
      run.setGoal(30.0 * (side = -side), 0.0);
    if (run.motor().message().bridge_state == motor_t::STATE_DISARMED) run.arm(5.0);
    return false;
  });
  listener.end();
  print("LCM, publish to handler", listener.lcm());
  print("INS to learner's set", listener.latencies().insToSet());
  print("set to plan", listener.latencies().setToPlan());
  print("scan to tile", listener.latencies().scanToTile());
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Measures delays of messages in the driving robot, and LCM's own latency.",
               "bench-latency"};
  double seconds = 60.0;
  app.add_option("--seconds", seconds, "duration of the drive")->check(CLI::Range(5.0, 3600.0));
  CLI11_PARSE(app, argc, argv);
  try {
    measure(seconds);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "bench-latency: " << error.what() << std::endl;
    return 1;
  }
}
