// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include "common/drive/drive_log.hpp"
#include "common/messages/blank.hpp"
#include "tests/tools/called_program.hpp"
#include "tools/robot/view/feed/feed.hpp"

using namespace tread;
using namespace tread::view;
using tread::samples::OwnFolder;
using Json = nlohmann::json;

namespace {

map_tile_t tileAt(int x, int64_t utime, uint8_t cell) {
  auto tile = blank<map_tile_t>();
  tile.utime = utime;
  tile.tile_x = x;
  tile.tile_cells = 8;
  tile.cell_size = 0.1;
  tile.num_cells = 64;
  tile.cells.assign(64, cell);
  return tile;
}

ins_t insAt(double x, int64_t utime) {
  auto ins = blank<ins_t>();
  ins.utime = utime;
  ins.position[0] = x;
  ins.position[1] = ins.position[2] = 0.0;
  DriveLogBuilder::setAttitude(ins, 0.0);
  ins.ins_status = ins_t::STATUS_GOOD;
  return ins;
}

/// Ten seconds of driving at 1 m/s; a new tile each second, and the first one repeatedly.
void writeLog(const std::string& path) {
  LogWriter log(path);
  for (int i = 0; i <= 100; ++i) {
    const int64_t utime = 1'000'000 + i * 100'000;
    log.write(kIns, insAt(0.1 * i, utime));
    if (i % 10 == 0) log.write(kMap, tileAt(i / 10, utime, kFree));
    if (i % 10 == 0) log.write(kMap, tileAt(-1, utime, i < 50 ? kFree : kObstacle));
    if (i == 70) {
      auto motor = blank<motor_t>();
      motor.utime = utime;
      motor.bridge_state = motor_t::STATE_FAULT;
      motor.state_reason = "the serial line is gone";
      log.write(kMotor, motor);
    }
  }
}

/// The messages that a new viewer of a channel gets at once.
std::vector<FeedMessage> stateOf(Feed& feed, const char* topic) {
  std::vector<FeedMessage> state;
  const uint32_t channel = feed.channels().find(topic)->id;
  for (const uint64_t part : feed.partsOf(channel)) state.push_back(*feed.newest(channel, part));
  return state;
}

/// A viewer that subscribes to everything and stores it.
struct Viewer {
  std::vector<FeedMessage> got;
  Feed feed{[](uint32_t) { return true; },
            [this](const FeedMessage& message) { got.push_back(message); }};

  int count(const std::string& topic) const {
    const uint32_t id = feed.channels().find(topic)->id;
    return static_cast<int>(std::count_if(
        got.begin(), got.end(), [&](const FeedMessage& message) { return message.channel == id; }));
  }
  Json last(const std::string& topic) const {
    const uint32_t id = feed.channels().find(topic)->id;
    Json found;
    for (const FeedMessage& message : got)
      if (message.channel == id) found = Json::parse(*message.payload);
    return found;
  }
};

}  // namespace

TEST_CASE("a seek tells the newest of each part, and later ones only what differs") {
  const OwnFolder folder;
  writeLog(folder.path("drive.lcmlog"));
  Viewer viewer;
  viewer.feed.openLogs({folder.path("drive.lcmlog")});
  viewer.got.clear();
  viewer.feed.seek(6'050'000, 7);
  CHECK(viewer.last("INS")["position"][0] == 5.0);
  CHECK(viewer.count("MAP") == 6);  // five new tiles, and the changed one
  CHECK(viewer.last("view/player")["now"] == 6'050'000);
  CHECK(viewer.last("view/player")["answered"] == 7);
  viewer.got.clear();
  viewer.feed.seek(6'060'000, 8);
  CHECK(viewer.count("MAP") == 0);
  CHECK(viewer.count("INS") == 0);
  viewer.feed.seek(3'050'000, 9);
  CHECK(viewer.last("INS")["position"][0] == 2.0);
  CHECK(viewer.count("MAP") == 1);  // the first tile as of that time
}

TEST_CASE("a log is played at its speed, message for message, and stops at its end") {
  const OwnFolder folder;
  writeLog(folder.path("drive.lcmlog"));
  Viewer viewer;
  viewer.feed.openLogs({folder.path("drive.lcmlog")});
  viewer.got.clear();
  viewer.feed.play(true, 2.0);
  for (int i = 0; i < 10; ++i) viewer.feed.step(0.1);
  CHECK(viewer.count("INS") == 20);
  CHECK(viewer.feed.now() == 3'000'000);
  viewer.feed.play(false, 2.0);
  viewer.feed.step(1.0);
  CHECK(viewer.count("INS") == 20);
  viewer.feed.play(true, 16.0);
  for (int i = 0; i < 10; ++i) viewer.feed.step(0.1);
  CHECK(viewer.count("INS") == 100);
  CHECK(viewer.last("view/player")["playing"] == false);
}

TEST_CASE("who comes later gets the state at once, and the history from the beginning") {
  Viewer viewer;
  LogEvent event = eventOf(kMap, tileAt(1, 5, kFree));
  viewer.feed.take(event);
  viewer.feed.take(eventOf(kMap, tileAt(2, 6, kFree)));
  viewer.feed.take(eventOf(kMap, tileAt(1, 7, kObstacle)));
  CHECK(stateOf(viewer.feed, "MAP").size() == 2);
  auto motor = blank<motor_t>();
  motor.bridge_state = motor_t::STATE_ESTOP;
  motor.state_reason = "a person in the way";
  viewer.feed.take(eventOf(kMotor, motor));
  const auto history = stateOf(viewer.feed, "view/history");
  REQUIRE(history.size() == 1);
  const Json told = Json::parse(*history[0].payload);
  REQUIRE(told["events"].size() == 1);
  CHECK(told["events"][0][3] == "emergency stop: a person in the way");
  CHECK(told["from_start"] == true);
}

