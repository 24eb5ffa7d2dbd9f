// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <fstream>
#include <map>
#include <string>

#include "common/mcap/mcap_records.hpp"

namespace tread::mcap {

/// A message with what its channel and schema say of it.
struct Message {
  std::string topic;
  std::string encoding;     ///< of `data`
  std::string schema_name;  ///< empty: without a schema
  uint64_t log_time = 0;    ///< [ns]
  std::string data;
};

/// Reads an MCAP file from front to back, packed by Zstandard, LZ4 or not at all.
/** A damaged or truncated file gives what is whole, and says so. The summary is not needed. */
class Reader {
 public:
  /// Throws std::runtime_error with one clear line if it cannot be read or is no MCAP file.
  explicit Reader(const std::string& path);

  /// The next message in the order of the file; false at its end.
  bool next(Message& message);
  /// One clear line if the file is damaged; empty if it is whole.
  const std::string& problem() const { return problem_; }

 private:
  struct Channel {
    uint16_t schema = 0;
    std::string topic, encoding;
  };
  struct Record {
    Op op;
    std::string content;
  };

  bool readRecord(Record& record);
  bool readFile(char* bytes, uint64_t size);
  void unpack(const std::string& content);
  bool take(const Record& record, Message& message);
  bool end(const std::string& what);

  std::string path_;
  std::ifstream file_;
  uint64_t left_ = 0;    ///< bytes of the file that were not read yet
  std::string chunk_;    ///< unpacked records
  size_t chunk_at_ = 0;  ///< next of them
  std::map<uint16_t, std::string> schemas_;
  std::map<uint16_t, Channel> channels_;
  std::string problem_;
  bool ended_ = false;
};

}  // namespace tread::mcap
