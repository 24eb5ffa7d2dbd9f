// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/core/series_player.hpp"

namespace tread::motor {

void ExecutionLog::begin(int64_t run_id, const ProgramSlot& slot, int64_t start_utime) {
  ExecutionRecord record;
  record.run_id = run_id;
  record.execution_id = slot.execution_id;
  record.pattern_id = slot.pattern_id;
  record.set_version = slot.set_version;
  record.started = start_utime;
  record.commands_total = static_cast<int32_t>(slot.series.size());
  records_.push_back(record);
  if (records_.size() > kCapacity) records_.pop_front();
  ++revision_;
}

void ExecutionLog::countCommand() {
  if (running()) ++records_.back().commands_played;
}

void ExecutionLog::close(ExecutionOutcome outcome, int64_t end_utime, const Reason& reason) {
  if (!running()) return;
  records_.back().outcome = outcome;
  records_.back().ended = end_utime;
  records_.back().reason = reason;
  ++revision_;
}

bool agrees(Offer offer) {
  return offer == Offer::kAccepted || offer == Offer::kStop || offer == Offer::kPlannerAhead ||
         offer == Offer::kPlannerBehind;
}

const char* describe(Offer offer) {
  switch (offer) {
    case Offer::kAccepted:
      return "accepted";
    case Offer::kStop:
      return "empty running slot";
    case Offer::kPlannerAhead:
      return "names the next slot shortly before the switch";
    case Offer::kPlannerBehind:
      return "names the slot before shortly after the switch";
    case Offer::kAlreadyExecuted:
      return "running slot was executed before";
    case Offer::kRunningUnknown:
      return "running slot is neither played nor pending";
    case Offer::kRunningAltered:
      return "running slot has the id of the one played but other commands";
    case Offer::kNextOutOfOrder:
      return "next slot's execution id is not above the running one's";
  }
  return "unknown";
}

void SeriesPlayer::beginRun(int64_t run_id) {
  if (run_id_) executed_by_run_[*run_id_] = last_executed_;
  if (executed_by_run_.size() > kRunsRemembered) executed_by_run_.erase(executed_by_run_.begin());
  const auto known = executed_by_run_.find(run_id);
  last_executed_ = known == executed_by_run_.end() ? 0 : known->second;
  run_id_ = run_id;
  previous_id_ = 0;
  candidate_ = Program{};
}

Offer SeriesPlayer::offer(const Program& program, int64_t now) {
  candidate_ = Program{};
  if (program.running.empty()) return Offer::kStop;
  if (!program.next.empty() && program.next.execution_id <= program.running.execution_id)
    return Offer::kNextOutOfOrder;
  return playing() ? offerPlaying(program, now) : offerIdle(program);
}

Offer SeriesPlayer::offerIdle(const Program& program) {
  if (program.running.execution_id <= last_executed_) return Offer::kAlreadyExecuted;
  candidate_ = program;
  return Offer::kAccepted;
}

Offer SeriesPlayer::offerPlaying(const Program& program, int64_t now) {
  const int64_t running_id = program.running.execution_id;
  if (running_id == current_.execution_id) {
    if (!sameOrder(program.running, current_)) return Offer::kRunningAltered;
    pending_ = program.next;
    return Offer::kAccepted;
  }
  const bool names_pending = !pending_.empty() && sameOrder(program.running, pending_);
  if (names_pending && endUtime() - now <= kSwitchTolerance) return Offer::kPlannerAhead;
  const bool names_previous = previous_id_ != 0 && running_id == previous_id_;
  if (names_previous && now - start_utime_ <= kSwitchTolerance) return Offer::kPlannerBehind;
  return Offer::kRunningUnknown;
}

SeriesPlayer::Advance SeriesPlayer::advance(int64_t now) {
  Advance advance;
  while (playing() && now >= endUtime()) {
    advance.skipped += static_cast<int32_t>(current_.series.size()) - given_;
    const int64_t end = endUtime();
    log_.close(ExecutionOutcome::kCompleted, end, {});
    const int64_t ended_id = current_.execution_id;
    current_ = ProgramSlot{};
    advance.ended = pending_.empty();
    if (!pending_.empty()) {
      const ProgramSlot next = pending_;
      begin(next, end);
      previous_id_ = ended_id;
      advance.switched = true;
    }
  }
  if (playing()) {
    index_ = static_cast<int32_t>((now - start_utime_) / current_.period_us);
    advance.skipped += index_ > given_ ? index_ - given_ : 0;
    given_ = index_ > given_ ? index_ : given_;
  }
  return advance;
}

void SeriesPlayer::start(int64_t now) {
  const Program program = candidate_;
  candidate_ = Program{};
  begin(program.running, now);
  pending_ = program.next;
}

void SeriesPlayer::begin(const ProgramSlot& slot, int64_t start_utime) {
  current_ = slot;
  pending_ = ProgramSlot{};
  previous_id_ = 0;
  start_utime_ = start_utime;
  index_ = 0;
  given_ = 0;
  last_executed_ = slot.execution_id;
  log_.begin(run_id_.value_or(0), slot, start_utime);
}

void SeriesPlayer::abort(int64_t now, const Reason& reason) {
  log_.close(ExecutionOutcome::kAborted, now, reason);
  current_ = ProgramSlot{};
  pending_ = ProgramSlot{};
  candidate_ = Program{};
}

Command SeriesPlayer::give() {
  if (given_ <= index_) {
    log_.countCommand();
    given_ = index_ + 1;
  }
  return current_.series[static_cast<size_t>(index_)];
}

}  // namespace tread::motor
