// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <zlib.h>
#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>

#include "common/geometry/se2.hpp"
#include "common/log/event_log.hpp"
#include "tests/helpers.hpp"
#include "tools/lab/replay/mapping_recording.hpp"
#include "tools/lab/replay/pass_overlap.hpp"

using namespace tread;

namespace {

/// A temporary file.
class TestFile {
 public:
  TestFile(const std::string& name, const std::string& content)
      : path_(
            (std::filesystem::temp_directory_path() / ("tread_mapping_replay_" + name)).string()) {
    std::ofstream(path_, std::ios::binary) << content;
  }
  ~TestFile() { std::filesystem::remove(path_); }
  TestFile(const TestFile&) = delete;
  TestFile& operator=(const TestFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// A scan of a wall across x, with a pose that is wrong by `drift` [m].
std::string carmenLine(double wall, double x, double drift) {
  std::ostringstream log;
  log << "ODOM " << x << " 0 0 0 0 0 0 host 0\nFLASER 360";
  for (int beam = 0; beam < 360; ++beam) {
    const double angle = -kPi / 2.0 + beam * kPi / 360.0;
    const double range = (wall - x) / std::max(1e-3, std::cos(angle));
    log << ' ' << std::min(81.91, range);
  }
  log << ' ' << x + drift << " 0 0 " << x + drift << " 0 0 0 host 0\n";
  return log.str();
}

/// A CARMEN log of a drive along x towards a wall across the path.
std::string carmenDrive(double wall, int lines) {
  std::string log =
      "# message formats defined: PARAM ODOM FLASER\nPARAM robot_length 0.47 1 host 1\n";
  for (int i = 0; i < lines; ++i) log += carmenLine(wall, i, 0.0);
  return log;
}

Cell at(const MappingReplay& replay, double x, double y) {
  return replay.window.at(replay.window.indexOf({x, y}));
}

}  // namespace

TEST_CASE("a CARMEN log becomes a map with its wall, and every scan is taken") {
  const TestFile file("drive.clf", carmenDrive(12.03, 6));
  const MappingReplay replay = replayMapping(readMappingRecording(file.path()));
  REQUIRE(replay.scans == 6);
  REQUIRE(replay.counters.at("scans taken") == 6);
  REQUIRE(replay.track.back().T_map_body.x == Approx(5.0));
  REQUIRE(replay.duration == Approx(5.0));
  REQUIRE(at(replay, 12.05, 0.0) == kObstacle);
  REQUIRE(at(replay, 8.0, 1.0) == kFree);
  REQUIRE(at(replay, 13.0, 0.0) == kUnknown);
  REQUIRE(reportOf(replay).find("scans taken: 6") != std::string::npos);
}

TEST_CASE(
    "a map closes where passes agree, and does not where the poses had drifted between them") {
  for (const double drift : {0.0, 0.2, 0.6}) {
    // Forth, back and forth again; the poses of the last part are wrong by the drift.
    std::string log = carmenDrive(12.03, 10);
    for (int i = 9; i >= 0; --i) log += carmenLine(12.03, i, 0.0);
    for (int i = 0; i < 10; ++i) log += carmenLine(12.03, i, drift);
    const TestFile file("passes.clf", log);
    const PassOverlap overlap = overlapOf(readMappingRecording(file.path()));
    CAPTURE(drift, reportOf(overlap));
    REQUIRE(overlap.again.pairs > 0);
    REQUIRE(overlap.again.cells > 100);
    CHECK(overlap.again.within_ten == overlap.again.cells);
    // The ends of the wall are visible from nearby only.
    const double share =
        static_cast<double>(overlap.again.within_two) / static_cast<double>(overlap.again.cells);
    if (drift < 0.5)
      CHECK(share > 0.95);
    else
      CHECK(share < 0.8);
    CHECK(overlap.in_a_row.within_two > 0);
  }
}

TEST_CASE("lines of a CARMEN log that are not whole are skipped and counted") {
  std::string text = carmenDrive(12.03, 3);
  text += "FLASER 360 1.0 2.0 3.0\nFLASER\nFLASER nonsense\n";
  const TestFile file("broken.clf", text);
  const MappingRecording recording = readMappingRecording(file.path());
  REQUIRE(recording.scans.size() == 3);
  REQUIRE(recording.skipped == 3);
}

TEST_CASE("logs that cannot be read are one clear line") {
  const TestFile garbage("garbage.clf", "what is this\n\x01\x02\x03");
  REQUIRE_THROWS_WITH(readMappingRecording(garbage.path()),
                      Catch::Contains("contains no FLASER or ROBOTLASER1 line"));
  REQUIRE_THROWS_WITH(readMappingRecording("/nowhere/at.log.gz"),
                      Catch::Contains("cannot be opened"));
  const TestFile gz("damaged.log.gz",
                    std::string("\x1f\x8b\x08\x00\x00\x00\x00\x00\x00\x03garbage", 17));
  REQUIRE_THROWS_WITH(readMappingRecording(gz.path()), Catch::Contains("is damaged"));
  const TestFile empty("empty.log", "");
  REQUIRE_THROWS_AS(readMappingRecording(empty.path()), std::runtime_error);
}

TEST_CASE("a recording that ends too early is played as far as it goes, and the report says so") {
  const TestFile whole("whole.log.gz", "");
  const std::string text = carmenDrive(12.03, 40);
  gzFile packed = gzopen(whole.path().c_str(), "wb");
  REQUIRE(gzwrite(packed, text.data(), static_cast<unsigned>(text.size())) > 0);
  REQUIRE(gzclose(packed) == Z_OK);
  REQUIRE(readMappingRecording(whole.path()).problem.empty());
  std::filesystem::resize_file(whole.path(), std::filesystem::file_size(whole.path()) * 2 / 3);
  MappingRecording cut = readMappingRecording(whole.path());
  REQUIRE(cut.scans.size() < 40);
  REQUIRE(cut.problem.find("is the file truncated?") != std::string::npos);
  cut.scans.resize(1);
  REQUIRE(reportOf(replayMapping(cut)).find(cut.problem) != std::string::npos);
}

TEST_CASE("an MBot log that is cut off says so") {
  const TestFile file("mbot_cut.log", "");
  {
    LogWriter log(file.path());
    std::vector<uint8_t> scan{0x89, 0xdc, 0x5b, 0x87, 0x9a, 0x50, 0x56, 0xcf};
    scan.resize(8 + 8, 0);  // utime
    scan.insert(scan.end(), {0, 0, 0, 2});
    scan.resize(scan.size() + 2 * (4 + 4 + 8 + 4), 0);  // two ranges, angles, times, intensities
    log.write(1'000'000, "LIDAR", scan.data(), scan.size());
    log.write(1'100'000, "LIDAR", scan.data(), scan.size());
  }
  REQUIRE(readMappingRecording(file.path()).problem.empty());
  std::filesystem::resize_file(file.path(), std::filesystem::file_size(file.path()) - 5);
  const MappingRecording cut = readMappingRecording(file.path());
  REQUIRE(cut.scans.size() == 1);
  REQUIRE_FALSE(cut.problem.empty());
}

TEST_CASE("other messages on the MBot's channels are skipped and counted") {
  const TestFile file("mbot.log", "");
  {
    LogWriter log(file.path());
    const std::vector<uint8_t> other(40, 7);
    log.write(1'000'000, "LIDAR", other.data(), other.size());
    log.write(1'000'100, "TRUE_POSE", other.data(), other.size());
    const std::vector<uint8_t> truncated{0x89, 0xdc, 0x5b, 0x87, 0x9a, 0x50, 0x56, 0xcf, 0, 0};
    log.write(1'000'200, "LIDAR", truncated.data(), truncated.size());
  }
  REQUIRE_THROWS_WITH(readMappingRecording(file.path()),
                      Catch::Contains("contains no LIDAR message"));
}

TEST_CASE("the Freiburg campus goes through mapping: every scan taken, walls where they stand") {
  const std::string path =
      tread::testing::recorded("lidar/carmen/freiburg-campus-corrected.log.gz");
  if (path.empty()) {
    WARN("skipped: the Freiburg campus log is not here (TREAD_RECORDINGS)");
    return;
  }
  MappingRecording campus = readMappingRecording(path);
  REQUIRE(campus.scans.size() == 2008);
  REQUIRE(campus.skipped == 0);
  campus.scans.resize(150);
  const MappingReplay replay = replayMapping(campus);
  REQUIRE(replay.counters.at("scans taken") == 150);
  REQUIRE(replay.health.empty());
  const auto cells = replay.window.cells();
  const auto free = std::count_if(cells.begin(), cells.end(), [](Cell c) { return isFree(c); });
  const auto obstacles = std::count(cells.begin(), cells.end(), kObstacle);
  CHECK(free > 200'000);  // 2000 m2
  CHECK(obstacles > 2'000);
  // The robot's path is free.
  for (const TimedPose& pose : replay.track) {
    if (pose.utime > campus.scans.back().utime) break;
    CHECK(at(replay, pose.T_map_body.x, pose.T_map_body.y) == kFree);
  }
}

TEST_CASE("a real LCM log of other types goes through mapping: the MBot's arena") {
  const std::string path =
      tread::testing::recorded("lcmlogs/mbot2017_sweep/sweep_drive_square.log");
  if (path.empty()) {
    WARN("skipped: the MBot log is not here (TREAD_RECORDINGS)");
    return;
  }
  const MappingReplay replay = replayMapping(readMappingRecording(path));
  REQUIRE(replay.scans == 125);
  REQUIRE(replay.counters.at("scans taken") > 100);
  REQUIRE(at(replay, 0.5, 0.5) == kFree);
  int walls = 0;
  for (double x = -2.2; x < -1.4; x += 0.05) walls += at(replay, x, 0.0) == kObstacle ? 1 : 0;
  REQUIRE(walls > 0);
}
