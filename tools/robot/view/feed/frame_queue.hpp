// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <memory>
#include <set>
#include <string>
#include <utility>

namespace tread::view {

/// A budget that is refilled over time.
class Allowance {
 public:
  Allowance(double rate, double most) : rate_(rate), most_(most), left_(most) {}
  void wait(double elapsed) { left_ = std::min(most_, left_ + rate_ * elapsed); }
  void use(double amount) { left_ -= amount; }
  /// Uses one unit if there is one.
  bool take() {
    if (left_ < 1.0) return false;
    left_ -= 1.0;
    return true;
  }
  double left() const { return left_; }

 private:
  double rate_, most_, left_;
};

/// Channel and part of a frame.
using FramePart = std::pair<uint32_t, uint64_t>;

/// A frame in a viewer's queue.
struct Frame {
  FramePart part;
  int64_t time = 0;                            ///< [us]
  std::shared_ptr<const std::string> payload;  ///< null: the newest one at its turn
  bool is_news = false;  ///< part of a sequence, which the newest one cannot replace
};

/// The queue of frames for one viewer.
/** If the line is slower than the robot, frames are merged: each part is queued once, and its
 * newest message is sent. So the queue holds a few payloads, and each part at most once more. */
class FrameQueue {
 public:
  static constexpr size_t kCrowded = 64;  ///< frames in the queue from which on they are merged
  static constexpr size_t kCrowdedBytes = 1'000'000;  ///< [bytes] from which on they are merged

  bool empty() const { return frames_.empty(); }
  size_t size() const { return frames_.size(); }
  size_t bytes() const { return bytes_; }  ///< of the payloads

  void push(Frame frame) {
    if (newest_.count(frame.part) > 0) return;
    if (frame.payload && isCrowded()) {
      frame.payload = nullptr;
      if (frame.is_news) drop(frame.part.first);
    }
    if (frame.payload)
      bytes_ += frame.payload->size();
    else
      newest_.insert(frame.part);
    frames_.push_back(std::move(frame));
  }
  void pushNewest(FramePart part) { push({part, 0, nullptr, false}); }
  bool isCrowded() const { return frames_.size() >= kCrowded || bytes_ >= kCrowdedBytes; }

  Frame pop() {
    Frame frame = std::move(frames_.front());
    frames_.pop_front();
    if (frame.payload)
      bytes_ -= frame.payload->size();
    else
      newest_.erase(frame.part);
    return frame;
  }

 private:
  void drop(uint32_t channel) {
    const auto gone = [&](const Frame& frame) {
      if (frame.part.first != channel || !frame.payload) return false;
      bytes_ -= frame.payload->size();
      return true;
    };
    frames_.erase(std::remove_if(frames_.begin(), frames_.end(), gone), frames_.end());
  }

  std::deque<Frame> frames_;
  std::set<FramePart> newest_;  ///< queued parts without a payload
  size_t bytes_ = 0;
};

}  // namespace tread::view
