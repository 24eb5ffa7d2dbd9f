// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/planner/kit/toy_robot.hpp"

#include <cmath>

namespace tread::planner::testkit {

void ToyRobot::step(int64_t utime) {
  if (takes_arm && arm_.any() && arm_.message().utime > armed_at_) armed_ = arm_.message().armed;
  play(utime);
  state_ = moveOn(state_, command_, 0.01, TrackModel{});
  if (utime % 20'000 == 0) publishMotor(utime);
  if (utime % 20'000 == 0 && ins_alive) publishIns(utime);
  if (utime % 100'000 == 0) publishExecutions(utime);
  if (utime % 50'000 == 0 && map_alive) publishTile(utime);
  if (utime % 1'000'000 == 0 && learner_alive) publishSet();
}

void ToyRobot::begin(const program_slot_t& slot, int64_t started) {
  current_ = slot;
  started_ = started;
  last_id_ = slot.execution_id;
  execution_record_t record{};
  record.record_run_id = program_.message().run_id;
  record.record_execution_id = slot.execution_id;
  record.record_pattern_id = slot.slot_pattern_id;
  record.record_set_version = slot.slot_set_version;
  record.started = started;
  record.ended = -1;
  records_.push_back(record);
}

void ToyRobot::close(int64_t ended, int16_t outcome) {
  records_.back().ended = ended;
  records_.back().outcome = outcome;
  current_ = program_slot_t{};
}

void ToyRobot::play(int64_t now) {
  const bool alive = program_.any() && now - program_.message().utime <= 200'000;
  const program_t& program = program_.message();
  const bool go = armed_ && alive && program.running.execution_id != 0;
  if (current_.execution_id != 0 && !go) {
    ++aborted_;
    close(now, execution_record_t::OUTCOME_ABORTED);
  }
  if (current_.execution_id != 0) {
    const int64_t end = started_ + int64_t{current_.period} * current_.num_commands;
    if (now >= end) {
      close(end, execution_record_t::OUTCOME_COMPLETED);
      const bool joined =
          program.running.execution_id == last_id_ && program.next.execution_id > last_id_;
      if (joined) begin(program.next, end);
    }
  }
  if (current_.execution_id == 0 && go && program.running.execution_id > last_id_)
    begin(program.running, now);
  command_ = {0.0, 0.0};
  index_ = -1;
  if (current_.execution_id == 0) return;
  index_ = static_cast<int>((now - started_) / current_.period);
  const auto i = static_cast<size_t>(index_);
  command_ = {static_cast<double>(current_.command[i][0]),
              static_cast<double>(current_.command[i][1])};
}

void ToyRobot::publishMotor(int64_t utime) {
  motor_t message{};
  message.utime = utime;
  message.seq = seq_motor_++;
  message.motor_run_id = program_.any() ? program_.message().run_id : 0;
  message.execution_id = current_.execution_id;
  message.command_index = index_;
  message.bridge_state = !armed_                      ? motor_t::STATE_DISARMED
                         : current_.execution_id != 0 ? motor_t::STATE_DRIVING
                                                      : motor_t::STATE_ARMED;
  message.state_reason = armed_ ? "" : "not armed yet";
  bus_.publish(kMotor, message);
}

void ToyRobot::publishIns(int64_t utime) {
  ins_t message{};
  message.utime = utime;
  message.seq = seq_ins_++;
  message.device_utc = -1;
  message.position[0] = state_.pose.x;
  message.position[1] = state_.pose.y;
  message.orientation[0] = std::cos(state_.pose.yaw / 2.0);
  message.orientation[3] = std::sin(state_.pose.yaw / 2.0);
  message.velocity[0] = speed();
  message.rate[2] = (state_.right - state_.left) / TrackModel{}.gauge;
  bus_.publish(kIns, message);
}

void ToyRobot::publishExecutions(int64_t utime) {
  execution_t message{};
  message.utime = utime;
  message.seq = seq_execution_++;
  const size_t first = records_.size() > 8 ? records_.size() - 8 : 0;
  message.records.assign(records_.begin() + static_cast<long>(first), records_.end());
  message.num_records = static_cast<int32_t>(message.records.size());
  bus_.publish(kExecution, message);
}

void ToyRobot::publishTile(int64_t utime) {
  const Tile& tile = tiles_[turn_++ % tiles_.size()];
  map_tile_t message{};
  message.utime = utime;
  message.seq = seq_map_++;
  message.tile_x = tile.tile_x;
  message.tile_y = tile.tile_y;
  message.tile_cells = 32;
  message.cell_size = 0.1;
  message.cells = tile.cells;
  message.num_cells = static_cast<int32_t>(tile.cells.size());
  bus_.publish(kMap, message);
}

void ToyRobot::publishSet() {
  for (pattern_set_part_t part : toMessages(samplePatterns())) {
    part.seq = seq_set_++;
    bus_.publish(kPatternSet, part);
  }
}

}  // namespace tread::planner::testkit
