// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <chrono>
#include <thread>

#include "common/bus/host_clock.hpp"
#include "common/bus/lcm_bus.hpp"
#include "common/messages/blank.hpp"
#include "tests/system/starter.hpp"

using namespace tread;
using tread::testing::Starter;

namespace {

void sleepFor(int milliseconds) {
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

/// Works until it is told to hang, in its step or in a handler.
class Worker : public Node {
 public:
  explicit Worker(Bus& bus) {
    bus.subscribe<mark_t>(kMark, [this](const mark_t&) { hang(hang_in_handler); });
  }
  int64_t period() const override { return 5'000; }
  void step(int64_t /*utime*/) override { hang(hang_in_step); }
  std::atomic<bool> hang_in_step{false};
  std::atomic<bool> hang_in_handler{false};

 private:
  static void hang(const std::atomic<bool>& hanging) {
    while (hanging) sleepFor(1);
  }
};

/// An in-memory bus with a worker in a separate thread.
class Works {
 public:
  Works() : runner_([this] { bus_.run(worker, stop_); }) {}
  ~Works() {
    worker.hang_in_step = worker.hang_in_handler = false;
    stop_ = true;
    runner_.join();
  }
  Works(const Works&) = delete;
  Works& operator=(const Works&) = delete;

 private:
  LcmBus bus_{"memq://", TimeSource::kHost};
  std::atomic<bool> stop_{false};

 public:
  Worker worker{bus_};
  void speak() { bus_.publish(kMark, blank<mark_t>()); }

 private:
  std::thread runner_;
};

int beats(Starter& starter) {
  return starter.count(getpid(), "WATCHDOG=1");
}

}  // namespace

TEST_CASE("a step that hangs ends the signs of life, and they return with it") {
  Starter starter;
  Works works;
  for (int i = 0; i < 100 && beats(starter) < 2; ++i) sleepFor(20);
  REQUIRE(beats(starter) >= 2);
  works.worker.hang_in_step = true;
  sleepFor(50);
  const int before = beats(starter);
  sleepFor(700);
  CHECK(beats(starter) == before);
  works.worker.hang_in_step = false;
  sleepFor(400);
  CHECK(beats(starter) > before);
}

TEST_CASE("a handler that hangs ends the signs of life") {
  Starter starter;
  Works works;
  for (int i = 0; i < 100 && beats(starter) < 2; ++i) sleepFor(20);
  works.worker.hang_in_handler = true;
  works.speak();
  sleepFor(100);
  const int before = beats(starter);
  sleepFor(700);
  CHECK(beats(starter) == before);
}

TEST_CASE("a starter that does not listen keeps nobody waiting, and still hears of the readiness") {
  Starter starter;
  LifeSign life;
  for (int i = 0; i < 100; ++i) life.tell("line " + std::to_string(i));  // its queue is full
  const int64_t begun = hostNow();
  for (int i = 1; i < 20; ++i) life.beat(begun + i * 1'000'000);
  CHECK(hostNow() - begun < 100'000);
  CHECK(starter.count(getpid(), "READY=1") == 0);
  life.beat(begun + 30'000'000);
  CHECK(starter.count(getpid(), "READY=1") == 1);
}

TEST_CASE("what a process is goes out as one line, once") {
  Starter starter;
  LifeSign life;
  for (int i = 0; i < 3; ++i) life.tell("DEGRADED: a\nREADY=1");
  CHECK(starter.count(getpid(), "STATUS=DEGRADED: a READY=1") == 1);
  CHECK(starter.count(getpid(), "READY=1") == 0);
}

TEST_CASE(
    "without a starter, with a place that is none or too long, nothing is said and nothing "
    "breaks") {
  for (const std::string& place : {std::string(), std::string("vsock:2:1"),
                                   "/" + std::string(200, 'x'), std::string("/nobody/is/here")}) {
    setenv("NOTIFY_SOCKET", place.c_str(), 1);
    LifeSign life;
    life.beat(0);
    life.tell("x");
    life.stopping();
  }
  unsetenv("NOTIFY_SOCKET");
  LifeSign().stopping();
}
