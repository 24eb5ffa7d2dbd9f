// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Drives with piecewise constant commands become executions of patterns.
#include <catch2/catch.hpp>

#include <cmath>

#include "common/config/config_reader.hpp"
#include "common/geometry/se2.hpp"
#include "common/pattern/pattern_file.hpp"
#include "tests/tools/called_program.hpp"
#include "tests/tools/robot/import/drive_samples.hpp"
#include "tools/robot/import/csv_drive.hpp"
#include "tools/robot/import/cut_drive.hpp"

using namespace tread;
using namespace tread::import;
using recordings::RecordedDrive;
using tread::samples::Folder;
using tread::samples::line;

namespace {

/// A base that moves in any direction: its channels are v_x, v_y and turn, as wheel speeds.
CommandChannels threeWheels() {
  CommandChannels channels;
  for (const char* name : {"front", "left_rear", "right_rear"})
    channels.push_back({name, CommandKind::kTrackSpeed, -20.0, 20.0});
  return channels;
}

Command three(double a, double b, double c) {
  Command command;
  command[0] = a;
  command[1] = b;
  command[2] = c;
  return command;
}

/// Motion for a command on a ground, linear in it.
Twist2 answer(const Command& u, double slip) {
  return {slip * (u[0] + 0.2 * u[2]), slip * (u[1] - 0.1 * u[0]), 0.5 * slip * u[2]};
}

struct Held {
  Command command;
  double seconds;
};

/// Consecutive commands, immediate motion, a pose every 40 ms.
RecordedDrive driven(const std::vector<Held>& parts, double slip = 0.7) {
  RecordedDrive drive;
  drive.channels = threeWheels();
  Pose2 T_map_body{2.0, -1.0, 3.0};
  double begin = 0.0;
  for (const Held& part : parts) {
    const Twist2 twist = answer(part.command, slip);
    for (double t = 0.0; t < part.seconds - 1e-9; t += 0.05) {
      recordings::DriveSample sample;
      sample.time = begin + t;
      sample.command = part.command;
      drive.drive.push_back(sample);
    }
    for (double t = 0.0; t < part.seconds - 1e-9; t += 0.04) {
      recordings::Fix fix;
      fix.time = begin + t;
      fix.T_map_body = T_map_body * integrate(twist, t);
      fix.T_map_body.yaw = wrapAngle(fix.T_map_body.yaw);
      fix.new_track = drive.fixes.empty();
      drive.fixes.push_back(fix);
    }
    T_map_body = T_map_body * integrate(twist, part.seconds);
    begin += part.seconds;
  }
  recordings::Fix last;
  last.time = begin;
  last.T_map_body = T_map_body;
  drive.fixes.push_back(last);
  findRuns(drive);
  return drive;
}

CutSurface cutOf(const RecordedDrive& drive, const CutLayout& layout,
                 const std::string& name = "gravel") {
  CutSurface surface;
  surface.name = name;
  cutDrive(drive, layout, surface);
  return surface;
}

CutLayout layoutOf(double length, double settle, size_t fewest, double alike = 0.0) {
  CutLayout layout;
  layout.length = length;
  layout.settle = settle;
  layout.fewest = fewest;
  layout.alike = alike;
  return layout;
}

void requireNear(const Pose2& a, const Pose2& b, double margin) {
  CHECK(a.x == Approx(b.x).margin(margin));
  CHECK(a.y == Approx(b.y).margin(margin));
  CHECK(a.yaw == Approx(b.yaw).margin(margin));
}

}  // namespace

