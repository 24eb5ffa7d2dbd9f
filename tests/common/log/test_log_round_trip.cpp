// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <stdexcept>

#include <catch2/catch.hpp>
#include <lcm/lcm-cpp.hpp>

#include "common/seal/seal.hpp"
#include "log_helpers.hpp"

namespace tread {

using testing::TemporaryFile;

TEST_CASE("what is written is read, with the utime of the message") {
  const TemporaryFile file;
  goal_t goal{};
  goal.utime = 123456789;
  goal.goal_id = 7;
  goal.goal_pose[0] = 12.5;
  {
    LogWriter writer(file.path);
    writer.write(kGoal, goal);
    writer.write(-5, "X", nullptr, 0);
  }
  LogReader reader(file.path);
  LogEvent event;
  REQUIRE(reader.next(event));
  CHECK(event.utime == 123456789);
  CHECK(event.channel == "GOAL");
  goal_t read{};
  REQUIRE(decode(event, kGoal, read));
  CHECK(read.goal_id == 7);
  CHECK(read.goal_pose[0] == 12.5);
  arm_t arm{};
  CHECK_FALSE(decode(event, kArm, arm));
  event.bytes.push_back(0);
  CHECK_FALSE(decode(event, kGoal, read));
  REQUIRE(reader.next(event));
  CHECK(event.utime == -5);
  CHECK(event.bytes.empty());
  CHECK_FALSE(reader.next(event));
  CHECK_FALSE(reader.next(event));
  CHECK(reader.problem().empty());
}

TEST_CASE("the log of a robot with a key is read as if there were no seals") {
  const TemporaryFile file;
  Sealer robot(SealKey{}, 1, 2);
  goal_t goal{};
  goal.utime = 5;
  goal.goal_id = 7;
  const std::vector<uint8_t> plain = encoded(goal);
  std::vector<uint8_t> sealed = plain;
  REQUIRE(robot.seal(kGoal.name, sealed, goal.utime));
  {
    LogWriter writer(file.path);
    writer.write(5, kGoal.name, sealed.data(), sealed.size());
    writer.write(5, kGoal.name, plain.data(), plain.size());
  }
  LogReader reader(file.path);
  LogEvent event;
  for (int i = 0; i < 2; ++i) {
    REQUIRE(reader.next(event));
    CHECK(event.bytes == plain);
    goal_t read{};
    REQUIRE(decode(event, kGoal, read));
    CHECK(read.goal_id == 7);
  }
}

TEST_CASE("LCM's own reader, that of lcm-logplayer, reads our logs") {
  const TemporaryFile file;
  testing::writeEvents(file.path, 300);
  lcm::LogFile log(file.path, "r");
  REQUIRE(log.good());
  for (int i = 0; i < 300; ++i) {
    const lcm::LogEvent* const event = log.readNextEvent();
    REQUIRE(event != nullptr);
    CHECK(event->eventnum == i);
    CHECK(event->timestamp == 1000 * i);
    CHECK(event->channel == "CHANNEL");
    const auto* const bytes = static_cast<const uint8_t*>(event->data);
    CHECK(std::vector<uint8_t>(bytes, bytes + event->datalen) == testing::messageOf(i));
  }
  CHECK(log.readNextEvent() == nullptr);
}

TEST_CASE("we read the logs of LCM's own writer, that of lcm-logger") {
  const TemporaryFile file;
  {
    lcm::LogFile log(file.path, "w");
    for (int i = 0; i < 300; ++i) {
      auto bytes = testing::messageOf(i);
      lcm::LogEvent event;
      event.eventnum = i;
      event.timestamp = 1000 * i;
      event.channel = "CHANNEL";
      event.datalen = i;
      event.data = bytes.data();
      log.writeEvent(&event);
    }
  }
  std::string problem;
  const auto events = testing::eventsOf(file.path, problem);
  REQUIRE(events.size() == 300);
  for (int i = 0; i < 300; ++i) CHECK(events[static_cast<size_t>(i)] == i);
  CHECK(problem.empty());
}

TEST_CASE("messages larger than any buffer go through") {
  const TemporaryFile file;
  const std::vector<uint8_t> large(3'000'000, 0x5A);
  {
    LogWriter writer(file.path);
    for (int i = 0; i < 4; ++i) writer.write(i, "MAP", large.data(), large.size());
  }
  LogReader reader(file.path);
  LogEvent event;
  int count = 0;
  while (reader.next(event)) count += event.bytes == large ? 1 : 0;
  CHECK(count == 4);
  CHECK(reader.problem().empty());
}

TEST_CASE("an empty log is whole") {
  const TemporaryFile file;
  { const LogWriter writer(file.path); }
  std::string problem;
  CHECK(testing::eventsOf(file.path, problem).empty());
  CHECK(problem.empty());
}

TEST_CASE("what was flushed of a growing log is there while the writer lives") {
  const TemporaryFile file;
  LogWriter writer(file.path, OutputFile::Kind::kGrowing);
  const auto bytes = testing::messageOf(1);
  writer.write(1000, "CHANNEL", bytes.data(), bytes.size());
  writer.flush();
  std::string problem;
  CHECK(testing::eventsOf(file.path, problem) == std::vector<int>{1});
}

TEST_CASE("a full disk, a folder that is not there and a bad channel are one clear line") {
  CHECK_THROWS_WITH(LogWriter("/tmp/no/such/folder/x.lcmlog"),
                    "/tmp/no/such/folder/x.lcmlog: cannot be written (No such file or directory); "
                    "check space and permissions");
  LogWriter full("/dev/full");
  const std::vector<uint8_t> bytes(1000);
  const auto fill = [&] {
    for (int i = 0; i < 1000; ++i) full.write(i, "X", bytes.data(), bytes.size());
  };
  CHECK_THROWS_WITH(fill(),
                    "/dev/full: cannot be written (No space left on device); check "
                    "space and permissions");
  CHECK_THROWS_AS(full.flush(), std::runtime_error);
  CHECK_THROWS_AS(full.write(0, "", bytes.data(), 1), std::invalid_argument);
  CHECK_THROWS_AS(full.write(0, std::string(64, 'X'), bytes.data(), 1), std::invalid_argument);
}

}  // namespace tread
