// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/core/checksums.hpp"

namespace tread::motor {
namespace {

/// A non-reflected CRC of this many bits, bit by bit, because lines are short.
uint32_t crc(std::string_view bytes, int bits, uint32_t polynomial) {
  const uint32_t top = 1U << (bits - 1);
  uint32_t value = 0;
  for (const char byte : bytes) {
    value ^= static_cast<uint32_t>(static_cast<uint8_t>(byte)) << (bits - 8);
    for (int i = 0; i < 8; ++i) value = (value & top) != 0 ? (value << 1) ^ polynomial : value << 1;
  }
  return value & ((top << 1) - 1);
}

}  // namespace

uint8_t xorOf(std::string_view bytes) {
  uint32_t value = 0;
  for (const char byte : bytes) value ^= static_cast<uint8_t>(byte);
  return static_cast<uint8_t>(value);
}

uint8_t sum8(std::string_view bytes) {
  uint32_t value = 0;
  for (const char byte : bytes) value += static_cast<uint8_t>(byte);
  return static_cast<uint8_t>(value);
}

uint8_t crc8(std::string_view bytes) {
  return static_cast<uint8_t>(crc(bytes, 8, 0x07));
}

uint16_t crc16(std::string_view bytes) {
  return static_cast<uint16_t>(crc(bytes, 16, 0x1021));
}

}  // namespace tread::motor
