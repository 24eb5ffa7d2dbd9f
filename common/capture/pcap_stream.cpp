// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/capture/pcap_stream.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tread {
namespace {

constexpr size_t kFileHeader = 24;
constexpr size_t kRecordHeader = 16;
constexpr size_t kLongestFrame = 262'144;
constexpr size_t kLongestBlock = 16 << 20;  // of another kind than frames
constexpr size_t kMostStreams = 1000;
constexpr uint32_t kMicroseconds = 0xA1B2C3D4;
constexpr uint32_t kNanoseconds = 0xA1B23C4D;
constexpr const char* kRepair = "; record it again, or repair it with pcapfix";
constexpr uint32_t kGzip = 0x8B1F;
constexpr uint32_t kSection = 0x0A0D0D0A;  // reads the same both ways
constexpr uint32_t kSectionOrder = 0x1A2B3C4D;

uint32_t byteAt(std::string_view bytes, size_t at) {
  return static_cast<unsigned char>(bytes[at]);
}
uint32_t bigEndian16(std::string_view bytes, size_t at) {
  return byteAt(bytes, at) << 8 | byteAt(bytes, at + 1);
}
uint32_t bigEndian32(std::string_view bytes, size_t at) {
  return bigEndian16(bytes, at) << 16 | bigEndian16(bytes, at + 2);
}
uint32_t reversed(uint32_t value) {
  return value >> 24 | (value >> 8 & 0xFF00U) | (value << 8 & 0xFF0000U) | value << 24;
}
uint32_t littleEndian32(std::string_view bytes, size_t at) {
  return reversed(bigEndian32(bytes, at));
}

/// Position of the type field and of the contents in a frame, by its link layer.
std::optional<std::pair<size_t, size_t>> contentsOf(uint32_t link_type) {
  switch (link_type) {
    case 1:
      return {{12, 14}};  // Ethernet
    case 113:
      return {{14, 16}};  // Linux cooked
    case 276:
      return {{0, 20}};  // the same, version 2
    default:
      return std::nullopt;
  }
}

/// Where IPv4 begins in a frame; nullopt for other contents.
std::optional<size_t> internetAt(uint32_t link_type, std::string_view frame) {
  constexpr uint32_t kIpv4 = 0x0800;
  if (link_type == 101 || link_type == 228) return 0;  // bare IP
  if (link_type == 0 || link_type == 108) return 4;    // loopback: four bytes of the family
  auto [type_at, at] = *contentsOf(link_type);
  if (frame.size() < at) return std::nullopt;
  uint32_t type = bigEndian16(frame, type_at);
  // A VLAN tag, or two of them (QinQ): two bytes, then the type of the contents.
  for (; type == 0x8100 || type == 0x88A8 || type == 0x9100; at += 4) {
    if (frame.size() < at + 4) return std::nullopt;
    type = bigEndian16(frame, at + 2);
  }
  return type == kIpv4 ? std::optional(at) : std::nullopt;
}

bool isKnown(uint32_t link_type) {
  for (const uint32_t bare : {0U, 101U, 108U, 228U})
    if (link_type == bare) return true;
  return contentsOf(link_type).has_value();
}

std::string endOf(std::string_view packet, size_t address, uint32_t port) {
  std::string text;
  for (size_t i = 0; i < 4; ++i)
    text += std::to_string(byteAt(packet, address + i)) + (i < 3 ? "." : ":");
  return text + std::to_string(port);
}

}  // namespace

bool PcapStream::begins(std::string_view bytes) {
  if (bytes.size() < 4) return false;
  const uint32_t magic = littleEndian32(bytes, 0);
  for (const uint32_t known : {kMicroseconds, kNanoseconds, kSection})
    if (magic == known || reversed(magic) == known) return true;
  return (magic & 0xFFFFU) == kGzip;
}

std::map<std::string, int64_t> PcapStream::takeLeftOut() {
  return std::exchange(left_out_, {});
}

std::nullopt_t PcapStream::leaveOut(const std::string& what) {
  ++left_out_[what];
  return std::nullopt;
}

uint32_t PcapStream::number(size_t at) const {
  const uint32_t value = littleEndian32(buffer_, at);
  return swapped_ ? reversed(value) : value;
}

uint32_t PcapStream::shortNumber(size_t at) const {
  const uint32_t value = bigEndian16(buffer_, at);
  return swapped_ ? value : (value >> 8 | (value & 0xFFU) << 8);
}

