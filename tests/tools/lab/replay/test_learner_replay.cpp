// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <limits>

#include "common/recordings/csv_table.hpp"
#include "common/recordings/recorded_drive.hpp"
#include "common/vehicle/model_file.hpp"
#include "tests/tools/lab/replay/synthetic_drive.hpp"
#include "tools/lab/replay/learner_replay.hpp"
#include "tools/lab/replay/pose_comparison.hpp"

using namespace tread;
using namespace tread::replay;
using namespace tread::samples;

namespace {

/// The ground halves every turn; the predicting model does not know it.
const VehicleModel kTruth = plainModel(0.9, 0.5);
const VehicleModel kModel = plainModel(1.0, 1.0);

learner::LearnerNodeConfig configFor(const PatternSet& set, learner::Rule rule) {
  learner::LearnerNodeConfig config(set);
  config.rule.rule = rule;
  config.limits.entry_speed = config.limits.entry_yaw_rate =
      std::numeric_limits<double>::infinity();
  return config;
}

LearnerRun runOf(const DriveLog& log, learner::Rule rule,
                 Commitment commitment = Commitment::kAhead) {
  return runLearner(log, configFor(predictedSet(log, kModel), rule), commitment, rule);
}

/// Mean of the last part of a run.
ErrorSummary lateErrors(const LearnerRun& run) {
  return summarise({run.learned.begin() + static_cast<std::ptrdiff_t>(run.learned.size() / 2),
                    run.learned.end()});
}

}  // namespace

