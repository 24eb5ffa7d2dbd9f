// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/pattern/command.hpp"

#include <algorithm>
#include <cmath>

namespace tread {
namespace {

struct KindWords {
  CommandKind kind;
  const char* name;
  const char* unit;  ///< behind a number
  double limit;
};

constexpr KindWords kKinds[] = {{CommandKind::kPower, "power", "", 1.0},
                                {CommandKind::kTrackSpeed, "track_speed", " m/s", 20.0},
                                {CommandKind::kSteeringAngle, "steering_angle", " rad", 1.2}};

const KindWords* wordsOf(CommandKind kind) {
  for (const KindWords& words : kKinds)
    if (words.kind == kind) return &words;
  return nullptr;
}

}  // namespace

const char* nameOf(CommandKind kind) {
  const KindWords* words = wordsOf(kind);
  return words != nullptr ? words->name : "";
}

std::optional<CommandKind> kindNamed(const std::string& name) {
  for (const KindWords& words : kKinds)
    if (words.name == name) return words.kind;
  return std::nullopt;
}

const char* unitOf(CommandKind kind) {
  const KindWords* words = wordsOf(kind);
  return words != nullptr ? words->unit : "";
}

double commandLimit(CommandKind kind) {
  const KindWords* words = wordsOf(kind);
  return words != nullptr ? words->limit : 0.0;
}

bool operator==(const CommandChannel& a, const CommandChannel& b) {
  return a.name == b.name && a.kind == b.kind && a.lowest == b.lowest && a.highest == b.highest;
}

std::vector<CommandKind> kindsOf(const CommandChannels& channels) {
  std::vector<CommandKind> kinds;
  for (const CommandChannel& channel : channels) kinds.push_back(channel.kind);
  return kinds;
}

CommandChannels trackChannels(CommandKind kind) {
  const double limit = commandLimit(kind);
  return {{"left", kind, -limit, limit}, {"right", kind, -limit, limit}};
}

CommandChannels carChannels(CommandKind kind) {
  const double drive = commandLimit(kind);
  const double angle = commandLimit(CommandKind::kSteeringAngle);
  return {{kind == CommandKind::kPower ? "throttle" : "speed", kind, -drive, drive},
          {"steering", CommandKind::kSteeringAngle, -angle, angle}};
}

const char* nameOf(VehicleLayout layout) {
  return layout == VehicleLayout::kTracks ? "two tracks"
         : layout == VehicleLayout::kCar  ? "a car"
                                          : "a holonomic base";
}

VehicleLayout layoutOf(const std::vector<CommandKind>& kinds) {
  if (kinds.size() > 2) return VehicleLayout::kOmni;
  const bool steered = kinds.size() == 2 && kinds[1] == CommandKind::kSteeringAngle;
  return steered ? VehicleLayout::kCar : VehicleLayout::kTracks;
}

double driveOf(VehicleLayout layout, const Command& command) {
  if (layout == VehicleLayout::kCar) return std::abs(command[0]);
  double largest = 0.0;
  for (size_t channel = 0; channel < Command::kMaxChannels; ++channel)
    largest = std::max(largest, std::abs(command[channel]));
  return largest;
}

TrackCommand rearWheels(double speed, double angle, double wheelbase, double gauge) {
  const double share = 0.5 * gauge * std::tan(angle) / wheelbase;
  return {speed * (1.0 - share), speed * (1.0 + share)};
}

std::optional<CommandKind> kindOfTracks(const CommandChannels& channels) {
  for (const CommandKind kind : {CommandKind::kPower, CommandKind::kTrackSpeed})
    if (channels == trackChannels(kind)) return kind;
  return std::nullopt;
}

std::string describe(const CommandChannels& channels) {
  std::string text;
  for (const CommandChannel& channel : channels) {
    const std::string unit = unitOf(channel.kind);
    text += (text.empty() ? "" : ", ") + channel.name + " [" +
            (unit.empty() ? "1" : unit.substr(1)) + "]";
  }
  return text;
}

std::vector<Command> commandsOf(const std::vector<TrackCommand>& tracks) {
  return {tracks.begin(), tracks.end()};
}

std::vector<TrackCommand> tracksOf(const std::vector<Command>& commands) {
  std::vector<TrackCommand> tracks;
  tracks.reserve(commands.size());
  for (const Command& command : commands) tracks.push_back(command.tracks());
  return tracks;
}

}  // namespace tread
