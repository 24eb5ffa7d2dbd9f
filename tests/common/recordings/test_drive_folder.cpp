// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "common/recordings/csv_table.hpp"
#include "tests/common/recordings/synthetic_drives.hpp"

using namespace tread;
using namespace tread::recordings;
using namespace tread::samples;

namespace {

const Ground kHard = linearGround(0.95, 0.5, -0.05);
const Ground kSoft = linearGround(0.85, 0.4, -0.10);

std::vector<DrivenSession> twoSurfaces() {
  return {{"one", "Rover (tracks, 5 kg)", "hard, dry", kHard},
          {"two", "Rover (tracks, 5 kg)", "soft", kSoft},
          {"slow", "Rover (tracks, 5 kg)", "soft", kSoft, 24, 0.5, 0.5},
          {"brief", "Rover (tracks, 5 kg)", "soft", kSoft, 5},
          {"other", "Rolling stone", "soft", kSoft}};
}

DriveRequest requestOf(const std::string& folder, const std::string& robot) {
  DriveRequest request;
  request.folder = folder;
  request.robot = robot;
  return request;
}

/// Exception when making a set of recordings, without the folder's name.
std::string complaint(const DriveRequest& request) {
  try {
    recordingsFromDrives(request);
  } catch (const std::exception& error) {
    const std::string text = error.what();
    CHECK(text.find('\n') == std::string::npos);
    const size_t folder = text.find(request.folder);
    return folder == std::string::npos ? text : text.substr(folder + request.folder.size());
  }
  return "";
}

/// The same for a folder with one file replaced.
std::string complaintWith(const std::string& file, const std::string& content) {
  const Folder folder("drive_bad");
  const std::string path = writeDrives(folder, twoSurfaces());
  std::filesystem::remove(folder.file(file));
  folder.file(file, content);
  return complaint(requestOf(path, "rover"));
}

}  // namespace

TEST_CASE("a folder of drives becomes recordings of what each surface does to the commands") {
  const Folder folder("drive_recordings");
  const DriveRecordings drives =
      recordingsFromDrives(requestOf(writeDrives(folder, twoSurfaces()), "rover"));
  REQUIRE(drives.recordings.surfaces.size() == 2);
  CHECK(drives.surfaces[0].surface == "hard_dry");
  CHECK(drives.surfaces[1].windows == 48);
  const Ground grounds[] = {kHard, kSoft};
  for (size_t s = 0; s < 2; ++s)
    for (size_t p = 0; p < 8; ++p) {
      const PatternWish wish = defaultRecipe().patterns[p];
      CAPTURE(s, wish.name);
      const auto& executions = drives.recordings.surfaces[s].executions[p];
      REQUIRE(executions.size() == 30);
      REQUIRE(executions.front().size() == 40);
      const Pose2 expected = integrate(grounds[s](wish.command).mean, 2.0);
      CHECK(executions.front().back().x == Approx(expected.x).margin(0.01));
      CHECK(executions.front().back().y == Approx(expected.y).margin(0.01));
      CHECK(executions.front().back().yaw == Approx(expected.yaw).margin(0.01));
    }
  REQUIRE(drives.notes.size() == 2);
  CHECK(drives.notes[0].find("session left out: slow (soft): commands reach 0.4") == 0);
  CHECK(drives.notes[1] == "session left out: brief (soft): has 5 ok steps, needed 20");
  const std::string report = reportOf(drives);
  CHECK(report.find("hard_dry: 48 steady windows used") != std::string::npos);
}

TEST_CASE("the same folder gives the same recordings, bit for bit") {
  const Folder folder("drive_twice");
  const DriveRequest request = requestOf(writeDrives(folder, twoSurfaces()), "rover");
  const DriveRecordings first = recordingsFromDrives(request);
  const DriveRecordings second = recordingsFromDrives(request);
  CHECK(first.recordings.patterns.checksum() == second.recordings.patterns.checksum());
  for (size_t s = 0; s < 2; ++s)
    CHECK(averagedSet(first, s).checksum() == averagedSet(second, s).checksum());
}

