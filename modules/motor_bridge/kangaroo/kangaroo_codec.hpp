// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tread::motor {

// Packet serial of a Kangaroo x2 motion controller (Dimension Engineering, Packet Serial
// Reference): address 128..135, command, length, data, checksum of 14 bits. Only the address has
// its highest bit set, so it always begins a packet.

/// Commands, and the one kind of reply.
enum class KangarooCommand : uint8_t {
  kStart = 0x20,
  kGet = 0x23,
  kMove = 0x24,
  kSystem = 0x25,
  kStatus = 0x43
};

/// Error codes in a status, as in the protocol.
enum class KangarooError : int32_t {
  kNotStarted = 1,
  kNotHomed = 2,
  kControl = 3,
  kWrongMode = 4,
  kBadParameter = 5,
  kSerialTimeout = 6
};

/// An error in words for people.
std::string describe(KangarooError error);

/// One whole packet; data of at most 32 bytes, each below 128.
std::string kangarooPacket(int address, KangarooCommand command, std::string_view data);
/// A number encoded for the data: the sign in the lowest bit, 6 bits per byte, lowest first.
/// Clamped to +-(2^29 - 1).
std::string kangarooNumber(int64_t value);

/// Starts a channel ('1' or '2'), which accepts no command before; clears the cause of its stop.
std::string kangarooStart(int address, char channel);
/// Sets a channel's speed [units/s].
std::string kangarooSpeed(int address, char channel, int64_t speed);
/// Queries a channel's speed.
std::string kangarooGetSpeed(int address, char channel);
/// The controller stops after this time without a packet [s/16]; 0 and below: never.
std::string kangarooTimeout(int address, int sixteenths);

/// A channel's answer.
struct KangarooStatus {
  char channel = 0;
  bool error = false;  ///< value is a KangarooError, else the speed [units/s]
  int32_t value = 0;
};

/// Splits a byte stream into packets of one address; damaged ones are counted and dropped.
class KangarooPackets {
 public:
  struct Packet {
    int command = 0;
    std::string data;
  };

  explicit KangarooPackets(int address) : address_(address) {}

  std::vector<Packet> push(std::string_view bytes);
  void clear() { packet_.clear(); }
  int64_t badChecksums() const { return bad_checksums_; }
  /// Bytes outside of packets, and of truncated packets.
  int64_t garbageBytes() const { return garbage_bytes_; }

 private:
  int address_;
  std::string packet_;  ///< so far
  int64_t bad_checksums_ = 0;
  int64_t garbage_bytes_ = 0;
};

/// Reads the data of a status. False if it is not that of a speed.
bool readKangarooStatus(const KangarooPackets::Packet& packet, KangarooStatus& status);
/// Reads a number at an offset and advances the offset. False if the data end within it.
bool readKangarooNumber(std::string_view data, size_t& offset, int32_t& value);

/// Code of a speed in Get and Move.
inline constexpr char kKangarooSpeed = 2;

}  // namespace tread::motor
