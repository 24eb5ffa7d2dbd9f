// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/lidar_driver/sick_cola/cola_framer.hpp"

#include <algorithm>
#include <utility>

namespace tread::lidar {
namespace {

constexpr char kStart = 0x02;
constexpr char kEnd = 0x03;
constexpr size_t kLongest = 65536;
constexpr size_t kHeader = 8;  // of the binary dialect: four start bytes and the length

char exclusiveOr(std::string_view bytes) {
  char sum = 0;
  for (const char byte : bytes) sum = static_cast<char>(sum ^ byte);
  return sum;
}

}  // namespace

std::vector<std::string> ColaFramer::push(std::string_view bytes) {
  std::vector<std::string> telegrams;
  // In pieces, to bound the buffer for any input.
  while (!bytes.empty()) {
    const size_t piece = std::min<size_t>(bytes.size(), 4096);
    buffer_.append(bytes.substr(0, piece));
    bytes.remove_prefix(piece);
    std::string telegram;
    while (dialect_ == ColaDialect::kA ? cutText(telegram) : cutBinary(telegram))
      telegrams.push_back(std::exchange(telegram, {}));
  }
  return telegrams;
}

void ColaFramer::skip(size_t bytes) {
  stray_ += static_cast<int64_t>(bytes);
  buffer_.erase(0, bytes);
}

bool ColaFramer::cutText(std::string& telegram) {
  skip(std::min(buffer_.find(kStart), buffer_.size()));
  const size_t end = buffer_.find(kEnd);
  // A second start before the end: the first telegram is incomplete.
  const size_t last_start = buffer_.rfind(kStart, end);
  if (last_start != std::string::npos && last_start > 0) skip(last_start);
  if (end == std::string::npos) {
    if (buffer_.size() > kLongest) skip(buffer_.size());
    return false;
  }
  const size_t length = buffer_.find(kEnd);
  telegram = buffer_.substr(1, length - 1);
  buffer_.erase(0, length + 1);
  return true;
}

bool ColaFramer::cutBinary(std::string& telegram) {
  static const std::string kStarts(4, kStart);
  size_t at = 0;  // bytes are skipped together: one by one would take quadratic time
  for (;; ++at) {
    at = buffer_.find(kStarts, at);
    if (at == std::string::npos) {
      // The last three bytes may begin the next telegram.
      skip(buffer_.size() - std::min<size_t>(buffer_.size(), 3));
      return false;
    }
    if (buffer_.size() - at < kHeader) break;
    size_t length = 0;
    for (size_t i = 4; i < kHeader; ++i)
      length = 256 * length + static_cast<unsigned char>(buffer_[at + i]);
    if (length == 0 || length > kLongest) continue;
    if (buffer_.size() - at < kHeader + length + 1) break;
    const std::string_view body = std::string_view(buffer_).substr(at + kHeader, length);
    if (exclusiveOr(body) != buffer_[at + kHeader + length]) {
      ++bad_checksums_;
      continue;
    }
    telegram = body;
    skip(at);
    buffer_.erase(0, kHeader + length + 1);
    return true;
  }
  skip(at);
  return false;
}

std::string colaFrame(ColaDialect dialect, std::string_view telegram) {
  if (dialect == ColaDialect::kA) return kStart + std::string(telegram) + kEnd;
  std::string frame(4, kStart);
  for (int shift = 24; shift >= 0; shift -= 8)
    frame += static_cast<char>((telegram.size() >> shift) & 0xff);
  frame.append(telegram);
  return frame + exclusiveOr(telegram);
}

}  // namespace tread::lidar
