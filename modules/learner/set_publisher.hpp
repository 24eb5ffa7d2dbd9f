// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <deque>
#include <string>

#include "common/bus/bus.hpp"
#include "common/pattern/pattern.hpp"

namespace tread::learner {

/// Sends sets and states in portions: LCM silently loses messages where one
/// publisher sends more than 100 kB in 20 ms.
class SetPublisher {
 public:
  explicit SetPublisher(Bus& bus) : bus_(bus) {}

  /// The parts of a set; those of an older one that are still here are not sent any more.
  void putSet(const PatternSet& set);
  /// The parts of a state's text, sent after the sets. At most two states wait; more drop the
  /// older.
  void putState(const PatternSet& set, const std::string& rule, const std::string& text);

  bool setsSent() const { return sets_.empty(); }
  /// Sends one portion.
  void step(int64_t utime);

 private:
  Bus& bus_;
  std::deque<pattern_set_part_t> sets_;
  std::deque<learner_state_t> states_;
  int64_t seq_set_ = 0;
  int64_t seq_state_ = 0;
};

}  // namespace tread::learner
