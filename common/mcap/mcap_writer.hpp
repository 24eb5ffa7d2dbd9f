// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/mcap/mcap_records.hpp"
#include "common/store/output_file.hpp"

namespace tread::mcap {

/// Writes an MCAP file: chunks packed by Zstandard, indexed, with a summary at the end.
/** Throws WriteError with one line if the file cannot be made or the disk is full. */
class Writer {
 public:
  explicit Writer(const std::string& path);
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// `encoding` of the schema, for instance "jsonschema".
  uint16_t addSchema(const std::string& name, const std::string& encoding, const std::string& data);
  /// `encoding` of the messages, for instance "json".
  uint16_t addChannel(uint16_t schema, const std::string& topic, const std::string& encoding);
  /// Times [ns]: when it was recorded, and when it was published.
  void write(uint16_t channel, uint64_t log_time, uint64_t publish_time, const std::string& data);
  /// Writes the remaining data and the summary, and moves the file to its final name.
  void close();

 private:
  struct Times {
    uint64_t first = UINT64_MAX;
    uint64_t last = 0;
    void add(uint64_t time);
  };

  void put(const std::string& bytes);
  void endChunk();

  OutputFile file_;
  uint64_t at_ = 0;                                 ///< bytes written
  uint32_t data_crc_ = 0;                           ///< of all bytes so far
  std::string schemas_, channels_, chunk_indexes_;  ///< records repeated in the summary
  uint16_t schema_count_ = 0;
  uint16_t channel_count_ = 0;
  uint32_t chunk_count_ = 0;
  Times all_;
  std::map<uint16_t, uint64_t> messages_;  ///< by channel
  std::string chunk_;                      ///< records that are not packed yet
  Times chunk_times_;
  std::map<uint16_t, std::vector<std::pair<uint64_t, uint64_t>>> index_;  ///< time and offset
};

}  // namespace tread::mcap
