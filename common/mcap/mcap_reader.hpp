// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/mcap/mcap_records.hpp"

namespace tread::mcap {

/// A message with the information of its channel and schema.
struct Message {
  std::string topic;
  std::string encoding;     ///< of `data`
  std::string schema_name;  ///< empty: without a schema
  uint64_t log_time = 0;    ///< [ns]
  std::string data;
};

/// Reads an MCAP file in the order of log times; chunks may be packed by Zstandard or LZ4, or not
/// at all.
/** A recorder writes chunks topic by topic, so that the file's order differs from the time order.
 * All messages are located first (32 bytes each are kept); chunks that are read together then stay
 * in memory, up to kMostCached bytes or one chunk. The intact part of a damaged or truncated file
 * is read, with a report. The summary is used only where a damaged chunk described a channel. */
class Reader {
 public:
  /// Throws std::runtime_error with one clear line if it cannot be read or is no MCAP file.
  explicit Reader(const std::string& path);

  /// The next message by time, ties in file order; false after the last one.
  bool next(Message& message);
  /// One clear line if the file is damaged; empty if it is whole.
  const std::string& problem() const { return problem_; }
  /// Messages in the file that cannot be read, as far as known.
  size_t lostMessages() const { return lost_messages_; }
  /// Bytes of the file that cannot be read, and its total size.
  uint64_t lostBytes() const { return lost_bytes_; }
  uint64_t size() const { return size_; }
  /// Whether the data end abruptly: what followed is unknown.
  bool cutOff() const { return cut_off_; }
  /// Number of readable messages.
  size_t messages() const { return order_.size(); }

  static constexpr size_t kMostCached = size_t{256} << 20U;  ///< [bytes] unpacked

 private:
  struct Channel {
    uint16_t schema = 0;
    std::string topic, encoding;
  };
  /// A record and the position of its content.
  struct Record {
    Op op{};
    const char* content = nullptr;
    size_t size = 0;
  };
  struct Place {
    uint64_t time;   ///< [ns]
    uint64_t chunk;  ///< of the file [bytes]; 0 = in none
    uint64_t at;     ///< of the chunk or of the file [bytes]
    uint16_t channel;
  };

  void scan();
  bool scanChunk(uint64_t at, const std::string& content);
  void take(const Record& record, uint64_t chunk, uint64_t at);
  /// Leaves out the messages of undeclared channels.
  void forgetUnknown();
  void damaged(const std::string& what);
  bool readAt(uint64_t at, char* bytes, uint64_t size);
  /// The record at this position; false at the end of the file or of its intact part.
  bool fileRecord(uint64_t at, Op& op, std::string& content);
  const std::string& chunkAt(uint64_t at);

  std::string path_;
  std::ifstream file_;
  uint64_t size_ = 0;
  std::vector<Place> order_;
  size_t next_ = 0;
  std::deque<std::pair<uint64_t, std::string>> chunks_;  ///< the most recently used first
  size_t cached_ = 0;                                    ///< [bytes]
  std::map<uint16_t, std::string> schemas_;
  std::map<uint16_t, Channel> channels_;
  std::string problem_;
  size_t lost_messages_ = 0;
  uint64_t lost_bytes_ = 0;
  bool cut_off_ = false;
};

}  // namespace tread::mcap
