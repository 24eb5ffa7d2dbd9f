// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "common/soundness/drive_log.hpp"
#include "tests/tools/lab/gap/small_log.hpp"

using namespace tread;
using namespace tread::gap;
using namespace tread::samples;

namespace {

SmallLog goodLog(double length = 30.0) {
  SmallLog log;
  drive(log, 0.0, length, {1.0, 0.0, 0.2}, {});
  return log;
}

/// The first fatal line; empty if there is none.
std::string fatal(const std::vector<LogEvent>& events) {
  for (const LogNote& note : toDrive(toDriveLog("a.lcmlog", events)).notes)
    if (note.isFatal()) return note.what;
  return "";
}

/// Shifts a channel's messages from a time on [s], including their logging times.
template <class Message>
void shift(std::vector<LogEvent>& events, const Channel<Message>& channel, double from, double by,
           double logged_by) {
  for (LogEvent& event : events) {
    Message message;
    if (!decode(event, channel, message) || message.utime < at(from)) continue;
    message.utime += std::llround(by * 1e6);
    message.encode(event.bytes.data(), 0, static_cast<int>(event.bytes.size()));
    event.utime += std::llround(logged_by * 1e6);
  }
}

bool noted(const std::vector<LogEvent>& events, const std::string& part) {
  for (const LogNote& note : toDrive(toDriveLog("a.lcmlog", events)).notes)
    if (note.what.find(part) != std::string::npos) return true;
  return false;
}

}  // namespace

TEST_CASE("a good log is not complained of") {
  const auto notes = toDrive(toDriveLog("a.lcmlog", goodLog().sorted())).notes;
  for (const LogNote& note : notes) REQUIRE_FALSE(note.isFatal());
  REQUIRE(notes.size() == 6);  // speed, turn, gyro, poses, standstill, driving
  REQUIRE(notes[0].log == "a.lcmlog");
}

TEST_CASE("a log without MOTOR or without INS says which channel is missing") {
  SmallLog only_ins;
  for (int i = 0; i < 100; ++i) only_ins.ins(0.1 * i, {}, 0.0);
  REQUIRE(fatal(only_ins.sorted()) ==
          "no MOTOR message among 100 events: the commands are unknown; record channel MOTOR");
  SmallLog only_motor;
  for (int i = 0; i < 100; ++i) only_motor.motor(0.1 * i, {1.0, 1.0});
  REQUIRE(fatal(only_motor.sorted()).find("no INS message") == 0);
  REQUIRE(fatal({}).find("no MOTOR message among 0 events") == 0);
}

TEST_CASE("a clock that goes back or jumps ahead is found with its place") {
  SECTION("the whole robot's clock, seen against the recorder's") {
    auto events = goodLog().sorted();
    shift(events, kMotor, 15.0, 5.0, 0.0);
    shift(events, kIns, 15.0, 5.0, 0.0);
    REQUIRE(fatal(events).find("clock jump: MOTOR goes on by 5.05 s at 14.9") == 0);
  }
  SECTION("it goes back") {
    auto events = goodLog().sorted();
    shift(events, kIns, 15.0, -3.0, 0.0);
    REQUIRE(fatal(events) == "clock jump: INS goes back by 2.90 s at 14.9 s; cut the log there");
  }
  SECTION("both channels go back, and the log is sorted by time") {
    auto events = goodLog().sorted();
    shift(events, kMotor, 15.0, -3.0, -3.0);
    shift(events, kIns, 15.0, -3.0, -3.0);
    std::stable_sort(events.begin(), events.end(),
                     [](const LogEvent& a, const LogEvent& b) { return a.utime < b.utime; });
    REQUIRE(fatal(events).find("clock jump: MOTOR goes back at 14.9") == 0);
  }
  SECTION("recorded with the robot's own clock: the robot does not move on in the pause") {
    auto events = goodLog().sorted();
    shift(events, kIns, 15.0, 4.0, 4.0);
    REQUIRE(fatal(events).find("clock jump: INS goes on by 4.10 s at 14.9 s, but the robot moves "
                               "on by 0.10 m at 1.00 m/s") == 0);
  }
}

