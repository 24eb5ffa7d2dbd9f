// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>

#include <Eigen/Geometry>

#include "common/messages/blank.hpp"
#include "tests/learner/bench.hpp"

using namespace tread;
using namespace tread::learner;
using namespace tread::learner::samples;

namespace {

/// Drives along x at 0.8 m/s over waves of 1.2 m, and publishes what mapping would see of them.
class BumpyDrive : public Node {
 public:
  explicit BumpyDrive(Bus& bus) : bus_(bus) {}
  int64_t period() const override { return 20'000; }
  void step(int64_t utime) override {
    const double seconds = 1e-6 * static_cast<double>(utime - start_);
    if (start_ == 0) start_ = utime;
    const double x = start_ == utime ? 0.0 : 0.8 * seconds;
    const double k = 2.0 * kPi / 1.2;
    const double rise = 0.01 * k * std::cos(k * x);
    auto ins = blank<ins_t>();
    ins.utime = utime;
    ins.seq = seq_++;
    ins.ins_status = 0;
    const Eigen::Quaterniond q(Eigen::AngleAxisd(-std::asin(rise), Eigen::Vector3d::UnitY()));
    const double orientation[] = {q.w(), q.x(), q.y(), q.z()};
    std::copy_n(orientation, 4, ins.orientation);
    ins.position[0] = x;
    ins.position[1] = 0.0;
    ins.position[2] = 0.01 * std::sin(k * x);
    ins.velocity[0] = 0.8;
    ins.velocity[1] = 0.0;
    ins.rate[2] = 0.0;
    bus_.publish(kIns, ins);
    if (utime % 200'000 == 0) sendTile(static_cast<int>((x + 4.0) / 3.2), utime);
  }

 private:
  void sendTile(int x, int64_t utime) {
    auto tile = blank<map_tile_t>();
    tile.utime = utime;
    tile.tile_x = x;
    tile.tile_cells = 32;
    tile.cell_size = 0.1;
    tile.num_cells = 32 * 32;
    tile.cells.assign(32 * 32, 7);
    bus_.publish(kMap, tile);
  }

  Bus& bus_;
  int64_t start_ = 0;
  int64_t seq_ = 0;
};

std::vector<shock_t> shocksOf(bool learn, MemoryStore& store) {
  VirtualBus bus(1);
  LearnerNodeConfig config(smallSet());
  config.shock = learn;
  config.front = 0.65;
  std::vector<shock_t> said;
  bus.outside().subscribe<shock_t>(kShock, [&](const shock_t& m) { said.push_back(m); });
  bus.addNode("learner",
              [&](Bus& end) { return std::make_unique<LearnerNode>(config, end, store); });
  bus.addNode("robot", [&](Bus& end) { return std::make_unique<BumpyDrive>(end); });
  bus.runUntil(bus.now() + 60'000'000);
  return said;
}

}  // namespace

TEST_CASE("the learner publishes what the ground's looks mean, learned from INS and MAP") {
  MemoryStore store;
  const std::vector<shock_t> said = shocksOf(true, store);
  REQUIRE(said.size() >= 55);
  CHECK(said.front().shock_pairs == 0);
  CHECK(std::isnan(said.front().here_shock));
  const shock_t& last = said.back();
  CHECK(last.shock_pairs > 30);
  CHECK(last.felt_speed == Approx(0.8).epsilon(0.02));
  CHECK(last.shock_covariance[0] < 0.3 * said.front().shock_covariance[0]);
  const double expected = std::exp(last.shock_weights[0] + last.shock_weights[1] * std::log(0.7) +
                                   last.shock_weights[2] * std::log(0.8));
  CHECK(expected == Approx(last.felt_shock).epsilon(0.2));
}

TEST_CASE("a learner that is not told to learn shock says nothing of it") {
  MemoryStore store;
  CHECK(shocksOf(false, store).empty());
}

TEST_CASE("what was learned of shock survives a restart, and a damaged entry counts for nothing") {
  MemoryStore store;
  const std::vector<shock_t> first = shocksOf(true, store);
  const std::vector<shock_t> second = shocksOf(true, store);
  CHECK(second.front().shock_pairs > 20);
  CHECK(second.front().shock_pairs <= first.back().shock_pairs);
  CHECK(second.front().shock_weights[0] == Approx(first.back().shock_weights[0]).margin(0.1));
  REQUIRE_FALSE(store.write("learner_shock", "1 2 half a line"));
  CHECK(shocksOf(true, store).front().shock_pairs == 0);
}
