// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/vectornav/vectornav_message.hpp"

#include <optional>

#include "modules/ins_driver/core/bytes.hpp"

namespace tread::ins {
namespace {

constexpr char kSync = '\xFA';
constexpr size_t kCrc = 2;

/// Bytes of each field; 0: unknown. VN-300 User Manual, tables of the groups' fields.
constexpr uint8_t kLengths[kVnGroups][16] = {
    {8, 8, 8, 12, 16, 12, 24, 12, 12, 24, 20, 28, 2, 4, 8, 0},
    {8, 8, 8, 2, 8, 8, 8, 4, 4, 1, 0, 0, 0, 0, 0, 0},
    {2, 12, 12, 12, 4, 4, 16, 12, 12, 12, 12, 2, 40, 0, 0, 0},
    {8, 8, 2, 1, 1, 24, 24, 12, 12, 12, 4, 4, 2, 28, 0, 0},
    {2, 12, 16, 36, 12, 12, 12, 12, 12, 12, 28, 24, 12, 0, 0, 0},
    {2, 24, 24, 12, 12, 12, 12, 12, 12, 4, 4, 68, 64, 0, 0, 0},
    {8, 8, 2, 1, 1, 24, 24, 12, 12, 12, 4, 4, 2, 28, 0, 0}};

bool holds(unsigned mask, size_t bit) {
  return (mask >> bit & 1U) != 0;
}

/// Calls `visit(group, mask)` for each group; false if bytes of its mask are missing.
template <class Visit>
bool forEachGroup(std::string_view bytes, const Visit& visit) {
  const unsigned groups = numberAt<uint8_t>(bytes, 1);
  size_t at = 2;
  for (size_t group = 0; group < kVnGroups; ++group) {
    if (!holds(groups, group)) continue;
    if (at + 2 > bytes.size()) return false;
    visit(group, numberAt<uint16_t>(bytes, at));
    at += 2;
  }
  return true;
}

size_t headerLength(unsigned groups) {
  size_t length = 2;
  for (size_t group = 0; group < kVnGroups; ++group) length += holds(groups, group) ? 2 : 0;
  return length;
}

/// Length of all fields of a mask; nullopt if one of them is unknown.
std::optional<size_t> lengthOf(size_t group, unsigned mask) {
  size_t length = 0;
  for (size_t bit = 0; bit < 16; ++bit) {
    if (!holds(mask, bit)) continue;
    if (kLengths[group][bit] == 0) return std::nullopt;
    length += kLengths[group][bit];
  }
  return length;
}

}  // namespace

uint16_t vectornavCrc(std::string_view bytes) {
  unsigned crc = 0;
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned>(static_cast<uint8_t>(byte)) << 8;
    for (int bit = 0; bit < 8; ++bit) crc = (crc << 1 ^ ((crc & 0x8000U) != 0 ? 0x1021U : 0U));
    crc &= 0xFFFFU;
  }
  return static_cast<uint16_t>(crc);
}

FrameLook lookForVectornav(std::string_view bytes) {
  using Verdict = FrameLook::Verdict;
  if (bytes[0] != kSync) return {Verdict::kNoStart};
  if (bytes.size() < 2) return {Verdict::kNeedMore};
  const unsigned groups = numberAt<uint8_t>(bytes, 1);
  if (groups == 0) return {Verdict::kNoStart};
  if (groups >> kVnGroups != 0) return {Verdict::kRefused, 0, "group not known"};
  size_t size = headerLength(groups) + kCrc;
  bool known = true;
  const bool whole = forEachGroup(bytes, [&](size_t group, unsigned mask) {
    const std::optional<size_t> length = lengthOf(group, mask);
    known = known && length && mask != 0;
    size += length.value_or(0);
  });
  if (!known) return {Verdict::kRefused, 0, "field not known"};
  if (!whole || bytes.size() < size) return {Verdict::kNeedMore};
  if (vectornavCrc(bytes.substr(1, size - 1)) != 0) return {Verdict::kRefused, 0, "wrong checksum"};
  return {Verdict::kFrame, size};
}

VectornavFields::VectornavFields(std::string_view frame) {
  size_t at = headerLength(numberAt<uint8_t>(frame, 1));
  forEachGroup(frame, [&](size_t group, unsigned mask) {
    for (size_t bit = 0; bit < 16; ++bit) {
      if (!holds(mask, bit)) continue;
      fields_[group][bit] = frame.substr(at, kLengths[group][bit]);
      at += kLengths[group][bit];
    }
  });
}

}  // namespace tread::ins
