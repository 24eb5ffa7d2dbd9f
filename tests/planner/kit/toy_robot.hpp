// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/bus/bus.hpp"
#include "common/messages/pattern_messages.hpp"
#include "tests/planner/kit/playground.hpp"
#include "tests/planner/kit/sample_patterns.hpp"

namespace tread::planner::testkit {

/// Motor bridge, vehicle, INS, mapping and learner of a toy robot in one node.
class ToyRobot : public Node {
 public:
  explicit ToyRobot(Bus& bus) : bus_(bus), program_(bus, kProgram), arm_(bus, kArm) {
    const Playground ground;
    tiles_ = tilesOf(ground.paint(0.1, {-9.6, -9.6}, {16.0, 9.6}), 32, 1);
  }

  int64_t period() const override { return 10'000; }

  void step(int64_t utime) override;

  const Pose2& pose() const { return state_.pose; }
  double speed() const { return (state_.left + state_.right) / 2.0; }
  int aborted() const { return aborted_; }
  int64_t lastId() const { return last_id_; }
  const std::vector<execution_record_t>& records() const { return records_; }
  const program_t& program() const { return program_.message(); }
  bool hasProgram() const { return program_.any(); }

  bool takes_arm = true;
  bool ins_alive = true;
  bool map_alive = true;
  bool learner_alive = true;

 private:
  void begin(const program_slot_t& slot, int64_t started);
  void close(int64_t ended, int16_t outcome);
  void play(int64_t now);
  void publishMotor(int64_t utime);
  void publishIns(int64_t utime);
  void publishExecutions(int64_t utime);
  void publishTile(int64_t utime);
  void publishSet();

  Bus& bus_;
  Latest<program_t> program_;
  Latest<arm_t> arm_;
  std::vector<Tile> tiles_;
  size_t turn_ = 0;
  TrackState state_;
  Command command_;
  program_slot_t current_{};
  std::vector<execution_record_t> records_;
  int64_t armed_at_ = 0;
  int64_t started_ = 0;
  int64_t last_id_ = 0;
  int index_ = -1;
  bool armed_ = false;
  int aborted_ = 0;
  int64_t seq_motor_ = 0;
  int64_t seq_ins_ = 0;
  int64_t seq_map_ = 0;
  int64_t seq_execution_ = 0;
  int64_t seq_set_ = 0;
};

}  // namespace tread::planner::testkit
