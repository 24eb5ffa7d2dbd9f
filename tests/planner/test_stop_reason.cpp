// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <set>
#include <string>

#include <catch2/catch.hpp>

#include "common/execution/stop_reason.hpp"

namespace tread {

TEST_CASE(
    "every reason that a message may carry has a sentence of its own, and comes back as itself") {
  std::set<std::string> sentences;
  int reasons = 0;
  for (int number = -5; number < 2000; ++number) {
    const StopReason reason = stopReasonFrom(static_cast<int16_t>(number));
    if (reason == StopReason::kUnsaid && number != -1) continue;
    CHECK(static_cast<int>(reason) == number);
    sentences.insert(sentenceOf(reason));
    ++reasons;
  }
  CHECK(reasons > 60);
  CHECK(sentences.size() == static_cast<size_t>(reasons));
}

TEST_CASE("a number that no reason has is a reason that was not said, and that is not ordinary") {
  CHECK(stopReasonFrom(11) == StopReason::kUnsaid);
  CHECK_FALSE(isOrdinary(StopReason::kUnsaid));
  CHECK_FALSE(isOrdinary(StopReason::kDisarmed));
  CHECK(isOrdinary(StopReason::kNone));
  CHECK(isOrdinary(StopReason::kPlannedStop));
  CHECK(isOrdinary(StopReason::kBridgeEnds));
}

TEST_CASE(
    "of reasons that come together the first is nearest to the cause: persons before devices") {
  CHECK(StopReason::kEstopEngaged < StopReason::kControllerLost);
  CHECK(StopReason::kControllerLost < StopReason::kOperatorLost);
  CHECK(StopReason::kOperatorLost < StopReason::kProgramLate);
  CHECK(StopReason::kProgramLate < StopReason::kInsStale);
  CHECK(StopReason::kInsStale < StopReason::kFenceNear);
  CHECK(StopReason::kFenceNear < StopReason::kStuck);
  CHECK(StopReason::kStuck < StopReason::kNoWayFound);
}

}  // namespace tread
