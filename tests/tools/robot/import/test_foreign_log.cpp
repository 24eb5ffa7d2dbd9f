// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "common/recordings/csv_table.hpp"
#include "common/recordings/foreign_types.hpp"
#include "tests/tools/robot/import/drive_samples.hpp"
#include "tools/robot/import/foreign_log.hpp"

using namespace tread;
using namespace tread::import;
using tread::recordings::foreignTypes;
using tread::samples::Folder;

namespace {

uint64_t fingerprintOf(const std::string& name) {
  return foreignTypes().fingerprint(*foreignTypes().find(name));
}

/// Big-endian bytes of a message, as from lcm-gen's encoders.
class Bytes {
 public:
  explicit Bytes(const std::string& type) { add(fingerprintOf(type), 8); }
  Bytes& time(int64_t utime) { return add(static_cast<uint64_t>(utime), 8); }
  Bytes& count(int32_t value) { return add(static_cast<uint32_t>(value), 4); }
  Bytes& number(double value) {
    const auto narrow = static_cast<float>(value);
    uint32_t bits = 0;
    std::memcpy(&bits, &narrow, sizeof bits);
    return add(bits, 4);
  }
  std::vector<uint8_t> bytes;

 private:
  Bytes& add(uint64_t value, unsigned size) {
    for (unsigned i = size; i-- > 0;) bytes.push_back(static_cast<uint8_t>(value >> (8 * i)));
    return *this;
  }
};

/// A log in a temporary folder.
class ForeignLog {
 public:
  ForeignLog() : folder_("import_foreign"), path_(folder_.file("foreign.log", "")) {
    writer_ = std::make_unique<LogWriter>(path_, OutputFile::Kind::kGrowing);
  }
  void add(int64_t utime, const std::string& channel, const Bytes& message) {
    writer_->write(utime, channel, message.bytes.data(), message.bytes.size());
  }
  void pose(int64_t utime, const std::string& channel, double x) {
    add(utime, channel, Bytes("pose_xyt_t").time(utime).number(x).number(2.0).number(0.5));
  }
  ForeignDrive read(const ForeignRobot& robot = {}) {
    writer_->flush();
    return readForeignLog(path_, robot);
  }

 private:
  Folder folder_;
  std::string path_;
  std::unique_ptr<LogWriter> writer_;
};

constexpr int64_t kBegin = 1'500'000'000'000'000;

}  // namespace

TEST_CASE("fingerprints of foreign types are those that real logs of these robots hold") {
  REQUIRE(fingerprintOf("pose_xyt_t") == 0x1f317af1246276acu);
  REQUIRE(fingerprintOf("lidar_t") == 0x89dc5b879a5056cfu);
  REQUIRE(fingerprintOf("mbot_motor_command_t") == 0xe817386df0c405a3u);
  REQUIRE(fingerprintOf("mbot_wheel_ctrl_t") == 0xd88a1e900e511606u);
  REQUIRE(foreignTypes().typeOf(Bytes("mbot_motor_pwm_t").bytes)->name == "mbot_motor_pwm_t");
  REQUIRE(foreignTypes().typeOf({1, 2, 3}) == nullptr);
}

TEST_CASE("a foreign message that is cut, too long or of a length below zero is none") {
  const MessageType& lidar = *foreignTypes().find("lidar_t");
  const auto decodeForeign = [&](const std::vector<uint8_t>& bytes) {
    return numbersOf(foreignTypes(), lidar, bytes);
  };
  Bytes good = Bytes("lidar_t").time(5).count(1).number(2.5).number(0.5).time(6).number(1.0);
  const auto message = decodeForeign(good.bytes);
  REQUIRE(message);
  REQUIRE(message->at("ranges") == std::vector<double>{2.5});
  REQUIRE(message->at("times") == std::vector<double>{6.0});
  for (size_t size = 0; size < good.bytes.size(); ++size)
    REQUIRE_FALSE(decodeForeign({good.bytes.begin(), good.bytes.begin() + long(size)}));
  good.bytes.push_back(0);
  REQUIRE_FALSE(decodeForeign(good.bytes));
  for (const int32_t count : {-1, 2, 0x7fffffff, INT32_MIN})
    REQUIRE_FALSE(decodeForeign(Bytes("lidar_t").time(5).count(count).bytes));
}

