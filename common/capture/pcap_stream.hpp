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

/// What a captured packet carried: a UDP datagram, or the next bytes of a TCP stream.
struct CapturedPayload {
  int64_t time = 0;  ///< [us] of the capture
  bool tcp = false;
  std::string from;  ///< "192.168.1.201:2368"
  std::string to;
  std::string bytes;
};

/// Takes a capture file (libpcap's classic format or pcapng, either byte order) apart while its
/// bytes come.
/** Sources: draft-ietf-opsawg-pcap, draft-ietf-opsawg-pcapng, tcpdump.org's link-layer types.
 * Frames of Ethernet and Linux cooked captures (both versions), with any number of VLAN tags, of
 * loopback and bare IPv4. What else there is is counted and left out; so are bytes of TCP that were
 * here before. */
class PcapStream {
 public:
  /// True if a file begins like a capture, also like a gzipped file, which is refused.
  static bool begins(std::string_view bytes);

  void push(std::string_view bytes) {
    if (problem_.empty()) buffer_.append(bytes);
  }
  /// The next payload; nothing while its bytes are missing, and for good after problem().
  std::optional<CapturedPayload> next();
  /// Why nothing more comes of this file, in one line; empty if something may.
  const std::string& problem() const { return problem_; }
  /// What was left out since the last call, by its name in words.
  std::map<std::string, int64_t> takeLeftOut();

 private:
  /// What describes the frames of one interface.
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