TEST_CASE("each piece of a held command is an execution in the frame of its own beginning") {
  const Command ahead = three(0.3, 0.1, 0.8);
  const CutSurface surface = cutOf(driven({{ahead, 6.0}, {Command{}, 3.0}}), layoutOf(1.5, 1.2, 1));
  REQUIRE(surface.pieces.size() == 3);
  CHECK(surface.seconds == Approx(6.0));
  for (const CutPiece& piece : surface.pieces) {
    CHECK(piece.command == ahead);
    REQUIRE(piece.poses.size() == 30);
    for (size_t i = 0; i < 30; i += 29)
      requireNear(piece.poses[i],
                  integrate(answer(ahead, 0.7), 0.05 * (static_cast<double>(i) + 1.0)), 1e-9);
  }
}

TEST_CASE("what is in no piece is counted by its reason, and nothing of it is cut") {
  const Command ahead = three(0.3, 0.0, 0.0), back = three(-0.3, 0.0, 0.0);
  RecordedDrive drive = driven({{ahead, 10.0}, {back, 1.0}, {ahead, 5.9}});
  // No poses from 3.02 to 3.5 s, and a jump at 6.0 s.
  drive.fixes.erase(
      std::remove_if(drive.fixes.begin(), drive.fixes.end(),
                     [](const auto& fix) { return fix.time > 3.02 && fix.time < 3.5; }),
      drive.fixes.end());
  for (recordings::Fix& fix : drive.fixes) {
    if (fix.time > 6.02) fix.T_map_body.x += 5.0;
    if (fix.time > 6.02 && fix.time < 6.06) fix.new_track = true;
  }
  const CutSurface surface = cutOf(drive, layoutOf(2.0, 1.0, 1));
  // 1-3 complete, 3-5 has the gap, 5-7 the jump, 7-9 complete, 1 s of rest; then two of 4.9 s.
  CHECK(surface.pieces.size() == 4);
  CHECK(surface.left_out.size() == 4);
  const UncutPart& poses =
      surface.left_out.at("with poses missing, jumping, or more than 0.3 s apart");
  CHECK(poses.count == 2);
  CHECK(poses.seconds == Approx(4.0));
  CHECK(surface.left_out.at("of commands shorter than a piece").seconds == Approx(1.0));
  CHECK(surface.left_out.at("after a change of command").seconds == Approx(2.0));
  CHECK(surface.left_out.at("at the end of a command, shorter than a piece").seconds ==
        Approx(1.9));
  double sum = 2.0 * static_cast<double>(surface.pieces.size());
  for (const auto& [why, part] : surface.left_out) sum += part.seconds;
  CHECK(sum == Approx(surface.seconds));
}

TEST_CASE("a command that changes within a step of a recording is in no piece") {
  RecordedDrive drive = driven({{three(0.3, 0.0, 0.0), 3.0}, {three(0.2, 0.0, 0.0), 3.0}});
  drive.runs = {{1, 0.0, 6.0, "the recording of the step ends"}};
  CutSurface surface = cutOf(drive, layoutOf(2.0, 0.0, 1));
  CHECK(surface.pieces.size() == 2);
  CHECK(surface.left_out.at("in which the command changes").count == 1);
  for (size_t i = 0; i < 30; ++i) drive.drive[i].automatic = false;
  surface = cutOf(drive, layoutOf(2.0, 0.0, 1));
  CHECK(surface.pieces.size() == 1);
  CHECK(surface.left_out.at("driven by the operator").count == 1);
}

