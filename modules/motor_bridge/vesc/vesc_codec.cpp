// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/vesc/vesc_codec.hpp"

#include <algorithm>
#include <array>

#include "modules/motor_bridge/core/checksums.hpp"

namespace tread::motor {
namespace {

constexpr char kShortStart = 2;
constexpr char kLongStart = 3;
constexpr char kEnd = 3;
constexpr uint32_t kExtendedFrame = 0x80000000U;
constexpr uint32_t kIdentifierBits = 0x1fffffffU;

std::string bigEndian(uint32_t value, int bytes) {
  std::string text;
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8)
    text += static_cast<char>(value >> shift);
  return text;
}

uint32_t wordAt(std::string_view bytes, size_t at, size_t size) {
  uint32_t value = 0;
  for (size_t i = at; i < at + size; ++i) value = value << 8 | static_cast<uint8_t>(bytes[i]);
  return value;
}

double int16At(std::string_view bytes, size_t at) {
  return static_cast<int16_t>(wordAt(bytes, at, 2));
}

double int32At(std::string_view bytes, size_t at) {
  return static_cast<int32_t>(wordAt(bytes, at, 4));
}

/// A packet at the front of a buffer: size of its header and of the whole; nullopt while the header
/// is incomplete, size 0 if there is none.
struct Framing {
  size_t header = 0;
  size_t payload = 0;
};
std::optional<Framing> framingOf(std::string_view buffer, size_t most) {
  if (buffer[0] != kShortStart && buffer[0] != kLongStart) return Framing{};
  const size_t header = buffer[0] == kShortStart ? 2 : 3;
  if (buffer.size() < header) return std::nullopt;
  const size_t payload = wordAt(buffer, 1, header - 1);
  const bool good = payload > 0 && payload <= most;
  return good ? Framing{header, payload} : Framing{};
}

bool isFrame(std::string_view frame) {
  const bool extended = (static_cast<uint8_t>(frame[3]) & 0x80U) != 0;
  return extended && static_cast<uint8_t>(frame[4]) <= 8 && frame[5] == 0 && frame[6] == 0;
}

std::optional<VescReading> readingOf(std::string_view frame) {
  uint32_t identifier = 0;
  for (size_t i = 4; i-- > 0;) identifier = identifier << 8 | static_cast<uint8_t>(frame[i]);
  identifier &= kIdentifierBits;
  VescReading reading;
  reading.id = static_cast<int>(identifier & 0xff);
  const size_t length = static_cast<uint8_t>(frame[4]);
  const std::string_view body = frame.substr(8, length);
  constexpr uint32_t kStatus = 9, kStatus4 = 16, kStatus5 = 27;
  if (identifier >> 8 == kStatus && length == 8) {
    reading.erpm = int32At(body, 0);
    reading.motor_current = int16At(body, 4) / 10.0;
  } else if (identifier >> 8 == kStatus4 && length == 8) {
    reading.temperature = std::max(int16At(body, 0), int16At(body, 2)) / 10.0;
  } else if (identifier >> 8 == kStatus5 && length >= 6) {
    reading.voltage = int16At(body, 4) / 10.0;
  } else {
    return std::nullopt;
  }
  return reading;
}

}  // namespace

std::string vescFault(int code) {
  static constexpr std::array<const char*, 8> kNames{"",
                                                     "overvoltage",
                                                     "undervoltage",
                                                     "gate driver",
                                                     "overcurrent",
                                                     "power stage too hot",
                                                     "motor too hot",
                                                     "gate driver overvoltage"};
  if (code >= 0 && code < static_cast<int>(kNames.size())) return kNames[static_cast<size_t>(code)];
  return "fault " + std::to_string(code);
}

bool isVoltageFault(int code) {
  constexpr int kOvervoltage = 1, kUndervoltage = 2;
  return code == kOvervoltage || code == kUndervoltage;
}

std::string vescPacket(std::string_view payload) {
  const auto size = static_cast<uint32_t>(payload.size());
  std::string packet(1, size < 256 ? kShortStart : kLongStart);
  packet += bigEndian(size, size < 256 ? 1 : 2);
  packet += payload;
  return packet + bigEndian(crc16(payload), 2) + kEnd;
}