bool PcapStream::readHeader() {
  if (buffer_.size() < kFileHeader) return false;
  const uint32_t magic = littleEndian32(buffer_, 0);
  blocks_ = magic == kSection;
  header_read_ = true;
  if (blocks_) return true;
  swapped_ = magic != kMicroseconds && magic != kNanoseconds;
  const bool nanoseconds = number(0) == kNanoseconds;
  if (!nanoseconds && number(0) != kMicroseconds) {
    problem_ =
        (magic & 0xFFFFU) == kGzip
            ? "the capture is gzipped; unpack it with gunzip"
            : "the file is no capture; its first bytes are neither those of pcap nor of pcapng";
    return false;
  }
  interfaces_ = {{number(20) & 0xFFFFU, 0, nanoseconds ? 1000.0 : 1.0}};
  buffer_.erase(0, kFileHeader);
  return true;
}

std::optional<CapturedPayload> PcapStream::next() {
  if (!problem_.empty() || (!header_read_ && !readHeader())) return std::nullopt;
  for (;;) {
    size_t whole = 0;
    const auto frame = blocks_ ? nextBlock(whole) : nextRecord(whole);
    if (whole == 0) return std::nullopt;
    std::optional<CapturedPayload> payload;
    if (frame) {
      payload =
          payloadOf(*frame->interface, std::string_view(buffer_).substr(frame->at, frame->size));
      last_time_ = frame->time;
    }
    buffer_.erase(0, whole);
    if (!payload) continue;
    payload->time = last_time_;
    return payload;
  }
}

/// A record of the classic format; `whole` stays 0 while bytes are missing.
std::optional<PcapStream::Frame> PcapStream::nextRecord(size_t& whole) {
  if (buffer_.size() < kRecordHeader) return std::nullopt;
  const size_t length = number(8);
  if (length > kLongestFrame) {
    problem_ = "the capture is damaged: a frame of " + std::to_string(length) + " bytes" + kRepair;
    return std::nullopt;
  }
  if (buffer_.size() < kRecordHeader + length) return std::nullopt;
  whole = kRecordHeader + length;
  const Interface& interface = interfaces_.front();
  const auto fraction = static_cast<int64_t>(number(4) / interface.ticks_per_us);
  return Frame{&interface, int64_t{1'000'000} * number(0) + fraction, kRecordHeader, length};
}

/// A block of pcapng; three kinds of blocks contain frames.
std::optional<PcapStream::Frame> PcapStream::nextBlock(size_t& whole) {
  constexpr size_t kLeast = 12;
  if (buffer_.size() < kLeast) return std::nullopt;
  const uint32_t type = littleEndian32(buffer_, 0);
  if (type == kSection) {
    swapped_ = littleEndian32(buffer_, 8) != kSectionOrder;
    interfaces_.clear();
  }
  const size_t length = number(4);
  if (length < kLeast || length % 4 != 0 || length > kLongestBlock) {
    problem_ = "the capture is damaged: a block of " + std::to_string(length) + " bytes" + kRepair;
    return std::nullopt;
  }
  if (buffer_.size() < length) return std::nullopt;
  whole = length;
  return frameIn(number(0), length);
}

std::optional<PcapStream::Frame> PcapStream::frameIn(uint32_t type, size_t length) {
  constexpr uint32_t kInterface = 1, kOldPacket = 2, kSimplePacket = 3, kEnhancedPacket = 6;
  const size_t end = length - 4;
  if (type == kInterface) addInterface(end);
  const bool simple = type == kSimplePacket;
  const bool old = type == kOldPacket;
  if (!simple && !old && type != kEnhancedPacket) return std::nullopt;
  const size_t begin = simple ? 12 : 28;
  if (end < begin) return leaveOut("captured frames that are damaged");
  const size_t which = simple ? 0 : old ? shortNumber(8) : number(8);
  if (which >= interfaces_.size()) return leaveOut("captured frames of an undescribed interface");
  const Interface& interface = interfaces_[which];
  size_t size = number(simple ? 8 : 20);
  if (simple && interface.longest > 0) size = std::min<size_t>(size, interface.longest);
  if (size > end - begin) return leaveOut("captured frames that are damaged");
  // A simple packet has no time of its own.
  if (simple) return Frame{&interface, last_time_, begin, size};
  const double ticks = number(12) * 4294967296.0 + number(16);
  return Frame{&interface, static_cast<int64_t>(ticks / interface.ticks_per_us), begin, size};
}

