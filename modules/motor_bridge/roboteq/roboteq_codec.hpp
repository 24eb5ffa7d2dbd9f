// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "modules/motor_bridge/core/program.hpp"

namespace tread::motor {

/// How the two tracks hang on a Roboteq dual-channel controller.
struct RoboteqLayout {
  bool both_in_one_line = true;  ///< "!M l r" moves both tracks at once; false: two "!G cc n" lines
  int left_channel = 1;          ///< 1 or 2; the right track has the other one
  bool invert_left = false;      ///< the left motor is mounted the other way round
  bool invert_right = false;
  double full_scale = 1.0;   ///< command that is 1000 per mille, in the units of the command kind
  double rpm_per_mps = 0.0;  ///< motor revolutions per minute at 1 m/s of track; 0 = no encoders
};

/// Command in per mille of full scale by channel, clamped to what the controller takes.
struct ChannelCommand {
  int channel_1 = 0;
  int channel_2 = 0;
};

/// Track command to channels. NaN becomes zero: this is the last place that can look.
ChannelCommand toChannels(const TrackCommand& command, const RoboteqLayout& layout);
/// Lines (each without its CR) that give a command to the controller.
std::vector<std::string> commandLines(const TrackCommand& command, const RoboteqLayout& layout);

/// Cuts the controller's bytes into lines.
/** Lines end with CR; other bytes below space and above '~' are dropped; an overlong line is
    discarded up to its end. */
class RoboteqLines {
 public:
  static constexpr size_t kMaxLine = 128;

  /// Complete lines, empty ones left out.
  std::vector<std::string> push(std::string_view bytes);
  void clear();
  int64_t overlong() const { return overlong_; }
  int64_t garbageBytes() const { return garbage_; }

 private:
  std::string line_;
  bool discarding_ = false;
  int64_t overlong_ = 0;
  int64_t garbage_ = 0;
};

/// One reply of the controller.
struct RoboteqReply {
  enum class Kind { kAck, kRefused, kValue, kOther };
  Kind kind = Kind::kOther;
  std::string key;           ///< e.g. "A" of "A=100:200"
  std::vector<long> values;  ///< empty if the value is text, as in FID
  std::string text;          ///< everything behind the equals sign
};

/// True if a line is one of ours coming back: the controller's own lines never begin like this.
bool isEcho(const std::string& line);
/// Reads one line; what it cannot read is kOther.
RoboteqReply parseReply(const std::string& line);

/// Runtime fault flags of query ?FF (Roboteq manual, maintenance and runtime queries).
enum FaultFlag : int32_t {
  kOverheat = 1,
  kOvervoltage = 2,
  kUndervoltage = 4,
  kShortCircuit = 8,
  kEmergencyStop = 16,
  kSensorSetup = 32,
  kMosfetFailure = 64,
  kDefaultConfiguration = 128,
};

/// Status flags of query ?FS that matter here; the others tell how it is commanded.
enum StatusFlag : int32_t {
  kPowerStageOff = 8,
  kStallDetected = 16,
  kAtLimit = 32,
};

/// Status flags that stop the robot.
inline constexpr int32_t kStoppingStatus = kPowerStageOff | kStallDetected;

/// Flags in words, e.g. "controller: overheat, undervoltage"; empty if nothing stops the robot.
std::string describeFaults(int32_t fault_flags, int32_t status_flags);

}  // namespace tread::motor
