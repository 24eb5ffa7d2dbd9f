// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "modules/ins_driver/nmea/nmea_framer.hpp"
#include "modules/ins_driver/nmea/nmea_ins.hpp"
#include "tests/helpers.hpp"
#include "tests/ins_driver/nmea_lines.hpp"

using namespace tread;
using namespace tread::ins;

namespace {

using tread::testing::kDeg;

/// Content of a recorded log.
struct NmeaLogSummary {
  NmeaCounts counts;
  AssemblerCounts epochs;
  std::optional<GeoOrigin> origin;
  std::vector<InsEstimate> estimates;
  std::optional<InsEstimate> first_pose;  ///< first with position and heading
  std::optional<InsEstimate> last_pose;   ///< last likewise
};

/// Runs a complete log through the core, in its own time.
NmeaLogSummary summarise(std::string_view log, const InsConfig& config) {
  NmeaIns ins(config);
  NmeaLogSummary summary;
  const auto collect = [&](int64_t now) {
    while (const std::optional<InsEstimate> estimate = ins.next(now))
      summary.estimates.push_back(*estimate);
  };
  int64_t now = 0;
  for (const NmeaBurst& burst : scheduleNmeaLog(log)) {
    // The silence before this burst ends the previous epoch.
    collect(burst.utime);
    now = burst.utime;
    ins.push(burst.bytes, now);
  }
  ins.interrupt();
  collect(now);
  for (const InsEstimate& estimate : summary.estimates) {
    if (estimate.status & (InsStatus::kNoPosition | InsStatus::kNoHeading)) continue;
    if (!summary.first_pose) summary.first_pose = estimate;
    summary.last_pose = estimate;
  }
  summary.counts = ins.counts();
  summary.epochs = ins.assembler().counts();
  summary.origin = ins.assembler().origin();
  return summary;
}

int64_t ofType(const NmeaLogSummary& summary, const std::string& type) {
  for (size_t i = 0; i < kSentenceTypes; ++i) {
    if (type == kSentenceNames[i]) return summary.counts.of_type[i];
  }
  return -1;
}

int64_t emptyOf(const NmeaLogSummary& summary, const std::string& type) {
  for (size_t i = 0; i < kSentenceTypes; ++i) {
    if (type == kSentenceNames[i]) return summary.counts.empty[i];
  }
  return -1;
}

}  // namespace

