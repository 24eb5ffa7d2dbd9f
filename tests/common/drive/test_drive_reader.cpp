// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "common/drive/drive_log.hpp"
#include "common/messages/blank.hpp"
#include "tests/common/log/log_helpers.hpp"

using namespace tread;

namespace {

std::vector<LogEvent> someEvents(int count) {
  DriveLogBuilder log;
  for (int i = 0; i < count; ++i) {
    auto ins = blank<ins_t>();
    ins.utime = 1'000'000 + i * 20'000;
    log.add(kIns, ins);
    log.addMark(ins.utime + 1000, "note", std::to_string(i));
  }
  return log.sorted();
}

void write(const std::string& path, const std::vector<LogEvent>& events) {
  LogWriter writer(path);
  for (const LogEvent& event : events)
    writer.write(event.utime, event.channel, event.bytes.data(), event.bytes.size());
}

}  // namespace

TEST_CASE("parts of a recording are read on, and every event can be read once more") {
  const testing::TemporaryFile first, second;
  std::vector<LogEvent> events = someEvents(100);
  write(first.path, {events.begin(), events.begin() + 60});
  write(second.path, {events.begin() + 60, events.end()});
  DriveReader reader({first.path, second.path});
  std::vector<EventPlace> places;
  for (DriveEvent event; reader.next(event);) {
    const LogEvent& written = events[places.size()];
    CHECK(event.bytes == written.bytes);
    CHECK(event.utime == written.utime);
    CHECK(event.recorded == written.utime);
    places.push_back(event.place());
  }
  REQUIRE(places.size() == events.size());
  CHECK(reader.problem().empty());
  for (const size_t i : {150U, 3U, 60U, 59U}) {
    LogEvent again;
    REQUIRE(reader.again(places[i], again));
    CHECK(again.bytes == events[i].bytes);
    CHECK(again.utime == events[i].utime);
  }
}

TEST_CASE("every event of a log with wrong times is given once, in its order") {
  std::vector<LogEvent> events = someEvents(100);
  for (size_t i = 0; i < 64; ++i)
    events[3 * i].utime =
        static_cast<int64_t>(static_cast<uint64_t>(events[3 * i].utime) ^ uint64_t{1} << i);
  events[196].utime = INT64_MIN;
  events[198].utime = INT64_MAX;
  const testing::TemporaryFile file;
  write(file.path, events);
  DriveReader reader({file.path});
  size_t count = 0;
  int64_t last = 0;
  for (DriveEvent event; reader.next(event); ++count) {
    REQUIRE(event.bytes == events[count].bytes);
    CHECK(event.recorded == events[count].utime);
    CHECK(event.utime >= last);
    CHECK(event.utime <= 1'000'000 + 101 * 20'000);
    last = event.utime;
  }
  CHECK(count == events.size());
  CHECK_THAT(reader.problem(), Catch::Contains("events with a time that cannot be, placed between "
                                               "their neighbours: ") &&
                                   Catch::Contains(" on INS and ") && Catch::Contains(" on MARK"));
}

TEST_CASE("messages that cannot be read are counted and named by channel") {
  std::vector<LogEvent> events = someEvents(10);
  events[4].bytes.pop_back();
  events[5].bytes = {1, 2, 3};
  auto ins = blank<ins_t>();
  ins.utime = 1'764'190'000'000'000'000;
  events[6].channel = kIns.name;
  events[6].bytes = encoded(ins);
  events.push_back({events.back().utime, "CAMERA", {1, 2, 3}});
  const DriveLog log = toDriveLog("some", events);
  CHECK(log.damage.empty());
  CHECK(log.notes ==
        std::vector<std::string>{
            "messages with a utime that cannot be (nanoseconds?), left out: 1 on INS",
            "messages that are broken or of another type, left out: 1 on INS and 1 on MARK"});
}
