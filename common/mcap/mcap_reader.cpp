// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/mcap/mcap_reader.hpp"

#include <lz4frame.h>
#include <zstd.h>

#include <filesystem>
#include <optional>
#include <stdexcept>

namespace tread::mcap {
namespace {

constexpr size_t kRecordHead = 9;            // opcode and length
constexpr uint64_t kLargestChunk = 1 << 30;  // unpacked; larger ones are no chunks of a robot's log

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

}  // namespace

Reader::Reader(const std::string& path) : path_(path), file_(path, std::ios::binary) {
  std::error_code error;
  left_ = std::filesystem::file_size(path, error);
  if (!file_ || error) throw std::runtime_error(path + ": cannot be opened");
  char magic[kMagicBytes] = {};
  if (!readFile(magic, kMagicBytes) || std::memcmp(magic, kMagic, kMagicBytes) != 0)
    throw std::runtime_error(path + ": is no MCAP file");
}

bool Reader::next(Message& message) {
  Record record;
  while (!ended_ && readRecord(record))
    if (take(record, message)) return true;
  return false;
}

bool Reader::end(const std::string& what) {
  ended_ = true;
  if (!what.empty()) problem_ = path_ + ": " + what;
  return false;
}

bool Reader::readFile(char* bytes, uint64_t size) {
  if (size > left_) return false;
  file_.read(bytes, static_cast<std::streamsize>(size));
  left_ -= size;
  return static_cast<bool>(file_);
}

bool Reader::readRecord(Record& record) {
  const bool inside = chunk_at_ < chunk_.size();
  std::string head(kRecordHead, '\0');
  if (inside) {
    if (chunk_.size() - chunk_at_ < kRecordHead) return end("a chunk ends within a record");
    head = chunk_.substr(chunk_at_, kRecordHead);
    chunk_at_ += kRecordHead;
  } else if (!readFile(head.data(), kRecordHead)) {
    return end("ends too early; is the file truncated?");
  }
  record.op = static_cast<Op>(head[0]);
  const uint64_t size = FieldReader(head.data() + 1, 8).u64();
  if (inside) {
    if (chunk_.size() - chunk_at_ < size) return end("a chunk ends within a record");
    record.content = chunk_.substr(chunk_at_, size);
    chunk_at_ += size;
    return true;
  }
  if (size > left_) return end("ends too early; is the file truncated?");
  record.content.resize(size);
  return readFile(record.content.data(), size) || end("cannot be read to its end");
}

void Reader::unpack(const std::string& content) {
  FieldReader fields(content.data(), content.size());
  fields.u64();
  fields.u64();
  const uint64_t size = fields.u64();
  const uint32_t crc = fields.u32();
  const std::string packing = fields.text();
  const std::string packed = fields.bytes(fields.u64());
  std::optional<std::string> chunk;
  if (fields.ok() && size <= kLargestChunk) chunk = unpackedAs(packing, packed, size);
  // Zero: the writer told no checksum.
  if (!chunk || (crc != 0 && crc32Of(*chunk) != crc)) {
    if (problem_.empty())
      problem_ = path_ + ": a chunk is damaged or packed in a way that is not known ('" + packing +
                 "'); it is left out";
    return;
  }
  chunk_ = std::move(*chunk);
  chunk_at_ = 0;
}

bool Reader::take(const Record& record, Message& message) {
  FieldReader fields(record.content.data(), record.content.size());
  if (record.op == Op::kSchema) {
    const uint16_t id = fields.u16();
    schemas_[id] = fields.text();
  } else if (record.op == Op::kChannel) {
    const uint16_t id = fields.u16();
    Channel& channel = channels_[id];
    channel.schema = fields.u16();
    channel.topic = fields.text();
    channel.encoding = fields.text();
  } else if (record.op == Op::kChunk) {
    unpack(record.content);
  } else if (record.op == Op::kDataEnd || record.op == Op::kFooter) {
    end("");
  } else if (record.op == Op::kMessage) {
    const auto channel = channels_.find(fields.u16());
    fields.u32();
    message.log_time = fields.u64();
    fields.u64();
    if (!fields.ok() || channel == channels_.end()) return false;
    message.topic = channel->second.topic;
    message.encoding = channel->second.encoding;
    const auto schema = schemas_.find(channel->second.schema);
    message.schema_name = schema == schemas_.end() ? "" : schema->second;
    message.data = fields.rest();
    return true;
  }
  return false;
}

}  // namespace tread::mcap
