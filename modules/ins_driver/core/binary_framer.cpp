// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/core/binary_framer.hpp"

namespace tread::ins {

void BinaryFramer::push(std::string_view bytes, int64_t arrival) {
  interrupted_ = false;
  buffer_.erase(0, at_);
  dropped_ += static_cast<int64_t>(at_);
  at_ = 0;
  arrivals_.emplace_back(bytes_, arrival);
  buffer_.append(bytes);
  bytes_ += static_cast<int64_t>(bytes.size());
}

std::optional<BinaryFramer::Frame> BinaryFramer::next() {
  while (at_ < buffer_.size()) {
    const std::string_view rest = std::string_view(buffer_).substr(at_);
    FrameLook look = look_(rest);
    if (look.verdict == FrameLook::Verdict::kFrame) {
      const Frame frame{rest.substr(0, look.size), arrivalAt(at_)};
      at_ += look.size;
      return frame;
    }
    if (look.verdict == FrameLook::Verdict::kNeedMore) {
      if (!interrupted_ && rest.size() < kMaxFrame) return std::nullopt;
      look = {FrameLook::Verdict::kRefused, 0, interrupted_ ? "cut short" : "too long"};
    }
    if (look.verdict == FrameLook::Verdict::kRefused) ++refusals_[look.reason];
    skipByte();
  }
  return std::nullopt;
}

void BinaryFramer::skipByte() {
  ++at_;
  ++stray_bytes_;
}

int64_t BinaryFramer::arrivalAt(size_t position) {
  const int64_t place = dropped_ + static_cast<int64_t>(position);
  while (arrivals_.size() > 1 && arrivals_[1].first <= place) arrivals_.pop_front();
  return arrivals_.front().second;
}

}  // namespace tread::ins
