// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/execution/stop_reason.hpp"

#include <algorithm>
#include <array>

namespace tread {
namespace {

struct Row {
  StopReason reason;
  const char* sentence;
};

constexpr std::array kRows{
    Row{StopReason::kUnsaid, "the message is older than the codes of reasons"},
    Row{StopReason::kNone, ""},
    Row{StopReason::kEstopEngaged, "E-stop is engaged"},
    Row{StopReason::kRangeFinder, "mapping does not believe a range finder"},
    Row{StopReason::kDisarmed, "disarmed"},
    Row{StopReason::kControllerLost, "the motor controller does not answer"},
    Row{StopReason::kControllerStarts, "controller is being started up"},
    Row{StopReason::kControllerVoltage, "the motor controller runs short of voltage"},
    Row{StopReason::kControllerFault, "the motor controller reports a fault"},
    Row{StopReason::kBridgeHeldUp, "motor_bridge was held up"},
    Row{StopReason::kClockWentBack, "the robot's clock went back"},
    Row{StopReason::kMotorStale, "MOTOR is old"},
    Row{StopReason::kNoMotor, "no MOTOR yet"},
    Row{StopReason::kBadProgram, "PROGRAM breaks its limits"},
    Row{StopReason::kOtherPlanner, "another run of the planner"},
    Row{StopReason::kOperatorLost, "the operator is lost"},
    Row{StopReason::kNoOperator, "no operator's program is heard (OPERATOR)"},
    Row{StopReason::kOperatorLetGo, "the operator has let go"},
    Row{StopReason::kGoalAbandoned, "no operator who holds the robot stands for the goal"},
    Row{StopReason::kNoProgram, "no PROGRAM yet"},
    Row{StopReason::kProgramLate, "no good PROGRAM within its lease"},
    Row{StopReason::kSeriesEnded, "series ended without a next"},
    Row{StopReason::kNothingInTime, "stopped: nothing was handed over in time"},
    Row{StopReason::kNotBegun, "stopped: motor_bridge did not begin the pattern"},
    Row{StopReason::kInsBlind, "INS knows no position or no heading"},
    Row{StopReason::kNoUsableIns, "no usable INS yet"},
    Row{StopReason::kNoIns, "no INS yet"},
    Row{StopReason::kInsRestarted, "the INS driver has been restarted"},
    Row{StopReason::kInsStale, "INS is stale"},
    Row{StopReason::kTilt, "it leans too far"},
    Row{StopReason::kTiltUnknown, "INS measures no roll and pitch: their limits cannot be kept"},
    Row{StopReason::kFenceNear, "a fence is too near"},
    Row{StopReason::kFenceBlind, "position unknown: fences cannot be kept"},
    Row{StopReason::kFencesLost, "kept fences are lost: set them anew"},
    Row{StopReason::kInsJump, "the pose jumps"},
    Row{StopReason::kInsFrozen, "pose frozen"},
    Row{StopReason::kTrackDead, "a track is dead, blocked or driven the wrong way"},
    Row{StopReason::kStuck, "stuck or pose frozen"},
    Row{StopReason::kInsDisagrees, "the INS contradicts itself"},
    Row{StopReason::kUnexplainedMotion, "moves in a way that the commands do not explain"},
    Row{StopReason::kNoMap, "no MAP yet"},
    Row{StopReason::kMapStale, "MAP is old"},
    Row{StopReason::kLearnerLost, "the learner is lost"},
    Row{StopReason::kBadPatterns, "no PATTERN_SET yet"},
    Row{StopReason::kPatternGone, "the running pattern is gone from the set"},
    Row{StopReason::kObstacleAhead, "something is in the way"},
    Row{StopReason::kGroundGivesWay, "the ground gives way"},
    Row{StopReason::kBoxedIn, "boxed in: no move is free"},
    Row{StopReason::kNoWayFound, "no free sequence of patterns brings the goal nearer"},
    Row{StopReason::kGettingOut, "trying to get out"},
    Row{StopReason::kGoalUnreachable, "the goal cannot be reached"},
    Row{StopReason::kGoalEnded, "the goal has ended: give it again"},
    Row{StopReason::kNotArmedYet, "not armed yet"},
    Row{StopReason::kArmed, "armed"},
    Row{StopReason::kPlaying, "playing"},
    Row{StopReason::kByHand, "driven by hand"},
    Row{StopReason::kGivenBack, "given back by hand"},
    Row{StopReason::kEstopCleared, "E-stop cleared"},
    Row{StopReason::kProgramEnded, "series ended"},
    Row{StopReason::kStoppedByPlanner, "stopped by the planner"},
    Row{StopReason::kLeftByHand, "the person drove on in another way"},
    Row{StopReason::kNotArmedSince, "not armed since the planner's start"},
    Row{StopReason::kNoGoal, "no goal"},
    Row{StopReason::kPlannedStop, "stopping: the plan ends there"},
    Row{StopReason::kCloseAsPossible, "as close to the goal as possible"},
    Row{StopReason::kLooksForAnotherWay, "no progress: looking for another way"},
    Row{StopReason::kBridgeEnds, "disarmed by the end of motor_bridge"},
    Row{StopReason::kOperatorDrives, "idle or driven by the operator"},
    Row{StopReason::kReturns, "the operator is lost: returning to where the link was good"},
};

constexpr bool ranked() {
  for (size_t i = 1; i < kRows.size(); ++i)
    if (kRows[i - 1].reason >= kRows[i].reason) return false;
  return true;
}
static_assert(ranked(), "a row for each reason, in their order");

const Row* rowOf(StopReason reason) {
  const auto found =
      std::lower_bound(kRows.begin(), kRows.end(), reason,
                       [](const Row& row, StopReason wanted) { return row.reason < wanted; });
  return found != kRows.end() && found->reason == reason ? &*found : nullptr;
}

}  // namespace

const char* sentenceOf(StopReason reason) {
  const Row* const row = rowOf(reason);
  return row == nullptr ? kRows.front().sentence : row->sentence;
}

StopReason stopReasonFrom(int16_t number) {
  const auto reason = static_cast<StopReason>(number);
  return rowOf(reason) == nullptr ? StopReason::kUnsaid : reason;
}

StopReason stopReasonOf(const std::string& words) {
  for (const Row& row : kRows)
    if (row.reason != StopReason::kUnsaid && words == row.sentence) return row.reason;
  return StopReason::kUnsaid;
}

}  // namespace tread
