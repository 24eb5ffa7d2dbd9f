// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <chrono>

#include <catch2/catch.hpp>

#include "type_samples.hpp"

namespace tread {

TEST_CASE("a message that ends early is no message, wherever it ends") {
  testing::forEachType([](const auto& sample) {
    using Message = std::decay_t<decltype(sample)>;
    const auto whole = testing::encode(sample);
    for (size_t size = 0; size < whole.size(); ++size) {
      // A vector of exactly this size, so that a sanitizer detects reads beyond it.
      const std::vector<uint8_t> bytes(whole.begin(), whole.begin() + static_cast<long>(size));
      Message message{};
      CHECK_FALSE(testing::decode(bytes, message));
    }
  });
}

TEST_CASE("bytes left over make it no message") {
  testing::forEachType([](const auto& sample) {
    using Message = std::decay_t<decltype(sample)>;
    auto bytes = testing::encode(sample);
    bytes.push_back(0);
    Message message{};
    CHECK_FALSE(testing::decode(bytes, message));
  });
}

TEST_CASE("a broken byte anywhere costs neither memory nor time") {
  const auto start = std::chrono::steady_clock::now();
  testing::forEachType([](const auto& sample) {
    using Message = std::decay_t<decltype(sample)>;
    const auto whole = testing::encode(sample);
    for (size_t at = 0; at < whole.size(); ++at) {
      for (const int value : {0x00, 0x01, 0x7F, 0x80, 0xFF}) {
        auto bytes = whole;
        bytes[at] = static_cast<uint8_t>(value);
        Message message{};
        testing::decode(bytes, message);
      }
    }
  });
  // Without bounded lengths one such byte could cost 50 GB and minutes.
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(20));
}

TEST_CASE("what was read with a zero anywhere can be sent on") {
  testing::forEachType([](const auto& sample) {
    using Message = std::decay_t<decltype(sample)>;
    const auto whole = testing::encode(sample);
    for (size_t at = 0; at < whole.size(); ++at) {
      auto bytes = whole;
      bytes[at] = 0;
      Message message{};
      if (testing::decode(bytes, message)) CHECK_FALSE(testing::encode(message).empty());
    }
  });
  mark_t cut{};
  cut.mark_kind = "surface";
  auto bytes = testing::encode(cut);
  bytes[std::string(bytes.begin(), bytes.end()).find("face")] = 0;
  mark_t read{};
  REQUIRE(testing::decode(bytes, read));
  CHECK(read.mark_kind == "sur");
}

TEST_CASE("no length, wherever it stands, makes a decoder throw or read beyond the message") {
  testing::forEachType([](const auto& sample) {
    using Message = std::decay_t<decltype(sample)>;
    const auto whole = testing::encode(sample);
    for (size_t at = 0; at + 4 <= whole.size(); ++at)
      for (const uint32_t length : {0x80000000U, 0x80000001U, 0xFFFFFFFFU, 0x7FFFFFFFU, 0U}) {
        auto bytes = whole;
        for (size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<uint8_t>(length >> (24 - 8 * i));
        Message message{};
        CHECK_NOTHROW(testing::decode(bytes, message));
      }
  });
}

}  // namespace tread