TEST_CASE("sessions of another geometry are left out, but may be asked for") {
  const Folder folder("drive_geometry");
  std::vector<DrivenSession> sessions = twoSurfaces();
  sessions.push_back({"wide", "Rover (tracks, 5 kg)", "third", kHard});
  const std::string path = writeDrives(folder, sessions);
  std::string table = kDrivenSessionsHeader;
  for (const DrivenSession& session : sessions)
    table += line("%s,\"%s\",\"%s\",0.3,%s,0.2\n", session.name.c_str(), session.robot.c_str(),
                  session.surface.c_str(), session.name == "wide" ? "1.3" : "1.0");
  std::filesystem::remove(folder.file("sessions.csv"));
  folder.file("sessions.csv", table);
  DriveRequest request = requestOf(path, "rover");
  const DriveRecordings drives = recordingsFromDrives(request);
  CHECK(drives.recordings.surfaces.size() == 2);
  CHECK(drives.notes.back().find("session left out: wide (third): wheel radius 0.300 m and "
                                 "baseline 1.300 m") == 0);
  request.sessions = {"wide", "one"};
  CHECK(recordingsFromDrives(request).surfaces.back().surface == "third");
}

TEST_CASE("a robot that was driven slowly gets smaller commands, and the report says so") {
  const Folder folder("drive_slow");
  const std::string path = writeDrives(folder, {{"one", "Snail", "hard", kHard, 24, 0.5, 1.0},
                                                {"two", "Snail", "soft", kSoft, 24, 0.5, 1.0}});
  DriveRequest request = requestOf(path, "");
  const DriveRecordings drives = recordingsFromDrives(request);
  const TrackCommand straight =
      drives.recordings.patterns.findByName("straight")->commands.front().tracks();
  CHECK(straight.left > 0.2);
  CHECK(straight.left < 0.3);
  CHECK(drives.notes.front().find("the robot was driven too slowly for the recipe") == 0);
  request.sessions = {"two", "one"};
  CHECK(recordingsFromDrives(request).recordings.patterns.checksum() ==
        drives.recordings.patterns.checksum());
  request.fit_recipe = false;
  CHECK(complaint(request).find("surface 'soft' left out: its commands reach 0.") !=
        std::string::npos);
  request.sessions.clear();
  CHECK(complaint(request).find(": 0 surface(s) of Snail have comparable sessions, 2 are needed; "
                                "session left out: one (hard): commands reach") == 0);
}

TEST_CASE("a robot is chosen by the beginning or a part of its name") {
  const Folder folder("drive_robot");
  const std::string path = writeDrives(folder, twoSurfaces());
  const auto sessions = readSessions(path);
  CHECK(chooseRobot(sessions, "ROVER") == "Rover (tracks, 5 kg)");
  CHECK(chooseRobot(sessions, "stone") == "Rolling stone");
  CHECK(complaint(requestOf(path, "ro")) ==
        "'ro' may be any of 'Rover (tracks, 5 kg)', 'Rolling stone'; give more of the name");
  CHECK(complaint(requestOf(path, "horse")) ==
        "no robot is called 'horse'; there are 'Rover (tracks, 5 kg)', 'Rolling stone'");
  CHECK(complaint(requestOf(path, "")) ==
        "sessions of several robots; choose one with --robot: 'Rover (tracks, 5 kg)', 'Rolling "
        "stone'");
  CHECK(complaint(requestOf(path, "stone")) ==
        ": Rolling stone was driven on one surface only ('soft'); learning from one to another "
        "needs two");
  DriveRequest unknown = requestOf(path, "rover");
  unknown.sessions = {"one", "nine"};
  CHECK(complaint(unknown) ==
        "no session 'nine' of Rover (tracks, 5 kg); there are 'one', 'two', 'slow', 'brief'");
}

