// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/messages/execution_queue.hpp"

namespace tread {
namespace {

/// Far more than the eight that are repeated.
constexpr size_t kRemembered = 64;
/// No queue of waiting executions is this long unless somebody sends nonsense.
constexpr size_t kMaxWaiting = 64;
/// An execution that is over does not end later than this after now [us].
constexpr int64_t kMaxAheadUs = 1'000'000;

}  // namespace

void ExecutionQueue::add(const execution_t& message, int64_t now) {
  for (const execution_record_t& record : message.records) {
    if (record.outcome == execution_record_t::OUTCOME_RUNNING) continue;
    const ExecutionKey key{record.record_run_id, record.record_execution_id};
    if (known_.count(key) > 0) continue;
    const bool sense =
        record.started > 0 && record.ended >= record.started && record.ended <= now + kMaxAheadUs;
    if (!sense || waiting_.size() >= kMaxWaiting) {
      ++invalid_;
      continue;
    }
    known_.insert(key);
    waiting_[{record.ended, key.first, key.second}] = record;
  }
}

std::optional<int64_t> ExecutionQueue::nextEnd() const {
  if (waiting_.empty()) return std::nullopt;
  return waiting_.begin()->second.ended;
}

std::optional<execution_record_t> ExecutionQueue::takeEndedBy(int64_t horizon) {
  if (waiting_.empty() || waiting_.begin()->second.ended > horizon) return std::nullopt;
  execution_record_t record = waiting_.begin()->second;
  waiting_.erase(waiting_.begin());
  noteHandled({record.record_run_id, record.record_execution_id});
  return record;
}

void ExecutionQueue::remember(const std::vector<ExecutionKey>& handled) {
  for (const ExecutionKey& key : handled) {
    known_.insert(key);
    noteHandled(key);
  }
}

void ExecutionQueue::noteHandled(const ExecutionKey& key) {
  order_.push_back(key);
  while (order_.size() > kRemembered) {
    known_.erase(order_.front());
    order_.pop_front();
  }
}

}  // namespace tread
