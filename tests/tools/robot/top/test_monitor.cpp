// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "common/log/event_log.hpp"
#include "common/messages/blank.hpp"
#include "tools/robot/top/monitor.hpp"

using namespace tread;
using namespace tread::top;

namespace {

/// A monitor with the time set by the test.
struct Watched {
  Monitor monitor;
  int64_t now = 1'000'000'000;

  template <class Message>
  void add(const Channel<Message>& channel, const Message& message) {
    const auto bytes = encoded(message);
    monitor.take(channel.name, bytes.data(), bytes.size(), now);
  }
  /// INS at a rate for a time; each `gap`-th message is missing.
  void drive(double seconds, double rate, int gap = 0) {
    for (int i = 0; i < static_cast<int>(seconds * rate); ++i) {
      now += static_cast<int64_t>(1e6 / rate);
      auto ins = blank<ins_t>();
      ins.utime = now;
      ins.seq = seq++;
      if (gap == 0 || i % gap != gap - 1) add(kIns, ins);
    }
  }
  Line lineWith(const std::string& words) const {
    for (const Line& line : monitor.lines(now))
      if (line.text.find(words) != std::string::npos) return line;
    return {Mood::kPlain, "no line with " + words};
  }
  int64_t seq = 0;
};

}  // namespace

TEST_CASE("a channel at its rate is plain, a slow one is told, a silent one is bad") {
  Watched watched;
  watched.drive(4.0, 50.0);
  CHECK(watched.lineWith("INS").mood == Mood::kPlain);
  CHECK_THAT(watched.lineWith("INS").text, Catch::Contains("50.") && Catch::Contains(" 0"));
  watched.drive(4.0, 20.0);
  CHECK(watched.lineWith("INS").mood == Mood::kDoubt);
  CHECK_THAT(watched.lineWith("INS").text, Catch::EndsWith("slow"));
  watched.now += 2'000'000;
  CHECK(watched.lineWith("INS").mood == Mood::kBad);
  CHECK_THAT(watched.lineWith("INS").text, Catch::EndsWith("silent"));
}

TEST_CASE("what is missing by number is counted, and several senders of a channel are told apart") {
  Watched watched;
  watched.drive(4.0, 50.0, 10);
  CHECK_THAT(watched.lineWith("INS").text, Catch::Contains("    19"));
  for (int i = 0; i < 10; ++i)
    for (const char* process : {"planner", "learner"}) {
      auto health = blank<health_t>();
      health.process = process;
      health.seq = process[0] == 'p' ? i : 500 + i;
      watched.add(kHealth, health);
    }
  CHECK_THAT(watched.lineWith("HEALTH").text, Catch::EndsWith("     0"));
}

TEST_CASE("processes are shown with their words, and grow silent") {
  Watched watched;
  auto health = blank<health_t>();
  health.process = "planner";
  health.health_state = health_t::HEALTH_DEGRADED;
  health.health_reason = "no INS for 2 s";
  watched.add(kHealth, health);
  CHECK(watched.lineWith("planner  ").mood == Mood::kDoubt);
  CHECK_THAT(watched.lineWith("degraded").text, Catch::Contains("no INS for 2 s"));
  watched.now += 4'000'000;
  CHECK(watched.lineWith("silent").mood == Mood::kBad);
}

TEST_CASE("the motors' state stands at the top, and that they are not heard") {
  Watched watched;
  CHECK(watched.monitor.lines(watched.now)[0].mood == Mood::kBad);
  auto motor = blank<motor_t>();
  motor.bridge_state = motor_t::STATE_ESTOP;
  motor.state_reason = "E-stop: a person";
  watched.add(kMotor, motor);
  CHECK(watched.monitor.lines(watched.now)[0].text == "motors   E-STOP: E-stop: a person");
}

TEST_CASE("foreign channels and broken messages are shown, and crash nothing") {
  Watched watched;
  const uint8_t bytes[5] = {1, 2, 3, 4, 5};
  watched.monitor.take("CAMERA", bytes, 5, watched.now);
  watched.monitor.take("INS", bytes, 5, watched.now);
  watched.monitor.take("INS", bytes, 0, watched.now);
  CHECK_THAT(watched.lineWith("CAMERA").text, Catch::EndsWith("not of Tread"));
  CHECK_THAT(watched.lineWith("INS").text, Catch::EndsWith("2 broken"));
}

TEST_CASE("the kernel's losses are counted from the beginning") {
  const auto counters = kernelCounters(
      "Tcp: a b\nTcp: 1 2\nUdp: InDatagrams NoPorts InErrors OutDatagrams RcvbufErrors\n"
      "Udp: 100 2 7 90 5\n");
  REQUIRE(counters);
  CHECK(counters->buffer_errors == 5);

  CHECK_FALSE(kernelCounters("Tcp: a\n"));
  Watched watched;
  watched.monitor.take(*counters);
  watched.monitor.take(KernelCounters{9});
  CHECK_THAT(watched.lineWith("kernel").text, Catch::Contains("4 datagrams"));
  CHECK(watched.lineWith("kernel").mood == Mood::kBad);
}

TEST_CASE("names that somebody makes up do not fill the screen, nor memory") {
  Watched watched;
  const uint8_t bytes[5] = {1, 2, 3, 4, 5};
  for (int i = 0; i < 1000; ++i) {
    watched.monitor.take("CHANNEL_" + std::to_string(i), bytes, 5, watched.now);
    auto health = blank<health_t>();
    health.process = "process_" + std::to_string(i);
    watched.add(kHealth, health);
  }
  CHECK(watched.monitor.lines(watched.now).size() < 150);
  watched.monitor.setDoubt("messages not shown: 120 unsealed");
  const auto lines = watched.monitor.lines(watched.now);
  CHECK(std::any_of(lines.begin(), lines.end(), [](const Line& line) {
    return line.mood == Mood::kBad && line.text == "trust    messages not shown: 120 unsealed";
  }));
}
