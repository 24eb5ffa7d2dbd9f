// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>

#include <nlohmann/json.hpp>

#include "common/log/event_log.hpp"
#include "common/messages/blank.hpp"
#include "common/types/message_json.hpp"
#include "common/types/tread_types.hpp"

using namespace tread;

namespace {

using Json = nlohmann::json;

template <class Message>
std::string textOf(const Channel<Message>& channel, const Message& message) {
  const auto text = jsonOf(treadTypes(), *typeOfChannel(channel.name), encoded(message));
  REQUIRE(text);
  return *text;
}

template <class Message>
void comesBack(const Channel<Message>& channel, const Message& message) {
  CAPTURE(channel.name);
  const std::string text = textOf(channel, message);
  REQUIRE(Json::accept(text));
  REQUIRE(bytesOf(treadTypes(), *typeOfChannel(channel.name), text) == encoded(message));
}

scan_t scanWithAll() {
  auto scan = blank<scan_t>();
  scan.utime = 1'764'000'000'000'123;
  scan.ranges = {0.1F, 1.0F / 3.0F, INFINITY, -INFINITY, NAN, -0.0F, 1e-30F};
  scan.num_beams = 7;
  scan.points = {{1.0F, 2.0F, 3.0F}, {4.0F, NAN, 6.0F}};
  scan.num_points = 2;
  return scan;
}

map_tile_t tile() {
  auto tile = blank<map_tile_t>();
  tile.cell_size = 0.1;
  tile.tile_cells = 2;
  tile.num_cells = 4;
  tile.cells = {0, 100, 254, 255};
  return tile;
}

std::string refusalOf(const Json& json) {
  try {
    bytesOf(treadTypes(), *treadTypes().find("health_t"), json.dump());
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a message becomes JSON and comes back to the bit") {
  comesBack(kIns, blank<ins_t>());
  comesBack(kMotor, blank<motor_t>());
  comesBack(kPlan, blank<plan_t>());
  comesBack(kScan, scanWithAll());
  comesBack(kMap, tile());
  auto learning = blank<learning_t>();
  learning.accepted = 1;
  learning.gate_reason = "quotes \" and \\ and \n and µ";
  learning.error_position = 0.1 + 0.2;
  comesBack(kLearning, learning);
  auto program = blank<program_t>();
  program.running.num_commands = 2;
  program.running.num_channels = 1;
  program.running.channel_kind = {1};
  program.running.command = {{0.5F}, {-0.25F}};
  comesBack(kProgram, program);
}

TEST_CASE("numbers that JSON lacks are texts, arrays of arrays lie flat, bytes are base64") {
  const Json scan = Json::parse(textOf(kScan, scanWithAll()));
  REQUIRE(scan["utime"] == 1'764'000'000'000'123);
  REQUIRE(scan["ranges"][0] == 0.1);
  REQUIRE(scan["ranges"][2] == "Infinity");
  REQUIRE(scan["ranges"][3] == "-Infinity");
  REQUIRE(scan["ranges"][4] == "NaN");
  REQUIRE(scan["points"].size() == 6);
  REQUIRE(scan["points"][3] == 4.0);
  REQUIRE(Json::parse(textOf(kMap, tile()))["cells"] == "AGT+/w==");
  auto learning = blank<learning_t>();
  learning.accepted = 1;
  REQUIRE(Json::parse(textOf(kLearning, learning))["accepted"] == true);
}

TEST_CASE("a text that is no UTF-8 still gives JSON") {
  auto mark = blank<mark_t>();
  mark.mark_value = "gr\xfcn";
  REQUIRE(Json::accept(textOf(kMark, mark)));
}

TEST_CASE("JSON that does not fit the type is refused with the field") {
  Json good = Json::parse(textOf(kHealth, blank<health_t>()));
  REQUIRE(refusalOf(good).empty());
  Json bad = good;
  bad.erase("process");
  CHECK(refusalOf(bad) == "process is missing");
  bad = good;
  bad["counters"] = Json::array({1});
  CHECK(refusalOf(bad) == "counters has 1 values instead of 0");
  bad = good;
  bad["num_counters"] = 1;
  bad["counters"] = Json::array({1});
  CHECK(refusalOf(bad) == "counters is no object");
  bad = good;
  bad["health_state"] = 40000;
  CHECK(refusalOf(bad) == "health_state does not fit into int16_t");
  bad = good;
  bad["health_reason"] = 3;
  CHECK(refusalOf(bad) == "health_reason is no text");
  bad = good;
  bad["num_counters"] = -1;
  CHECK(refusalOf(bad) == "counters has an impossible length");
  CHECK(refusalOf(Json::array()) == "the message is no object");
  CHECK_THROWS_WITH(bytesOf(treadTypes(), *treadTypes().find("health_t"), "{"),
                    Catch::Contains("no JSON"));
  Json tiles = Json::parse(textOf(kMap, tile()));
  tiles["cells"] = "AGT";
  CHECK_THROWS_WITH(bytesOf(treadTypes(), *treadTypes().find("map_tile_t"), tiles.dump()),
                    Catch::Contains("cells is no base64 text"));
}

TEST_CASE("schemas use only what viewers know: no arrays of arrays, one type a field") {
  for (const auto& [name, type] : treadTypes().all()) {
    CAPTURE(name);
    const Json schema = Json::parse(jsonSchemaOf(treadTypes(), type));
    REQUIRE(schema["title"] == "tread." + name);
    REQUIRE(schema["type"] == "object");
    for (const auto& [field, property] : schema["properties"].items()) {
      CAPTURE(field);
      REQUIRE(property["type"].is_string());
      if (property["type"] == "array") REQUIRE(property["items"]["type"] != "array");
    }
  }
  const Json plan = Json::parse(jsonSchemaOf(treadTypes(), *treadTypes().find("plan_t")));
  REQUIRE_THAT(plan["properties"]["pose"]["description"].get<std::string>(),
               Catch::EndsWith("num_patterns x 3, the last fastest"));
  REQUIRE_THAT(plan["description"].get<std::string>(), Catch::Contains("PLAN_BLOCKED = 4"));
}
