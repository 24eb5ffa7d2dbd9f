// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <lcm/lcm-cpp.hpp>

#include "common/bus/lcm_listener.hpp"
#include "common/messages/blank.hpp"
#include "tests/system/own_bus.hpp"

using namespace tread;

namespace {

constexpr uint64_t kSession = 7;

Sealer sealerOf(uint8_t secret, uint64_t sender, std::optional<uint64_t> session = kSession) {
  SealKey key;
  key.bytes.fill(secret);
  return {key, sender, session};
}

mark_t markOf(const char* value) {
  auto mark = blank<mark_t>();
  mark.mark_value = value;
  return mark;
}

/// Listens and stores the marks that it received.
struct Listening {
  explicit Listening(std::optional<Sealer> sealer)
      : listener({url, std::move(sealer)},
                 [this](const std::string&, const uint8_t* bytes, size_t size, int64_t) {
                   mark_t mark;
                   REQUIRE(mark.decode(bytes, 0, static_cast<int>(size)) == static_cast<int>(size));
                   marks.push_back(mark.mark_value);
                 }) {}
  void handle() {
    for (int i = 0; i < 20; ++i) listener.handle(5);
  }
  std::string url = testing::ownLcmUrl();
  std::vector<std::string> marks;
  LcmListener listener;
};

}  // namespace

TEST_CASE("a listener with a key passes on what is sealed by it, and counts the rest") {
  // From the robot's host, and from a station that learns session and clock from messages.
  const bool here = GENERATE(true, false);
  Listening listening(sealerOf(1, 10, here ? std::optional<uint64_t>(kSession) : std::nullopt));
  LcmBus robot(BusAccess{listening.url, sealerOf(1, 11)}, TimeSource::kHost);
  LcmBus stranger(listening.url, TimeSource::kHost);
  LcmBus other(BusAccess{listening.url, sealerOf(2, 12)}, TimeSource::kHost);
  robot.publish(kMark, markOf("robot"));
  listening.handle();
  for (int i = 0; i < 120; ++i) stranger.publish(kMark, markOf("forged"));
  other.publish(kMark, markOf("another key"));
  listening.handle();
  CHECK(listening.marks == std::vector<std::string>{"robot"});
  CHECK(listening.listener.refused() ==
        std::map<std::string, int64_t>{{"unsealed", 120}, {"wrong tag", 1}});
  CHECK(listening.listener.doubt() == "messages not shown: 120 unsealed, 1 wrong tag");
}

TEST_CASE("a message that a listener has passed on is not passed on again") {
  Listening listening(sealerOf(1, 10));
  lcm::LCM line(listening.url);
  std::vector<uint8_t> sent;
  const auto mark = markOf("robot");
  sent.resize(static_cast<size_t>(mark.getEncodedSize()));
  mark.encode(sent.data(), 0, static_cast<int>(sent.size()));
  Sealer sealer = sealerOf(1, 11);
  sealer.seal("MARK", sent, LcmBus("memq://", TimeSource::kHost).now());
  for (int i = 0; i < 3; ++i)
    line.publish("MARK", sent.data(), static_cast<unsigned int>(sent.size()));
  listening.handle();
  CHECK(listening.marks.size() == 1);
  CHECK(listening.listener.refused() == std::map<std::string, int64_t>{{"replayed", 2}});
}

TEST_CASE("a listener without a key says so where the robot has one, and shows no larger message") {
  Listening listening(std::nullopt);
  LcmBus robot(BusAccess{listening.url, sealerOf(1, 11)}, TimeSource::kHost);
  LcmBus unsealed(listening.url, TimeSource::kHost);
  unsealed.publish(kMark, markOf("simulated"));
  listening.handle();
  CHECK(listening.listener.doubt().empty());
  robot.publish(kMark, markOf("robot"));
  lcm::LCM line(listening.url);
  const std::vector<uint8_t> large(200'000);
  line.publish("MARK", large.data(), static_cast<unsigned int>(large.size()));
  listening.handle();
  CHECK(listening.marks == std::vector<std::string>{"simulated", "robot"});
  CHECK(listening.listener.refused() == std::map<std::string, int64_t>{{"too large", 1}});
  CHECK_THAT(listening.listener.doubt(), Catch::Contains("--key FILE"));
}
