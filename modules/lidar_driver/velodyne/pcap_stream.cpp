// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/lidar_driver/velodyne/pcap_stream.hpp"

namespace tread::lidar {
namespace {

constexpr size_t kFileHeader = 24;
constexpr size_t kRecordHeader = 16;
constexpr size_t kLongestFrame = 262'144;
constexpr uint32_t kMicroseconds = 0xA1B2C3D4;
constexpr uint32_t kNanoseconds = 0xA1B23C4D;
constexpr uint32_t kNewFormat = 0x0A0D0D0A;  // reads the same both ways

uint32_t byteAt(std::string_view bytes, size_t at) {
  return static_cast<unsigned char>(bytes[at]);
}
uint32_t bigEndian16(std::string_view bytes, size_t at) {
  return byteAt(bytes, at) << 8 | byteAt(bytes, at + 1);
}
uint32_t littleEndian32(std::string_view bytes, size_t at) {
  return byteAt(bytes, at) | byteAt(bytes, at + 1) << 8 | byteAt(bytes, at + 2) << 16 |
         byteAt(bytes, at + 3) << 24;
}
uint32_t reversed(uint32_t value) {
  return value >> 24 | (value >> 8 & 0xFF00U) | (value << 8 & 0xFF0000U) | value << 24;
}

/// Where IPv4 begins in a frame; nothing for other contents.
std::optional<size_t> internetAt(uint32_t link_type, std::string_view frame) {
  constexpr uint32_t kIpv4 = 0x0800;
  constexpr uint32_t kVlan = 0x8100;
  size_t type = 0;
  switch (link_type) {
    case 101:  // bare IP
      return 0;
    case 1:
      type = 12;
      if (frame.size() >= 18 && bigEndian16(frame, type) == kVlan) type += 4;
      break;
    case 113:  // Linux cooked
      type = 14;
      break;
    default:
      return std::nullopt;
  }
  if (frame.size() < type + 2 || bigEndian16(frame, type) != kIpv4) return std::nullopt;
  return type + 2;
}

}  // namespace

bool PcapStream::begins(std::string_view bytes) {
  if (bytes.size() < 4) return false;
  const uint32_t magic = littleEndian32(bytes, 0);
  for (const uint32_t known : {kMicroseconds, kNanoseconds, kNewFormat})
    if (magic == known || reversed(magic) == known) return true;
  return false;
}

uint32_t PcapStream::number(size_t at) const {
  const uint32_t value = littleEndian32(buffer_, at);
  return swapped_ ? reversed(value) : value;
}

bool PcapStream::readHeader() {
  if (buffer_.size() < kFileHeader) return false;
  const uint32_t magic = littleEndian32(buffer_, 0);
  if (magic == kNewFormat) {
    problem_ = "the capture is in the pcapng format; write it anew with editcap -F pcap";
    return false;
  }
  swapped_ = magic != kMicroseconds && magic != kNanoseconds;
  nanoseconds_ = number(0) == kNanoseconds;
  if (!nanoseconds_ && number(0) != kMicroseconds) {
    problem_ = "the file is no capture: its first bytes are not those of pcap";
    return false;
  }
  link_type_ = number(20) & 0xFFFFU;
  buffer_.erase(0, kFileHeader);
  header_read_ = true;
  return true;
}

std::optional<CapturedDatagram> PcapStream::next() {
  if (!problem_.empty() || (!header_read_ && !readHeader())) return std::nullopt;
  while (buffer_.size() >= kRecordHeader) {
    const size_t length = number(8);
    if (length > kLongestFrame) {
      problem_ = "the capture is damaged: a frame of " + std::to_string(length) + " bytes";
      return std::nullopt;
    }
    if (buffer_.size() < kRecordHeader + length) return std::nullopt;
    const int64_t fraction = number(4);
    const int64_t time = int64_t{1'000'000} * number(0) + fraction / (nanoseconds_ ? 1000 : 1);
    auto payload = payloadOf(std::string_view(buffer_).substr(kRecordHeader, length));
    buffer_.erase(0, kRecordHeader + length);
    if (payload) return CapturedDatagram{time, std::move(*payload)};
  }
  return std::nullopt;
}

std::optional<std::string> PcapStream::payloadOf(std::string_view frame) {
  const auto leaveOut = [&](const char* what) {
    ++counters_[what];
    return std::nullopt;
  };
  const auto begin = internetAt(link_type_, frame);
  if (!begin) return leaveOut("captured frames without IPv4");
  const std::string_view packet = frame.substr(*begin);
  if (packet.size() < 20 || byteAt(packet, 0) >> 4 != 4)
    return leaveOut("captured frames without IPv4");
  const size_t header = 4 * (byteAt(packet, 0) & 0xFU);
  const bool udp = byteAt(packet, 9) == 17;
  const bool fragment = (bigEndian16(packet, 6) & 0x3FFFU) != 0;
  if (!udp || header < 20) return leaveOut("captured packets that are no UDP");
  if (fragment || packet.size() < header + 8)
    return leaveOut("captured datagrams that are not whole");
  const size_t length = bigEndian16(packet, header + 4);
  if (length < 8 || packet.size() < header + length)
    return leaveOut("captured datagrams that are not whole");
  return std::string(packet.substr(header + 8, length - 8));
}

}  // namespace tread::lidar