/// Link type, longest frame, and the clock's resolution from the options.
void PcapStream::addInterface(size_t end) {
  constexpr uint32_t kResolution = 9;
  Interface interface;
  if (end < 16) return;
  interface.link_type = shortNumber(8);
  interface.longest = number(12);
  for (size_t at = 16; at + 4 <= end && shortNumber(at) != 0;) {
    const size_t size = shortNumber(at + 2);
    if (shortNumber(at) == kResolution && size == 1 && at + 4 < end) {
      const uint32_t told = byteAt(buffer_, at + 4);
      const double base = (told & 0x80U) != 0 ? 2.0 : 10.0;
      interface.ticks_per_us = std::pow(base, told & 0x7FU) * 1e-6;
    }
    at += 4 + (size + 3) / 4 * 4;
  }
  interfaces_.push_back(interface);
}

std::optional<CapturedPayload> PcapStream::payloadOf(const Interface& interface,
                                                     std::string_view frame) {
  if (!isKnown(interface.link_type))
    return leaveOut("captured frames of link layer " + std::to_string(interface.link_type) +
                    ", not of Ethernet, Linux cooked, loopback or bare IPv4");
  const auto begin = internetAt(interface.link_type, frame);
  const std::string_view packet = begin ? frame.substr(std::min(*begin, frame.size())) : "";
  if (packet.size() < 20 || byteAt(packet, 0) >> 4 != 4)
    return leaveOut("captured frames without IPv4");
  const size_t header = 4 * (byteAt(packet, 0) & 0xFU);
  const uint32_t protocol = byteAt(packet, 9);
  const bool fragment = (bigEndian16(packet, 6) & 0x3FFFU) != 0;
  if ((protocol != 17 && protocol != 6) || header < 20)
    return leaveOut("captured packets that are neither UDP nor TCP");
  if (fragment || packet.size() < header + 8) return leaveOut("incomplete captured packets");
  CapturedPayload ends;
  ends.tcp = protocol == 6;
  ends.from = endOf(packet, 12, bigEndian16(packet, header));
  ends.to = endOf(packet, 16, bigEndian16(packet, header + 2));
  // The rest of the frame is padding.
  const size_t told = bigEndian16(packet, 2);
  if (!ends.tcp) return datagramOf(packet.substr(header), ends);
  const std::string_view whole = told > header ? packet.substr(0, told) : packet;
  return segmentOf(whole.substr(header), ends);
}

std::optional<CapturedPayload> PcapStream::datagramOf(std::string_view packet,
                                                      CapturedPayload ends) {
  const size_t length = bigEndian16(packet, 4);
  if (length < 8 || packet.size() < length) return leaveOut("incomplete captured packets");
  ends.bytes = packet.substr(8, length - 8);
  return ends;
}

std::optional<CapturedPayload> PcapStream::segmentOf(std::string_view packet,
                                                     CapturedPayload ends) {
  constexpr size_t kLeast = 20;
  const size_t header = packet.size() < kLeast ? 0 : 4 * (byteAt(packet, 12) >> 4);
  if (header < kLeast || packet.size() < header) return leaveOut("incomplete captured packets");
  uint32_t sequence = bigEndian32(packet, 4);
  const bool begins = (byteAt(packet, 13) & 2U) != 0;
  std::string_view bytes = packet.substr(header);
  const std::string stream = ends.from + ">" + ends.to;
  if (begins) tcp_next_[stream] = sequence + 1;
  if (begins || bytes.empty()) return std::nullopt;
  if (tcp_next_.size() > kMostStreams) tcp_next_.clear();
  const auto [place, first] = tcp_next_.emplace(stream, sequence);
  const auto ahead = static_cast<int32_t>(sequence - place->second);
  if (ahead > 0) left_out_["bytes of TCP that the capture lacks"] += ahead;
  if (ahead < 0) {  // sent again
    const auto again = std::min<size_t>(bytes.size(), static_cast<size_t>(-int64_t{ahead}));
    left_out_["bytes of TCP that were sent again"] += static_cast<int64_t>(again);
    bytes.remove_prefix(again);
    sequence += static_cast<uint32_t>(again);
    if (bytes.empty()) return std::nullopt;
  }
  place->second = sequence + static_cast<uint32_t>(bytes.size());
  ends.bytes = bytes;
  return ends;
}

}  // namespace tread
