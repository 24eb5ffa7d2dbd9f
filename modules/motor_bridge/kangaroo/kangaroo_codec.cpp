// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/kangaroo/kangaroo_codec.hpp"

#include <algorithm>
#include <cstdlib>

namespace tread::motor {
namespace {

constexpr int kMostData = 32;
constexpr int kFrame = 5;  // address, command, length, two bytes of checksum
constexpr int kSystemTimeout = 33;
constexpr uint8_t kErrorFlag = 0x01, kEchoFlag = 0x10, kSequenceFlag = 0x40;

/// Over the lower seven bits of each byte, lowest first.
uint16_t checksumOf(std::string_view bytes) {
  constexpr uint16_t kAll = 0x3fff, kPolynomial = 0x22f0;
  uint16_t sum = kAll;
  for (const char byte : bytes) {
    sum = static_cast<uint16_t>(sum ^ (byte & 0x7f));
    for (int bit = 0; bit < 7; ++bit)
      sum = static_cast<uint16_t>(sum & 1 ? (sum >> 1) ^ kPolynomial : sum >> 1);
  }
  return sum ^ kAll;
}

std::string sealed(std::string packet) {
  const uint16_t sum = checksumOf(packet);
  packet += static_cast<char>(sum & 0x7f);
  packet += static_cast<char>(sum >> 7);
  return packet;
}

/// Data of a command to a channel: its name without flags.
std::string dataFor(char channel) {
  return {channel, '\0'};
}

}  // namespace

std::string describe(KangarooError error) {
  switch (error) {
    case KangarooError::kNotStarted:
      return "is not started";
    case KangarooError::kNotHomed:
      return "is not homed: tune it for speeds (DEScribe)";
    case KangarooError::kControl:
      return "has lost control of its motor: check encoder, motor and Sabertooth, then arm again";
    case KangarooError::kWrongMode:
      return "is tuned for another mode than its switches select";
    case KangarooError::kBadParameter:
      return "refuses a parameter";
    case KangarooError::kSerialTimeout:
      return "was stopped by its serial timeout";
  }
  return "has the unknown error " + std::to_string(static_cast<int32_t>(error));
}

std::string kangarooPacket(int address, KangarooCommand command, std::string_view data) {
  std::string packet{static_cast<char>(address), static_cast<char>(command),
                     static_cast<char>(data.size())};
  return sealed(packet.append(data));
}

std::string kangarooNumber(int64_t value) {
  constexpr int64_t kLargest = (1 << 29) - 1;
  const int64_t held = std::clamp(value, -kLargest, kLargest);
  std::string bytes;
  int64_t left = 2 * std::abs(held) + (held < 0);
  do {
    bytes += static_cast<char>((left & 0x3f) | (left > 0x3f ? 0x40 : 0));
    left >>= 6;
  } while (left > 0);
  return bytes;
}

std::string kangarooStart(int address, char channel) {
  return kangarooPacket(address, KangarooCommand::kStart, dataFor(channel));
}

std::string kangarooSpeed(int address, char channel, int64_t speed) {
  return kangarooPacket(address, KangarooCommand::kMove,
                        dataFor(channel) + kKangarooSpeed + kangarooNumber(speed));
}

std::string kangarooGetSpeed(int address, char channel) {
  return kangarooPacket(address, KangarooCommand::kGet, dataFor(channel) + kKangarooSpeed);
}

std::string kangarooTimeout(int address, int sixteenths) {
  return kangarooPacket(
      address, KangarooCommand::kSystem,
      dataFor('1') + static_cast<char>(kSystemTimeout) + kangarooNumber(sixteenths));
}

std::vector<KangarooPackets::Packet> KangarooPackets::push(std::string_view bytes) {
  std::vector<Packet> packets;
  for (const char byte : bytes) {
    const int value = static_cast<unsigned char>(byte);
    if (value > 0x7f) {
      garbage_bytes_ += static_cast<int64_t>(packet_.size());
      packet_.clear();
    }
    if (packet_.empty() && value != address_) {
      ++garbage_bytes_;
      continue;
    }
    packet_ += byte;
    if (packet_.size() < 3) continue;
    if (packet_[2] > kMostData) {
      garbage_bytes_ += static_cast<int64_t>(packet_.size());
      packet_.clear();
      continue;
    }
    const auto length = static_cast<size_t>(packet_[2]);
    if (packet_.size() < length + kFrame) continue;
    if (sealed(packet_.substr(0, length + 3)) == packet_)
      packets.push_back({packet_[1], packet_.substr(3, length)});
    else
      ++bad_checksums_;
    packet_.clear();
  }
  return packets;
}

bool readKangarooNumber(std::string_view data, size_t& offset, int32_t& value) {
  constexpr int kMostBits = 30;
  int64_t number = 0;
  for (int shift = 0; shift < kMostBits; shift += 6) {
    if (offset >= data.size()) return false;
    const char byte = data[offset++];
    number |= static_cast<int64_t>(byte & 0x3f) << shift;
    if ((byte & 0x40) != 0) continue;
    value = static_cast<int32_t>(number & 1 ? -(number >> 1) : number >> 1);
    return true;
  }
  return false;
}

bool readKangarooStatus(const KangarooPackets::Packet& packet, KangarooStatus& status) {
  const std::string& data = packet.data;
  if (packet.command != static_cast<int>(KangarooCommand::kStatus) || data.size() < 2) return false;
  status.channel = data[0];
  const auto flags = static_cast<uint8_t>(data[1]);
  size_t offset = 2;
  offset += (flags & kEchoFlag) != 0;
  offset += (flags & kSequenceFlag) != 0;
  if (offset >= data.size() || data[offset++] != kKangarooSpeed) return false;
  status.error = (flags & kErrorFlag) != 0;
  if (!readKangarooNumber(data, offset, status.value)) return false;
  return !status.error || status.value > 0;
}

}  // namespace tread::motor