TEST_CASE("patterns are the commands that every surface has enough pieces of, named after them") {
  const Command ahead = three(0.3, 0.0, 0.0), aside = three(0.0, -0.25, 0.0);
  const Command seldom = three(0.0, 0.0, 0.5);
  const CutLayout layout = layoutOf(1.0, 0.0, 3);
  const std::vector<CutSurface> surfaces{
      cutOf(driven({{ahead, 4.0}, {aside, 3.0}, {seldom, 3.0}}, 0.8), layout, "gravel"),
      cutOf(driven({{seldom, 2.0}, {aside, 5.0}, {ahead, 3.0}}, 0.4), layout, "ice")};
  const CutRecordings cut = recordingsOf(surfaces, layout, {});
  const PatternSet& set = cut.recordings.patterns;
  REQUIRE(set.patterns().size() == 2);
  CHECK(set.patterns()[0].name == "front+0.3");
  CHECK(set.patterns()[1].name == "left_rear-0.25");
  CHECK(set.content().channels == threeWheels());
  CHECK(set.patterns()[0].commands == std::vector<Command>(20, ahead));
  CHECK(set.classNamed("front+0.3").steady == ahead);
  CHECK(set.classNamed("front+0.3").twist.v_x == Approx(0.6 * 0.3));
  REQUIRE(cut.notes.size() == 1);
  CHECK(cut.notes.back() ==
        "left out 1 commands with fewer than 3 pieces on a surface: right_rear+0.5 (2 on ice)");
  REQUIRE(cut.recordings.surfaces.size() == 2);
  CHECK(cut.recordings.surfaces[1].executions[1].size() == 5);
  recordings::requireReadable(cut.recordings.surfaces[0], set);
  CHECK_THROWS_WITH(recordingsOf(surfaces, layoutOf(1.0, 0.0, 6), {}),
                    Catch::Contains("no pattern is left: drive commands for longer"));
}

TEST_CASE("pieces of commands nearby become what the pattern's command would have made") {
  const Command ahead = three(0.3, 0.0, 0.0), nearly = three(0.29, 0.02, 0.02);
  const CutLayout layout = layoutOf(1.0, 0.0, 5, 0.1);
  const std::vector<CutSurface> surfaces{cutOf(
      driven(
          {{ahead, 3.0}, {nearly, 3.0}, {three(0.0, 0.3, 0.0), 5.0}, {three(0.1, 0.0, 0.3), 5.0}}),
      layout)};
  const CutRecordings cut = recordingsOf(surfaces, layout, {});
  REQUIRE(cut.recordings.patterns.patterns().size() == 3);
  const auto& executions = cut.recordings.surfaces[0].executions[0];
  REQUIRE(executions.size() == 6);
  for (const recordings::Execution& poses : executions)
    requireNear(poses.back(), integrate(answer(ahead, 0.7), 1.0), 2e-6);
  CHECK(cut.notes.front() ==
        "gravel: 3 of 16 pieces are of similar commands, corrected to the pattern's");
}

TEST_CASE("surfaces with commands to other channels are refused by name") {
  RecordedDrive tracks = driven({{three(0.3, 0.2, 0.0), 3.0}});
  tracks.channels = trackChannels(CommandKind::kTrackSpeed);
  const CutLayout layout = layoutOf(1.0, 0.0, 1);
  const std::vector<CutSurface> surfaces{cutOf(driven({{three(0.3, 0.2, 0.0), 3.0}}), layout, "a"),
                                         cutOf(tracks, layout, "b")};
  CHECK_THROWS_WITH(recordingsOf(surfaces, layout, {}),
                    Catch::StartsWith("surface 'b' has commands left [m/s], right [m/s], 'a' "));
  CutSurface surface = surfaces[0];
  CHECK_THROWS_WITH(cutDrive(tracks, layout, surface), Catch::Contains("cut them apart"));
  CHECK_THROWS_WITH(recordingsOf({cutOf(RecordedDrive{}, layout, "c")}, layout, {}),
                    Catch::StartsWith("surface 'c': no piece; commands must stay"));
}

