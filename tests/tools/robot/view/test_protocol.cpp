// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include "tools/robot/view/feed/protocol.hpp"

using namespace tread::view;
using Json = nlohmann::json;

TEST_CASE("the server says who it is and offers every channel with a schema") {
  const Json info = Json::parse(serverInfo("tread-view", true, true, "7"));
  CHECK(info["op"] == "serverInfo");
  CHECK(info["capabilities"] == Json({"time", "clientPublish"}));
  CHECK(Json::parse(serverInfo("tread-view", false, false, "7"))["capabilities"] == Json::array());

  const OfferedChannels channels;
  const Json offered = Json::parse(advertisement(channels));
  CHECK(offered["channels"].size() == channels.all().size());
  for (const Json& channel : offered["channels"]) {
    CHECK(channel["encoding"] == "json");
    CHECK(channel["schemaEncoding"] == "jsonschema");
    CHECK(Json::parse(channel["schema"].get<std::string>())["type"] == "object");
  }
  CHECK(channels.find("INS") != nullptr);
  CHECK(channels.find("scene/map")->schema_name == "foxglove.Grid");
  CHECK(channels.find("CAMERA") == nullptr);
}

TEST_CASE("a message's frame has its subscription and its time in nanoseconds, little-endian") {
  const std::string frame = messageFrame(0x01020304, 5'000'000, "{}");
  CHECK(frame == std::string("\x01\x04\x03\x02\x01\x00\xf2\x05\x2a\x01\x00\x00\x00{}", 15));
  CHECK(timeFrame(1) == std::string("\x02\xe8\x03\x00\x00\x00\x00\x00\x00", 9));
}

TEST_CASE("what a client asks for is read, and what is none is told") {
  const ClientRequest subscribe =
      readRequest(R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":5}]})");
  REQUIRE(subscribe.subscribe.size() == 1);
  CHECK(subscribe.subscribe[0] == std::pair<uint32_t, uint32_t>(1, 5));
  CHECK(readRequest(R"({"op":"unsubscribe","subscriptionIds":[1]})").unsubscribe ==
        std::vector<uint32_t>{1});
  const ClientRequest own = readRequest(
      R"({"op":"advertise","channels":[{"id":3,"topic":"view/command","encoding":"json"}]})");
  REQUIRE(own.advertise.size() == 1);
  CHECK(own.advertise[0].second == "view/command");
  CHECK_FALSE(readRequest("{").problem.empty());
  CHECK_FALSE(readRequest(R"({"op":"subscribe"})").problem.empty());
  CHECK_FALSE(readRequest(R"({"op":"subscribe","subscriptions":[{"id":-1}]})").problem.empty());
  CHECK_FALSE(readRequest(R"({"op":"fetchAsset"})").problem.empty());
  CHECK_FALSE(readRequest(R"([1, 2])").problem.empty());
  uint32_t channel = 0;
  std::string payload;
  CHECK(readClientFrame(std::string("\x01\x03\x00\x00\x00{}", 7), channel, payload));
  CHECK(channel == 3);
  CHECK(payload == "{}");
  CHECK_FALSE(readClientFrame("\x01", channel, payload));
  CHECK_FALSE(readClientFrame(std::string("\x07\x03\x00\x00\x00{}", 7), channel, payload));
}
