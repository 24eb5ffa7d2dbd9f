// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string_view>

namespace tread::motor {

/// All bytes combined by exclusive or, as in NMEA 0183.
uint8_t xorOf(std::string_view bytes);
/// Sum of all bytes, modulo 256.
uint8_t sum8(std::string_view bytes);
/// CRC-8/SMBUS: polynomial 0x07, initial value 0, not reflected.
uint8_t crc8(std::string_view bytes);
/// CRC-16/XMODEM: polynomial 0x1021, initial value 0, not reflected.
uint16_t crc16(std::string_view bytes);

}  // namespace tread::motor
