// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tread {

/// Seeded faults on messages between a publisher and one receiver, each drawn per message and
/// receiver.
struct MessageFault {
  std::string channel = "*";   ///< channel name, or * for all
  std::string receiver = "*";  ///< node name, or * for all
  double drop = 0.0;           ///< probability 0..1
  double duplicate = 0.0;      ///< probability 0..1: delivered twice
  double corrupt = 0.0;        ///< probability 0..1: one byte changed
  double reorder =
      0.0;  ///< probability 0..1: held back by up to reorder_us, so that later ones overtake it
  int64_t reorder_us = 100'000;
  int64_t delay_us = 0;       ///< constant delay of each message
  int64_t from = 0;           ///< [us] since the start of the run
  int64_t until = INT64_MAX;  ///< [us] since the start of the run
};

/// A node is killed, and perhaps started again.
struct NodeFault {
  std::string node;
  int64_t kill_at = 0;         ///< [us] since the start of the run
  int64_t restart_after = -1;  ///< [us] after the kill; negative = never
};

/// What goes wrong in a run on the virtual bus.
struct FaultPlan {
  std::vector<MessageFault> messages;
  std::vector<NodeFault> nodes;
};

}  // namespace tread
