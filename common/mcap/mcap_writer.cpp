// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/mcap/mcap_writer.hpp"

#include <zstd.h>

#include <algorithm>
#include <stdexcept>

namespace tread::mcap {
namespace {

constexpr size_t kChunkBytes = 1 << 20;  // before packing
constexpr int kPacking = 3;              // Zstandard's own default

std::string packed(const std::string& bytes) {
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  const size_t size = ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), kPacking);
  if (ZSTD_isError(size) != 0) throw std::runtime_error("Zstandard cannot pack a chunk");
  out.resize(size);
  return out;
}

}  // namespace

void Writer::Times::add(uint64_t time) {
  first = std::min(first, time);
  last = std::max(last, time);
}

Writer::Writer(const std::string& path) : file_(path) {
  put(std::string(kMagic, kMagicBytes));
  put(recordOf(Op::kHeader, FieldWriter().text("").text("tread").bytes));
}

uint16_t Writer::addSchema(const std::string& name, const std::string& encoding,
                           const std::string& data) {
  const std::string record = recordOf(
      Op::kSchema, FieldWriter().u16(++schema_count_).text(name).text(encoding).text(data).bytes);
  schemas_ += record;
  chunk_ += record;
  return schema_count_;
}

uint16_t Writer::addChannel(uint16_t schema, const std::string& topic,
                            const std::string& encoding) {
  const std::string record = recordOf(
      Op::kChannel,
      FieldWriter().u16(channel_count_).u16(schema).text(topic).text(encoding).u32(0).bytes);
  channels_ += record;
  chunk_ += record;
  return channel_count_++;
}

void Writer::write(uint16_t channel, uint64_t log_time, uint64_t publish_time,
                   const std::string& data) {
  index_[channel].emplace_back(log_time, chunk_.size());
  FieldWriter head;
  head.u16(channel)
      .u32(static_cast<uint32_t>(messages_[channel]++))
      .u64(log_time)
      .u64(publish_time);
  chunk_ += recordOf(Op::kMessage, head.bytes + data);
  chunk_times_.add(log_time);
  all_.add(log_time);
  if (chunk_.size() >= kChunkBytes) endChunk();
}

void Writer::close() {
  endChunk();
  put(recordOf(Op::kDataEnd, FieldWriter().u32(data_crc_).bytes));
  const uint64_t summary = at_;
  FieldWriter statistics;
  uint64_t messages = 0;
  for (const auto& [channel, count] : messages_) messages += count;
  statistics.u64(messages).u16(schema_count_).u32(channel_count_).u32(0).u32(0).u32(chunk_count_);
  statistics.u64(messages > 0 ? all_.first : 0).u64(all_.last);
  statistics.u32(static_cast<uint32_t>(10 * messages_.size()));
  for (const auto& [channel, count] : messages_) statistics.u16(channel).u64(count);

  std::string parts;
  FieldWriter offsets;
  const auto group = [&](Op op, const std::string& records) {
    if (records.empty()) return;
    FieldWriter offset;
    offset.u8(static_cast<uint8_t>(op)).u64(summary + parts.size()).u64(records.size());
    offsets.bytes += recordOf(Op::kSummaryOffset, offset.bytes);
    parts += records;
  };
  group(Op::kSchema, schemas_);
  group(Op::kChannel, channels_);
  group(Op::kChunkIndex, chunk_indexes_);
  group(Op::kStatistics, recordOf(Op::kStatistics, statistics.bytes));
  const uint64_t offsets_at = summary + parts.size();
  parts += offsets.bytes;
  // The summary's checksum covers everything up to its own field in the footer.
  FieldWriter footer;
  footer.u8(static_cast<uint8_t>(Op::kFooter)).u64(20).u64(summary).u64(offsets_at);
  const uint32_t crc = crc32Of(parts + footer.bytes);
  put(parts + footer.u32(crc).bytes + std::string(kMagic, kMagicBytes));
  file_.commit();
}

void Writer::put(const std::string& bytes) {
  file_.write(bytes);
  data_crc_ = crc32Of(bytes, data_crc_);
  at_ += bytes.size();
}

void Writer::endChunk() {
  if (chunk_.empty()) return;
  const bool any = !index_.empty();
  const uint64_t first = any ? chunk_times_.first : 0;
  const std::string records = packed(chunk_);
  FieldWriter chunk;
  chunk.u64(first).u64(chunk_times_.last).u64(chunk_.size()).u32(crc32Of(chunk_)).text("zstd");
  chunk.u64(records.size());
  const uint64_t chunk_at = at_;
  const std::string record = recordOf(Op::kChunk, chunk.bytes + records);
  put(record);

  FieldWriter offsets;
  const uint64_t indexes_at = at_;
  for (auto& [channel, entries] : index_) {
    std::stable_sort(entries.begin(), entries.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    offsets.u16(channel).u64(at_);
    FieldWriter index;
    index.u16(channel).u32(static_cast<uint32_t>(16 * entries.size()));
    for (const auto& [time, offset] : entries) index.u64(time).u64(offset);
    put(recordOf(Op::kMessageIndex, index.bytes));
  }
  FieldWriter entry;
  entry.u64(first).u64(chunk_times_.last).u64(chunk_at).u64(record.size()).text(offsets.bytes);
  entry.u64(at_ - indexes_at).text("zstd").u64(records.size()).u64(chunk_.size());
  chunk_indexes_ += recordOf(Op::kChunkIndex, entry.bytes);
  ++chunk_count_;
  chunk_.clear();
  chunk_times_ = {};
  index_.clear();
}

}  // namespace tread::mcap
