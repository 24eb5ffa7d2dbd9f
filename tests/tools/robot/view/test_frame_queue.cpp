// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "tools/robot/view/feed/frame_queue.hpp"

using namespace tread::view;

namespace {

Frame frameOf(FramePart part, size_t size = 100, bool is_news = false) {
  return {part, 0, std::make_shared<const std::string>(size, 'x'), is_news};
}

}  // namespace

TEST_CASE("who reads as fast as the robot tells gets every frame as it came") {
  FrameQueue queue;
  for (int i = 0; i < 1000; ++i) {
    for (int k = 0; k < 10; ++k) queue.push(frameOf({1, 0}));
    for (int k = 0; k < 10; ++k) CHECK(queue.pop().payload);
  }
  CHECK(queue.empty());
  CHECK(queue.bytes() == 0);
}

TEST_CASE("who is slower gets each part's newest, and its queue does not grow") {
  FrameQueue queue;
  for (uint64_t i = 0; i < 100'000; ++i) queue.push(frameOf({1, i % 7}, 50'000));
  CHECK(queue.bytes() <= FrameQueue::kCrowdedBytes + 50'000);
  CHECK(queue.size() <= FrameQueue::kCrowded + 7);
  size_t newest = 0;
  std::set<uint64_t> parts;
  while (!queue.empty()) {
    const Frame frame = queue.pop();
    if (!frame.payload) ++newest;
    parts.insert(frame.part.second);
  }
  CHECK(newest == 7);
  CHECK(parts.size() == 7);
  CHECK(queue.bytes() == 0);
  // Afterwards it is served as before.
  queue.push(frameOf({1, 0}));
  CHECK(queue.pop().payload);
}

TEST_CASE("news that came too fast are told as one whole, nothing of it twice") {
  FrameQueue queue;
  queue.push(frameOf({2, 0}));
  for (int i = 0; i < 500; ++i) queue.push(frameOf({9, 0}, 100, true));
  REQUIRE(queue.size() == 2);
  CHECK(queue.pop().part.first == 2);
  CHECK_FALSE(queue.pop().payload);
}

TEST_CASE("an allowance is used up, and comes again with time up to its most") {
  Allowance allowance(10.0, 5.0);
  allowance.use(6.0);
  CHECK(allowance.left() < 0.0);
  allowance.wait(0.2);
  CHECK(allowance.left() == 1.0);
  allowance.wait(100.0);
  CHECK(allowance.left() == 5.0);
  // A refused viewer costs nothing: all is normal after the flood.
  int taken = 0;
  for (int i = 0; i < 1000; ++i) taken += allowance.take() ? 1 : 0;
  CHECK(taken == 5);
  allowance.wait(0.1);
  CHECK(allowance.take());
}