TEST_CASE("a clock that jumps ahead on all channels is found however slowly the robot moves") {
  for (const Twist2& twist : {Twist2{0.15, 0.0, 0.02}, Twist2{0.0, 0.0, 0.5}, Twist2{1.0, 0.0, 1.5},
                              Twist2{-0.2, 0.0, -0.3}}) {
    SmallLog log;
    drive(log, 0.0, 30.0, twist, {});
    auto events = log.sorted();
    REQUIRE(fatal(events) == "");
    shift(events, kIns, 15.0, 7.0, 7.0);
    shift(events, kMotor, 15.0, 7.0, 7.0);
    CHECK(fatal(events).find("clock jump: INS and MOTOR go on by 7.") == 0);
  }
}

TEST_CASE("a silence in which time went on is no clock jump") {
  SECTION("the robot stood") {
    SmallLog log;
    drive(log, 0.0, 14.0, {0.5, 0.0, 0.1}, {});
    const Pose2 there = integrate({0.5, 0.0, 0.1}, 14.0);
    drive(log, 14.0, 16.0, {}, there);
    drive(log, 23.0, 25.0, {}, there);
    drive(log, 25.0, 40.0, {0.5, 0.0, 0.1}, there);
    CHECK(fatal(log.sorted()) == "");
    CHECK(noted(log.sorted(), "and miss no number, while the robot stands: if its clock jumped"));
  }
  SECTION("the robot drove on") {
    SmallLog log;
    const Pose2 there = drive(log, 0.0, 15.0, {0.5, 0.0, 0.1}, {});
    drive(log, 22.0, 40.0, {0.5, 0.0, 0.1}, there * integrate({0.5, 0.0, 0.1}, 7.0));
    CHECK(fatal(log.sorted()) == "");
  }
  SECTION("it was stopped by its watchdog, and started again") {
    SmallLog log;
    Pose2 there = drive(log, 0.0, 15.0, {0.5, 0.0, 0.1}, {});
    there = there * integrate({0.5, 0.0, 0.1}, 0.3);
    there = drive(log, 22.0, 23.0, {}, there);
    drive(log, 23.0, 40.0, {0.5, 0.0, 0.1}, there);
    CHECK(fatal(log.sorted()) == "");
  }
  SECTION("the recorder lost messages of all channels") {
    SmallLog log;
    drive(log, 0.0, 40.0, {0.5, 0.0, 0.1}, {});
    std::vector<LogEvent> kept;
    for (const LogEvent& event : log.sorted())
      if (event.utime < at(15.0) || event.utime > at(22.0)) kept.push_back(event);
    CHECK(fatal(kept) == "");
  }
}

TEST_CASE("an import that has neither commands nor poses for a while has a break, no clock jump") {
  // The robot turns by 360 deg during the pause.
  const Twist2 turning{0.02, 0.0, 1.0};
  const double break_end = 15.0 + 2.0 * kPi;
  SmallLog log;
  const Pose2 there = drive(log, 0.0, 15.0, turning, {});
  drive(log, break_end, break_end + 15.0, turning, there * integrate(turning, 2.0 * kPi));
  CHECK(fatal(log.sorted()).find("clock jump: INS and MOTOR go on by 6.") == 0);
  config_t config{};
  config.utime = at(0.0);
  config.config_process = "tread-import";
  config.config_text = "format: csv\n";
  log.add(kConfig, config);
  CHECK(fatal(log.sorted()) == "");
  CHECK(noted(log.sorted(), "MOTOR is silent for more than 0.3 s 1 times (first at 15.0 s"));

  const Drive both_sides = toDrive(toDriveLog("a.lcmlog", log.sorted()));
  REQUIRE(both_sides.segments.size() == 2);
  CHECK(both_sides.segments[0].end == Approx(15.0).margin(0.06));
  CHECK(both_sides.segments[1].begin() == Approx(break_end).margin(0.06));
  const auto measured = [&](size_t segment) {
    return std::count_if(both_sides.executions.begin(), both_sides.executions.end(),
                         [&](const Execution& execution) { return execution.segment == segment; });
  };
  CHECK(measured(0) == 7);
  CHECK(measured(1) >= 5);  // without encoders the first 3 s are not used
  // Poses that return to an earlier time 1 s after the commands; the robot drives a circle.
  SmallLog late;
  Pose2 at_break = drive(late, 0.0, 15.0, {0.5, 0.0, 1.0}, {});
  for (double time = break_end - 1.0; time < break_end; time += 0.05) late.motor(time, {0.0, 1.0});
  drive(late, break_end, break_end + 15.0, {0.5, 0.0, 1.0}, at_break);
  CHECK(fatal(late.sorted()).find("clock jump: INS goes on by 6.") == 0);
  late.add(kConfig, config);
  CHECK(fatal(late.sorted()) == "");
  // A stream that jumps ahead of the other one is a clock fault, also in an import.
  auto events = goodLog().sorted();
  events.push_back(eventOf(kConfig, config));
  shift(events, kIns, 15.0, 4.0, 4.0);
  CHECK(fatal(events).find("clock jump: INS goes on by 4.10 s at 14.9 s") == 0);
}

