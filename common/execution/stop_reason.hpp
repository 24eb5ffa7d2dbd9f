// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <utility>

namespace tread {

/// Why the robot stops, stands or ends a pattern early: every reason known to motor_bridge and the
/// planner. sentenceOf() gives each in words.
/** The order is the rank: of several simultaneous reasons the first one is closest to the cause.
 * The numbers travel in MOTOR, PLAN and EXECUTION: a new reason takes a free one between its
 * neighbours, and no number is reused. */
enum class StopReason : int16_t {
  kUnsaid = -1,  ///< message older than the codes; its words give the reason
  kNone = 0,     ///< there is no reason

  // A person, or mapping, which disarms the robot if a range finder is wrong.
  kEstopEngaged = 10,
  kRangeFinder = 20,
  kDisarmed = 30,

  // The motor controller, and motor_bridge itself.
  kControllerLost = 40,
  kControllerStarts = 41,
  kControllerVoltage = 42,
  kControllerFault = 43,
  kBridgeHeldUp = 50,
  kClockWentBack = 51,
  kMotorStale = 52,
  kNoMotor = 53,

  // Orders that cannot be trusted.
  kBadProgram = 55,
  kOtherPlanner = 56,

  // The operator.
  kOperatorLost = 60,
  kNoOperator = 61,
  kOperatorLetGo = 62,
  kGoalAbandoned = 63,  ///< no program vouches for the goal any more

  // The planner's orders are missing or late.
  kNoProgram = 70,
  kProgramLate = 71,
  kSeriesEnded = 72,
  kNothingInTime = 73,
  kNotBegun = 74,

  // The INS.
  kInsBlind = 80,  ///< no position or no heading
  kNoUsableIns = 81,
  kNoIns = 90,
  kInsRestarted = 91,
  kInsStale = 92,

  // Limits that a person set.
  kTilt = 100,
  kTiltUnknown = 101,
  kFenceNear = 110,
  kFenceBlind = 111,
  kFencesLost = 112,

  // The commands do not explain the motion.
  kInsJump = 120,
  kInsFrozen = 121,
  kTrackDead = 122,  ///< or blocked, or driven in the wrong direction
  kStuck = 123,      ///< or the pose is frozen
  kInsDisagrees = 124,
  kUnexplainedMotion = 125,

  // The planner's inputs.
  kNoMap = 130,
  kMapStale = 131,
  kLearnerLost = 140,
  kBadPatterns = 141,  ///< none yet, or unusable
  kPatternGone = 142,

  // The way.
  kObstacleAhead = 150,
  kGroundGivesWay = 151,
  kBoxedIn = 160,
  kNoWayFound = 161,
  kGettingOut = 162,
  kGoalUnreachable = 170,
  kGoalEnded = 171,

  // No fault: states at the start, and planned stops (isOrdinary()).
  kNotArmedYet = 1000,
  kArmed = 1001,
  kPlaying = 1002,
  kByHand = 1003,
  kGivenBack = 1004,
  kEstopCleared = 1005,
  kProgramEnded = 1006,
  kStoppedByPlanner = 1007,
  kLeftByHand = 1008,
  kNotArmedSince = 1009,
  kNoGoal = 1010,
  kPlannedStop = 1011,
  kCloseAsPossible = 1012,
  kLooksForAnotherWay = 1013,
  kBridgeEnds = 1014,
  kOperatorDrives = 1015,
  kReturns = 1016,
};

/// The sentence for people. A message may add details to it or replace it by a more exact one.
const char* sentenceOf(StopReason reason);

/// The reason with a number from a message; kUnsaid for one that this version does not know.
StopReason stopReasonFrom(int16_t number);

/// The reason with exactly this sentence; kNone for an empty text, kUnsaid for any other.
/** Only for messages that are older than the codes. */
StopReason stopReasonOf(const std::string& words);

/// Whether it is no fault: a planned stop, or a state at the start.
inline bool isOrdinary(StopReason reason) {
  return reason == StopReason::kNone || reason >= StopReason::kNotArmedYet;
}

/// A reason, and its words for people: programs decide by the code, people read the words.
struct Reason {
  StopReason code = StopReason::kNone;
  std::string words;

  Reason() = default;
  Reason(StopReason why) : code(why), words(sentenceOf(why)) {}  // NOLINT: meant to convert
  Reason(StopReason why, std::string in_words) : code(why), words(std::move(in_words)) {}

  /// The reason if there are words, else none.
  static Reason of(StopReason why, const std::string& words) {
    return words.empty() ? Reason() : Reason(why, words);
  }
  bool empty() const { return code == StopReason::kNone; }
  bool operator==(const Reason& other) const { return code == other.code && words == other.words; }
  bool operator!=(const Reason& other) const { return !(*this == other); }
};

}  // namespace tread