TEST_CASE("bursts of a log together are the log, in the device's own time") {
  const std::string log = "# comment\r\n" + gga(10.0) + vtg(0.0, 1.0) + line("GPHDT,1.0,T") +
                          gga(10.5) + vtg(0.0, 1.0) + "garbage\r\n" + line("GPVTG,,T,,M,,N,,K,N") +
                          gga(11.5);
  const auto bursts = scheduleNmeaLog(log);
  std::string together;
  for (const NmeaBurst& burst : bursts) together += burst.bytes;
  CHECK(together == log);
  REQUIRE(bursts.size() == 3);
  CHECK(bursts[1].utime - bursts[0].utime == 500'000);
  CHECK(bursts[2].utime - bursts[1].utime == 1'000'000);
  CHECK(scheduleNmeaLog("").empty());
  CHECK(scheduleNmeaLog("no sentence at all").size() == 1);
}

TEST_CASE("a log is cut into the same bursts whatever ends its lines") {
  const std::string log = gga(10.0) + line("GPHDT,1.0,T") + gga(10.5) + line("GPHDT,1.0,T");
  for (const std::string end : {"\r", "\n", "\r\n", "\n\r"}) {
    std::string ended;
    for (const char byte : log)
      if (byte != '\r') ended += byte == '\n' ? end : std::string(1, byte);
    const auto bursts = scheduleNmeaLog(ended);
    REQUIRE(bursts.size() == 2);
    CHECK(bursts[1].utime - bursts[0].utime == 500'000);
    CHECK(std::string(bursts[0].bytes) + std::string(bursts[1].bytes) == ended);
  }
}

TEST_CASE("a log across midnight plays without a break") {
  std::string log;
  for (int i = 0; i < 10; ++i) log += gga(86399.6 + i * 0.1) + pashr(86399.6 + i * 0.1, 90.0);
  const NmeaLogSummary summary = summarise(log, {});
  REQUIRE(summary.estimates.size() == 10);
  for (size_t i = 1; i < 10; ++i)
    CHECK(summary.estimates[i].utime - summary.estimates[i - 1].utime == 100'000);
  CHECK(summary.epochs.jumps == 0);
}

TEST_CASE("rst39.log: every sentence is decoded, 100 poses with heading, 40 of them at a fix") {
  const auto log = recording("ins/nmea/rst39.log");
  if (!log) {
    WARN("skipped: rst39.log is not here (TREAD_RECORDINGS)");
    return;
  }
  const NmeaLogSummary summary = summarise(*log, {});
  CHECK(summary.counts.sentences == 152);
  CHECK(summary.counts.decoded == 152);
  CHECK(summary.counts.refused.total() == 0);
  CHECK(ofType(summary, "GGA") == 40);
  CHECK(ofType(summary, "RMC") == 4);
  CHECK(ofType(summary, "ZDA") == 4);
  CHECK(ofType(summary, "PASHR") == 100);
  CHECK(ofType(summary, "HDT") == 4);
  CHECK(emptyOf(summary, "GGA") == 0);
  int64_t poses = 0;
  for (const InsEstimate& ins : summary.estimates) {
    if (!(ins.status & (InsStatus::kNoPosition | InsStatus::kNoHeading))) ++poses;
    CHECK_FALSE(ins.status & (InsStatus::kGap | InsStatus::kJump));
  }
  CHECK(poses - summary.epochs.positions_carried == 40);
  CHECK(poses >= 100);
  REQUIRE(summary.first_pose);
  CHECK(summary.first_pose->device_utc == 1392842492100000);
  CHECK(summary.first_pose->p_map_body.norm() < 1e-6);
  CHECK(yawPitchRoll(summary.first_pose->R_map_body).yaw == Approx(78.26 * kDeg).margin(1e-3));
  REQUIRE(summary.last_pose);
  CHECK(summary.last_pose->device_utc == 1392842496000000);
  CHECK(summary.last_pose->p_map_body.x() == Approx(15.255).margin(0.01));
  CHECK(summary.last_pose->p_map_body.y() == Approx(8.909).margin(0.01));
  CHECK(yawPitchRoll(summary.last_pose->R_map_body).yaw == Approx(15.21 * kDeg).margin(1e-3));
}

TEST_CASE("rst39.log: the velocity that it tells is the one that its positions show") {
  const auto log = recording("ins/nmea/rst39.log");
  if (!log) {
    WARN("skipped: rst39.log is not here (TREAD_RECORDINGS)");
    return;
  }
  const NmeaLogSummary summary = summarise(*log, {});
  int compared = 0;
  for (size_t i = 1; i + 1 < summary.estimates.size(); ++i) {
    const InsEstimate& before = summary.estimates[i - 1];
    const InsEstimate& ins = summary.estimates[i];
    const InsEstimate& after = summary.estimates[i + 1];
    if ((ins.status | before.status) & InsStatus::kNoPosition ||
        ins.status & InsStatus::kNoVelocity)
      continue;
    const Eigen::Vector3d v_map = (after.p_map_body - before.p_map_body) /
                                  (static_cast<double>(after.utime - before.utime) * 1e-6);
    const Eigen::Vector3d v_body = ins.R_map_body.conjugate() * v_map;
    // One velocity per second, extrapolated for 150 ms in a curve.
    CHECK(ins.v_body.x() == Approx(v_body.x()).margin(0.15));
    CHECK(ins.v_body.y() == Approx(v_body.y()).margin(0.15));
    ++compared;
  }
  CHECK(compared == 12);
}

TEST_CASE("hemi.log: 215 epochs, of which 21 hold a fix and 4 a heading") {
  const auto log = recording("ins/nmea/hemi.log");
  if (!log) {
    WARN("skipped: hemi.log is not here (TREAD_RECORDINGS)");
    return;
  }
  const NmeaLogSummary summary = summarise(*log, {});
  CHECK(summary.counts.sentences == 753);
  CHECK(summary.counts.decoded == 753);
  CHECK(ofType(summary, "HDT") - emptyOf(summary, "HDT") == 4);
  CHECK(ofType(summary, "VTG") - emptyOf(summary, "VTG") == 21);
  CHECK(ofType(summary, "GGA") - emptyOf(summary, "GGA") == 21);
  CHECK(summary.estimates.size() == 215);
  int headings = 0;
  for (const InsEstimate& ins : summary.estimates) {
    if (!(ins.status & InsStatus::kNoHeading)) ++headings;
    // At rest: its course varies over all directions, its velocity must not.
    if (!(ins.status & InsStatus::kNoVelocity)) CHECK(ins.v_body.head<2>().norm() == 0.0);
  }
  CHECK(headings == 4);
}

TEST_CASE("bt451.log: indoors, then outdoors, no heading, so never a pose") {
  const auto log = recording("ins/nmea/bt451.log");
  if (!log) {
    WARN("skipped: bt451.log is not here (TREAD_RECORDINGS)");
    return;
  }
  const NmeaLogSummary summary = summarise(*log, {});
  CHECK(summary.counts.sentences == 144);
  CHECK(summary.counts.decoded == 68);
  CHECK(summary.counts.refused[SentenceRefusal::kUnknownSentence] == 76);
  CHECK(summary.counts.refused.total() == 76);
  CHECK_FALSE(summary.first_pose);
  // Two recordings in one file: the second is earlier that day.
  CHECK(summary.epochs.clock_steps == 1);
}

TEST_CASE("nmea_sample.txt: two fixes out of GGA with 13 and 14 fields, dated by ZDA and RMC") {
  const auto log = recording("ins/novatel/nmea_sample.txt");
  if (!log) {
    WARN("skipped: nmea_sample.txt is not here (TREAD_RECORDINGS)");
    return;
  }
  const NmeaLogSummary summary = summarise(*log, {});
  CHECK(ofType(summary, "GGA") + ofType(summary, "RMC") == 3);  // sorted by type: the rest is late
  CHECK(summary.counts.reasons.count("GGA: field count") == 0);
  CHECK(summary.origin);
  int fixes = 0;
  for (const InsEstimate& ins : summary.estimates) {
    if (ins.status & InsStatus::kNoPosition) continue;
    ++fixes;
    CHECK(ins.device_utc / 1'000'000 >= 1543387769);  // 2018-11-28 06:49:29
    CHECK(ins.device_utc / 1'000'000 <= 1543387770);
  }
  CHECK(fixes >= 2);
}
