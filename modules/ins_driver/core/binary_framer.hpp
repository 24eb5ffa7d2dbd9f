// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "modules/ins_driver/core/ins_pipeline.hpp"

namespace tread::ins {

/// A protocol's result for the front of the bytes.
struct FrameLook {
  enum class Verdict : uint8_t {
    kNoStart,   ///< no frame can start here
    kNeedMore,  ///< the start of a frame, or possibly of one
    kRefused,   ///< looks like a frame but is invalid: `reason` gives the cause
    kFrame      ///< a whole frame of `size` bytes with a good checksum
  };
  Verdict verdict = Verdict::kNoStart;
  size_t size = 0;
  const char* reason = "";
};

/// A protocol's function that examines the bytes from a possible start on.
using LookForFrame = FrameLook (*)(std::string_view bytes);

/// Longest frame of any protocol [bytes]; a header that claims more is refused.
inline constexpr size_t kMaxFrame = 4096;

/// Splits a byte stream into frames with a good checksum.
/** After a bad frame the search continues one byte after its start, so that a false start costs no
 * frame after it. At most kMaxFrame bytes wait for the rest of a frame. */
class BinaryFramer {
 public:
  struct Frame {
    std::string_view bytes;  ///< valid until the next call
    int64_t arrival;         ///< host time of its first byte [us]
  };

  explicit BinaryFramer(LookForFrame look) : look_(look) {}

  void push(std::string_view bytes, int64_t arrival);
  /// The next frame; nullopt until more bytes arrive.
  std::optional<Frame> next();
  /// No more bytes will arrive: an incomplete frame is cut off. next() then returns the frames
  /// after its start.
  void interrupt() { interrupted_ = true; }

  int64_t bytes() const { return bytes_; }
  /// Bytes outside of good frames.
  int64_t strayBytes() const { return stray_bytes_; }
  const ReasonCounts& refusals() const { return refusals_; }
  /// Bytes that wait for the rest of their frame.
  size_t waiting() const { return buffer_.size() - at_; }

 private:
  void skipByte();
  int64_t arrivalAt(size_t position);

  LookForFrame look_;
  std::string buffer_;
  size_t at_ = 0;                                     ///< position of the search in buffer_
  int64_t dropped_ = 0;                               ///< bytes of the stream before buffer_
  std::deque<std::pair<int64_t, int64_t>> arrivals_;  ///< position in the stream, host time
  bool interrupted_ = false;
  int64_t bytes_ = 0;
  int64_t stray_bytes_ = 0;
  ReasonCounts refusals_;
};

}  // namespace tread::ins