namespace {

const std::string kMapping =
    "wheel_radius: 0.1\n"
    "tables:\n"
    "  - time: {column: t}\n"
    "    run: run\n"
    "    only: {speed: [0.1, 0.2]}\n"
    "    columns:\n"
    "      front_command: {column: front, unit: rad/s}\n"
    "      boom_command: {column: boom, unit: deg}\n"
    "      front_speed: {column: f, unit: m/s}\n"
    "      x: {column: x}\n"
    "      y: {column: y}\n"
    "      yaw: {column: yaw}\n"
    "      pose_new: {column: new}\n";

/// Runs of 5.1 s, each with its own time 0 and pose 0: front 1 rad/s and boom 10 deg by speed.
std::string runs(double slip) {
  std::string csv = "run,speed,t,front,boom,f,x,y,yaw,new\n";
  int run = 0;
  for (const double speed : {0.1, 0.2, 0.3})
    for (int i = 0; i < 102; ++i, run += i == 102 ? 1 : 0)
      csv += line("r%d,%.1f,%.2f,%.1f,%.1f,%.3f,%.5f,0,0,%d\n", run, speed, 0.05 * i, 10.0 * speed,
                  100.0 * speed, speed, slip * speed * 0.05 * (i - i % 2), i % 2 == 0 ? 1 : 0);
  return csv;
}

}  // namespace

TEST_CASE("a table of several runs with named channels, rows asked for and poses that repeat") {
  const Folder folder("cut_mapping");
  ConfigReader reader = ConfigReader::fromText(kMapping, "map.yaml");
  const CsvMapping mapping = readCsvMapping(reader);
  const ForeignDrive read = readMappedCsv(folder.file("a.csv", runs(0.5)), mapping);
  CHECK_FALSE(mapping.isOfTracks());
  REQUIRE(read.drive.channels.size() == 2);
  CHECK(read.drive.channels[0].name == "front");
  CHECK(read.drive.channels[0].kind == CommandKind::kTrackSpeed);
  CHECK(read.drive.channels[1].kind == CommandKind::kSteeringAngle);
  CHECK(read.losses.empty());
  REQUIRE(read.drive.drive.size() == 204);
  CHECK(read.drive.drive[150].command[0] == Approx(0.2));
  CHECK(read.drive.drive[150].command[1] == Approx(20.0 * kPi / 180.0));
  CHECK(read.drive.drive[150].speed[0] == Approx(0.2));
  CHECK(read.drive.drive[102].apart);
  CHECK(read.drive.drive[102].time - read.drive.drive[101].time == Approx(recordings::kSilence));
  REQUIRE(read.drive.fixes.size() == 102);
  CHECK(read.drive.fixes[51].new_track);
  CHECK_FALSE(read.drive.fixes[52].new_track);
  REQUIRE(read.drive.runs.size() == 2);
  CHECK(read.drive.runs[0].end == Approx(5.1));
  size_t others = 0, held = 0;
  for (const auto& [what, count] : read.left_out) {
    if (what.find("excluded by the mapping") != std::string::npos) others = count;
    if (what.find("pose_new") != std::string::npos) held = count;
  }
  CHECK(others == 102);
  CHECK(held == 102);
}