TEST_CASE("what was measured before the motion has settled is not used") {
  const Folder folder("drive_settle");
  const std::string path = writeDrives(folder, {{"one", "Rover", "hard", kHard}});
  // Poses half a second late; the robot stands until 1.8 s after the command.
  std::string rows = kDrivenStepsHeader;
  for (int i = 0; i <= 120; ++i) {
    const double t = 0.05 * i;
    const Pose2 pose = integrate({2.0, 0.1, 0.7}, std::max(0.0, t - 0.5 - 1.8));
    rows += line("1,%d,%.3f,%.6f,%.6f,%.6f,%.6f,%.6f,%d\n", std::min(2, i / 40), t, 1.0, 1.0,
                 pose.x, pose.y, pose.yaw, i % 4 == 0 ? 1 : 0);
  }
  std::filesystem::remove(folder.file("steps/one.csv"));
  folder.file("steps/one.csv", rows);
  Session session = readSessions(path).front();
  session.pose_lag = 0.5;
  const SessionWindows windows = readWindows(path, session, kBaseline, 2.0);
  REQUIRE(windows.used.size() == 2);
  for (const SteadyWindow& window : windows.used) {
    CHECK(window.profile.mean.v_x == Approx(2.0).margin(1e-4));
    CHECK(window.profile.mean.v_y == Approx(0.1).margin(1e-4));
    CHECK(window.profile.mean.omega == Approx(0.7).margin(1e-4));
    CHECK(std::abs(window.profile.slope.v_x) < 1e-3);
  }
}

TEST_CASE("files that are missing, damaged or of another layout are one clear line") {
  CHECK(complaint(requestOf("/no/such/folder", "x")) ==
        "/sessions.csv: cannot be read or is empty; give a CSV file with a header line");
  CHECK(complaintWith("steps/two.csv", "") ==
        "/steps/two.csv: cannot be read or is empty; give a CSV file with a header line");
  CHECK(complaintWith("steps/two.csv", "step,window,t_s,x_m,y_m,yaw_rad\n1,1,2.0,0,0,0\n") ==
        "/steps/two.csv:1: no column pose_new; needed are step, window, t_s, x_m, y_m, yaw_rad, "
        "pose_new");
  CHECK(complaintWith("steps_quality.csv", "session,step\none,1\n") ==
        "/steps_quality.csv:1: no column cmd_left_rad_s; needed are session, step, "
        "cmd_left_rad_s, cmd_right_rad_s, ok");
  CHECK(complaintWith("sessions.csv",
                      kDrivenSessionsHeader + std::string("one,Rover,hard,0.3,1.0,soon\n"
                                                          "two,Rover,soft,0.3,1.0,0.2\n"))
            .find("/sessions.csv:2: column pose_lag_s is 'soon'; a finite number is needed") !=
        std::string::npos);
  CHECK(complaintWith(
            "steps/one.csv",
            kDrivenStepsHeader + std::string("1,1,2.0,0,0,0,0,0,1\n1,1,2.0,0,0,0,0,0,1\n")) ==
        "/steps/one.csv:3: t_s does not grow within the window; are the rows in order?");
}

TEST_CASE("a recipe says which patterns are built, and what it gets wrong is told with its line") {
  const PatternRecipe shipped = readRecipe(ConfigReader::fromFile(
      std::string(TREAD_SOURCE_DIR) + "/config/patterns/recipes/drive.yaml"));
  const PatternRecipe built_in = defaultRecipe();
  CHECK(shipped.name == built_in.name);
  CHECK(shipped.neighbours == built_in.neighbours);
  CHECK(shipped.deviations == built_in.deviations);
  REQUIRE(shipped.patterns.size() == built_in.patterns.size());
  for (size_t i = 0; i < shipped.patterns.size(); ++i) {
    CHECK(shipped.patterns[i].name == built_in.patterns[i].name);
    CHECK(shipped.patterns[i].command.v == built_in.patterns[i].command.v);
    CHECK(shipped.patterns[i].command.w == built_in.patterns[i].command.w);
  }
  const auto wrong = [](const std::string& text) {
    return readRecipe(ConfigReader::fromText(text, "recipe"));
  };
  CHECK_THROWS_WITH(wrong("name: x\npatterns:\n  - name: a\n    command: [1, 0]\n  - name: a\n"
                          "    command: [2, 0]\n"),
                    Catch::Contains("two are called 'a'"));
  CHECK_THROWS_WITH(wrong("name: x\npatterns:\n  - name: a\n    command: [1]\n"),
                    Catch::Contains("recipe:4"));
  CHECK_THROWS_AS(wrong("name: x\nneighbors: 3\npatterns:\n  - name: a\n    command: [1, 0]\n"),
                  ConfigError);
}
