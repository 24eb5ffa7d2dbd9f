// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <algorithm>
#include <random>

#include "common/drive/drive_timeline.hpp"
#include "common/messages/blank.hpp"

using namespace tread;

namespace {

/// 10 s from x 0 to 10 m, messages at 50 Hz.
std::vector<LogEvent> tenMetresDriven() {
  DriveLogBuilder log;
  for (int i = 0; i <= 500; ++i) {
    auto ins = blank<ins_t>();
    ins.utime = 1'000'000 + i * 20'000;
    ins.ins_status = ins_t::STATUS_GOOD;
    ins.position[0] = 0.02 * i;
    ins.position[1] = ins.position[2] = 0.0;
    DriveLogBuilder::setAttitude(ins, 0.0);
    log.add(kIns, ins);
  }
  return log.sorted();
}

ins_t insOf(const LogEvent& event) {
  ins_t ins{};
  REQUIRE(decode(event, kIns, ins));
  return ins;
}

double metresIn(const std::vector<LogEvent>& events) {
  return timelineOf(DriveReader(events)).distance;
}

}  // namespace

TEST_CASE("metres are counted between poses, standing adds none") {
  std::vector<LogEvent> events = tenMetresDriven();
  CHECK(metresIn(events) == Approx(10.0).margin(0.06));
  for (int i = 1; i <= 1000; ++i) {
    ins_t ins = insOf(events[500]);
    ins.utime += i * 20'000;
    ins.position[0] += i % 2 == 0 ? 0.02 : -0.02;
    events.push_back(eventOf(kIns, ins));
  }
  CHECK(metresIn(events) == Approx(10.0).margin(0.06));
}

TEST_CASE("no metres lie between poses that do not follow each other") {
  const std::vector<LogEvent> events = tenMetresDriven();
  SECTION("the robot's clock begins anew") {
    std::vector<LogEvent> twice = events;
    twice.insert(twice.end(), events.begin(), events.end());
    CHECK(metresIn(twice) == Approx(20.0).margin(0.12));
  }
  SECTION("events are out of order") {
    std::vector<LogEvent> shuffled = events;
    std::mt19937 random(3);
    std::shuffle(shuffled.begin() + 150, shuffled.begin() + 220, random);
    CHECK(metresIn(shuffled) == Approx(10.0).margin(0.06));
  }
  SECTION("the INS tells a jump") {
    std::vector<LogEvent> jumping = events;
    for (size_t i = 250; i < jumping.size(); ++i) {
      ins_t ins = insOf(jumping[i]);
      ins.position[1] += 0.9;
      if (i == 250) ins.ins_status |= ins_t::STATUS_JUMP;
      jumping[i] = eventOf(kIns, ins);
    }
    CHECK(metresIn(jumping) == Approx(10.0).margin(0.12));
  }
  SECTION("a pose is farther than a vehicle can go, or no number of a map") {
    for (const double x : {100.0, 1e5, 1e9}) {
      std::vector<LogEvent> spiked = events;
      ins_t ins = insOf(spiked[250]);
      ins.position[0] = x;
      spiked[250] = eventOf(kIns, ins);
      CHECK(metresIn(spiked) == Approx(10.0).margin(0.12));
    }
  }
  SECTION("an event's time cannot be") {
    std::vector<LogEvent> wrong = events;
    ins_t ins = insOf(wrong[250]);
    ins.utime += 3'600'000'000'000;
    wrong[250] = eventOf(kIns, ins);
    CHECK(metresIn(wrong) == Approx(10.0).margin(0.06));
  }
}
