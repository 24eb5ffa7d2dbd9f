// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/mcap/mcap_reader.hpp"

#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <stdexcept>

namespace tread::mcap {
namespace {

constexpr size_t kRecordHead = 9;            // opcode and length
constexpr uint64_t kLargestChunk = 1 << 30;  // unpacked; a robot's log has no larger chunks

std::optional<std::string> unpackedLz4(const std::string& packed, size_t size) {
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) != 0) return {};
  std::string out(size, '\0');
  size_t made = 0, used = 0;
  for (;;) {
    size_t room = size - made, rest = packed.size() - used;
    const size_t hint =
        LZ4F_decompress(context, out.data() + made, &room, packed.data() + used, &rest, nullptr);
    made += room;
    used += rest;
    if (LZ4F_isError(hint) != 0 || hint == 0 || (room == 0 && rest == 0)) break;
  }
  LZ4F_freeDecompressionContext(context);
  if (made != size) return {};
  return out;
}

std::optional<std::string> unpackedAs(const std::string& packing, const std::string& packed,
                                      size_t size) {
  if (packing.empty()) return packed;
  if (packing == "lz4") return unpackedLz4(packed, size);
  if (packing != "zstd") return {};
  std::string out(size, '\0');
  if (ZSTD_decompress(out.data(), size, packed.data(), packed.size()) != size) return {};
  return out;
}

/// The records of a chunk; nullopt if it is damaged or packed in an unknown way.
std::optional<std::string> unpacked(const std::string& content, std::string& packing) {
  FieldReader fields(content.data(), content.size());
  fields.u64();
  fields.u64();
  const uint64_t size = fields.u64();
  const uint32_t crc = fields.u32();
  packing = fields.text();
  const std::string packed = fields.bytes(fields.u64());
  std::optional<std::string> chunk;
  if (fields.ok() && size <= kLargestChunk) chunk = unpackedAs(packing, packed, size);
  // Zero means that the writer computed no checksum.
  if (chunk && crc != 0 && crc32Of(*chunk) != crc) chunk.reset();
  return chunk;
}

/// The record at this position of a chunk; false if it is incomplete.
bool recordIn(const std::string& chunk, size_t at, Op& op, const char*& content, size_t& size) {
  if (chunk.size() < kRecordHead || at > chunk.size() - kRecordHead) return false;
  op = static_cast<Op>(chunk[at]);
  const uint64_t length = FieldReader(chunk.data() + at + 1, 8).u64();
  if (length > chunk.size() - at - kRecordHead) return false;
  content = chunk.data() + at + kRecordHead;
  size = static_cast<size_t>(length);
  return true;
}

}  // namespace

Reader::Reader(const std::string& path) : path_(path), file_(path, std::ios::binary) {
  std::error_code error;
  size_ = std::filesystem::file_size(path, error);
  if (!file_ || error) throw std::runtime_error(path + ": cannot be opened");
  char magic[kMagicBytes] = {};
  if (!readAt(0, magic, kMagicBytes) || std::memcmp(magic, kMagic, kMagicBytes) != 0)
    throw std::runtime_error(path + ": is no MCAP file");
  scan();
  std::stable_sort(order_.begin(), order_.end(),
                   [](const Place& a, const Place& b) { return a.time < b.time; });
}

void Reader::damaged(const std::string& what) {
  if (problem_.empty()) problem_ = path_ + ": " + what;
}

bool Reader::readAt(uint64_t at, char* bytes, uint64_t size) {
  if (at > size_ || size > size_ - at) return false;
  file_.clear();
  file_.seekg(static_cast<std::streamoff>(at));
  file_.read(bytes, static_cast<std::streamsize>(size));
  return static_cast<bool>(file_);
}

bool Reader::fileRecord(uint64_t at, Op& op, std::string& content) {
  char head[kRecordHead];
  if (!readAt(at, head, kRecordHead)) return false;
  op = static_cast<Op>(head[0]);
  const uint64_t size = FieldReader(head + 1, 8).u64();
  if (size > size_ - at - kRecordHead) return false;
  content.resize(size);
  return readAt(at + kRecordHead, content.data(), size);
}