TEST_CASE("held commands of a foreign log become executions, body speeds become tracks") {
  ForeignLog log;
  for (int i = 0; i < 400; ++i) {
    const int64_t utime = kBegin + 20'000 * i;
    log.pose(utime, "ODOMETRY", 0.01 * i);
    const double v = i < 50 ? 0.0 : i < 350 ? 0.4 : 0.2;
    // Without its own time it has the logger's.
    log.add(utime, "MOTORS", Bytes("mbot_motor_command_t").time(0).number(v).number(1.0));
  }
  REQUIRE_THROWS_WITH(log.read(), Catch::Contains("--baseline"));
  ForeignRobot robot;
  robot.baseline = 0.2;
  const ForeignDrive foreign = log.read(robot);
  REQUIRE(foreign.drive.fixes.size() == 400);
  REQUIRE(foreign.drive.fixes[100].time == Approx(2.0));
  REQUIRE(foreign.drive.channels == trackChannels(CommandKind::kTrackSpeed));
  REQUIRE(foreign.drive.runs.size() == 3);
  REQUIRE(foreign.drive.runs[1].begin == Approx(1.0).margin(0.051));
  REQUIRE(foreign.drive.runs[1].end == Approx(7.0).margin(0.051));
  REQUIRE(foreign.drive.drive[40].command[0] == Approx(0.3));
  REQUIRE(foreign.drive.drive[40].command[1] == Approx(0.5));
  recordings::Session session;
  session.pose_rate = 50.0;
  recordings::ImportCounts counts;
  const auto events = makeLog(foreign.drive, session, "lcm", {}, counts);
  REQUIRE(counts.completed == 2);
  REQUIRE(counts.ins == 400);
  REQUIRE(events.size() > 550);
}

TEST_CASE("power of two wheels stays power, and where no command came there is none") {
  ForeignLog log;
  const auto tell = [&](double seconds, double left) {
    const int64_t utime = kBegin + std::llround(seconds * 1e6);
    log.add(utime, "PWM", Bytes("mbot_motor_pwm_t").time(utime).number(left).number(-0.5));
  };
  for (int i = 0; i < 20; ++i) tell(0.05 * i, 0.25);
  for (int i = 0; i < 20; ++i) tell(3.0 + 0.05 * i, 0.25);
  const recordings::RecordedDrive drive = log.read().drive;
  REQUIRE(drive.channels == trackChannels(CommandKind::kPower));
  REQUIRE(drive.drive.front().command[0] == 0.25);
  REQUIRE(drive.drive.front().command[1] == -0.5);
  REQUIRE(std::isnan(drive.drive.front().speed[0]));
  REQUIRE(drive.drive.size() == 40);
  REQUIRE(drive.drive[20].time == Approx(3.0));
  for (const recordings::DriveSample& sample : drive.drive) REQUIRE(sample.automatic);
  REQUIRE(drive.runs.size() == 2);
  REQUIRE(drive.runs[0].end == Approx(1.0));
  REQUIRE(drive.runs[0].end_reason == recordings::kCommandsMissing);
  REQUIRE(drive.runs[0].step == drive.runs[1].step);
}

TEST_CASE("bytes of a foreign log that are damaged are counted with the seconds that they last") {
  const Folder folder("import_damaged");
  const std::string path = folder.file("foreign.log");
  uint64_t from = 0, to = 0;
  {
    LogWriter writer(path, OutputFile::Kind::kGrowing);
    for (int i = 0; i < 200; ++i) {
      const int64_t utime = kBegin + 50'000 * i;
      const auto pose = Bytes("pose_xyt_t").time(utime).number(0.01 * i).number(0).number(0);
      const auto pwm = Bytes("mbot_motor_pwm_t").time(utime).number(0.5).number(0.5);
      writer.write(utime, "POSE", pose.bytes.data(), pose.bytes.size());
      writer.write(utime, "PWM", pwm.bytes.data(), pwm.bytes.size());
      writer.flush();
      if (i == 79) from = std::filesystem::file_size(path);
      if (i == 139) to = std::filesystem::file_size(path);
    }
  }
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  file.seekp(static_cast<std::streamoff>(from));
  file << std::string(to - from, '\0');
  file.close();
  const ForeignDrive foreign = readForeignLog(path, {});
  REQUIRE(foreign.losses.size() == 2);
  // The event before the gap is complete only if a sync word follows.
  CHECK(foreign.losses[0].unit == "bytes");
  CHECK(foreign.losses[0].lost == Approx(double(to - from)).margin(120.0));
  CHECK(foreign.losses[1].unit == "s");
  CHECK(foreign.losses[1].lost == Approx(3.05).margin(0.06));
  CHECK(largestShare(foreign.losses) > 0.29);
  const std::vector<recordings::CommandHole> holes = recordings::commandHoles(foreign.drive.drive);
  REQUIRE(holes.size() == 1);
  CHECK(holes[0].end - holes[0].begin == Approx(3.0).margin(0.06));
  for (const recordings::DriveSample& sample : foreign.drive.drive) CHECK(sample.command[0] == 0.5);
}

