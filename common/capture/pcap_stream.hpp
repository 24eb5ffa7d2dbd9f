// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tread {

/// The payload of a captured packet: a UDP datagram, or the next bytes of a TCP stream.
struct CapturedPayload {
  int64_t time = 0;  ///< [us] of the capture
  bool tcp = false;
  std::string from;  ///< "192.168.1.201:2368"
  std::string to;
  std::string bytes;
};

/// Parses a capture file (libpcap's classic format or pcapng, either byte order) incrementally.
/** Sources: draft-ietf-opsawg-pcap, draft-ietf-opsawg-pcapng, tcpdump.org's link-layer types. Reads
 * frames of Ethernet and Linux cooked captures (both versions), with any number of VLAN tags, of
 * loopback and of bare IPv4. Everything else is counted and left out, and so are retransmitted TCP
 * bytes. */
class PcapStream {
 public:
  /// Whether a file begins like a capture, or like a gzipped file, which is refused.
  static bool begins(std::string_view bytes);

  void push(std::string_view bytes) {
    if (problem_.empty()) buffer_.append(bytes);
  }
  /// The next payload; nullopt while its bytes are incomplete, and permanently after problem().
  std::optional<CapturedPayload> next();
  /// Why the file yields no more payloads, in one line; empty if it may.
  const std::string& problem() const { return problem_; }
  /// What was left out since the last call: counts by kind, in words.
  std::map<std::string, int64_t> takeLeftOut();

 private:
  /// Describes the frames of one interface.
  struct Interface {
    uint32_t link_type = 0;
    uint32_t longest = 0;       ///< bytes of a frame that were kept; 0: all
    double ticks_per_us = 1.0;  ///< of the clock
  };
  struct Frame {
    const Interface* interface;
    int64_t time;  ///< [us]
    size_t at;     ///< in the buffer
    size_t size;
  };

  uint32_t number(size_t at) const;
  uint32_t shortNumber(size_t at) const;
  bool readHeader();
  std::optional<Frame> nextRecord(size_t& whole);
  std::optional<Frame> nextBlock(size_t& whole);
  std::optional<Frame> frameIn(uint32_t type, size_t length);
  void addInterface(size_t end);
  std::optional<CapturedPayload> payloadOf(const Interface& interface, std::string_view frame);
  std::optional<CapturedPayload> datagramOf(std::string_view packet, CapturedPayload ends);
  std::optional<CapturedPayload> segmentOf(std::string_view packet, CapturedPayload ends);
  std::nullopt_t leaveOut(const std::string& what);

  std::string buffer_;
  std::string problem_;
  bool header_read_ = false;
  bool swapped_ = false;
  bool blocks_ = false;  ///< pcapng
  std::vector<Interface> interfaces_;
  int64_t last_time_ = 0;
  std::map<std::string, uint32_t> tcp_next_;  ///< sequence number that follows, by both ends
  std::map<std::string, int64_t> left_out_;
};

}  // namespace tread