TEST_CASE("an INS that was silent while the robot moved on is no clock jump") {
  SmallLog log;
  Pose2 T_map_body;
  for (int i = 0; i < 600; ++i) {
    log.motor(0.05 * i, {0.9, 1.1});
    if (i < 200 || i > 280) log.ins(0.05 * i, T_map_body, 0.2);
    T_map_body = T_map_body * integrate({1.0, 0.0, 0.2}, 0.05);
  }
  REQUIRE(fatal(log.sorted()) == "");
  REQUIRE(noted(log.sorted(), "no new INS pose for more than 1.5 s 1 times, first at 9.9"));
}

TEST_CASE("a recorder that is held up, or whose own clock jumps, does not condemn the log") {
  auto events = goodLog().sorted();
  for (size_t i = 0; i < events.size(); ++i)
    if (i > 400 && i < 440) events[i].utime = events[440].utime;
  REQUIRE(fatal(events) == "");
  for (size_t i = 500; i < events.size(); ++i) events[i].utime += 3'600'000'000;
  REQUIRE(fatal(events) == "");
  REQUIRE(noted(events, "the recorder's clock jumped"));
}

TEST_CASE("two robots in one log are found by their numbers, by contradictions or by their boots") {
  SECTION("interleaved") {
    SmallLog first;
    SmallLog second;
    drive(first, 0.0, 20.0, {1.0, 0.0, 0.2}, {});
    drive(second, 0.02, 20.02, {0.5, 0.0, -0.2}, {3.0, 1.0, 0.0});
    for (const LogEvent& event : second.events) first.events.push_back(event);
    REQUIRE(fatal(first.sorted()).find("two robots in one log: MOTOR has two publishers") == 0);
  }
  SECTION("with the same numbers at the same times") {
    SmallLog first;
    SmallLog second;
    drive(first, 0.0, 20.0, {1.0, 0.0, 0.2}, {});
    drive(second, 0.0, 20.0, {0.5, 0.0, -0.2}, {3.0, 1.0, 0.0});
    for (const LogEvent& event : second.events) first.events.push_back(event);
    REQUIRE(fatal(first.sorted()).find("two robots in one log") == 0);
  }
  SECTION("boots") {
    SmallLog log = goodLog();
    for (int i = 0; i < 3; ++i) {
      config_t config{};
      config.utime = at(10.0 * i);
      config.config_process = "motor_bridge";
      config.config_boot_id = i % 2;
      log.add(kConfig, config);
    }
    REQUIRE(fatal(log.sorted()).find("two robots in one log: CONFIG of motor_bridge") == 0);
  }
  SECTION("every message twice is still one robot") {
    SmallLog log = goodLog();
    const auto events = log.events;
    for (const LogEvent& event : events) log.events.push_back(event);
    REQUIRE(fatal(log.sorted()) == "");
  }
}

