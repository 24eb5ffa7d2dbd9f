// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace tread::lidar {

/// A UDP datagram out of a capture.
struct CapturedDatagram {
  int64_t time = 0;  ///< [us] of the capture
  std::string payload;
};

/// Takes a capture file (libpcap's classic format, times in us or ns, either byte order) apart
/// while its bytes come.
/** Source: draft-ietf-opsawg-pcap. Frames of Ethernet (also with a VLAN tag), Linux cooked captures
 * and bare IPv4; anything but whole UDP datagrams is counted and left out. */
class PcapStream {
 public:
  /// True if a file begins like a capture, also like one of the newer format, which is refused.
  static bool begins(std::string_view bytes);

  void push(std::string_view bytes) {
    if (problem_.empty()) buffer_.append(bytes);
  }
  /// The next datagram; nothing while its bytes are missing, and for good after problem().
  std::optional<CapturedDatagram> next();
  /// Why nothing comes of this file, in one line; empty if something may.
  const std::string& problem() const { return problem_; }
  /// What was left out, by its name in words.
  const std::map<std::string, int64_t>& counters() const { return counters_; }

 private:
  uint32_t number(size_t at) const;
  bool readHeader();
  std::optional<std::string> payloadOf(std::string_view frame);

  std::string buffer_;
  std::string problem_;
  bool header_read_ = false;
  bool swapped_ = false;
  bool nanoseconds_ = false;
  uint32_t link_type_ = 0;
  std::map<std::string, int64_t> counters_;
};

}  // namespace tread::lidar
