// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <functional>
#include <memory>
#include <sstream>

#include "modules/ins_driver/nmea/nmea_ins.hpp"
#include "modules/simulator/emulators/nmea/nmea_ins_emulator.hpp"
#include "modules/simulator/emulators/novatel/novatel_emulator.hpp"
#include "modules/simulator/emulators/ublox/ublox_emulator.hpp"
#include "modules/simulator/emulators/vectornav/vectornav_emulator.hpp"
#include "modules/simulator/emulators/xsens/xsens_emulator.hpp"
#include "tests/common/capture/capture_file.hpp"
#include "tests/ins_driver/nmea_lines.hpp"
#include "tools/lab/replay/ins_replay.hpp"
#include "tools/lab/replay/mapping_replay.hpp"

using namespace tread;
using namespace tread::ins;

namespace {

int64_t decoded(const InsReplay& replay) {
  int64_t sum = 0;
  for (const auto& [name, count] : replay.tally.decoded) sum += count;
  return sum;
}

InsDriverConfig configOf(const std::string& source) {
  ConfigReader reader = ConfigReader::fromText("source: " + source + "\n",
                                               TREAD_SOURCE_DIR "/config/robots/teodor/x");
  return readInsDriverConfig(reader);
}

std::unique_ptr<sim::InsEmulator> emulatorOf(const std::string& source) {
  const sim::MapOnEarth map;
  if (source == "novatel") return std::make_unique<sim::NovatelEmulator>(map, 5);
  if (source == "ublox") return std::make_unique<sim::UbloxEmulator>(map, 5);
  if (source == "vectornav") return std::make_unique<sim::VectornavEmulator>(map, 5);
  if (source == "xsens") return std::make_unique<sim::XsensEmulator>(map, 5);
  return std::make_unique<sim::NmeaInsEmulator>(sim::NmeaInsSettings{}, 5);
}

/// Output of an instrument in 10 s at 50 Hz while it drives 10 m to the north.
std::vector<std::pair<int64_t, std::string>> driveOf(const std::string& source) {
  const auto emulator = emulatorOf(source);
  std::vector<std::pair<int64_t, std::string>> said;
  for (int64_t utime = 1'000'000; utime < 11'000'000; utime += 20'000) {
    sim::InsMeasurement sample;
    sample.utime = utime;
    sample.yaw = 1.5707963267948966;
    sample.p_map.y() = static_cast<double>(utime) * 1e-6;
    sample.v_body.x() = 1.0;
    emulator->add(sample);
    said.emplace_back(utime, emulator->transmit(utime));
  }
  return said;
}

void checkDrive(const InsReplay& replay) {
  INFO(reportOf(replay));
  CHECK(replay.poses >= 495);
  CHECK(replay.tally.stray_bytes == 0);
  CHECK(replay.epochs.gaps == 0);
  CHECK(replay.epochs.jumps == 0);
  REQUIRE(replay.last_pose);
  CHECK(replay.last_pose->position[1] - replay.first_pose->position[1] == Approx(9.96).margin(0.1));
  // In its own time, not the time of reading.
  CHECK(replay.last_pose->utime - replay.first_pose->utime == Approx(9.96e6).margin(1e5));
  CHECK(reportOf(replay).find("with position and heading") != std::string::npos);
}

}  // namespace

TEST_CASE("a recording of every instrument that ins_driver knows comes out as the drive it was") {
  for (const std::string source : {"nmea", "novatel", "ublox", "vectornav", "xsens"}) {
    CAPTURE(source);
    const auto said = driveOf(source);
    std::string bytes;
    for (const auto& [utime, message] : said) bytes += message;
    checkDrive(replayIns(bytes, configOf(source)));
    for (const bool tcp : {false, true}) {
      testing::CaptureForm form;
      form.tcp = tcp;
      form.blocks = tcp;
      testing::CaptureFile capture(form);
      for (const auto& [utime, message] : said) capture.add(utime, message);
      const InsReplay replay = replayIns(capture.bytes(), configOf(source));
      checkDrive(replay);
      CHECK(replay.notes.find(tcp ? "played: TCP 10.0.0.1:2368" : "played: UDP 10.0.0.1:2368") ==
            0);
    }
  }
}

