// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <cstring>
#include <string>

namespace tread::mcap {

// The container's records (mcap.dev/spec): an opcode, a length of 8 bytes, the content; all numbers
// little-endian, texts and maps behind a length of 4 bytes.

inline constexpr char kMagic[] = "\x89MCAP0\r\n";
inline constexpr size_t kMagicBytes = 8;

enum class Op : uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F
};

/// Appends a record's fields.
class FieldWriter {
 public:
  FieldWriter& u8(uint8_t value) { return number(value, 1); }
  FieldWriter& u16(uint16_t value) { return number(value, 2); }
  FieldWriter& u32(uint32_t value) { return number(value, 4); }
  FieldWriter& u64(uint64_t value) { return number(value, 8); }
  FieldWriter& text(const std::string& value) {
    u32(static_cast<uint32_t>(value.size()));
    bytes += value;
    return *this;
  }
  std::string bytes;

 private:
  FieldWriter& number(uint64_t value, int size) {
    for (int i = 0; i < size; ++i) bytes += static_cast<char>(value >> (8 * i));
    return *this;
  }
};

/// A whole record.
std::string recordOf(Op op, const std::string& content);

/// Reads a record's fields; ok() becomes false if they end too early.
class FieldReader {
 public:
  FieldReader(const char* begin, size_t size) : at_(begin), end_(begin + size) {}

  uint16_t u16() { return static_cast<uint16_t>(number(2)); }
  uint32_t u32() { return static_cast<uint32_t>(number(4)); }
  uint64_t u64() { return number(8); }
  std::string text() { return bytes(u32()); }
  std::string bytes(uint64_t size);
  std::string rest() { return bytes(static_cast<uint64_t>(end_ - at_)); }
  bool ok() const { return ok_; }

 private:
  uint64_t number(size_t size);

  const char* at_;
  const char* end_;
  bool ok_ = true;
};

/// IEEE CRC-32 of the bytes, continued from `crc`.
uint32_t crc32Of(const std::string& bytes, uint32_t crc = 0);

}  // namespace tread::mcap
