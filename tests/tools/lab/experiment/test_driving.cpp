// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>

#include <catch2/catch.hpp>

#include "common/log/event_log.hpp"
#include "common/recordings/recorded_drive.hpp"
#include "tests/helpers.hpp"
#include "tests/tools/lab/experiment/drawn_driving.hpp"
#include "tools/lab/experiment/adaptation/read_recordings.hpp"

namespace tread::adaptation {
namespace {

gap::InsSample fix(double time, const Pose2& pose) {
  gap::InsSample sample;
  sample.time = time;
  sample.T_map_body = pose;
  return sample;
}

TEST_CASE("poses are interpolated along the arc, and not across a long silence") {
  const Twist2 twist{1.0, 0.0, 1.0};
  gap::Segment recorded;
  recorded.commands = {{0.0, {1.0, 1.0}}, {0.5, {2.0, 2.0}}};
  recorded.end = 2.0;
  recorded.ins = {fix(0.0, {}), fix(0.5, integrate(twist, 0.5)), fix(1.5, integrate(twist, 1.5)),
                  fix(2.0, integrate(twist, 2.0))};
  const SampledSegment segment = sampled(recorded, true);
  REQUIRE(segment.commands.size() == 40);
  REQUIRE(segment.poses.size() == 41);
  CHECK(segment.commands[9] == TrackCommand{1.0, 1.0});
  CHECK(segment.commands[10] == TrackCommand{2.0, 2.0});
  const Pose2 arc = integrate(twist, 0.25);
  CHECK(segment.poses[5].x == Approx(arc.x));
  CHECK(segment.poses[5].y == Approx(arc.y));
  CHECK(std::isnan(segment.poses[20].x));  // one second without a pose
  CHECK(std::isfinite(segment.poses[35].x));
}

TEST_CASE("pieces follow one another until a pose is missing or jumps") {
  SampledSession session = drawnSession("one", "grass", {}, 4, 0.0, 3);
  REQUIRE(session.pieces.size() == 12);
  for (size_t i = 0; i + 1 < 12; ++i) CHECK(session.goesOn(i));
  const size_t broken = session.pieces[4].begin + 10;
  SampledSession gap = session, jump = session;
  gap.segments[0].poses[broken].x = testing::kNan;
  cutPieces(gap);
  CHECK(gap.pieces.size() == 11);
  CHECK_FALSE(gap.goesOn(3));
  CHECK(gap.pieces[4].begin == broken + 1);
  for (size_t t = broken; t < jump.segments[0].poses.size(); ++t)
    jump.segments[0].poses[t].x += 3.0;
  cutPieces(jump);
  CHECK_FALSE(jump.goesOn(3));
  CHECK(jump.pieces[4].begin == broken);
  // If the initial motion is unknown, two seconds are left out.
  session.segments[0].entry_known = false;
  cutPieces(session);
  CHECK(session.pieces.front().begin == kPieceSamples);
}

TEST_CASE("steps that were recorded apart are joined where one went on into the next") {
  const samples::Folder folder("joined");
  const std::string path =
      writeDriving(folder, {{"whole", "grass", 6}, {"parts", "grass", 6, 0.5, 3, 5}});
  const Recordings found = readRecordings(path);
  REQUIRE(found.sessions.size() == 2);
  const SampledSession& whole = found.sessions[0];
  REQUIRE(whole.segments.size() == 1);
  // The truth over ten seconds, across a join, equals the driven one.
  const auto commands = drawnCommands(6, 1);
  const size_t begin = 60;
  REQUIRE(std::isfinite(whole.segments[0].poses[begin].x));
  Pose2 truth;
  for (size_t t = begin; t < begin + 200; ++t)
    truth =
        truth * integrate({0.95 * commands[t / 121].v, 0.0, 0.5 * commands[t / 121].w}, kPeriod);
  const Pose2 said = between(whole.segments[0].poses[begin], whole.segments[0].poses[begin + 200]);
  CHECK(distanceBetween(truth, said) < 0.02);
  CHECK(std::abs(truth.yaw - said.yaw) < 0.01);
  // Step 3 is unusable, and somebody else drove before step 5.
  const SampledSession& parts = found.sessions[1];
  REQUIRE(parts.segments.size() == 2);
  CHECK(parts.segments[0].commands.size() == 4 * 121);
  CHECK(std::isnan(parts.segments[0].poses[2 * 121 + 60].x));
  CHECK(std::isfinite(parts.segments[0].poses[3 * 121 + 60].x));
}

TEST_CASE("a folder of LCM logs is read, too, each log a session") {
  const samples::Folder drives("drives"), logs("logs");
  const std::string folder = writeDriving(drives, {{"one", "gravel", 6}, {"two", "sand", 6}});
  for (const char* name : {"one", "two"}) {
    const recordings::Session session = recordings::readSession(folder + "/sessions.csv", name);
    recordings::ImportCounts counts;
    LogWriter writer(logs.file(std::string(name) + ".lcmlog"));
    for (const LogEvent& event :
         recordings::makeLog(recordings::readSteps(folder + "/steps/" + name + ".csv", session),
                             session, "steps", {}, counts))
      writer.write(event.utime, event.channel, event.bytes.data(), event.bytes.size());
    writer.flush();
  }
  const Recordings found = readRecordings(logs.file(""));
  REQUIRE(found.sessions.size() == 2);
  const SampledSession& two = found.sessions[1];
  CHECK(two.name == "two");
  CHECK(two.vehicle == "drawn robot");
  CHECK(two.surface == "sand");
  CHECK(two.kind == CommandKind::kTrackSpeed);
  CHECK(two.baseline == Approx(1.0));
  // Six separate steps; the first two seconds of each are its lead-in.
  REQUIRE(two.pieces.size() == 6);
  const recordings::BodyCommand command = drawnCommands(6, 2)[two.pieces[3].segment];
  CHECK(two.pieces[3].mean_twist[0] == Approx(0.95 * command.v).margin(0.01));
  CHECK(two.pieces[3].mean_twist[2] == Approx(0.5 * command.w).margin(0.01));
}

TEST_CASE("a folder without recordings is refused, a session without driving is told") {
  const samples::Folder folder("none");
  CHECK_THROWS_WITH(readRecordings(folder.file("")), Catch::Contains("neither sessions.csv"));
  const samples::Folder other("nothing");
  const Recordings found =
      readRecordings(writeDriving(other, {{"good", "grass"}, {"short", "grass", 1, 0.5, 1}}));
  CHECK(found.sessions.size() == 1);
  REQUIRE(found.notes.size() == 1);
  CHECK_THAT(found.notes[0], Catch::Contains("short: less than two seconds"));
}

}  // namespace
}  // namespace tread::adaptation