std::vector<std::string> VescPackets::push(std::string_view bytes) {
  std::vector<std::string> payloads;
  buffer_ += bytes;
  size_t at = 0;
  while (at < buffer_.size()) {
    const std::string_view rest = std::string_view(buffer_).substr(at);
    const std::optional<Framing> framing = framingOf(rest, most_);
    if (!framing) break;
    const size_t body = framing->header + framing->payload;
    if (framing->header > 0 && rest.size() < body + 3) break;
    const std::string_view payload = rest.substr(framing->header, framing->payload);
    const bool good =
        framing->header > 0 && rest[body + 2] == kEnd && wordAt(rest, body, 2) == crc16(payload);
    if (good) payloads.emplace_back(payload);
    bad_checksums_ += framing->header > 0 && !good;
    garbage_ += !good;
    // A false start may hide the next packet: only its first byte is dropped.
    at += good ? body + 3 : 1;
  }
  buffer_.erase(0, at);
  return payloads;
}

std::string vescPayload(const VescCommand& command) {
  if (command.kind == VescCommand::Kind::kServo)
    return std::string(1, static_cast<char>(kCommSetServo)) +
           bigEndian(static_cast<uint32_t>(command.value), 2);
  const uint8_t comm = command.kind == VescCommand::Kind::kDuty           ? kCommSetDuty
                       : command.kind == VescCommand::Kind::kBrakeCurrent ? kCommSetBrakeCurrent
                                                                          : kCommSetRpm;
  return std::string(1, static_cast<char>(comm)) +
         bigEndian(static_cast<uint32_t>(command.value), 4);
}

std::string vescForwarded(int id, std::string_view payload) {
  return std::string{static_cast<char>(kCommForwardCan), static_cast<char>(id)} +
         std::string(payload);
}

std::optional<VescReading> vescValues(std::string_view payload) {
  // Offsets after the command byte: temperatures 0 and 2 [0.1 degC], motor current 4 [0.01 A], erpm
  // 22, battery 26 [0.1 V], fault 52, id 57.
  constexpr size_t kSmallest = 59;
  if (payload.size() < kSmallest || payload[0] != kCommGetValues) return std::nullopt;
  const std::string_view body = payload.substr(1);
  VescReading reading;
  reading.temperature = std::max(int16At(body, 0), int16At(body, 2)) / 10.0;
  reading.motor_current = int32At(body, 4) / 100.0;
  reading.erpm = int32At(body, 22);
  reading.voltage = int16At(body, 26) / 10.0;
  reading.fault = static_cast<uint8_t>(body[52]);
  reading.id = static_cast<uint8_t>(body[57]);
  return reading;
}

std::optional<VescTimeout> vescTimeout(std::string_view payload) {
  if (payload.size() < 10 || payload[0] != kCommGetAppConfiguration) return std::nullopt;
  return VescTimeout{static_cast<uint8_t>(payload[5]), wordAt(payload, 6, 4)};
}

std::string vescFrame(int id, const VescCommand& command) {
  const uint32_t packet = command.kind == VescCommand::Kind::kDuty           ? 0
                          : command.kind == VescCommand::Kind::kBrakeCurrent ? 2
                                                                             : 3;
  const uint32_t identifier = kExtendedFrame | packet << 8 | static_cast<uint32_t>(id);
  std::string frame;
  for (int shift = 0; shift < 32; shift += 8) frame += static_cast<char>(identifier >> shift);
  frame += std::string{4, 0, 0, 0} + bigEndian(static_cast<uint32_t>(command.value), 4);
  frame.resize(VescFrames::kFrameSize, '\0');
  return frame;
}

std::vector<VescReading> VescFrames::push(std::string_view bytes) {
  std::vector<VescReading> readings;
  buffer_ += bytes;
  size_t at = 0;
  while (buffer_.size() - at >= kFrameSize) {
    const std::string_view frame = std::string_view(buffer_).substr(at, kFrameSize);
    const bool good = isFrame(frame);
    at += good ? kFrameSize : 1;
    garbage_ += !good;
    if (!good) continue;
    const std::optional<VescReading> reading = readingOf(frame);
    if (reading) readings.push_back(*reading);
    others_ += !reading;
  }
  buffer_.erase(0, at);
  return readings;
}

}  // namespace tread::motor
