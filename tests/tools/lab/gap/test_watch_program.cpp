// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "common/bus/virtual_bus.hpp"
#include "common/messages/blank.hpp"
#include "common/vehicle/model_file.hpp"
#include "tests/tools/lab/gap/gap_program.hpp"
#include "tests/tools/lab/gap/small_log.hpp"
#include "tools/lab/gap/watch_node.hpp"

namespace tread::gap {
namespace {

using samples::Folder;
using samples::run;
using samples::Run;

constexpr const char* kWatchedModel = "name: watched\nkind: track_speed\ngauge: 1.0\nlag: 0.2\n";

/// Arcs of two seconds, with a few per cent of ground noise; from `from` on the left drive has this
/// share of its command.
std::vector<LogEvent> driveWithLeft(double seconds, double from, double gain,
                                    double stands_until = 0.0) {
  const ModelDocument model = parseModelDocument(kWatchedModel, "model");
  VehicleKernel kernel(model.vehicle, EntryState{});
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::normal_distribution<double> gauss(0.0, 1.0);
  tread::samples::SmallLog log;
  TrackCommand asked{};
  const auto ticks = static_cast<int>(std::lround(seconds / 0.05));
  for (int i = 0; i < ticks; ++i) {
    const double time = 0.05 * i;
    if (i % 40 == 0) {
      asked = {0.6 + 0.4 * uniform(random), 0.6 + 0.4 * uniform(random)};
      kernel.setNoise({1.0 + 0.02 * gauss(random), 1.0 + 0.02 * gauss(random), 0.0});
    }
    if (time < stands_until) {
      log.motor(time, {}, motor_t::STATE_ARMED);
      log.ins(time, kernel.pose(), 0.0);
      continue;
    }
    log.motor(time, asked);
    const Pose2 pose = kernel.pose();
    log.ins(time, {pose.x + 0.005 * gauss(random), pose.y + 0.005 * gauss(random), pose.yaw},
            kernel.twist().omega);
    kernel.step({asked.left * (time >= from ? gain : 1.0), asked.right}, 0.05);
  }
  return log.sorted();
}

void writeEvents(const std::vector<LogEvent>& events, const std::string& path) {
  LogWriter writer(path);
  for (const LogEvent& event : events)
    writer.write(event.utime, event.channel, event.bytes.data(), event.bytes.size());
  writer.flush();
}

/// Publishes a log's messages when they are due.
class Player : public Node {
 public:
  Player(Bus& bus, const std::vector<LogEvent>& events) : bus_(bus), events_(events) {}
  int64_t period() const override { return 50'000; }
  void step(int64_t utime) override {
    for (; next_ < events_.size() && events_[next_].utime <= utime; ++next_) {
      ins_t ins{};
      motor_t motor{};
      if (decode(events_[next_], kIns, ins)) bus_.publish(kIns, ins);
      if (decode(events_[next_], kMotor, motor)) bus_.publish(kMotor, motor);
    }
  }

 private:
  Bus& bus_;
  const std::vector<LogEvent>& events_;
  size_t next_ = 0;
};

TEST_CASE("watch says in one line what a recording has that its model has not, and since when") {
  const Folder folder;
  const std::string model = folder.write("model.yaml", kWatchedModel);
  writeEvents(driveWithLeft(600.0, 200.0, 0.9), folder.path("weak.lcmlog"));
  const Run weak = run("watch --model " + model + " " + folder.path("weak.lcmlog"));
  INFO(weak.printed);
  CHECK(weak.status == 10);
  CHECK(weak.isOneLine());
  CHECK((weak.says("since 19") || weak.says("since 20")));
  CHECK(weak.says("the left drive gives 10 % less than the model says"));
  writeEvents(driveWithLeft(300.0, 1000.0, 1.0), folder.path("sound.lcmlog"));
  const Run sound = run("watch --model " + model + " " + folder.path("sound.lcmlog"));
  INFO(sound.printed);
  CHECK(sound.status == 0);
  CHECK(sound.isOneLine());
  CHECK(sound.says("nothing new in 2"));
}

TEST_CASE("a robot that stands armed before it drives is watched when it drives") {
  const Folder folder;
  writeEvents(driveWithLeft(200.0, 1000.0, 1.0, 60.0), folder.path("drive.lcmlog"));
  const Run drive = run("watch --model " + folder.write("model.yaml", kWatchedModel) + " " +
                        folder.path("drive.lcmlog"));
  INFO(drive.printed);
  CHECK(drive.status == 0);
  CHECK(drive.says("nothing new in 1"));
}

TEST_CASE("watch refuses a robot of other commands, and logs that are none, in one line") {
  const Folder folder;
  writeEvents(driveWithLeft(60.0, 100.0, 1.0), folder.path("drive.lcmlog"));
  const std::string power =
      folder.write("power.yaml", "name: p\nkind: power\nfull_speed: 1\ngauge: 1\n");
  for (const Run& refused :
       {run("watch --model " + power + " " + folder.path("drive.lcmlog")),
        run("watch --model " + power + " " + folder.path("none.lcmlog")),
        run("watch --model " + power + " " + folder.write("notes.txt", "no log\n")),
        run("watch --model " +
            folder.write("battery.yaml", std::string(kWatchedModel) + "effects:\n  battery_sag:\n"
                                                                      "    per_drop: 0.5\n") +
            " " + folder.path("drive.lcmlog"))}) {
    INFO(refused.printed);
    CHECK(refused.status == 2);
    CHECK(refused.isOneLine());
  }
}

TEST_CASE("watch tells a running robot's log and HEALTH what is new") {
  const std::vector<LogEvent> events = driveWithLeft(400.0, 100.0, 0.85);
  VirtualBus bus(1);
  const ModelDocument model = parseModelDocument(kWatchedModel, "model");
  std::vector<mark_t> marks;
  health_t health{};
  bus.outside().subscribe<mark_t>(kMark, [&](const mark_t& mark) { marks.push_back(mark); });
  bus.outside().subscribe<health_t>(kHealth, [&](const health_t& said) {
    if (said.process == "gap_watch") health = said;
  });
  bus.addNode("player", [&](Bus& own) { return std::make_unique<Player>(own, events); });
  bus.addNode("watch",
              [&](Bus& own) { return std::make_unique<WatchNode>(own, model, WatchLimits{}); });
  bus.runUntil(120'000'000);
  CHECK(marks.empty());
  CHECK(health.health_state == health_t::HEALTH_OK);
  bus.runUntil(410'000'000);
  REQUIRE(marks.size() == 1);
  CHECK(marks[0].mark_kind == "gap");
  CHECK(marks[0].mark_value.find("the left drive gives 15 % less") != std::string::npos);
  CHECK(health.health_state == health_t::HEALTH_DEGRADED);
  CHECK(health.health_reason == marks[0].mark_value);
}

TEST_CASE("watch says once that a running robot's commands are not its model's, and lives on") {
  const std::vector<LogEvent> events = driveWithLeft(60.0, 100.0, 1.0);
  VirtualBus bus(1);
  const ModelDocument model =
      parseModelDocument("name: p\nkind: power\nfull_speed: 1\ngauge: 1\n", "model");
  health_t health{};
  bus.outside().subscribe<health_t>(kHealth, [&](const health_t& said) {
    if (said.process == "gap_watch") health = said;
  });
  bus.addNode("player", [&](Bus& own) { return std::make_unique<Player>(own, events); });
  bus.addNode("watch",
              [&](Bus& own) { return std::make_unique<WatchNode>(own, model, WatchLimits{}); });
  bus.runUntil(60'000'000);
  CHECK(health.health_state == health_t::HEALTH_FAILED);
  CHECK(health.health_reason.find("another kind") != std::string::npos);
}

}  // namespace
}  // namespace tread::gap
