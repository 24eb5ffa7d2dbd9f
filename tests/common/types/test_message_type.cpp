// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <random>

#include "common/log/event_log.hpp"
#include "common/messages/blank.hpp"
#include "common/types/tread_types.hpp"

using namespace tread;

namespace {

/// Counts visited fields.
class Heard : public MessageVisitor {
 public:
  void beginField(const MessageField&, size_t) override { ++fields; }
  void endField(const MessageField&) override {}
  void integer(int64_t) override { ++values; }
  void real(double, bool) override { ++values; }
  void text(const std::string&) override { ++values; }
  void beginMessage(const MessageType&) override { ++messages; }
  void endMessage(const MessageType&) override {}

  int fields = 0;
  int values = 0;
  int messages = 0;
};

template <class Message>
void isDescribed(const Channel<Message>& channel) {
  CAPTURE(channel.name);
  const MessageType* const type = typeOfChannel(channel.name);
  REQUIRE(type != nullptr);
  REQUIRE(type->name == channel.type);
  Heard heard;
  REQUIRE(visit(treadTypes(), *type, encoded(blank<Message>()), heard));
  REQUIRE(heard.fields >= static_cast<int>(type->fields.size()));
}

health_t healthWithCounters() {
  auto health = blank<health_t>();
  health.process = "planner";
  health.num_counters = 2;
  health.counters.resize(2);
  health.counters[1].counter_name = "plans";
  health.counters[1].counted = 7;
  return health;
}

}  // namespace

TEST_CASE("every channel's type is described as lcm-gen made it, fingerprint and fields") {
  std::apply([](const auto&... channel) { (isDescribed(channel), ...); }, kTypedChannels);
  for (const ChannelSpec& spec : kChannels) REQUIRE(typeOfChannel(spec.name) != nullptr);
  REQUIRE(typeOfChannel("LIDAR") == nullptr);
}

TEST_CASE("a type is found by the first bytes of its message") {
  const MessageType* const type = treadTypes().typeOf(encoded(healthWithCounters()));
  REQUIRE(type == treadTypes().find("health_t"));
  REQUIRE(treadTypes().typeOf({1, 2, 3}) == nullptr);
  REQUIRE(treadTypes().typeOf(std::vector<uint8_t>(8, 0)) == nullptr);
}

TEST_CASE("messages within messages are heard, with all their values") {
  Heard heard;
  REQUIRE(
      visit(treadTypes(), *treadTypes().find("health_t"), encoded(healthWithCounters()), heard));
  REQUIRE(heard.messages == 2);
  REQUIRE(heard.values == 14 + 2 * 2);  // of the message, of its counters
}

TEST_CASE("comments of a type and of its fields stay with them, also over two lines") {
  const MessageType& motor = *treadTypes().find("motor_t");
  REQUIRE_THAT(motor.comment, Catch::StartsWith("State of the motors. Channel MOTOR"));
  REQUIRE(motor.field("battery_voltage")->comment == "[V]; NaN unknown");
  REQUIRE_THAT(motor.field("measured")->comment, Catch::EndsWith("[rad] + left; NaN unknown"));
  const MessageType& program = *treadTypes().find("program_t");
  REQUIRE_THAT(program.field("next")->comment, Catch::EndsWith("may be replaced until then"));
  REQUIRE(program.field("inputs_heard") != nullptr);
  REQUIRE(program.field("unheard_of") == nullptr);
  REQUIRE(motor.constants.size() == 7);
  CHECK(motor.enumeration == "BridgeState");
  CHECK_FALSE(motor.is_bit_set);
  CHECK(treadTypes().find("ins_t")->is_bit_set);
  REQUIRE(motor.constants[1].name == "STATE_ARMED");
  REQUIRE(motor.constants[1].comment == "may drive, standing");
}

TEST_CASE("a blank message has the number that the comment of a field says") {
  const auto blank = [](const std::string& comment) {
    const MessageTypes types =
        MessageTypes::fromText("struct a_t { int32_t x; // " + comment + "\n }");
    return blankInteger(types.find("a_t")->fields.front());
  };
  CHECK(blank("[us]; -1 unknown") == -1);
  CHECK(blank("0-based; -1 = none") == -1);
  CHECK(blank("-1..1") == 0);
  CHECK(blank("id; 0 = none") == 0);
  CHECK(blank("bit set; 0 = good; blank 51") == 51);
}

TEST_CASE("what is no type is refused with its line and what is wrong there") {
  const auto refusal = [](const std::string& text) -> std::string {
    try {
      MessageTypes::fromText(text);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  CHECK(refusal("struct a_t { int32_t x; }").empty());
  CHECK(refusal("struct a_t { int32_t x, y; /* both */ float z[3]; const int8_t A = 1, B = -2; }")
            .empty());
  CHECK(refusal("struct a_t {\n int32_t x\n}") == "message type, line 3: expected ;, not '}'");
  CHECK(refusal("enum a_t") == "message type, line 1: expected struct, not 'a_t'");
  CHECK_THAT(refusal("struct a_t { other_t x; }"), Catch::Contains("a_t.x: no type other_t"));
  CHECK_THAT(refusal("struct a_t { a_t x; }"), Catch::Contains("a_t.x"));
  CHECK_THAT(refusal("struct a_t { float x[n]; int32_t n; }"), Catch::Contains("its length n"));
  CHECK_THAT(refusal("struct a_t { float n; float x[n]; }"), Catch::Contains("its length n"));
  CHECK_THAT(refusal("struct a_t { int32_t x;"), Catch::Contains("expected"));
}

TEST_CASE("broken bytes are no message, and nothing is read beyond them") {
  const std::vector<uint8_t> good = encoded(healthWithCounters());
  const MessageType& type = *treadTypes().find("health_t");
  for (size_t size = 0; size < good.size(); ++size) {
    Heard heard;
    REQUIRE_FALSE(visit(treadTypes(), type, {good.begin(), good.begin() + long(size)}, heard));
  }
  std::mt19937 random(1);
  for (int round = 0; round < 20000; ++round) {
    std::vector<uint8_t> bytes = good;
    for (unsigned i = 0; i < 1 + random() % 4; ++i)
      bytes[8 + random() % (bytes.size() - 8)] = static_cast<uint8_t>(random());
    Heard heard;
    visit(treadTypes(), type, bytes, heard);
    REQUIRE(heard.values < 1000);
  }
}