TEST_CASE("a model predicts one pattern per command step of a log, from the commands applied") {
  const DriveLog log = syntheticLog(syntheticRecording(kTruth, 5));
  REQUIRE(log.executions.size() == 10);
  REQUIRE(log.surfaceAt(log.executions[0].ended) == "ice");
  const PatternSet set = predictedSet(log, kModel);
  REQUIRE(set.patterns().size() == 5);
  REQUIRE(set.content().period_us == 50'000);
  for (const MotionPattern& pattern : set.patterns()) {
    REQUIRE(pattern.commands.size() == 40);
    const TrackCommand command = pattern.commands.front().tracks();
    // Single precision in MOTOR.
    REQUIRE(pattern.end().yaw == Approx(2.0 * (command.right - command.left)).margin(1e-6));
  }
}

TEST_CASE("a model of the other kind of command is refused with one line") {
  const DriveLog log = syntheticLog(syntheticRecording(kTruth, 2));
  VehicleModel power = kModel;
  power.kind = CommandKind::kPower;
  REQUIRE_THROWS_WITH(predictedSet(log, power), Catch::Contains("not of the kind of model"));
}

TEST_CASE("off scores the model itself on every execution") {
  const DriveLog log = syntheticLog(syntheticRecording(kTruth, 8));
  const LearnerRun run = runOf(log, "off");
  REQUIRE(run.learned.size() == 16);
  const PatternSet set = predictedSet(log, kModel);
  for (const learning_t& learned : run.learned) {
    REQUIRE(learned.accepted);
    const double predicted = set.find(learned.learned_pattern_id)->end().yaw;
    REQUIRE(learned.error_yaw == Approx(-0.5 * predicted).margin(1e-4));
  }
}

TEST_CASE("collective carries what one command taught to commands that were never executed") {
  const DriveLog log = syntheticLog(syntheticRecording(kTruth, 40));
  const ErrorSummary off = lateErrors(runOf(log, "off"));
  const ErrorSummary collective = lateErrors(runOf(log, "collective"));
  REQUIRE(off.count == 40);
  REQUIRE(collective.yaw_mean < 0.3 * off.yaw_mean);
  REQUIRE(collective.position_mean < off.position_mean);
}

TEST_CASE("single helps a command that comes twice only if the first was learned in time") {
  const DriveLog log = syntheticLog(syntheticRecording(kTruth, 10));
  const ErrorSummary off = summarise(runOf(log, "off").learned);
  const ErrorSummary ahead = summarise(runOf(log, "single").learned);
  const ErrorSummary prompt = summarise(runOf(log, "single", Commitment::kPrompt).learned);
  // The second execution of a command begins when the first ends: its set was chosen before.
  REQUIRE(ahead.yaw_mean == Approx(off.yaw_mean));
  REQUIRE(prompt.yaw_mean == Approx(0.75 * off.yaw_mean).epsilon(0.01));
}

TEST_CASE("the same log gives the same run, to the bit") {
  const DriveLog log = syntheticLog(syntheticRecording(kTruth, 10));
  const LearnerRun first = runOf(log, "collective");
  const LearnerRun second = runOf(log, "collective");
  REQUIRE(first.learned.size() == second.learned.size());
  for (size_t i = 0; i < first.learned.size(); ++i) {
    REQUIRE(first.learned[i].error_position == second.learned[i].error_position);
    REQUIRE(first.learned[i].result_version == second.learned[i].result_version);
  }
}

TEST_CASE("the report says what came in, what was refused and why, and the errors side by side") {
  recordings::RecordedDrive recording = syntheticRecording(kTruth, 6);
  // The INS is silent for half a second in the first execution of step 2.
  recording.fixes.erase(
      std::remove_if(recording.fixes.begin(), recording.fixes.end(),
                     [](const auto& fix) { return fix.time > 18.0 && fix.time < 18.5; }),
      recording.fixes.end());
  const DriveLog log = syntheticLog(recording);
  const PatternSet set = predictedSet(log, kModel);
  const std::string report = reportOf(log, set, {runOf(log, "off"), runOf(log, "collective")});
  INFO(report);
  REQUIRE(report.find("synthetic: 12 executions in, 11 measured, 1 refused\n") == 0);
  REQUIRE(report.find("1 refused: INS gap") != std::string::npos);
  REQUIRE(report.find("  ice                      11  off") != std::string::npos);
  REQUIRE(report.find("collective") != std::string::npos);
  REQUIRE(report.find("forward turn") != std::string::npos);
}

TEST_CASE("the report is also a picture") {
  const DriveLog log = syntheticLog(syntheticRecording(kTruth, 6));
  const std::string path =
      (std::filesystem::temp_directory_path() / "tread_learner_replay.png").string();
  drawReport(log, predictedSet(log, kModel), {runOf(log, "off"), runOf(log, "collective")}, path);
  REQUIRE(std::filesystem::file_size(path) > 5000);
  std::filesystem::remove(path);
}

TEST_CASE("commands are told apart by what they ask for") {
  const auto classOf = [](double left, double right) {
    MotionPattern pattern;
    pattern.commands.assign(10, {left, right});
    return commandClass(pattern, trackChannels(CommandKind::kPower));
  };
  REQUIRE(classOf(1.0, 1.0) == "forward");
  REQUIRE(classOf(0.6, 1.0) == "forward turn");
  REQUIRE(classOf(-0.5, 1.0) == "counter-rotating");
  REQUIRE(classOf(-1.0, -0.5) == "reverse turn");
  REQUIRE(classOf(-1.0, -1.0) == "reverse");
  REQUIRE(classOf(0.0, 0.0) == "standing");
}

TEST_CASE("messages of other programs in a log are skipped and counted") {
  recordings::Session session;
  session.pose_rate = 20.0;
  recordings::ImportCounts counts;
  auto events = recordings::makeLog(syntheticRecording(kTruth, 2), session, "steps", {}, counts);
  LogEvent other;
  other.utime = events[5].utime;
  other.channel = "INS";
  other.bytes = {1, 2, 3};
  events.push_back(other);
  other.channel = "POSE";
  events.push_back(other);
  const DriveLog log = toLearnerLog("other", events);
  REQUIRE_THAT(log.problem, Catch::Contains("broken or of another type, left out: 1 on "));
  REQUIRE(log.executions.size() == 4);
}

TEST_CASE("a log without executions is refused with what to do") {
  const std::string path =
      (std::filesystem::temp_directory_path() / "tread_empty_drive.log").string();
  { LogWriter writer(path); }
  REQUIRE_THROWS_WITH(readLearnerLog(path), Catch::Contains("tread-import makes one"));
  std::filesystem::remove(path);
  REQUIRE_THROWS(readLearnerLog("/nowhere/at/all.log"));
}

TEST_CASE("real grass goes through the learner") {
  const char* recordings = std::getenv("TREAD_RECORDINGS");
  const std::string drive = std::string(recordings ? recordings : "") + "/drive/";
  if (!std::filesystem::exists(drive + "sessions.csv")) {
    WARN("skipped: no recordings in " + drive);
    return;
  }
  const auto session = recordings::readSession(drive + "sessions.csv", "warthog_grass_20240729c");
  recordings::ImportCounts counts;
  const DriveLog log = toLearnerLog(
      session.name, recordings::makeLog(
                        recordings::readSteps(drive + "steps/warthog_grass_20240729c.csv", session),
                        session, "steps", {}, counts));
  const PatternSet set = predictedSet(
      log, readModelFile(std::string(TREAD_SOURCE_DIR) + "/config/models/warthog_asphalt.yaml"));
  const LearnerRun off = runLearner(log, configFor(set, "off"), Commitment::kAhead, "off");
  const LearnerRun collective =
      runLearner(log, configFor(set, "collective"), Commitment::kAhead, "collective");
  REQUIRE(off.learned.size() == 40);
  REQUIRE(summarise(off.learned).count >= 35);
  REQUIRE(summarise(collective.learned).count == summarise(off.learned).count);
  REQUIRE(summarise(collective.learned).yaw_mean < summarise(off.learned).yaw_mean);
}

namespace {

/// The events of a drive with its poses also on SCAN_MATCHING, modified by `change`.
std::vector<LogEvent> withScanMatching(const DriveLog& log,
                                       const std::function<void(ins_t&)>& change) {
  std::vector<LogEvent> events = log.events;
  for (const LogEvent& event : log.events) {
    ins_t message;
    if (!decode(event, kIns, message)) continue;
    change(message);
    LogEvent other{event.utime, kScanMatching.name, {}};
    other.bytes.resize(static_cast<size_t>(message.getEncodedSize()));
    message.encode(other.bytes.data(), 0, static_cast<int>(other.bytes.size()));
    events.push_back(std::move(other));
  }
  std::stable_sort(events.begin(), events.end(),
                   [](const LogEvent& a, const LogEvent& b) { return a.utime < b.utime; });
  return events;
}

}  // namespace

TEST_CASE("the learner is compared with itself, fed by the poses of scan matching") {
  const DriveLog log = syntheticLog(syntheticRecording(kTruth, 12));
  const learner::LearnerNodeConfig config = configFor(predictedSet(log, kModel), "collective");
  const auto compared = [&](const std::function<void(ins_t&)>& change) {
    return comparePoses("drive", withScanMatching(log, change), kScanMatching.name, config);
  };

  const PoseComparison same = compared([](ins_t&) {});
  INFO(reportOf(same));
  CHECK(same.learned_with_ins >= 10);
  CHECK(same.learned_with_other == same.learned_with_ins);
  CHECK(same.corrected.position > 0.1);
  CHECK(same.apart.position < 1e-9);
  CHECK(same.measured_apart < 1e-9);
  CHECK(same.errors_with_other.position_mean ==
        Approx(same.errors_with_ins.position_mean).margin(1e-9));

  // Scans that make each path 10 % too short.
  const PoseComparison shorter = compared([](ins_t& message) {
    message.position[0] *= 0.9;
    message.position[1] *= 0.9;
  });
  INFO(reportOf(shorter));
  CHECK(shorter.apart.position > 0.01);
  CHECK(shorter.measured_apart > 0.1);
  CHECK(shorter.apart.yaw < 0.2 * shorter.corrected.yaw);

  CHECK_THROWS_WITH(comparePoses("drive", log.events, kScanMatching.name, config),
                    Catch::Contains("drive: no SCAN_MATCHING"));
}
