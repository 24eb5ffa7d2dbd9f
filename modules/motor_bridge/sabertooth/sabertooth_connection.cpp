// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/sabertooth/sabertooth_connection.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace tread::motor {
namespace {

constexpr char kBaudingCharacter = static_cast<char>(170);
constexpr int kForward[] = {0, 4};  // by motor; the next code is backwards
constexpr int kSerialTimeout = 14;
constexpr double kFullPower = 127.0;
constexpr int64_t kTimeoutStep = 100'000;  // [us]
constexpr int64_t kSetUpRepeat = 500'000;  // [us]

/// Power of a track, -127..127. NaN becomes zero: this is the last check.
int powerOf(double value, bool invert, double full_scale) {
  const double share = value / full_scale;
  if (!std::isfinite(share)) return 0;
  const auto power = static_cast<int>(std::lround(kFullPower * std::clamp(share, -1.0, 1.0)));
  return invert ? -power : power;
}

}  // namespace

SabertoothConfig readSabertoothConfig(ConfigReader& reader, const DriveDescription& drive) {
  SabertoothConfig config;
  config.full_scale = drive.fullCommand();
  config.left_motor = drive.left_channel;
  config.invert_left = drive.invert_left;
  config.invert_right = drive.invert_right;
  config.times.watchdog_us = 200'000;
  int64_t address = config.address;
  reader.integer("address", address, {128.0, 135.0}, "");
  config.address = static_cast<int>(address);
  reader.seconds("watchdog", config.times.watchdog_us, {0.2, 0.5});
  if (config.times.watchdog_us % kTimeoutStep != 0)
    throw reader.error("watchdog", "must be a multiple of 0.1 s");
  return config;
}

std::string sabertoothPacket(int address, int command, int value) {
  const int sum = (address + command + value) & 0x7f;
  return {static_cast<char>(address), static_cast<char>(command), static_cast<char>(value),
          static_cast<char>(sum)};
}

std::string SabertoothConnection::commandBytes(const TrackCommand& command) const {
  int first = powerOf(command.left, config_.invert_left, config_.full_scale);
  int second = powerOf(command.right, config_.invert_right, config_.full_scale);
  if (config_.left_motor == 2) std::swap(first, second);
  std::string bytes;
  for (const auto& [motor, power] : {std::pair(0, first), std::pair(1, second)})
    bytes += sabertoothPacket(config_.address, kForward[motor] + (power < 0), std::abs(power));
  return bytes;
}

std::string SabertoothConnection::setUp() const {
  const auto steps = static_cast<int>(times().watchdog_us / kTimeoutStep);
  return kBaudingCharacter + sabertoothPacket(config_.address, kSerialTimeout, steps);
}

std::string SabertoothConnection::startupRequest(int step) const {
  // Half a packet left by a killed predecessor is completed with zeros, or dropped for its
  // checksum.
  if (step == kBaud) return std::string(4, '\0') + kBaudingCharacter;
  return step == kTimeout ? setUp() : zero();
}

void SabertoothConnection::receive(std::string_view bytes, int64_t /*now*/) {
  unexpected_ += static_cast<int64_t>(bytes.size());
}

void SabertoothConnection::give(const Command& command, int64_t /*now*/) {
  output_ += commandBytes(command.tracks());
  ++commands_;
}

std::string SabertoothConnection::talk(int64_t now) {
  if (now - set_up_at_ >= kSetUpRepeat) {
    set_up_at_ = now;
    output_ += setUp();
  }
  return std::exchange(output_, {});
}

std::string SabertoothConnection::notice() const {
  return "a Sabertooth does not answer: its presence, reception, watchdog setting and faults "
         "cannot be verified; test its watchdog with the tracks off the ground";
}

std::map<std::string, int64_t> SabertoothConnection::counted() const {
  return {{"commands given", commands_}, {"unexpected bytes", unexpected_}};
}

}  // namespace tread::motor
