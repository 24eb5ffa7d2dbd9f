// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cstring>

#include "modules/ins_driver/novatel/novatel_ins.hpp"
#include "tests/helpers.hpp"
#include "tests/ins_driver/nmea_lines.hpp"

using namespace tread;
using namespace tread::ins;

namespace {

template <class Number>
Number numberIn(const std::string& bytes, size_t at) {
  Number number{};
  if (at + sizeof number <= bytes.size()) std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

/// TCP payload of an IPv4 packet in an Ethernet frame, sent from this port.
std::string payloadOf(const std::string& frame, unsigned port) {
  constexpr size_t kEthernet = 14;
  const auto byte = [&](size_t at) -> size_t {
    return at < frame.size() ? static_cast<uint8_t>(frame[at]) : 0;
  };
  const size_t tcp = kEthernet + (byte(kEthernet) & 15U) * 4;
  if (byte(kEthernet) >> 4 != 4 || byte(kEthernet + 9) != 6) return {};
  if (byte(tcp) * 256 + byte(tcp + 1) != port) return {};
  const size_t end = kEthernet + byte(kEthernet + 2) * 256 + byte(kEthernet + 3);
  const size_t start = tcp + (byte(tcp + 12) >> 4) * 4;
  return end > start && end <= frame.size() ? frame.substr(start, end - start) : std::string{};
}

/// Plays the enhanced packet blocks of a pcapng file (segments in order) to a driver.
template <class Play>
void playCapture(const std::string& file, unsigned port, const Play& play) {
  constexpr uint32_t kEnhancedPacket = 6;
  for (size_t at = 0; at + 12 <= file.size();) {
    const auto type = numberIn<uint32_t>(file, at);
    const auto length = numberIn<uint32_t>(file, at + 4);
    if (length < 12) return;
    if (type == kEnhancedPacket) {
      const int64_t utime =
          int64_t{numberIn<uint32_t>(file, at + 12)} << 32 | numberIn<uint32_t>(file, at + 16);
      play(payloadOf(file.substr(at + 28, numberIn<uint32_t>(file, at + 20)), port), utime);
    }
    at += length;
  }
}

}  // namespace

TEST_CASE("corrimudata.pcap: 28 BESTPOS, 29 CORRIMUDATA, 28 INSPVAX, and a pose for each") {
  const auto file = recording("ins/novatel/corrimudata.pcap");
  if (!file) {
    WARN("skipped: corrimudata.pcap is not here (TREAD_RECORDINGS)");
    return;
  }
  InsConfig config;
  config.imu_rate = 200.0;
  config.p_body_gnss = Eigen::Vector3d(0.0, 0.0, 1.0);
  NovatelIns ins(config);
  std::vector<InsEstimate> poses;
  int64_t now = 0;
  playCapture(*file, 3001, [&](const std::string& bytes, int64_t utime) {
    now = utime;
    ins.push(bytes, utime);
    while (const auto estimate = ins.next(utime)) poses.push_back(*estimate);
  });
  ins.interrupt();
  while (const auto estimate = ins.next(now)) poses.push_back(*estimate);
  CHECK(ins.decoded().at("BESTPOS") == 28);
  CHECK(ins.decoded().at("CORRIMUDATA") == 29);
  CHECK(ins.decoded().at("INSPVAX") == 28);
  CAPTURE(ins.refusals());
  CHECK(ins.framer().refusals().count("wrong checksum") == 0);
  const AssemblerCounts& epochs = ins.assembler().counts();
  CAPTURE(epochs.epochs, epochs.attitude_only, epochs.not_newer);
  // The capture begins within its first epoch; with the clock offset of the second one it is not
  // older than that.
  CHECK(poses.size() == 27);
  CHECK(epochs.not_newer == 1);
  REQUIRE_FALSE(poses.empty());
  const InsEstimate& last = poses.back();
  CHECK(last.p_map_body.head<2>().norm() < 0.6);  // at rest; the first fix may be the antenna's
  CHECK(last.device_utc ==
        (int64_t{315964800} + 1820 * int64_t{604800} - 18) * 1000000 + 160207250000);
  CHECK(yawPitchRoll(last.R_map_body).yaw == Approx(-4.203 * testing::kDeg).margin(0.001));
  CHECK(last.attitude_std.z() == Approx(0.281 * testing::kDeg).margin(1e-4));
  CHECK(last.v_body.head<2>().norm() < 0.01);
  CHECK(last.rate_body.norm() < 0.01);
  CHECK(last.satellites == 12);
}

TEST_CASE("advanceddecoder_alllogs.BIN: 563 good frames, each of ours decoded or refused by name") {
  const auto file = recording("ins/novatel/advanceddecoder_alllogs.BIN");
  if (!file) {
    WARN("skipped: advanceddecoder_alllogs.BIN is not here (TREAD_RECORDINGS)");
    return;
  }
  NovatelIns ins(InsConfig{});
  for (size_t at = 0; at < file->size(); at += 777)
    ins.push(std::string_view(*file).substr(at, 777), static_cast<int64_t>(at) * 1000);
  ins.interrupt();
  CHECK(ins.frames() == 563);
  int64_t ours = 0;
  for (const auto& [name, count] : ins.decoded()) ours += count;
  const ReasonCounts reasons = ins.reasons();
  CAPTURE(ins.refusals(), ours);
  int64_t unused = 0;
  for (const auto& [reason, count] : reasons) {
    if (reason.find(": ") != std::string::npos) unused += count;
  }
  CHECK(ours + unused == 563);
  CHECK(ours >= 3);
  CHECK(reasons.at("INSPVAX: length") == 1);
  WARN("alllogs: " << ours << " used; " << ins.refusals());
}