TEST_CASE("of a capture that stream is played in which the instrument speaks") {
  std::string other;
  for (const auto& [utime, message] : driveOf("ublox")) other += message;
  const InsReplay replay = [&] {
    testing::CaptureFile capture({});
    for (size_t at = 0; at < other.size(); at += 1000)
      capture.add(1'000'000 + static_cast<int64_t>(at), other.substr(at, 1000));
    return replayIns(capture.bytes(), configOf("vectornav"));
  }();
  CHECK(replay.track.empty());
  CHECK(reportOf(replay).find("none of the capture's 1 UDP and TCP streams") != std::string::npos);
  CHECK(reportOf(replay).find("name another `source`") != std::string::npos);
}

TEST_CASE("recordings of a NovAtel, as bytes and as a capture of its TCP stream") {
  const auto bytes = recording("ins/novatel/advanceddecoder_alllogs.BIN");
  const auto capture = recording("ins/novatel/corrimudata.pcap");
  if (!bytes || !capture) {
    WARN("skipped: the NovAtel recordings are not here (TREAD_RECORDINGS)");
    return;
  }
  const InsReplay all = replayIns(*bytes, configOf("novatel"));
  WARN(reportOf(all));
  CHECK(all.tally.messages == 563);
  CHECK(decoded(all) == 3);
  CHECK(all.tally.refused.at("messages: not known") == 552);
  const InsReplay stood = replayIns(*capture, configOf("novatel"));
  WARN(reportOf(stood));
  CHECK(stood.tally.decoded.at("BESTPOS") == 28);
  CHECK(stood.tally.decoded.at("INSPVAX") == 28);
  CHECK(stood.poses == 27);
}

TEST_CASE("rst39.log through the real node: 152 sentences in, 152 decoded, 116 poses") {
  const auto log = recording("ins/nmea/rst39.log");
  if (!log) {
    WARN("skipped: rst39.log is not here (TREAD_RECORDINGS)");
    return;
  }
  const InsReplay replay = replayIns(*log, {});
  WARN(reportOf(replay));
  CHECK(replay.tally.messages == 152);
  CHECK(decoded(replay) == 152);
  CHECK(replay.tally.refused.empty());
  // 40 fixes at 10 Hz; attitudes at 25 Hz in between, with extrapolated positions.
  CHECK(replay.poses == 116);
  CHECK(replay.poses - replay.epochs.positions_carried == 40);
  REQUIRE(replay.track.size() == 117);
  for (size_t i = 1; i < replay.track.size(); ++i) {
    const int64_t interval = replay.track[i].utime - replay.track[i - 1].utime;
    CHECK(interval > 0);
    CHECK(interval <= 100'000);
    CHECK((replay.track[i].ins_status & (ins_t::STATUS_GAP | ins_t::STATUS_JUMP)) == 0);
  }
  REQUIRE(replay.last_pose);
  CHECK(replay.last_pose->position[0] == Approx(15.255).margin(0.01));
  CHECK(replay.last_pose->position[1] == Approx(8.909).margin(0.01));
  CHECK(replay.last_pose->device_utc == 1392842496000000);
}

TEST_CASE("hemi.log through the real node: 753 sentences in, a heading four times") {
  const auto log = recording("ins/nmea/hemi.log");
  if (!log) {
    WARN("skipped: hemi.log is not here (TREAD_RECORDINGS)");
    return;
  }
  const InsReplay replay = replayIns(*log, {});
  WARN(reportOf(replay));
  CHECK(replay.tally.messages == 753);
  CHECK(decoded(replay) == 753);
  CHECK(replay.poses == 4);
}

TEST_CASE("a log of sentences without good checksums is named as that, not as another instrument") {
  std::string good;
  for (int i = 0; i < 50; ++i) good += gga(10.0 + 0.02 * i) + pashr(10.0 + 0.02 * i, 90.0);
  for (const auto& [end, words] :
       {std::pair("\r\n", "without checksums (*hh): let the device send them"),
        std::pair("*00\r\n", "with wrong checksums")}) {
    std::istringstream lines(good);
    std::string log;
    for (std::string one; std::getline(lines, one);) log += one.substr(0, one.find('*')) + end;
    const std::string report = reportOf(replayIns(log, {}));
    CHECK_THAT(report, Catch::Contains(words));
    CHECK_THAT(report, !Catch::Contains("name another `source`"));
  }
}

TEST_CASE("a log that is no log is reported, not crashed upon") {
  CHECK(replayIns("", {}).track.empty());
  const InsReplay garbage = replayIns(std::string(300'000, 'x'), {});
  CHECK(garbage.tally.stray_bytes == 300'000);
  CHECK(garbage.track.empty());
  CHECK_THROWS_WITH(replayInsFile("/no/such/file.log", {}), Catch::Contains("/no/such/file.log"));
}
