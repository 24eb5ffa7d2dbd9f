// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "common/recordings/csv_table.hpp"
#include "tests/tools/robot/import/drive_samples.hpp"
#include "tools/robot/import/rawlog.hpp"

using namespace tread;
using namespace tread::import;
using namespace mrpt::obs;
using tread::recordings::RecordingError;
using tread::samples::Folder;

namespace {

mrpt::system::TTimeStamp rawlogTime(double seconds) {
  return mrpt::Clock::fromDouble(1'700'000'000.0 + seconds);
}

CObservationOdometry::Ptr odometryAt(double seconds, double x) {
  auto odometry = CObservationOdometry::Create();
  odometry->timestamp = rawlogTime(seconds);
  odometry->odometry = mrpt::poses::CPose2D(x, 2.0, 0.5);
  return odometry;
}

/// Half a revolution of 181 beams, clockwise; one has no return and one is invalid.
CObservation2DRangeScan::Ptr sweepAt(double seconds) {
  auto sweep = CObservation2DRangeScan::Create();
  sweep->timestamp = rawlogTime(seconds);
  sweep->aperture = static_cast<float>(M_PI);
  sweep->rightToLeft = false;
  sweep->maxRange = 30.0F;
  sweep->sensorPose = mrpt::poses::CPose3D(0.4, 0.1, 0.6, M_PI / 2.0, 0.0, 0.0);
  sweep->resizeScan(181);
  for (size_t i = 0; i < 181; ++i) {
    sweep->setScanRange(i, 5.0F);
    sweep->setScanRangeValidity(i, true);
  }
  sweep->setScanRange(7, 30.0F);
  sweep->setScanRangeValidity(7, false);
  sweep->setScanRange(8, 0.0F);
  sweep->setScanRangeValidity(8, false);
  return sweep;
}

class RawlogFile {
 public:
  explicit RawlogFile(const std::string& name)
      : folder_("rawlog_" + name), path_(folder_.file("drive.rawlog")) {}

  void write(const std::vector<mrpt::serialization::CSerializable::Ptr>& objects) const {
    mrpt::io::CFileGZOutputStream file(path_);
    auto archive = mrpt::serialization::archiveFrom(file);
    for (const auto& object : objects) archive << *object;
  }
  std::string bytes() const {
    std::ifstream file(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void overwrite(const std::string& bytes) const {
    std::ofstream(path_, std::ios::binary) << bytes;
  }
  const std::string& path() const { return path_; }

 private:
  Folder folder_;
  std::string path_;
};

std::vector<mrpt::serialization::CSerializable::Ptr> smallDrive() {
  std::vector<mrpt::serialization::CSerializable::Ptr> objects;
  for (int i = 0; i < 20; ++i) {
    objects.push_back(odometryAt(0.1 * i, 0.05 * i));
    objects.push_back(sweepAt(0.1 * i + 0.03));
  }
  return objects;
}

}  // namespace

TEST_CASE("a rawlog of observations gives its odometry and its scans with their mounting") {
  const RawlogFile file("observations");
  auto objects = smallDrive();
  objects.push_back(CObservationComment::Create());
  file.write(objects);
  const ForeignDrive drive = readRawlog(file.path());
  REQUIRE(drive.drive.fixes.size() == 20);
  CHECK(drive.drive.fixes[4].time == Approx(0.4));
  CHECK(drive.drive.fixes[4].T_map_body.x == Approx(0.2));
  CHECK(drive.drive.fixes[4].T_map_body.yaw == Approx(0.5));
  CHECK(drive.drive.fixes.front().new_track);
  CHECK_FALSE(drive.drive.fixes[1].new_track);
  REQUIRE(drive.drive.scans.size() == 20);
  const scan_t& scan = drive.drive.scans[3].message;
  CHECK(drive.drive.scans[3].time == Approx(0.33));
  CHECK(scan.angle_first == Approx(M_PI / 2.0));
  CHECK(scan.angle_step == Approx(-M_PI / 180.0));
  CHECK(scan.sensor_position[0] == Approx(0.4));
  CHECK(scan.sensor_orientation[3] == Approx(std::sqrt(0.5)));
  CHECK(scan.ranges[0] == Approx(5.0));
  CHECK(std::isinf(scan.ranges[7]));
  CHECK(std::isnan(scan.ranges[8]));
  REQUIRE(drive.left_out.size() == 1);
  CHECK(drive.left_out.begin()->first.find("CObservationComment") != std::string::npos);
}

TEST_CASE("steps of the odometry in a rawlog of frames are added up") {
  const RawlogFile file("frames");
  std::vector<mrpt::serialization::CSerializable::Ptr> objects;
  for (int i = 0; i < 4; ++i) {
    CActionRobotMovement2D step;
    step.timestamp = rawlogTime(i);
    step.computeFromOdometry(mrpt::poses::CPose2D(1.0, 0.0, M_PI / 2.0), {});
    auto actions = CActionCollection::Create();
    actions->insert(step);
    auto frame = CSensoryFrame::Create();
    frame->insert(sweepAt(i + 0.5));
    objects.push_back(actions);
    objects.push_back(frame);
  }
  file.write(objects);
  const ForeignDrive drive = readRawlog(file.path());
  REQUIRE(drive.drive.fixes.size() == 4);
  CHECK(drive.drive.fixes[0].T_map_body.x == Approx(1.0));
  CHECK(drive.drive.fixes[1].T_map_body.y == Approx(1.0));
  CHECK(drive.drive.fixes[3].T_map_body.x == Approx(0.0).margin(1e-9));
  CHECK(drive.drive.fixes[3].T_map_body.y == Approx(0.0).margin(1e-9));
  CHECK(drive.drive.scans.size() == 4);
}

TEST_CASE("a rawlog cut off within a record keeps what stands before") {
  const RawlogFile file("cut");
  file.write(smallDrive());
  const std::string whole = file.bytes();
  file.overwrite(whole.substr(0, whole.size() / 2));
  const ForeignDrive drive = readRawlog(file.path());
  CHECK(drive.drive.fixes.size() >= 2);
  CHECK(drive.drive.fixes.size() < 20);
}

TEST_CASE("what is no rawlog is refused with one line") {
  const RawlogFile file("foreign");
  file.overwrite("utime,x,y\n1,2,3\n");
  CHECK_THROWS_WITH(readRawlog(file.path()), Catch::Contains("neither odometry nor scans") &&
                                                 Catch::Contains("drive.rawlog"));
  CHECK_THROWS_AS(readRawlog("/nowhere/drive.rawlog"), RecordingError);
}

TEST_CASE("damaged rawlogs never crash the program that reads them") {
  const RawlogFile file("damaged");
  file.write({odometryAt(0.0, 0.0), sweepAt(0.1), odometryAt(0.2, 0.1), sweepAt(0.3)});
  // Damaging packed bytes would rarely give any object, so the unpacked ones are damaged.
  std::string open;
  {
    const std::string gunzip = "gzip -dc < " + file.path();
    FILE* const pipe = ::popen(gunzip.c_str(), "r");
    REQUIRE(pipe != nullptr);
    char buffer[4096];
    size_t count = 0;
    while ((count = std::fread(buffer, 1, sizeof buffer, pipe)) > 0) open.append(buffer, count);
    ::pclose(pipe);
  }
  REQUIRE(open.size() > 1000);
  std::mt19937 random(20261126);
  int refused = 0;
  int told = 0;
  for (int i = 0; i < 150; ++i) {
    std::string damaged = open;
    for (int flips = 0; flips < 3; ++flips)
      damaged[random() % damaged.size()] = static_cast<char>(random());
    file.overwrite(damaged);
    try {
      told += readRawlog(file.path()).losses.empty() ? 0 : 1;
    } catch (const RecordingError&) {
      ++refused;
    }
  }
  CHECK(refused + told > 10);
}
