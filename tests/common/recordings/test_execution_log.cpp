// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdlib>

#include "common/recordings/csv_table.hpp"
#include "common/recordings/execution_log.hpp"
#include "tests/common/recordings/synthetic_drives.hpp"
#include "tests/helpers.hpp"
#include "tools/lab/replay/learner_report.hpp"

using namespace tread;
using namespace tread::recordings;
using namespace tread::samples;

namespace {

DriveRecordings syntheticRecordings() {
  const auto hard = drawnWindows(linearGround(0.95, 0.5, -0.05), 60, 0.03, 3);
  const auto soft = drawnWindows(linearGround(0.85, 0.43, -0.10), 60, 0.03, 4);
  return recordingsOf({{"hard", {}, hard, {}}, {"soft", {}, soft, {}}}, defaultRecipe(), 1.08, 2);
}

std::vector<LogEvent> logOf(const DriveRecordings& drives, size_t from, size_t to, int executions,
                            uint64_t seed) {
  ExecutionLogRequest request;
  request.executions = executions;
  request.seed = seed;
  return executionLog(averagedSet(drives, from), drives.recordings.surfaces[from],
                      drives.recordings.surfaces[to], request);
}

/// Runs the log through the learner node on the virtual bus.
replay::LearnerRun learned(const DriveRecordings& drives, size_t from, std::vector<LogEvent> events,
                           learner::Rule rule) {
  learner::LearnerNodeConfig config(averagedSet(drives, from));
  config.rule.rule = rule;
  return replay::runLearner(replay::toLearnerLog("drives", std::move(events)), config,
                            replay::Commitment::kAhead, "run");
}

size_t accepted(const replay::LearnerRun& run) {
  return static_cast<size_t>(std::count_if(run.learned.begin(), run.learned.end(),
                                           [](const learning_t& l) { return l.accepted; }));
}

/// Errors of a range of executions.
replay::ErrorSummary errors(const replay::LearnerRun& run, int64_t first, int64_t last) {
  std::vector<learning_t> part;
  for (const learning_t& learning : run.learned)
    if (learning.learned_execution_id >= first && learning.learned_execution_id <= last)
      part.push_back(learning);
  return replay::summarise(part);
}

}  // namespace