TEST_CASE("an INS that hangs while commands drive is found with its place") {
  SmallLog log;
  Pose2 T_map_body;
  for (int i = 0; i < 600; ++i) {
    log.motor(0.05 * i, {0.9, 1.1});
    log.ins(0.05 * i, T_map_body, 0.2);
    if (i < 300) T_map_body = T_map_body * integrate({1.0, 0.0, 0.2}, 0.05);
  }
  REQUIRE(fatal(log.sorted()).find("the INS is frozen: one pose from 15.0 to 29.9") == 0);
  // One cause is reported once, although its numbers repeat, too.
  size_t fatal_findings = 0;
  for (const LogNote& note : toDrive(toDriveLog("a.lcmlog", log.sorted())).notes)
    fatal_findings += note.isFatal();
  CHECK(fatal_findings == 1);
}

TEST_CASE("what hung while it drove is no measurement at the standstill after it") {
  SmallLog log;
  for (int i = 0; i < 600; ++i) {
    const double time = 0.05 * i;
    log.motor(time, time < 20.0 ? TrackCommand{1.0, 1.0} : TrackCommand{});
    log.ins(time, {std::min(time, 10.0), 0.0, 0.0}, 0.2);
  }
  const Drive result = toDrive(toDriveLog("a", log.sorted()));
  REQUIRE(fatal(log.sorted()).find("the INS is frozen: one pose from 10.0 to 29.9") == 0);
  for (const Segment& segment : result.segments)
    for (const InsSample& sample : segment.ins)
      REQUIRE(std::isfinite(sample.T_map_body.x) == (sample.time < 10.01));
}

TEST_CASE("an INS that sends one message again and again is frozen, too") {
  SmallLog log = goodLog();
  const LogEvent last = log.events.back().channel == std::string("INS")
                            ? log.events.back()
                            : log.events[log.events.size() - 2];
  REQUIRE(last.channel == "INS");
  for (int i = 0; i < 100; ++i) log.events.push_back(last);
  REQUIRE(fatal(log.sorted()).find("the INS is frozen: one message of 29.9 s") == 0);
}

TEST_CASE("a robot that stands, or is told so little that it may stand, has no frozen INS") {
  SmallLog log;
  Pose2 T_map_body;
  for (int i = 0; i < 900; ++i) {
    const double time = 0.05 * i;
    const double command = time < 15.0 ? 1.0 : time < 25.0 ? 0.1 : time < 35.0 ? 0.0 : 1.0;
    log.motor(time, {command, command});
    log.ins(time, T_map_body, 0.0);
    if (command == 1.0) T_map_body.x += 0.05;
  }
  REQUIRE(fatal(log.sorted()) == "");
}

TEST_CASE("arbitrary bytes and numbers that are none never break the reader") {
  SmallLog log = goodLog();
  LogEvent odd;
  odd.utime = at(3.0);
  odd.channel = "MOTOR";
  odd.bytes = {1, 2, 3};
  log.events.push_back(odd);
  odd.channel = "INS";
  odd.bytes.clear();
  log.events.push_back(odd);
  log.motor(3.01, {kNaN, 1.0});
  log.ins(3.02, {kNaN, 1.0, kNaN}, kNaN);
  log.ins(3.03, {1e300, -1e300, 0.0}, 1e300);
  const auto events = log.sorted();
  REQUIRE(noted(events, "broken or of another type, left out: 1 on INS and 1 on MOTOR"));
  REQUIRE(noted(events, "1 MOTOR messages without a number as command"));
}

TEST_CASE("commands of two kinds cannot be explained by one model") {
  SmallLog log = goodLog();
  for (int i = 0; i < 100; ++i) {
    log.motor(30.0 + 0.05 * i, {0.1, 0.1});
    motor_t motor = log.lastMotor();
    motor.channel_kind[0] = motor.channel_kind[1] = 1;
    log.events.pop_back();
    log.add(kMotor, motor);
  }
  REQUIRE(fatal(log.sorted()).find("commands of two kinds: 100 power, 600 track speed") == 0);
}