void Reader::scan() {
  uint64_t at = kMagicBytes;
  std::string content;
  Op op{};
  bool chunk_lost = false;
  bool data_ended = false;
  for (; fileRecord(at, op, content); at += kRecordHead + content.size()) {
    if (op == Op::kFooter) return forgetUnknown();
    data_ended = data_ended || op == Op::kDataEnd;
    if (op == Op::kChunk) {
      chunk_lost = !scanChunk(at, content);
    } else if (op == Op::kMessageIndex && chunk_lost) {
      FieldReader fields(content.data(), content.size());
      fields.u16();
      constexpr uint32_t kEntry = 16;  // [bytes]
      lost_messages_ += fields.u32() / kEntry;
    } else {
      // The summary after the data repeats the channels described in a damaged chunk.
      take({op, content.data(), content.size()}, 0, at);
    }
  }
  cut_off_ = !data_ended;
  if (cut_off_) {
    lost_bytes_ += size_ - std::min(at, size_);
    damaged("ends too early; is the file truncated?");
  }
  forgetUnknown();
}

bool Reader::scanChunk(uint64_t at, const std::string& content) {
  std::string packing;
  const auto chunk = unpacked(content, packing);
  if (!chunk) {
    lost_bytes_ += content.size();
    damaged("a chunk is damaged or packed in an unknown way ('" + packing + "'); it is left out");
    return false;
  }
  Record record;
  size_t from = 0;
  for (; recordIn(*chunk, from, record.op, record.content, record.size);
       from += kRecordHead + record.size)
    take(record, at, from);
  if (from != chunk->size()) {
    ++lost_messages_;
    damaged("a chunk ends within a record");
  }
  return true;
}

void Reader::forgetUnknown() {
  const auto unknown = std::stable_partition(order_.begin(), order_.end(), [&](const Place& place) {
    return channels_.count(place.channel) != 0;
  });
  if (unknown == order_.end()) return;
  lost_messages_ += static_cast<size_t>(order_.end() - unknown);
  order_.erase(unknown, order_.end());
  damaged("messages of a channel that the file does not describe");
}

void Reader::take(const Record& record, uint64_t chunk, uint64_t at) {
  FieldReader fields(record.content, record.size);
  if (record.op == Op::kSchema) {
    const uint16_t id = fields.u16();
    schemas_[id] = fields.text();
  } else if (record.op == Op::kChannel) {
    const uint16_t id = fields.u16();
    Channel& channel = channels_[id];
    channel.schema = fields.u16();
    channel.topic = fields.text();
    channel.encoding = fields.text();
  } else if (record.op == Op::kMessage) {
    const uint16_t id = fields.u16();
    fields.u32();
    const uint64_t time = fields.u64();
    fields.u64();
    if (fields.ok()) return order_.push_back({time, chunk, at, id});
    ++lost_messages_;
    damaged("a message ends too early");
  }
}

const std::string& Reader::chunkAt(uint64_t at) {
  const auto found = std::find_if(chunks_.begin(), chunks_.end(),
                                  [&](const auto& chunk) { return chunk.first == at; });
  if (found != chunks_.end()) {
    std::rotate(chunks_.begin(), found, found + 1);
    return chunks_.front().second;
  }
  std::string content, packing;
  Op op{};
  if (fileRecord(at, op, content)) content = unpacked(content, packing).value_or("");
  cached_ += content.size();
  chunks_.emplace_front(at, std::move(content));
  for (; cached_ > kMostCached && chunks_.size() > 1; chunks_.pop_back())
    cached_ -= chunks_.back().second.size();
  return chunks_.front().second;
}

bool Reader::next(Message& message) {
  if (next_ >= order_.size()) return false;
  const Place& place = order_[next_++];
  std::string content;
  Record record;
  if (place.chunk != 0) {
    if (!recordIn(chunkAt(place.chunk), place.at, record.op, record.content, record.size))
      return next(message);  // the file has changed while being read
  } else {
    if (!fileRecord(place.at, record.op, content)) return next(message);
    record.content = content.data();
    record.size = content.size();
  }
  FieldReader fields(record.content, record.size);
  const Channel& channel = channels_[fields.u16()];
  fields.u32();
  message.log_time = fields.u64();
  fields.u64();
  message.topic = channel.topic;
  message.encoding = channel.encoding;
  const auto schema = schemas_.find(channel.schema);
  message.schema_name = schema == schemas_.end() ? "" : schema->second;
  message.data = fields.rest();
  return true;
}

}  // namespace tread::mcap