TEST_CASE("channels of a mapping are checked where they stand") {
  const auto complaint = [](const std::string& columns) -> std::string {
    try {
      ConfigReader reader = ConfigReader::fromText(
          "tables:\n  - time: {rate: 10}\n    columns: {" + columns + "}\n", "map.yaml");
      readCsvMapping(reader);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "nothing";
  };
  CHECK_THAT(complaint("boom_speed: {column: a}, arm_command: {column: b}"),
             Catch::Contains("boom_speed: there is no boom_command"));
  CHECK_THAT(complaint("left_command: {column: a, unit: deg}"), Catch::Contains("unit"));
  CHECK_THAT(complaint("lft_command: {column: a}, right_command: {column: b}"),
             Catch::Contains("left_command and right_command come together"));
  CHECK_THAT(complaint("_command: {column: a}"),
             Catch::Contains("is not a quantity; known are NAME_"));
  std::string many;
  for (char name = 'a'; name <= 'i'; ++name)
    many += std::string(many.empty() ? "" : ", ") + name + "_command: {column: " + name + "}";
  CHECK_THAT(complaint(many), Catch::Contains("commands have up to 8 channels"));
}

TEST_CASE("tread-import --cut writes recordings, to which surfaces can be added") {
  const Folder folder("cut_program");
  const std::string out = folder.file("recordings");
  const std::string call = "tread-import --format csv --mapping " +
                           folder.file("map.yaml", kMapping) + " --cut 1 --offset 1 --fewest 4 ";
  const std::string hard = folder.file("hard.csv", runs(0.9));
  const std::string soft = folder.file("soft.csv", runs(0.5));
  auto run = tread::samples::called(call + hard + " " + soft + " -o " + out);
  CAPTURE(run.printed);
  REQUIRE(run.status == 0);
  CHECK(run.says("commands: front [m/s], boom [rad]"));
  CHECK(run.says("16 executions of 2 patterns on 2 surfaces"));
  CHECK(run.says("hard: left out 2.0 s (2 times) after a change of command"));
  const recordings::PatternRecordings read = recordings::readRecordings(out);
  REQUIRE(read.patterns.patterns().size() == 2);
  CHECK(read.patterns.patterns()[0].name == "front+0.1_boom+0.175");
  REQUIRE(read.surfaces.size() == 2);
  REQUIRE(read.surfaces[1].surface == "soft");
  REQUIRE(read.surfaces[1].executions[1].size() == 4);
  CHECK(read.surfaces[1].executions[1][3].back().x == Approx(0.5 * 0.2).margin(1e-6));

  const std::string more = call + "--set surface=wet " + soft + " -o " + out;
  run = tread::samples::called(more);
  CHECK(run.status != 0);
  CHECK(run.isOneLine());
  run = tread::samples::called(more + " --force");
  CAPTURE(run.printed);
  REQUIRE(run.status == 0);
  CHECK(run.says("existing patterns kept"));
  CHECK(recordings::readRecordings(out).surfaces.size() == 3);
  // Pieces of another length match no existing pattern.
  run = tread::samples::called(call + "--set surface=ice --cut 2 " + soft + " --force -o " + out);
  CHECK(run.status != 0);
  run = tread::samples::called("tread-import --format csv --mapping " + folder.file("map.yaml") +
                               " --cut 2 --offset 1 --set surface=ice " + soft + " --force -o " +
                               out);
  CHECK(run.status != 0);
  CHECK(run.says("that is not one command held for 2 s; write to another folder"));
  run = tread::samples::called("tread-import --format csv --mapping " + folder.file("map.yaml") +
                               " " + hard + " " + soft + " -o " + folder.file("a.lcmlog"));
  CHECK(run.status != 0);
  CHECK(run.says("a log holds one recording; several are for --cut"));
}

TEST_CASE("commands of named channels come into a log as they are") {
  const Folder folder("cut_log");
  ConfigReader reader = ConfigReader::fromText(kMapping, "map.yaml");
  const ForeignDrive read = readMappedCsv(folder.file("a.csv", runs(0.5)), readCsvMapping(reader));
  recordings::Session session;
  session.pose_rate = 10.0;
  recordings::ImportCounts counts;
  const auto events = recordings::makeLog(read.drive, session, "csv", {}, counts);
  const auto motors = tread::samples::messagesOn(kMotor, events);
  REQUIRE(motors.size() == 204);
  CHECK(motors[0].command[0] == Approx(0.1F));
  CHECK(motors[0].command[1] == Approx(10.0 * kPi / 180.0));
  CHECK(std::isnan(motors[0].command[2]));
  CHECK(std::isnan(motors[0].measured[1]));
  CHECK(motors[0].channel_kind[1] == static_cast<int16_t>(CommandKind::kSteeringAngle));
  CHECK(counts.completed == 2);
  const auto run = tread::samples::called("tread-import --format csv --mapping " +
                                          folder.file("map.yaml", kMapping) + " " +
                                          folder.file("a.csv") + " -o " + folder.file("a.lcmlog"));
  CAPTURE(run.printed);
  CHECK(run.says("2 commands, 2 executions completed"));
}
