// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>

#include "common/bus/bus.hpp"
#include "common/bus/channels.hpp"
#include "common/store/store.hpp"
#include "modules/learner/core/shock_learner.hpp"

namespace tread::learner {

/// Learns from INS and MAP how strongly ground shakes the robot, publishes it as SHOCK once a
/// second and keeps it in the store (entry learner_shock). Its node passes it INS and time.
class ShockPublisher {
 public:
  /// `front` [m] from the body origin to the front end, where shock is measured. Continues from the
  /// store's content.
  ShockPublisher(double front, Bus& bus, Store& store, HealthReporter& health);

  void take(const ins_t& ins);
  void step(int64_t utime);

 private:
  std::optional<ShockRegression> recall() const;
  void save();

  Bus& bus_;
  Store& store_;
  HealthReporter& health_;
  ShockLearner learner_;
  FeltSegment felt_;  ///< newest
  int64_t seq_ = 0;
  int64_t next_ = 0;  ///< [us]
  int saved_pairs_ = 0;
};

}  // namespace tread::learner
