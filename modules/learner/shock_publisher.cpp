// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/shock_publisher.hpp"

#include <cmath>
#include <sstream>

#include "common/messages/blank.hpp"
#include "common/messages/ins_messages.hpp"

namespace tread::learner {
namespace {

constexpr const char* kEntry = "learner_shock";
constexpr int64_t kPeriod = 1'000'000;  // [us]
/// Not every pair justifies a write.
constexpr int kPairsBetweenWrites = 10;

}  // namespace

ShockPublisher::ShockPublisher(double front, Bus& bus, Store& store, HealthReporter& health)
    : bus_(bus), store_(store), health_(health), learner_(front) {
  if (const auto known = recall()) learner_.resume(*known);
  saved_pairs_ = learner_.pairs();
  bus_.subscribe<map_tile_t>(kMap, [this](const map_tile_t& tile) {
    if (!learner_.takeTile({tile.tile_x, tile.tile_y, tile.utime, tile.cells}, tile.cell_size,
                           tile.tile_cells))
      health_.addToCounter("MAP refused: invalid sizes");
  });
}

void ShockPublisher::take(const ins_t& ins) {
  constexpr int kBroken = ins_t::STATUS_JUMP | ins_t::STATUS_NO_ATTITUDE;
  const auto T_map_body = spatialPose(ins);
  if ((ins.ins_status & ins_t::STATUS_JUMP) != 0) learner_.restart();
  if (!T_map_body || (ins.ins_status & kBroken) != 0) return;
  const Eigen::RowVector3d up = T_map_body->linear().row(2);
  BodyMotion motion{ins.utime, T_map_body->translation().head<2>(), up[0], ins.velocity[0], 0.0};
  // A component that the device does not measure is 0: a vehicle moves in its own plane.
  const double own_up = std::isfinite(ins.velocity[2]) ? ins.velocity[2] : 0.0;
  motion.climb = up.dot(Eigen::RowVector3d(ins.velocity[0], ins.velocity[1], own_up));
  if (const auto felt = learner_.take(motion)) felt_ = *felt;
}

void ShockPublisher::step(int64_t utime) {
  if (utime < next_) return;
  next_ = utime + kPeriod;
  auto message = blank<shock_t>();
  message.utime = felt_.utime;
  message.seq = seq_++;
  const ShockModel model = learner_.model();
  int at = 0;
  for (int i = 0; i < 3; ++i) {
    message.shock_weights[i] = model.mean[i];
    for (int j = i; j < 3; ++j) message.shock_covariance[at++] = model.covariance(i, j);
  }
  message.shock_variance = model.variance;
  message.shock_pairs = learner_.pairs();
  message.here_shock = learner_.here();
  if (felt_.utime > 0) {
    message.felt_shock = felt_.shock;
    message.felt_peak = felt_.peak;
    message.felt_pitch_rate = felt_.pitch_rate;
    message.felt_speed = felt_.speed;
  }
  bus_.publish(kShock, message);
  save();
  health_.setCounter("segments that shock was learned from", learner_.pairs());
}

std::optional<ShockRegression> ShockPublisher::recall() const {
  std::istringstream in(store_.read(kEntry).value_or(""));
  std::vector<double> numbers;
  for (double number = 0.0; in >> number;) numbers.push_back(number);
  return ShockRegression::fromState(numbers);
}

void ShockPublisher::save() {
  if (learner_.pairs() < saved_pairs_ + kPairsBetweenWrites) return;
  saved_pairs_ = learner_.pairs();
  std::ostringstream out;
  out.precision(17);
  for (const double number : learner_.regression().state()) out << number << '\n';
  if (store_.write(kEntry, out.str())) health_.addToCounter("states not written");
}

}  // namespace tread::learner