TEST_CASE("the history of a log holds what comes later, so that one can go there") {
  const OwnFolder folder;
  writeLog(folder.path("drive.lcmlog"));
  Viewer viewer;
  viewer.feed.openLogs({folder.path("drive.lcmlog")});
  const auto history = stateOf(viewer.feed, "view/history");
  const Json told = Json::parse(*history.at(0).payload);
  REQUIRE(told["events"].size() == 1);
  CHECK(told["events"][0][0] == 8'000'000);
  CHECK(told["way"].size() > 50);
}

TEST_CASE("who looks at the scene late, or goes back in time, gets all of it") {
  const OwnFolder folder;
  writeLog(folder.path("drive.lcmlog"));
  bool looks = false;
  std::vector<FeedMessage> got;
  Feed feed([&](uint32_t) { return looks; },
            [&](const FeedMessage& message) { got.push_back(message); });
  feed.openLogs({folder.path("drive.lcmlog")});
  feed.seek(6'050'000, 1);
  CHECK(got.size() <= 2);  // the playback position
  looks = true;
  const uint32_t map = feed.channels().find("scene/map")->id;
  CHECK(stateOf(feed, "scene/map").size() == 1);
  CHECK(stateOf(feed, "scene/tf").size() == 1);
  got.clear();
  feed.seek(3'050'000, 2);
  const auto drawn = std::count_if(
      got.begin(), got.end(), [&](const FeedMessage& message) { return message.channel == map; });
  CHECK(drawn >= 1);
  const auto transform = stateOf(feed, "scene/tf");
  REQUIRE(transform.size() == 1);
  CHECK(Json::parse(*transform[0].payload)["translation"]["x"] == 2.0);
}

TEST_CASE("two fences are two parts, and news replace no news") {
  Viewer viewer;
  auto fence = blank<fence_t>();
  for (const char* name : {"pond", "yard"}) {
    fence.fence_name = name;
    viewer.feed.take(eventOf(kFence, fence));
  }
  CHECK(stateOf(viewer.feed, "FENCE").size() == 2);
  viewer.feed.step(1.0);
  for (const FeedMessage& message : viewer.got)
    CHECK(message.is_news == (message.channel == viewer.feed.channels().find("view/history")->id ||
                              message.channel == viewer.feed.channels().find("scene/events")->id));
}

TEST_CASE("names, counters and channels that somebody makes up fill no memory") {
  Viewer viewer;
  auto health = blank<health_t>();
  health.health_state = health_t::HEALTH_DEGRADED;
  size_t largest = 0;
  for (int i = 0; i < 30'000; ++i) {
    health.utime = i;
    health.process = "process " + std::to_string(i);
    health.health_reason = std::to_string(i) + std::string(4000, 'x');
    const LogEvent event = eventOf(kHealth, health);
    viewer.feed.take(event);
    viewer.feed.take({i, "CHANNEL_" + std::to_string(i), event.bytes});
    viewer.got.clear();
    if (i % 100 == 0)
      largest =
          std::max(largest, viewer.feed.partsOf(viewer.feed.channels().find("HEALTH")->id).size());
  }
  CHECK(largest * health.health_reason.size() < 5'000'000);
  const auto history = stateOf(viewer.feed, "view/history");
  CHECK(history.at(0).payload->size() < 2'500'000);
  const Json told = Json::parse(*history.at(0).payload);
  CHECK(told["events"].size() >= 2000);
  CHECK(told["events"].size() <= 4000);
  // The newest are kept.
  CHECK(told["events"].back()[2] == "process 29999");
}

TEST_CASE("news come once, also to those who ask for the whole meanwhile") {
  Viewer viewer;
  auto motor = blank<motor_t>();
  for (int i = 0; i < 4100; ++i) {
    motor.state_reason = std::to_string(i);
    viewer.feed.take(eventOf(kMotor, motor));
    if (i % 1000 == 0) viewer.feed.step(1.0);
  }
  stateOf(viewer.feed, "view/history");
  viewer.feed.step(1.0);
  size_t news = 0;
  const uint32_t id = viewer.feed.channels().find("view/history")->id;
  for (const FeedMessage& message : viewer.got)
    if (message.channel == id) news += Json::parse(*message.payload)["events"].size();
  CHECK(news == 4100);
}

TEST_CASE("nothing is turned into JSON that nobody wants") {
  int sent = 0;
  Feed feed([](uint32_t) { return false; }, [&](const FeedMessage&) { ++sent; });
  feed.take(eventOf(kIns, insAt(1.0, 5)));
  CHECK(sent == 0);
}

TEST_CASE("a log that holds nothing is one clear line") {
  const OwnFolder folder;
  { LogWriter log(folder.path("empty.lcmlog")); }
  Viewer viewer;
  CHECK_THROWS_WITH(viewer.feed.openLogs({folder.path("empty.lcmlog")}),
                    Catch::Contains("holds no message"));
}
