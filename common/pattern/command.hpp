// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lcmtypes/enums.hpp"

namespace tread {

/// "power", "track_speed" or "steering_angle"; empty for an unknown kind.
const char* nameOf(CommandKind kind);
/// The kind with this name; nullopt if there is none.
std::optional<CommandKind> kindNamed(const std::string& name);
/// " m/s", " rad" or empty, to be appended to a number.
const char* unitOf(CommandKind kind);
/// Largest magnitude of a command of a kind: 1 for power, 20 m/s, 1.2 rad.
double commandLimit(CommandKind kind);

/// One channel of the commands to a vehicle.
struct CommandChannel {
  std::string name;  ///< for instance left, right, throttle, steering
  CommandKind kind = CommandKind::kPower;
  double lowest = 0.0;  ///< in the unit of the kind
  double highest = 0.0;
};

bool operator==(const CommandChannel& a, const CommandChannel& b);
inline bool operator!=(const CommandChannel& a, const CommandChannel& b) {
  return !(a == b);
}

/// A vehicle's command channels, in order: 1 to Command::kMaxChannels.
using CommandChannels = std::vector<CommandChannel>;

/// The kinds of channels, in their order.
std::vector<CommandKind> kindsOf(const CommandChannels& channels);
/// Channels left and right of a vehicle with two tracks, in the whole range of a kind.
CommandChannels trackChannels(CommandKind kind);
/// Channels of a car, in the whole range of each: throttle (power) or speed, then steering.
CommandChannels carChannels(CommandKind kind);
/// The kind if these are trackChannels(); nullopt for another vehicle.
std::optional<CommandKind> kindOfTracks(const CommandChannels& channels);
/// "left [m/s], right [m/s]".
std::string describe(const CommandChannels& channels);

/// A command to two tracks: power -1..1 [1] or track speed [m/s], + forward.
struct TrackCommand {
  double left = 0.0;
  double right = 0.0;
};

inline bool operator==(const TrackCommand& a, const TrackCommand& b) {
  return a.left == b.left && a.right == b.right;
}
inline bool operator!=(const TrackCommand& a, const TrackCommand& b) {
  return !(a == b);
}

/// One command u_t: a value for each channel, in order; values beyond the last channel are 0.
/** A command whose channels are all 0 stops any vehicle. */
class Command {
 public:
  static constexpr size_t kMaxChannels = 8;

  constexpr Command() = default;
  constexpr Command(double first, double second) : values_{first, second} {}
  constexpr Command(const TrackCommand& tracks) : Command(tracks.left, tracks.right) {}

  constexpr double& operator[](size_t channel) { return values_[channel]; }
  constexpr double operator[](size_t channel) const { return values_[channel]; }
  /// The first two channels, of a vehicle with two tracks.
  TrackCommand tracks() const { return {values_[0], values_[1]}; }

  friend bool operator==(const Command& a, const Command& b) { return a.values_ == b.values_; }
  friend bool operator!=(const Command& a, const Command& b) { return !(a == b); }

 private:
  std::array<double, kMaxChannels> values_{};
};

/// A command with its start time.
struct TimedCommand {
  int64_t utime = 0;  ///< [us]
  Command command;
};

/// The same with a time in seconds, for the analysis of drives.
struct CommandSample {
  double time = 0.0;  ///< [s]
  Command command{};
};

/// The drive of a vehicle, which determines the meaning of its commands.
enum class VehicleLayout {
  kTracks = 1,  ///< left and right
  kCar = 2,     ///< throttle or speed, and a steering angle
  kOmni = 4     ///< one channel for each wheel of a holonomic base
};

/// "two tracks", "a car", "a holonomic base".
const char* nameOf(VehicleLayout layout);
/// The layout whose commands have channels of these kinds.
VehicleLayout layoutOf(const std::vector<CommandKind>& kinds);
/// The largest magnitude among the channels that move the vehicle; 0 = the command is to stand.
double driveOf(VehicleLayout layout, const Command& command);

/// Speeds of the two rear wheels of a car by Ackermann's law: `speed` at the middle of the rear
/// axle (in any unit), steering angle [rad] at the middle of the front axle, wheelbase and gauge
/// [m].
TrackCommand rearWheels(double speed, double angle, double wheelbase, double gauge);

/// Conversion of two-track series to pattern commands and back; of a car, the first two values.
std::vector<Command> commandsOf(const std::vector<TrackCommand>& tracks);
std::vector<TrackCommand> tracksOf(const std::vector<Command>& commands);

}  // namespace tread
