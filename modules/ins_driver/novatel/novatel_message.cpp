// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/novatel/novatel_message.hpp"

#include <array>

#include "modules/ins_driver/core/bytes.hpp"

namespace tread::ins {
namespace {

constexpr std::string_view kSync("\xAA\x44", 2);
constexpr char kLong = '\x12';
constexpr char kShort = '\x13';
constexpr size_t kShortHeader = 12;
constexpr size_t kLongHeader = 28;  // the fields of the manual; byte 3 may give a longer one
constexpr size_t kCrc = 4;

std::array<uint32_t, 256> makeCrcTable() {
  std::array<uint32_t, 256> table{};
  for (uint32_t i = 0; i < 256; ++i) {
    uint32_t crc = i;
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1) != 0 ? 0xEDB88320U : 0U);
    table[i] = crc;
  }
  return table;
}

// Ids and lengths: OEM7 Commands and Logs Reference Manual, "Logs" and "SPAN Logs".
constexpr NovatelType kTypes[] = {
    {42, 72, "BESTPOS", NovatelKind::kBestpos},
    {99, 44, "BESTVEL", NovatelKind::kBestvel},
    {507, 88, "INSPVA", NovatelKind::kInspva},
    {508, 88, "INSPVAS", NovatelKind::kInspva},
    {1465, 126, "INSPVAX", NovatelKind::kInspvax},
    {263, 40, "INSATT", NovatelKind::kInsatt},
    {319, 40, "INSATTS", NovatelKind::kInsatt},
    {971, 44, "HEADING", NovatelKind::kHeading},
    {812, 60, "CORRIMUDATA", NovatelKind::kCorrimu},
    {813, 60, "CORRIMUDATAS", NovatelKind::kCorrimu},
};

}  // namespace

uint32_t novatelCrc(std::string_view bytes) {
  static const std::array<uint32_t, 256> kTable = makeCrcTable();
  uint32_t crc = 0;
  for (const char byte : bytes) crc = crc >> 8 ^ kTable[(crc ^ static_cast<uint8_t>(byte)) & 0xFF];
  return crc;
}

FrameLook lookForNovatel(std::string_view bytes) {
  using Verdict = FrameLook::Verdict;
  const size_t compared = std::min(bytes.size(), kSync.size());
  if (bytes.substr(0, compared) != kSync.substr(0, compared)) return {Verdict::kNoStart};
  if (bytes.size() > 2 && bytes[2] != kLong && bytes[2] != kShort) return {Verdict::kNoStart};
  if (bytes.size() < kShortHeader) return {Verdict::kNeedMore};
  const bool is_long = bytes[2] == kLong;
  const size_t told = numberAt<uint8_t>(bytes, 3);
  if (is_long && told < kLongHeader) return {Verdict::kRefused, 0, "header too short"};
  const size_t header = is_long ? told : kShortHeader;
  const size_t body = is_long ? numberAt<uint16_t>(bytes, 8) : told;
  const size_t size = header + body + kCrc;
  if (size > kMaxFrame) return {Verdict::kRefused, 0, "too long"};
  if (bytes.size() < size) return {Verdict::kNeedMore};
  const auto crc = numberAt<uint32_t>(bytes, header + body);
  if (novatelCrc(bytes.substr(0, header + body)) != crc)
    return {Verdict::kRefused, 0, "wrong checksum"};
  return {Verdict::kFrame, size};
}

NovatelFrame frameOf(std::string_view frame) {
  const bool is_long = frame[2] == kLong;
  const size_t header = is_long ? numberAt<uint8_t>(frame, 3) : kShortHeader;
  NovatelFrame parts;
  parts.id = numberAt<uint16_t>(frame, 4);
  parts.body = frame.substr(header, frame.size() - header - kCrc);
  parts.week = numberAt<uint16_t>(frame, is_long ? 14 : 6);
  parts.time_of_week = int64_t{numberAt<uint32_t>(frame, is_long ? 16 : 8)} * 1000;
  if (is_long) parts.time_status = numberAt<uint8_t>(frame, 13);
  return parts;
}

const NovatelType* typeOfId(uint16_t id) {
  for (const NovatelType& type : kTypes) {
    if (type.id == id) return &type;
  }
  return nullptr;
}

}  // namespace tread::ins
