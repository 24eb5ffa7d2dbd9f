// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cstddef>

#include "tools/robot/view/feed/frame_queue.hpp"

namespace tread::view {

// Limits of the viewers' cost. A viewer that exceeds them waits, gets only the newest, or is
// closed.
constexpr size_t kMostClients = 32;
constexpr size_t kMostPages = 40;            // clients, plus pages of our own
constexpr size_t kLargestRequest = 1 << 16;  // [bytes] of a client
constexpr double kRequestRate = 32'000.0;    // [bytes/s] of a client
constexpr double kRequestBurst = 128'000.0;  // [bytes]
constexpr size_t kLeastRequest = 200;        // [bytes] minimum charge per request
constexpr size_t kMostTopics = 16;           // topics advertised by a client
constexpr size_t kLongestTopic = 64;         // [bytes]
constexpr size_t kPiece = 65'536;            // [bytes] sent per turn

/// Limits the cost of all viewers together for the robot's computer. The operator is always served.
class Limits {
 public:
  /// If the processor is scarce and steps are late, viewers get less.
  void wait(double elapsed) {
    const double granted = std::min(elapsed, kLongestStep);
    accepts_.wait(granted);
    sends_.wait(granted);
    processor_.wait(granted);
  }

  void accepted() { accepts_.use(1.0); }
  bool mayAccept() const { return accepts_.left() >= 1.0 && mayCompute(); }
  void sent(size_t bytes) { sends_.use(static_cast<double>(bytes)); }
  /// Bytes that may be sent now; zero or less: none.
  double sends() const { return mayCompute() ? sends_.left() : 0.0; }
  /// Charges `seconds` of processor time. The debt is limited to a quarter of a second of waiting,
  /// because an E-stop may be among the waiting requests.
  void computed(double seconds) {
    processor_.use(std::min(seconds, processor_.left() + kMostDebt));
  }
  bool mayCompute() const { return processor_.left() > 0.0; }

 private:
  static constexpr double kLongestStep = 0.01;     // [s] credited per step
  static constexpr double kAcceptRate = 50.0;      // [1/s] new connections
  static constexpr double kAcceptBurst = 100.0;    // as many as a few pages open at once
  static constexpr double kSendRate = 12e6;        // [bytes/s] to all but the operator
  static constexpr double kSendBurst = 1e6;        // [bytes]
  static constexpr double kProcessorShare = 0.12;  // of a core
  static constexpr double kProcessorBurst = 0.05;  // [s]
  static constexpr double kMostDebt = 0.03;        // [s]

  Allowance accepts_{kAcceptRate, kAcceptBurst};
  Allowance sends_{kSendRate, kSendBurst};
  Allowance processor_{kProcessorShare, kProcessorBurst};
};

}  // namespace tread::view
