// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// lcm-logplayer, an external program, plays imported logs to the real tread-learner.
#include <catch2/catch.hpp>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>

#include "common/bus/lcm_bus.hpp"
#include "common/pattern/pattern_file.hpp"
#include "common/recordings/csv_table.hpp"
#include "common/recordings/recorded_drive.hpp"
#include "common/vehicle/model_file.hpp"
#include "tests/system/process.hpp"
#include "tests/tools/lab/replay/synthetic_drive.hpp"
#include "tools/lab/replay/robot_learner.hpp"
#include "tools/lab/replay/robot_planner.hpp"
#include "tools/lab/replay/robot_replay.hpp"
#include "tools/robot/report/logged_learner.hpp"

using namespace tread;
using namespace tread::replay;
using namespace tread::samples;
using namespace tread::testing;

namespace {

/// A temporary folder with everything that a run needs and produces.
class Folder {
 public:
  explicit Folder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() /
              ("tread_live_" + name + std::to_string(getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

/// A learner with this pattern file and gates for a log without a learner.
std::string learnerYaml(const std::string& patterns) {
  return "patterns: \"" + patterns +
         "\"\nstore: state/x\nrule: multi_model\ngates:\n  max_gap: 0.3\n  any_entry: true\n";
}

/// A running learner that receives a played log; its messages are stored.
class LiveLearner {
 public:
  LiveLearner(const std::string& name, std::vector<LogEvent> events, const VehicleModel& model,
              const std::string& speed)
      : folder_(name), name_(name) {
    const PatternSet set = predictedSet(toLearnerLog(name, events), model);
    std::ofstream(folder_.file("patterns.yaml")) << formatPatterns(set);
    std::ofstream(folder_.file("learner.yaml")) << learnerYaml(folder_.file("patterns.yaml"));
    LogWriter writer(folder_.file("played.lcmlog"));
    for (const LogEvent& event : events)
      writer.write(event.utime, event.channel, event.bytes.data(), event.bytes.size());
    writer.close();
    bus_ = std::make_unique<LcmBus>(url_, TimeSource::kHost);
    keep(kIns);
    keep(kMotor);
    keep(kExecution);
    keep(kLearning);
    keep(kPatternSet);
    keep(kLearnerState);
    keep(kHealth);
    keep(kConfig);
    learner_ = std::make_unique<Process>(
        "tread-learner",
        std::vector<std::string>{"--config", folder_.file("learner.yaml"), "--set",
                                 "store=" + folder_.file("state"), "--lcm-url", url_},
        folder_.file("said"));
    // Messages in flight when HEALTH is sent are earlier in the log, but not in its count.
    REQUIRE(until(
        [this] {
          return std::any_of(heard_.begin(), heard_.end(),
                             [](const LogEvent& event) { return event.channel == kHealth.name; });
        },
        20.0));
    player_ = std::make_unique<Process>(
        TREAD_LOGPLAYER,
        std::vector<std::string>{"--lcm-url=" + url_, "-s", speed, "-e", channelFilter("learner"),
                                 folder_.file("played.lcmlog")});
  }

  /// Listens until the log has been played and its executions are given up; replays the received
  /// messages.
  LearnerCheck finish(double seconds) {
    REQUIRE(until([this] { return player_->waitFor(0); }, seconds));
    until([] { return false; }, 4.0);
    const RobotLog run = toRobotLog(name_, std::move(heard_));
    const Intake intake = intakeOf(run, "learner", playedChannels("learner"));
    CHECK(intake.lost == 0);
    CHECK(intake.heard == intake.in_log);
    return checkLearner(run, report::learnerConfigOf(run, folder_.file("")));
  }

 private:
  template <class Message>
  void keep(const Channel<Message>& channel) {
    bus_->subscribe<Message>(channel, [this, channel](const Message& message) {
      heard_.push_back({bus_->now(), channel.name, encoded(message)});
    });
  }

  template <class Condition>
  bool until(Condition condition, double seconds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (!condition()) {
      if (std::chrono::steady_clock::now() > end) return false;
      bus_->handle(20);
    }
    return true;
  }

  Folder folder_;
  std::string name_;
  std::string url_ = ownLcmUrl();
  std::unique_ptr<LcmBus> bus_;
  std::vector<LogEvent> heard_;
  std::unique_ptr<Process> learner_;
  std::unique_ptr<Process> player_;
};

bool possible() {
  if (!std::filesystem::exists(TREAD_LOGPLAYER)) {
    WARN("skipped: no lcm-logplayer; tools/setup installs it");
    return false;
  }
  try {
    const LcmBus bus(ownLcmUrl(), TimeSource::kHost);
    return true;
  } catch (const std::runtime_error& error) {
    WARN("skipped: " << error.what());
    return false;
  }
}

/// The first seconds of a real drive; empty without recordings.
std::vector<LogEvent> realDrive(const std::string& name, double seconds) {
  const char* recordings = std::getenv("TREAD_RECORDINGS");
  const std::string drive = std::string(recordings ? recordings : "") + "/drive/";
  if (!std::filesystem::exists(drive + "sessions.csv")) return {};
  const auto session = recordings::readSession(drive + "sessions.csv", name);
  recordings::ImportCounts counts;
  auto events =
      recordings::makeLog(recordings::readSteps(drive + "steps/" + name + ".csv", session), session,
                          "steps", {}, counts);
  const int64_t end = events.front().utime + std::llround(seconds * 1e6);
  while (events.back().utime > end) events.pop_back();
  return events;
}

void requireEqual(const LearnerCheck& check) {
  INFO(reportOf(check));
  REQUIRE(check.learning.equal >= 5);
  REQUIRE(check.measured >= 1);
  REQUIRE(check.equal());
}

}  // namespace

TEST_CASE("a played log gives the running learner the reports of the virtual replay, to the bit") {
  if (!possible()) return;
  recordings::Session session;
  session.name = "synthetic";
  session.surface = "ice";
  session.pose_rate = 20.0;
  recordings::ImportCounts counts;
  auto events = recordings::makeLog(syntheticRecording(plainModel(0.9, 0.5), 4), session, "steps",
                                    {}, counts);
  LiveLearner run("synthetic", std::move(events), plainModel(1.0, 1.0), "1");
  requireEqual(run.finish(60.0));
}

TEST_CASE("real grass and sand, played at the same time, lose nothing") {
  if (!possible()) return;
  std::vector<LogEvent> grass = realDrive("warthog_grass_20240920a", 60.0);
  std::vector<LogEvent> sand = realDrive("warthog_sand_20240925a", 60.0);
  if (grass.empty() || sand.empty()) {
    WARN("skipped: no recordings (TREAD_RECORDINGS)");
    return;
  }
  const VehicleModel model = readModelFile(TREAD_SOURCE_DIR "/config/models/warthog_asphalt.yaml");
  LiveLearner on_grass("grass", std::move(grass), model, "1");
  LiveLearner on_sand("sand", std::move(sand), model, "1");
  requireEqual(on_grass.finish(90.0));
  // This recorder was delayed for a minute: its messages of that time have the same recording time.
  requireEqual(on_sand.finish(30.0));
}
