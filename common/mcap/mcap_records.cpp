// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/mcap/mcap_records.hpp"

#include <zlib.h>

namespace tread::mcap {

std::string recordOf(Op op, const std::string& content) {
  FieldWriter record;
  record.u8(static_cast<uint8_t>(op)).u64(content.size());
  return record.bytes + content;
}

std::string FieldReader::bytes(uint64_t size) {
  if (static_cast<uint64_t>(end_ - at_) < size) {
    ok_ = false;
    at_ = end_;
    return "";
  }
  std::string text(at_, static_cast<size_t>(size));
  at_ += size;
  return text;
}

uint64_t FieldReader::number(size_t size) {
  if (static_cast<size_t>(end_ - at_) < size) {
    ok_ = false;
    at_ = end_;
    return 0;
  }
  uint64_t value = 0;
  for (size_t i = 0; i < size; ++i)
    value |= static_cast<uint64_t>(static_cast<uint8_t>(at_[i])) << (8 * i);
  at_ += size;
  return value;
}

uint32_t crc32Of(const std::string& bytes, uint32_t crc) {
  return static_cast<uint32_t>(
      crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace tread::mcap
