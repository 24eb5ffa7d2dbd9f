// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/execution/operator_lease.hpp"

#include <algorithm>
#include <iterator>

namespace tread {

OperatorLease::Receipt OperatorLease::receive(const OperatorNotice& notice, int64_t now) {
  if (notice.seen_utime > now + kMaxFuture) return Receipt::kFromFuture;
  // Compared with a time near now, because the difference to an arbitrary number could overflow.
  if (notice.seen_utime < now - lease_us_) return Receipt::kStale;
  const auto known = programs_.find(notice.station);
  // Out of order, or repeated.
  if (known != programs_.end() && notice.seen_utime < known->second.seen_utime)
    return Receipt::kStale;
  if (!notice.drives) {
    if (known != programs_.end()) programs_.erase(known);
    return Receipt::kTaken;
  }
  if (known == programs_.end() && programs_.size() >= kMaxPrograms) {
    dropStale(now);
    if (programs_.size() >= kMaxPrograms) return Receipt::kTooMany;
  }
  programs_[notice.station] = {notice.name, notice.seen_utime, notice.goal_id};
  if (holder_.empty()) holder_ = notice.name;
  if (holder_ != notice.name) return Receipt::kOfAnother;
  last_valid_ = now;
  const std::string& next = notice.hand_over_to;
  if (!next.empty() && next != holder_ && anyFresh(next, now)) holder_ = next;
  return Receipt::kTaken;
}

void OperatorLease::holdBy(const std::string& signature, int64_t now) {
  for (const auto& [station, program] : programs_)
    if (isOf(signature, program.name) && fresh(program, now)) holder_ = program.name;
}

void OperatorLease::update(int64_t now, bool armed) {
  // One of two programs of the holder may fall silent: the other one keeps the lease.
  if (anyFresh(holder_, now)) dropStale(now);
  if (armed || valid(now)) return;
  dropStale(now);
  holder_.clear();
}

void OperatorLease::dropStale(int64_t now) {
  for (auto at = programs_.begin(); at != programs_.end();)
    at = fresh(at->second, now) ? std::next(at) : programs_.erase(at);
}

bool OperatorLease::anyFresh(const std::string& name, int64_t now) const {
  return std::any_of(programs_.begin(), programs_.end(), [&](const auto& program) {
    return program.second.name == name && fresh(program.second, now);
  });
}

OperatorLease::State OperatorLease::state(int64_t now) const {
  if (holder_.empty()) return State::kNone;
  if (anyFresh(holder_, now)) return State::kValid;
  const bool silent = std::any_of(programs_.begin(), programs_.end(), [this](const auto& program) {
    return program.second.name == holder_;
  });
  return silent ? State::kLost : State::kNone;
}

std::optional<int64_t> OperatorLease::newestSeen() const {
  std::optional<int64_t> newest;
  for (const auto& [station, program] : programs_)
    if (program.name == holder_) newest = std::max(newest.value_or(0), program.seen_utime);
  return newest;
}

bool OperatorLease::standsFor(int64_t goal_id, int64_t now) const {
  return std::any_of(programs_.begin(), programs_.end(), [&](const auto& program) {
    return program.second.name == holder_ && program.second.goal_id == goal_id &&
           fresh(program.second, now);
  });
}

bool OperatorLease::isOf(const std::string& signature, const std::string& name) {
  const std::string suffix = " (" + name + ")";
  return signature == name ||
         (signature.size() > suffix.size() &&
          signature.compare(signature.size() - suffix.size(), suffix.size(), suffix) == 0);
}

const char* describe(OperatorLease::Receipt receipt) {
  switch (receipt) {
    case OperatorLease::Receipt::kTaken:
      return "taken";
    case OperatorLease::Receipt::kOfAnother:
      return "of another operator than the one who holds the robot";
    case OperatorLease::Receipt::kStale:
      return "its sender has not seen the robot within the lease";
    case OperatorLease::Receipt::kFromFuture:
      return "its sender claims to have seen the future";
    case OperatorLease::Receipt::kTooMany:
      return "too many operator programs";
  }
  return "unknown";
}

}  // namespace tread
