// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/helpers.hpp"
#include "tests/motor_bridge/bridge_world.hpp"

using namespace tread;
using namespace tread::motor;

namespace {

constexpr int64_t kStep = 10'000;

/// A bridge among randomly failing peers, and an observer that knows only the delivered messages.
class Chaos {
 public:
  explicit Chaos(uint64_t seed) : random_(seed) {}

  void step() {
    now_ += kStep;
    disturb();
    planner();
    ins();
    operators();
    const BridgeOutput out = bridge_.step(now_, device_);
    witness(out);
    was_armed_ = isArmed(out.failsafe.state);
  }

  int64_t driven() const { return driven_; }
  int64_t stops() const { return stops_; }
  const Bridge& bridge() const { return bridge_; }

 private:
  struct Delivery {
    int64_t due;
    Program program;
  };

  bool chance(double p) { return static_cast<double>(random_() >> 11) * 0x1.0p-53 < p; }

  void disturb() {
    planner_silent_ = planner_silent_ ? !chance(0.02) : chance(0.001);
    ins_silent_ = ins_silent_ ? !chance(0.05) : chance(0.001);
    operator_silent_ = operator_silent_ ? !chance(0.005) : chance(0.0005);
    if (chance(0.0003)) {
      endless_ = EndlessPlanner(++run_id_);
      endless_.commands = 2 + static_cast<int>(random_() % 60);
    }
    std::string& link = device_.link_fault;
    link = link.empty() ? (chance(0.0005) ? "lost" : "") : (chance(0.03) ? "" : "lost");
    std::string& fault = device_.device_fault;
    fault = fault.empty() ? (chance(0.0005) ? "overheat" : "") : (chance(0.03) ? "" : "overheat");
  }

  void planner() {
    if (!planner_silent_ && now_ % 50'000 == 0) {
      Program program = endless_.plan(now_ - 1'000, newest(bridge_.executions()));
      spoil(program);
      const int copies = chance(0.05) ? 0 : chance(0.05) ? 2 : 1;
      for (int i = 0; i < copies; ++i) {
        const int64_t delay = chance(0.1) ? static_cast<int64_t>(random_() % 150'000) : 0;
        queue_.push_back({now_ + delay, program});
      }
    }
    for (size_t i = 0; i < queue_.size();) {
      if (queue_[i].due > now_) {
        ++i;
        continue;
      }
      if (queue_[i].program.utime <= now_ + 50'000)
        newest_program_ = std::max(newest_program_, queue_[i].program.utime);
      bridge_.receive(queue_[i].program, now_);
      queue_.erase(queue_.begin() + static_cast<ptrdiff_t>(i));
    }
  }

  void spoil(Program& program) {
    if (!chance(0.002)) return;
    ProgramSlot& slot = chance(0.5) ? program.running : program.next;
    switch (random_() % 7) {
      case 0:
        slot.series[0][0] = std::numeric_limits<double>::quiet_NaN();
        break;
      case 1:
        slot.series[0][1] = 1e9;
        break;
      case 2:
        slot.kinds = kindsOf(trackChannels(CommandKind::kTrackSpeed));
        break;
      case 3:
        program.running = ProgramSlot{};
        break;
      case 4:
        program.next = ProgramSlot{};
        break;
      case 5:
        program.utime += static_cast<int64_t>(random_() % 10'000'000) - 5'000'000;
        break;
      default:
        slot.period_us = 1;
        break;
    }
  }

  void ins() {
    if (!ins_silent_ && now_ % 20'000 == 0) {
      bridge_.receive(InsNotice{now_ - 8'000, true}, now_);
      newest_ins_ = now_;
    }
  }

  void operators() {
    armed_request_ = false;
    if (now_ % 200'000 == 0 && !operator_silent_) {
      const int64_t seen = now_ - static_cast<int64_t>(random_() % 300'000);
      newest_seen_ = std::max(newest_seen_, seen);
      bridge_.receive(OperatorNotice{1, "operator", true, seen, 0, ""}, now_);
    }
    if (chance(0.01)) {
      bridge_.receive(ArmRequest{now_, true, "operator", "go"}, now_);
      armed_request_ = true;
    }
    if (chance(0.0003)) {
      bridge_.receive(EstopRequest{now_, true, "anyone", "test"}, now_);
      estop_ = true;
    } else if (estop_ && chance(0.01)) {
      bridge_.receive(EstopRequest{now_, false, "operator", "clear"}, now_);
      estop_ = false;
    }
  }

  void witness(const BridgeOutput& out) {
    const bool zero = isZero(out.command);
    const bool fault = !device_.link_fault.empty() || !device_.device_fault.empty();
    const bool lease = now_ - newest_program_ <= 200'000;
    const bool ins = now_ - newest_ins_ <= 100'000;
    const bool leased = now_ - newest_seen_ <= 1'000'000;
    REQUIRE((zero || (was_armed_ && !estop_ && !fault && lease && ins && leased)));
    REQUIRE((was_armed_ || !isArmed(out.failsafe.state) || (armed_request_ && zero)));
    REQUIRE((zero || out.execution_id > 0));
    REQUIRE((out.command == last_.command || out.send));
    REQUIRE((out.execution_id == 0 || last_.execution_id == 0 ||
             out.execution_id >= last_.execution_id));
    driven_ += zero ? 0 : kStep;
    stops_ += zero && !isZero(last_.command);
    last_ = out;
  }

  std::mt19937_64 random_;
  Bridge bridge_{BridgeConfig{}};
  DeviceReport device_;
  int64_t run_id_ = 1;
  EndlessPlanner endless_{1};
  std::vector<Delivery> queue_;
  int64_t now_ = 10'000'000;
  int64_t newest_program_ = 0;
  int64_t newest_ins_ = 0;
  bool planner_silent_ = false;
  bool ins_silent_ = false;
  bool operator_silent_ = false;
  int64_t newest_seen_ = 0;
  bool estop_ = false;
  bool was_armed_ = false;
  bool armed_request_ = false;
  BridgeOutput last_;
  int64_t driven_ = 0;
  int64_t stops_ = 0;
};

}  // namespace

TEST_CASE(
    "ten hours among failing peers: it never moves without every condition, and moves again") {
  for (int seed = 1; seed <= testing::effort(10); ++seed) {
    Chaos chaos(static_cast<uint64_t>(seed));
    for (int i = 0; i < 360'000; ++i) chaos.step();
    CHECK(chaos.driven() > 360'000'000);
    CHECK(chaos.stops() > 100);
  }
}
