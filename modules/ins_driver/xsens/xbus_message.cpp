// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/xsens/xbus_message.hpp"

#include <array>
#include <cstring>

namespace tread::ins {
namespace {

constexpr uint8_t kPreamble = 0xFA;
constexpr uint8_t kBus = 0xFF;
constexpr uint8_t kMtData2 = 0x36;
constexpr uint8_t kLongLength = 0xFF;  // the length follows in two bytes
constexpr size_t kHeader = 4;
constexpr size_t kLongHeader = 6;

constexpr unsigned kNumberFormat = 0x3;
constexpr unsigned kCoordinates = 0xC;  // 0: east, north, up
constexpr std::array<size_t, 4> kNumberLengths{4, 4, 6, 8};

size_t headerOf(std::string_view message) {
  return bigEndianAt<uint8_t>(message, 3) == kLongLength ? kLongHeader : kHeader;
}

size_t dataLength(std::string_view message) {
  return headerOf(message) == kLongHeader ? bigEndianAt<uint16_t>(message, 4)
                                          : bigEndianAt<uint8_t>(message, 3);
}

double numberOf(unsigned format, std::string_view bytes) {
  switch (format) {
    case 0: {
      const auto bits = bigEndianAt<uint32_t>(bytes, 0);
      float number = 0.0F;
      std::memcpy(&number, &bits, sizeof number);
      return static_cast<double>(number);
    }
    case 1:  // 12.20
      return bigEndianAt<int32_t>(bytes, 0) / 1048576.0;
    case 2:  // 16.32: the 32 bits after the point come first
      return bigEndianAt<int16_t>(bytes, 4) + bigEndianAt<uint32_t>(bytes, 0) / 4294967296.0;
    default: {
      const auto bits = bigEndianAt<uint64_t>(bytes, 0);
      double number = 0.0;
      std::memcpy(&number, &bits, sizeof number);
      return number;
    }
  }
}

}  // namespace

FrameLook lookForXbus(std::string_view bytes) {
  using Verdict = FrameLook::Verdict;
  if (bigEndianAt<uint8_t>(bytes, 0) != kPreamble) return {Verdict::kNoStart};
  if (bytes.size() > 1 && bigEndianAt<uint8_t>(bytes, 1) != kBus) return {Verdict::kNoStart};
  if (bytes.size() < kLongHeader) return {Verdict::kNeedMore};
  const size_t size = headerOf(bytes) + dataLength(bytes) + 1;
  if (size > kMaxFrame) return {Verdict::kRefused, 0, "too long"};
  if (bytes.size() < size) return {Verdict::kNeedMore};
  uint8_t sum = 0;
  for (const char byte : bytes.substr(1, size - 1))
    sum = static_cast<uint8_t>(sum + static_cast<uint8_t>(byte));
  if (sum != 0) return {Verdict::kRefused, 0, "wrong checksum"};
  return {Verdict::kFrame, size};
}

std::optional<XbusFields> XbusFields::of(std::string_view frame) {
  if (bigEndianAt<uint8_t>(frame, 2) != kMtData2) return std::nullopt;
  const std::string_view data = frame.substr(headerOf(frame), dataLength(frame));
  XbusFields fields;
  size_t at = 0;
  while (at < data.size()) {
    if (at + 3 > data.size()) return std::nullopt;
    const auto id = bigEndianAt<uint16_t>(data, at);
    const size_t length = bigEndianAt<uint8_t>(data, at + 2);
    at += 3;
    if (at + length > data.size()) return std::nullopt;
    fields.fields_[static_cast<XbusData>(id & 0xFFF0U)] = {id & 0xFU, data.substr(at, length)};
    at += length;
  }
  return fields;
}

std::vector<double> XbusFields::numbers(XbusData data, size_t count) const {
  std::vector<double> numbers;
  const auto found = fields_.find(data);
  if (found == fields_.end()) return numbers;
  const auto& [format, bytes] = found->second;
  const size_t length = kNumberLengths[format & kNumberFormat];
  if (bytes.size() != count * length) return numbers;
  for (size_t i = 0; i < count; ++i)
    numbers.push_back(numberOf(format & kNumberFormat, bytes.substr(i * length, length)));
  return numbers;
}

std::string_view XbusFields::bytes(XbusData data, size_t length) const {
  const auto found = fields_.find(data);
  if (found == fields_.end() || found->second.bytes.size() != length) return {};
  return found->second.bytes;
}

bool XbusFields::eastNorthUp() const {
  for (const XbusData data : {XbusData::kQuaternion, XbusData::kEulerAngles, XbusData::kVelocity}) {
    const auto found = fields_.find(data);
    if (found != fields_.end() && (found->second.format & kCoordinates) != 0) return false;
  }
  return true;
}

}  // namespace tread::ins
