// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace tread::testing {

/// Format of a capture.
struct CaptureForm {
  uint32_t link_type = 1;  ///< 1 Ethernet, 113 and 276 Linux cooked, 101 bare IP, 0 loopback
  int vlan_tags = 0;       ///< 2: QinQ
  bool blocks = false;     ///< pcapng
  bool swapped = false;    ///< most significant bytes first
  bool nanoseconds = false;
  bool tcp = false;
  uint16_t port = 2368;  ///< both ends
};

/// A capture file as libpcap or Wireshark writes it.
class CaptureFile {
 public:
  explicit CaptureFile(const CaptureForm& form) : form_(form) { begin(); }

  /// A datagram, or the next segment of the TCP stream with sequence numbers from 1000 on.
  void add(int64_t time, const std::string& payload) {
    addPacket(time, packetOf(payload, sequence_));
    sequence_ += static_cast<uint32_t>(payload.size());
  }
  /// A TCP segment that begins at this byte of the stream.
  void addSegment(int64_t time, const std::string& payload, uint32_t at) {
    addPacket(time, packetOf(payload, 1000 + at));
  }
  const std::string& bytes() const { return file_; }

 private:
  static std::string big(uint64_t value, int bytes) {
    std::string text;
    for (int i = bytes - 1; i >= 0; --i) text += static_cast<char>(value >> 8 * i & 0xffU);
    return text;
  }
  std::string own(uint64_t value, int bytes) const {
    const std::string text = big(value, bytes);
    return form_.swapped ? text : std::string(text.rbegin(), text.rend());
  }
  void addBlock(uint32_t type, std::string body) {
    body.resize((body.size() + 3) / 4 * 4);
    const std::string length = own(body.size() + 12, 4);
    file_ += own(type, 4) + length + body + length;
  }
  void begin() {
    if (!form_.blocks) {
      file_ = own(form_.nanoseconds ? 0xA1B23C4D : 0xA1B2C3D4, 4) + own(2, 2) + own(4, 2) +
              own(0, 8) + own(65535, 4) + own(form_.link_type, 4);
      return;
    }
    addBlock(0x0A0D0D0A, own(0x1A2B3C4D, 4) + own(1, 2) + own(0, 2) + own(UINT64_MAX, 8));
    std::string options;
    if (form_.nanoseconds) options = own(9, 2) + own(1, 2) + std::string("\x09\0\0\0", 4);
    addBlock(1, own(form_.link_type, 2) + own(0, 2) + own(0, 4) + options + own(0, 4));
  }
  void addPacket(int64_t time, const std::string& packet) {
    const std::string frame = frameOf(packet);
    const auto size = static_cast<uint32_t>(frame.size());
    const int64_t unit = form_.nanoseconds ? 1000 : 1;
    if (form_.blocks) {
      const auto ticks = static_cast<uint64_t>(time * unit);
      addBlock(6, own(0, 4) + own(ticks >> 32, 4) + own(ticks & 0xffffffffU, 4) + own(size, 4) +
                      own(size, 4) + frame);
      return;
    }
    file_ += own(static_cast<uint64_t>(time / 1'000'000), 4) +
             own(static_cast<uint64_t>(time % 1'000'000 * unit), 4) + own(size, 4) + own(size, 4) +
             frame;
  }
  std::string frameOf(const std::string& packet) const {
    std::string contents;
    for (int i = 0; i < form_.vlan_tags; ++i)
      contents += big(7, 2) + big(i + 1 < form_.vlan_tags ? 0x8100 : 0x0800, 2);
    contents += packet;
    // Two tags: the outer one is the provider's.
    const std::string type = big(form_.vlan_tags == 0   ? 0x0800
                                 : form_.vlan_tags == 1 ? 0x8100
                                                        : 0x88A8,
                                 2);
    if (form_.link_type == 1) return std::string(12, '\x11') + type + contents;
    if (form_.link_type == 113) return std::string(14, '\0') + type + contents;
    if (form_.link_type == 276) return type + std::string(18, '\0') + contents;
    if (form_.link_type == 0) return own(2, 4) + contents;
    return contents;
  }
  std::string packetOf(const std::string& payload, uint32_t sequence) const {
    std::string rest = big(form_.port, 2) + big(form_.port, 2);
    if (form_.tcp)
      rest += big(sequence, 4) + big(0, 4) + std::string("\x50\x10\0\0\0\0\0\0", 8);
    else
      rest += big(payload.size() + 8, 2) + big(0, 2);
    rest += payload;
    return std::string("\x45\x00", 2) + big(rest.size() + 20, 2) + big(0, 4) + "\x40" +
           (form_.tcp ? "\x06" : "\x11") + big(0, 2) + std::string("\x0a\0\0\x01\x0a\0\0\x02", 8) +
           rest;
  }

  CaptureForm form_;
  std::string file_;
  uint32_t sequence_ = 1000;
};

}  // namespace tread::testing