TEST_CASE("poses out of order are sorted, repeated ones and a clock that goes back are counted") {
  ForeignLog log;
  for (const int i : {0, 1, 3, 2, 2, 4, 5, 6, 7, 8}) log.pose(kBegin + 50'000 * i, "POSE", 0.1 * i);
  log.pose(kBegin + 400'000, "POSE", 0.9);
  log.pose(kBegin, "POSE", 7.0);
  const ForeignDrive foreign = log.read();
  REQUIRE(foreign.drive.fixes.size() == 9);
  for (size_t i = 0; i < 9; ++i)
    CHECK(foreign.drive.fixes[i].T_map_body.x == Approx(0.1 * double(i)));
  REQUIRE(foreign.losses.size() == 2);
  CHECK(lineOf(foreign.losses[0]) == "1 of 12 poses (8.3 %): their clock goes back");
  CHECK(lineOf(foreign.losses[1]) == "1 of 12 poses (8.3 %): the same time as the one before");
}

TEST_CASE("a foreign log whose messages count nanoseconds is named") {
  ForeignLog log;
  for (int i = 0; i < 100; ++i)
    log.add(kBegin + 50'000 * i, "POSE",
            Bytes("pose_xyt_t").time(1000 * (kBegin + 50'000 * i)).number(0).number(0).number(0));
  REQUIRE_THROWS_WITH(log.read(), Catch::Contains("count time in ns"));
}

TEST_CASE("a foreign log whose recorder and messages count another unit together is named") {
  for (const auto& [unit, in_us] : {std::pair("ns", 1000.0), std::pair("ms", 0.001)}) {
    ForeignLog log;
    for (int i = 0; i < 100; ++i) {
      const auto time = static_cast<int64_t>(static_cast<double>(kBegin + 50'000 * i) * in_us);
      log.pose(time, "POSE", 0.01 * i);
    }
    REQUIRE_THROWS_WITH(log.read(), Catch::Contains(std::string("in ") + unit));
  }
}

TEST_CASE(
    "a recorder that counts another unit than its messages is named, and its dates in ns read") {
  const auto logged = [](int64_t recorder_begin, int64_t recorder_period) {
    auto log = std::make_unique<ForeignLog>();
    for (int i = 0; i < 100; ++i) {
      const int64_t utime = kBegin + 50'000 * i;
      const int64_t recorded = recorder_begin + recorder_period * i;
      log->add(recorded, "POSE",
               Bytes("pose_xyt_t").time(utime).number(0.01 * i).number(0).number(0));
      // Without its own time it has the recorder's.
      log->add(recorded, "PWM", Bytes("mbot_motor_pwm_t").time(0).number(0.5).number(0.5));
    }
    return log;
  };
  const ForeignDrive foreign = logged(1000 * kBegin, 50'000'000)->read();
  REQUIRE(foreign.notes ==
          std::vector<std::string>{"the recorder's times are ns, not us; read as such"});
  REQUIRE(foreign.losses.empty());
  REQUIRE(foreign.drive.fixes.size() == 100);
  REQUIRE(foreign.drive.fixes.back().time == Approx(4.95));
  REQUIRE(foreign.drive.drive.back().time == Approx(4.95));
  for (const auto& [unit, begin, period] :
       {std::tuple("ms", kBegin / 1000, 50), std::tuple("ns", int64_t{0}, 50'000'000)})
    REQUIRE_THROWS_WITH(logged(begin, period)->read(),
                        Catch::Contains(std::string("recorder counts time in ") + unit));
}

TEST_CASE("a foreign scan becomes points, its angles clockwise, its times in us or ms") {
  ForeignLog log;
  Bytes scan = Bytes("lidar_t").time(kBegin).count(3);
  for (const double range : {2.0, 0.0, 3.0}) scan.number(range);
  for (const double angle : {0.0, 1.0, 1.5707963}) scan.number(angle);
  for (const int64_t time : {0, 100, 200}) scan.time(kBegin + time);
  for (int i = 0; i < 3; ++i) scan.number(1.0);
  log.add(kBegin, "LIDAR", scan);
  const recordings::RecordedDrive drive = log.read().drive;
  REQUIRE(drive.scans.size() == 1);
  const scan_t& message = drive.scans[0].message;
  REQUIRE(message.num_points == 2);
  REQUIRE(message.points[0][0] == Approx(2.0));
  REQUIRE(message.points[1][1] == Approx(-3.0));
  REQUIRE(message.duration == 200'000);
  REQUIRE(message.sensor_position[2] == 0.2);
}

TEST_CASE("several channels of poses: one must be chosen, and a pose out of range is refused") {
  ForeignLog log;
  log.pose(kBegin, "ODOMETRY", 1.0);
  log.pose(kBegin, "SLAM_POSE", 1.5);
  REQUIRE_THROWS_WITH(log.read(),
                      Catch::Contains("ODOMETRY, SLAM_POSE") && Catch::Contains("--pose-channel"));
  ForeignRobot robot;
  robot.pose_channel = "SLAM_POSE";
  const ForeignDrive foreign = log.read(robot);
  REQUIRE(foreign.drive.fixes.at(0).T_map_body.x == 1.5);
  REQUIRE(foreign.left_out.at("ODOMETRY: another --pose-channel") == 1);
  robot.pose_channel = "TRUE_POSE";
  REQUIRE_THROWS_WITH(log.read(robot), Catch::Contains("choose one"));
  log.pose(kBegin + 1000, "SLAM_POSE", 1e10);
  robot.pose_channel = "SLAM_POSE";
  REQUIRE_THROWS_WITH(log.read(robot), Catch::Contains("beyond 100 km"));
}

TEST_CASE("a log without any known type says so and names those that are known") {
  ForeignLog log;
  Bytes other("pose_xyt_t");
  other.bytes[0] ^= 1;
  log.add(kBegin, "OTHER", other);
  REQUIRE_THROWS_WITH(log.read(),
                      Catch::Contains("no type") && Catch::Contains("mbot_wheel_ctrl_t"));
}

TEST_CASE("real logs of other robots are read: poses, scans, commands") {
  const char* recordings = std::getenv("TREAD_RECORDINGS");
  const std::string logs = std::string(recordings ? recordings : "") + "/lcmlogs/";
  if (!std::filesystem::exists(logs)) {
    WARN("skipped: no recordings in " + logs);
    return;
  }
  const ForeignDrive maebot = readForeignLog(logs + "maebot2015_tsnowak/convex.log", {});
  REQUIRE(maebot.drive.fixes.size() == 457);
  REQUIRE(maebot.drive.scans.size() == 459);
  REQUIRE(maebot.left_out.at("MAEBOT_IMU: another type") == 1376);
  ForeignRobot robot;
  robot.baseline = 0.15;
  robot.pose_channel = "TRUE_POSE";
  const ForeignDrive square = readForeignLog(logs + "mbot2017_sweep/sweep_drive_square.log", robot);
  REQUIRE(square.drive.fixes.size() > 2300);
  REQUIRE(square.drive.scans.size() == 125);
  REQUIRE(square.drive.scans[5].message.duration > 150'000);
  REQUIRE(square.drive.drive.size() > 450);
  const ForeignDrive open = readForeignLog(logs + "mbot2021_haotsunglee/openloop_50.log", {});
  REQUIRE(open.drive.channels == trackChannels(CommandKind::kPower));
  REQUIRE(open.drive.fixes.empty());
  REQUIRE(open.drive.drive.size() > 270);
}
