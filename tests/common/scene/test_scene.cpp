// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <algorithm>

#include <nlohmann/json.hpp>

#include "common/drive/drive_log.hpp"
#include "common/messages/blank.hpp"
#include "common/scene/scene.hpp"
#include "common/scene/scene_schemas.hpp"

using namespace tread;

namespace {

using Json = nlohmann::json;

/// The scene's output for a message, by topic.
class Drawn {
 public:
  template <class Message>
  void add(const Channel<Message>& channel, const Message& message, int64_t utime = 5'000'000) {
    LogEvent event = eventOf(channel, message);
    event.utime = utime;
    for (const SceneMessage& made : maker_.take(event)) {
      last[made.topic] = Json::parse(made.json);
      const auto& topics = sceneTopics();
      CHECK(std::find(topics.begin(), topics.end(), std::pair(made.topic, made.schema)) !=
            topics.end());
    }
  }
  std::map<std::string, Json> last;

 private:
  SceneMaker maker_;
};

ins_t insAt(double x, double y) {
  auto ins = blank<ins_t>();
  ins.utime = 1;
  ins.position[0] = x;
  ins.position[1] = y;
  ins.position[2] = 0.2;
  DriveLogBuilder::setAttitude(ins, 0.5);
  ins.ins_status = ins_t::STATUS_GOOD;
  return ins;
}

}  // namespace

TEST_CASE("the pose is a transform from map to body at the time of recording") {
  Drawn drawn;
  drawn.add(kIns, insAt(3.0, 4.0));
  const Json& transform = drawn.last.at("scene/tf");
  REQUIRE(transform["translation"]["x"] == 3.0);
  REQUIRE(transform["timestamp"]["sec"] == 5);
  REQUIRE(transform["rotation"]["w"].get<double>() == Approx(std::cos(0.25)));
}

TEST_CASE("the map around the robot is drawn: obstacles dark, unknown not at all") {
  Drawn drawn;
  auto tile = blank<map_tile_t>();
  tile.tile_cells = 32;
  tile.cell_size = 0.1;
  tile.cells.assign(32 * 32, kFree);
  tile.cells[0] = kObstacle;
  tile.num_cells = 32 * 32;
  drawn.add(kMap, tile);
  REQUIRE(drawn.last.count("scene/map") == 0);  // the robot's pose is unknown
  drawn.add(kIns, insAt(0.0, 0.0));
  const Json& grid = drawn.last.at("scene/map");
  REQUIRE(grid["column_count"] == 300);
  REQUIRE(grid["pose"]["position"]["x"] == -15.0);
  REQUIRE(grid["fields"].size() == 4);
  REQUIRE(grid["data"].get<std::string>().size() == 4 * 300 * 300 / 3 * 4);
}

TEST_CASE("a broken tile or pose draws nothing and ends nothing") {
  Drawn drawn;
  auto far = insAt(1e300, 0.0);
  drawn.add(kIns, far);
  CHECK(drawn.last.count("scene/tf") == 0);
  drawn.add(kIns, insAt(0.0, 0.0));
  auto tile = blank<map_tile_t>();
  tile.tile_cells = 8;
  tile.num_cells = 64;
  tile.cells.assign(64, kFree);
  for (const double cell_size : {1e-12, 0.0, -1.0, 1e9, std::nan("")}) {
    tile.cell_size = cell_size;
    drawn.add(kMap, tile);
  }
  tile.cell_size = 0.1;
  tile.tile_x = INT32_MAX;
  drawn.add(kMap, tile);
  tile.tile_x = 0;
  tile.tile_cells = 9;  // differs from the data's size
  drawn.add(kMap, tile, 90'000'000);
  CHECK(drawn.last.count("scene/map") == 0);
}

TEST_CASE("a plan is a line with the doubt at its patterns' ends") {
  Drawn drawn;
  drawn.add(kIns, insAt(0.0, 0.0));
  auto plan = blank<plan_t>();
  plan.num_patterns = 2;
  plan.execution_id = {1, 2};
  plan.pattern_id = {1, 2};
  plan.pose = {{1.0, 0.0, 0.0}, {2.0, 0.0, 0.0}};
  plan.covariance = {{0.01, 0, 0, 0.04, 0, 0.1}, {NAN, NAN, NAN, NAN, NAN, NAN}};
  drawn.add(kPlan, plan);
  const Json& entity = drawn.last.at("scene/plan")["entities"][0];
  REQUIRE(entity["id"] == "plan");
  REQUIRE(entity["lines"][0]["points"].size() == 3);
  REQUIRE(entity["cylinders"].size() == 1);
  REQUIRE(entity["cylinders"][0]["size"]["x"].get<double>() == Approx(0.8));  // 4 x .2 m
}

TEST_CASE("only what came back of a scan is drawn") {
  Drawn drawn;
  auto scan = blank<scan_t>();
  scan.ranges = {1.0F, INFINITY, NAN, 0.01F};
  scan.num_beams = 4;
  scan.angle_first = scan.angle_step = 0.0;
  scan.range_min = 0.1;
  scan.range_max = 10.0;
  drawn.add(kScan, scan);
  REQUIRE(drawn.last.at("scene/scan")["data"].get<std::string>().size() == 16);  // one point
}

TEST_CASE("every topic's schema says its own name and knows only one type a field") {
  for (const auto& [topic, name] : sceneTopics()) {
    const Json schema = Json::parse(sceneSchema(name));
    CHECK(schema["title"] == name);
    CHECK(schema["type"] == "object");
    CHECK(schema["properties"].size() >= 2);
  }
}