TEST_CASE("executions are whole, each a track of its own with silence before it") {
  const DriveRecordings drives = syntheticRecordings();
  const auto events = logOf(drives, 0, 1, 8, 1);
  const auto ins = messagesOn(kIns, events);
  int tracks = 1;
  for (size_t i = 1; i < ins.size(); ++i) {
    const int64_t gap = ins[i].utime - ins[i - 1].utime;
    const bool new_track = (ins[i].ins_status & ins_t::STATUS_JUMP) != 0;
    CHECK(new_track == (gap > 300'000));
    CHECK((gap == 10'000 || gap == 1'000'000));
    tracks += new_track ? 1 : 0;
  }
  CHECK(tracks == 16);
  const auto executions = messagesOn(kExecution, events);
  REQUIRE(executions.size() == 32);
  CHECK(executions.back().records.size() == 8);
  CHECK(executions.back().records.back().record_set_version == averagedSet(drives, 0).version());
  const auto marks = messagesOn(kMark, events);
  REQUIRE(marks.size() == 2);
  CHECK(marks[1].mark_value == "soft");
  int commands = 0;
  for (const motor_t& motor : messagesOn(kMotor, events)) commands += motor.execution_id > 0;
  CHECK(commands == 16 * 40);
}

TEST_CASE("the learner measures in the log what the recordings hold") {
  const DriveRecordings drives = syntheticRecordings();
  const auto events = logOf(drives, 0, 1, 16, 2);
  const auto run = learned(drives, 0, events, "off");
  CHECK(accepted(run) == 32);
  for (const learning_t& learning : run.learned) {
    const auto& executions = drives.recordings.surfaces[learning.learned_execution_id <= 16 ? 0 : 1]
                                 .executions[static_cast<size_t>(learning.learned_pattern_id - 1)];
    const bool found = std::any_of(executions.begin(), executions.end(), [&](const auto& poses) {
      return std::abs(poses.back().x - learning.measured_end[0]) < 1e-5 &&
             std::abs(poses.back().y - learning.measured_end[1]) < 1e-5 &&
             std::abs(poses.back().yaw - learning.measured_end[2]) < 1e-5;
    });
    CHECK(found);
  }
}

TEST_CASE("a learner that knows one surface adapts to the other through the log") {
  const DriveRecordings drives = syntheticRecordings();
  const auto events = logOf(drives, 0, 1, 48, 1);
  const auto off = learned(drives, 0, events, "off");
  const auto single = learned(drives, 0, events, "single");
  const auto known = errors(off, 1, 48);
  const auto unknown = errors(off, 49, 96);
  const auto adapted = errors(single, 65, 96);  // each pattern was executed twice, then four times
  CHECK(unknown.position_mean > 2.0 * known.position_mean);
  CHECK(adapted.position_mean < 0.6 * unknown.position_mean);
  CHECK(adapted.yaw_mean < 0.6 * unknown.yaw_mean);
}

TEST_CASE("the same seed gives the same log, another seed another one") {
  const DriveRecordings drives = syntheticRecordings();
  const auto same = [](const std::vector<LogEvent>& a, const std::vector<LogEvent>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const LogEvent& x, const LogEvent& y) {
                        return x.utime == y.utime && x.channel == y.channel && x.bytes == y.bytes;
                      });
  };
  CHECK(same(logOf(drives, 0, 1, 8, 5), logOf(drives, 0, 1, 8, 5)));
  CHECK_FALSE(same(logOf(drives, 0, 1, 8, 5), logOf(drives, 0, 1, 8, 6)));
}

TEST_CASE("recordings of another set are refused in one line") {
  const DriveRecordings drives = syntheticRecordings();
  auto broken = drives.recordings.surfaces[1];
  broken.executions[2].front().pop_back();
  CHECK_THROWS_WITH(executionLog(averagedSet(drives, 0), drives.recordings.surfaces[0], broken, {}),
                    Catch::Contains("surface 'soft': pattern 'right' execution ") &&
                        Catch::Contains("is not one finite pose a command"));
  broken.executions.pop_back();
  CHECK_THROWS_WITH(executionLog(averagedSet(drives, 0), drives.recordings.surfaces[0], broken, {}),
                    "surface 'soft': recordings of 7 patterns, the set has 8");
}

TEST_CASE("recorded drives: the learner hears a real change of surface") {
  const std::string folder = tread::testing::recorded("drive");
  if (folder.empty()) {
    WARN("skipped: the recorded drives are not here (TREAD_RECORDINGS)");
    return;
  }
  DriveRequest request;
  request.folder = folder;
  request.robot = "warthog";
  const DriveRecordings drives = recordingsFromDrives(request);
  REQUIRE(drives.recordings.surfaces.size() >= 2);
  for (const auto& surface : drives.recordings.surfaces)
    for (const auto& executions : surface.executions) REQUIRE(executions.size() >= 20);
  for (const SurfaceSummary& surface : drives.surfaces) CHECK(surface.windows >= 100);
  const auto events = logOf(drives, 0, 1, 40, 1);
  const auto off = learned(drives, 0, events, "off");
  const auto collective = learned(drives, 0, events, "collective");
  CHECK(off.learned.size() == 80);
  CHECK(accepted(off) >= 72);
  CHECK(accepted(collective) == accepted(off));
  // Skid steering on real ground: the other surface's predictions are worse than its own.
  CHECK(errors(off, 41, 80).position_mean > errors(off, 1, 40).position_mean);
  CHECK(std::isfinite(errors(collective, 41, 80).yaw_mean));
}
