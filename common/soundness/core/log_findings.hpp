// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/words/words.hpp"

// Everything that can be found out about a log: code, consequence and sentence. The checks decide
// and fill in the gaps of the sentence.
namespace tread::gap {

namespace findings {

enum Consequence {
  kNote,
  kComparison,     ///< a note on commands and motion
  kFatal,          ///< nothing can be concluded from the log
  kContradiction,  ///< the same, because commands and motion contradict each other
};

}  // namespace findings

struct LogFinding {
  findings::Consequence consequence;
  const char* sentence;
};

namespace findings {

// The file and its messages.
inline constexpr LogFinding kFileNote{kNote, "{}"};
inline constexpr LogFinding kNoMotor{
    kFatal, "no MOTOR message among {} events: the commands are unknown; record channel MOTOR"};
inline constexpr LogFinding kNoIns{
    kFatal, "no INS message among {} events: the motion is unknown; record channel INS"};
inline constexpr LogFinding kNeverDriven{
    kFatal, "the bridge never drives or stands armed for a second: no command is known"};
inline constexpr LogFinding kTwoKinds{
    kFatal, "commands of two kinds: {} power, {} track speed; cut the log where the kind changes"};
inline constexpr LogFinding kInvalidCommands{
    kNote, "{} MOTOR messages without a number as command; left out"};
inline constexpr LogFinding kMotorSilences{kNote,
                                           "MOTOR is silent for more than 0.3 s {} times (first at "
                                           "{} s, longest {} s); each silence ends a segment"};
inline constexpr LogFinding kPublisherRestarts{
    kNote, "{}'s publisher was started again {} times, or messages came out of order"};
inline constexpr LogFinding kOutOfOrder{
    kNote, "{} messages of {} come out of order; sorted by their own time"};
inline constexpr LogFinding kTwoPublishers{
    kFatal,
    "two robots in one log: {} has two publishers (its seq falls back {} times, {} messages "
    "contradict another one of the same time); record one robot"};
inline constexpr LogFinding kTwoBoots{
    kFatal, "two robots in one log: CONFIG of {} alternates between two boots; record one robot"};

// Clocks.
inline constexpr LogFinding kClockGoesBack{
    kFatal, "clock jump: {} goes back by {} s at {} s; cut the log there"};
inline constexpr LogFinding kTimesMixed{kFatal,
                                        "clock jump: {} goes back at {} s, and its messages of "
                                        "both times are mixed; cut the log there"};
inline constexpr LogFinding kClockGoesOn{
    kFatal, "clock jump: {} goes on by {} s at {} s, the recorder by {} s; cut the log there"};
inline constexpr LogFinding kClockLeavesRobot{kFatal,
                                              "clock jump: {} on by {} s at {} s, but the robot "
                                              "moves on by {} m at {} m/s{}; cut the log there"};
inline constexpr LogFinding kClockSpan{
    kFatal, "clock jump: INS and MOTOR span {} hours; are both on the robot's clock?"};
inline constexpr LogFinding kPauseStanding{
    kNote,
    "INS and MOTOR are silent for {} s at {} s and miss no number, while the robot stands: if its "
    "clock jumped there, what depends on time is wrong"};
inline constexpr LogFinding kTwoClocks{
    kContradiction,
    "commands and poses are on two clocks: the motion fits its commands if it comes {} s {} them "
    "(correlation {}, without this {}); correct the times of one of them by that"};
inline constexpr LogFinding kClocksDrift{
    kContradiction,
    "the clocks of INS and MOTOR drift: the motion follows its commands by {} s at {} s and by {} "
    "s at {} s, {} us more each second; correct the times of one of them"};
inline constexpr LogFinding kMotionPrecedes{
    kContradiction, "the motion precedes its commands by {} s: INS and MOTOR are not on one clock"};
inline constexpr LogFinding kLagJumps{
    kContradiction,
    "clock jump between INS and MOTOR: from {} to {} s the motion follows the commands by {} s, "
    "elsewhere by {} s; cut the log there"};

// The INS.
inline constexpr LogFinding kMessageFrozen{
    kFatal, "the {} is frozen: one message of {} s comes again and again"};
inline constexpr LogFinding kInsFrozen{kFatal,
                                       "the INS is frozen: one pose from {} to {} s while commands "
                                       "drive; cut the log before, check the INS"};
inline constexpr LogFinding kInsRepeats{kFatal,
                                        "the INS is frozen: it repeats the same {} times from {} "
                                        "to {} s while the robot is driven; cut the log there"};
inline constexpr LogFinding kGyroFrozen{kFatal,
                                        "the gyro is frozen: it reads {} rad/s all the time from "
                                        "{} to {} s while the heading turns {} rad; check the INS"};
inline constexpr LogFinding kPoseHeld{kNote, "one pose from {} to {} s; not used as measurement"};
inline constexpr LogFinding kPosesRepeated{
    kNote,
    "the INS repeats its pose in {} % of its messages while it drives; only new poses count"};
inline constexpr LogFinding kInsSilences{
    kNote,
    "no new INS pose for more than 1.5 s {} times, first at {} s; driving there is not used"};
inline constexpr LogFinding kJumpsAnnounced{
    kNote, "the INS announces {} jumps, first at {} s; each begins a new segment"};
inline constexpr LogFinding kJumps{kNote,
                                   "{} pose jumps faster than {} m/s, first at {} s, fastest {} "
                                   "m/s; a heavy-tailed likelihood bears them"};
inline constexpr LogFinding kTooManyJumps{
    kFatal,
    "{} pose jumps faster than {} m/s, first at {} s, fastest {} m/s: too many for one robot's "
    "INS; two robots, or no fix?"};
inline constexpr LogFinding kPoseRate{
    kNote, "new poses every {} s as a rule, longest {} s; {} % of the INS messages have none"};
inline constexpr LogFinding kNoGyro{
    kNote, "no gyro to compare with the heading, or no turns: not compared"};
inline constexpr LogFinding kGyroHardlyAgrees{
    kNote, "gyro and heading hardly agree (correlation {} over {} intervals)"};
inline constexpr LogFinding kGyroAgrees{kNote,
                                        "gyro and heading agree: the heading turns {} of the gyro; "
                                        "correlation {} over {} intervals; {}"};
inline constexpr LogFinding kGyroFlipped{
    kContradiction,
    "flipped sign: the gyro turns against the heading (slope {}, correlation {} over {} "
    "intervals); check how the INS is mounted and which sign it uses"};
inline constexpr LogFinding kFlipsMidway{
    kFatal, "flipped sign: from {} to {} s {}, elsewhere it does not; cut the log there"};
inline constexpr LogFinding kTurnsMidway{
    kFatal,
    "from {} to {} s the way does not go along the heading, else it does: heading or position have "
    "turned; cut the log there"};
inline constexpr LogFinding kCourseOff{
    kFatal,
    "only {} % of the way is along the heading: position and heading do not belong together (a "
    "mirrored or turned map?)"};
inline constexpr LogFinding kSegmentsLeftOut{
    kNote,
    "{} of {} segments have poses in a wrong frame (heading against gyro, or way against heading), "
    "first at {} s; {}"};

// The driving.
inline constexpr LogFinding kNoKnownMotion{kFatal,
                                           "no motion with known commands: no two new poses are "
                                           "within 1.2 s while MOTOR contains the commands"};
inline constexpr LogFinding kNeverStands{
    kNote, "it never stands still for long: gyro bias and noise cannot be measured separately"};
inline constexpr LogFinding kStandstill{kNote, "{} s of standstill:{}{}"};
inline constexpr LogFinding kDriven{kNote,
                                    "driven {} s in {} segments: speed {}, yaw rate {}, their "
                                    "product {}, {} commands, {} reversals, {}"};

// The motion against its commands.
inline constexpr LogFinding kTooSteady{kComparison,
                                       "{}: too little changes to be compared with the commands"};
inline constexpr LogFinding kFollows{kComparison, "{}: {}, correlation {} over {} intervals, {}"};
inline constexpr LogFinding kGyroTooFast{
    kContradiction,
    "the gyro reads up to {} rad/s, and no ground vehicle turns so: are these degrees per second?"};
inline constexpr LogFinding kHeadingTooFast{
    kContradiction,
    "the heading turns by up to {} rad/s, and no ground vehicle does: are these degrees?"};
inline constexpr LogFinding kPositionsTooFast{
    kContradiction,
    "the positions go by up to {} m/s, and no ground vehicle does: are these mm or cm, or is the "
    "time in another unit?"};
inline constexpr LogFinding kHeadingInDegrees{
    kContradiction, "the course agrees with the heading if that is in degrees, but not in radians"};
inline constexpr LogFinding kHeadingInRadians{
    kContradiction, "the course agrees with the heading if that is in radians, but not in degrees"};
inline constexpr LogFinding kHeadingTurned{
    kContradiction,
    "the way goes {} degrees to the {} of the heading all the time: is its zero north instead of "
    "east (heading: zero), or are x and y those of another frame?"};
inline constexpr LogFinding kMirrored{
    kContradiction, "the course agrees with the heading only if one of them is mirrored: {}"};
inline constexpr LogFinding kBothReversed{
    kContradiction,
    "it goes backwards and turns right when commanded forwards and left (correlation {}): both "
    "commands have the other sign"};
inline constexpr LogFinding kTurnsAgainst{
    kContradiction,
    "the robot turns against its commands (correlation {}): left and right are swapped, or y, yaw "
    "and gyro are inverted (z down)"};
inline constexpr LogFinding kGoesBackwards{
    kContradiction,
    "the robot goes backwards when commanded forward (correlation {}): the heading is turned half "
    "round, or the commands are negative and swapped"};
inline constexpr LogFinding kOneSideReversed{
    kContradiction,
    "speed goes with the difference of the commands and turn with their sum: the {} side's command "
    "has the other sign"};
inline constexpr LogFinding kBodySpeeds{
    kContradiction,
    "speed goes with the {} command alone and turn with the other one alone: these are speed and "
    "turn of the body, not commands of two sides"};
inline constexpr LogFinding kSpeedUnit{kContradiction, "the speed is {} of the commanded: {}"};
inline constexpr LogFinding kTurnInRadians{
    kContradiction, "the heading turns {} of the commanded: is it in radians, not in degrees?"};
inline constexpr LogFinding kTurnInDegrees{
    kContradiction, "the heading turns {} times the commanded: is it in degrees, not in radians?"};
inline constexpr LogFinding kWheelsSwapped{
    kContradiction,
    "the robot turns against its wheels' speeds (correlation {}), but with its commands: the "
    "measured speeds of left and right are swapped"};
inline constexpr LogFinding kWheelUnit{
    kContradiction, "the speed is {} of the wheels' measured one: is that in m/s?"};
inline constexpr LogFinding kGyroInRadians{kContradiction,
                                           "the heading turns {} times as much as the gyro: is the "
                                           "gyro in rad/s, not in degrees per second?"};
inline constexpr LogFinding kGyroInDegrees{
    kContradiction,
    "the heading turns {} of what the gyro says: is the gyro in degrees per second?"};

}  // namespace findings

/// A finding about one log.
struct LogNote {
  std::string log;
  std::string what;  ///< one clear line
  LogFinding finding = findings::kFileNote;

  bool is(const LogFinding& other) const {
    return std::string_view(finding.sentence) == other.sentence;
  }
  /// Nothing can be concluded from this log.
  bool isFatal() const { return finding.consequence >= findings::kFatal; }
  /// About commands against the motion.
  bool isOfCommands() const {
    return finding.consequence == findings::kComparison ||
           finding.consequence == findings::kContradiction;
  }
};

/// The findings about one log, in the order of their making.
class Diagnostics {
 public:
  explicit Diagnostics(std::string log) : log_(std::move(log)) {}

  /// `values` of the gaps in the sentence, in order.
  void add(const LogFinding& finding, const std::vector<std::string>& values = {}) {
    notes_.push_back({log_, filledIn(finding.sentence, values), finding});
  }
  void append(const std::vector<LogNote>& later) {
    notes_.insert(notes_.end(), later.begin(), later.end());
  }
  bool hasFatal() const {
    return std::any_of(notes_.begin(), notes_.end(),
                       [](const LogNote& note) { return note.isFatal(); });
  }
  std::vector<LogNote> notes() { return std::move(notes_); }

 private:
  std::string log_;
  std::vector<LogNote> notes_;
};

}  // namespace tread::gap
