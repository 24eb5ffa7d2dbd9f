// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>

#include "common/capture/pcap_stream.hpp"
#include "modules/lidar_driver/carmen/carmen_player.hpp"
#include "modules/lidar_driver/hokuyo/scip_session.hpp"
#include "modules/lidar_driver/rplidar/rplidar_session.hpp"
#include "modules/lidar_driver/sick_cola/cola_session.hpp"
#include "modules/lidar_driver/sick_lms2xx/lms_session.hpp"
#include "modules/lidar_driver/velodyne/velodyne_session.hpp"
#include "modules/simulator/emulators/hokuyo/scip_emulator.hpp"
#include "modules/simulator/emulators/rplidar/rplidar_emulator.hpp"
#include "modules/simulator/emulators/sick_cola/cola_emulator.hpp"
#include "modules/simulator/emulators/sick_lms2xx/lms_emulator.hpp"
#include "tests/fuzz/reading.hpp"
#include "tests/fuzz/targets.hpp"

namespace tread::fuzz {
namespace {

/// Checks the output of a session: scans must end before they arrive.
void requireScans(lidar::ScanDevice& device, int64_t now) {
  for (const lidar::RangeScan& scan : device.take(now)) {
    const bool slice = scan.ranges.empty() && !scan.points.empty();
    require(slice || (scan.ranges.size() >= 2 && scan.ranges.size() <= 4000));
    require(scan.points.size() <= lidar::kMostPoints && scan.duration_us >= 0);
    require(std::isfinite(scan.angle_first) && scan.utime <= now - scan.duration_us);
  }
}

/// Feeds bytes in pieces, with time between them, to an open device.
template <class Use>
void inPieces(const uint8_t* bytes, size_t size, int64_t now, Use use) {
  for (size_t at = 0; at < size; at += 61) {
    now += 1000 * (bytes[at] % 64);
    use(textOf(bytes + at, std::min<size_t>(61, size - at)), now);
  }
}

/// The first byte selects the dialect; valid start-up replies come first, so that scans are parsed.
void cola(const uint8_t* bytes, size_t size) {
  if (size == 0) return;
  lidar::ColaConfig config;
  config.dialect = bytes[0] % 2 == 0 ? lidar::ColaDialect::kA : lidar::ColaDialect::kB;
  lidar::ColaSession session(config);
  int64_t now = 10'000'000;
  session.open(now);
  for (const char* answer : {"sEA LMDscandata 0", "sRA DeviceIdent", "sAN SetAccessMode 1",
                             "sAN LMCstartmeas 0", "sAN Run 1", "sEA LMDscandata 1"}) {
    session.poll(now);
    session.receive(lidar::colaFrame(config.dialect, answer), now);
  }
  // First as one telegram with a valid checksum, so that its fields are parsed, then as a stream.
  const std::string telegram = "sSN LMDscandata " + textOf(bytes + 1, size - 1);
  session.receive(lidar::colaFrame(config.dialect, telegram), now);
  requireScans(session, now);
  inPieces(bytes + 1, size - 1, now, [&](const std::string& piece, int64_t time) {
    session.receive(piece, time);
    requireScans(session, time);
    session.poll(time);
  });
}

void colaCommand(const uint8_t* bytes, size_t size) {
  sim::ColaEmulator emulator{sim::LaserParameters{}};
  emulator.receive(textOf(bytes, size), 1'000'000);
  sim::LaserScan scan;
  scan.ranges.assign(541, 2.0F);
  emulator.add(scan);
  emulator.transmit(1'100'000);
}

/// The first byte selects the insertion point: a place in the reply to PP, or in the stream.
void hokuyo(const uint8_t* bytes, size_t size) {
  if (size == 0) return;
  lidar::ScipSession session({bytes[0] % 2 == 0, 0.0});
  sim::ScipEmulator emulator(sim::scipSettingsOf(sim::LaserParameters{}), 1);
  int64_t now = 10'000'000;
  session.open(now);
  for (int i = 0; i < 8; ++i, now += 100'000) {
    emulator.receive(session.poll(now), now);
    std::string answer = emulator.transmit(now);
    if (bytes[0] >= 128 && answer.compare(0, 2, "PP") == 0)
      answer = "PP\n00P\n" + textOf(bytes + 1, size - 1) + "\n\n";
    session.receive(answer, now);
  }
  inPieces(bytes + 1, size - 1, now, [&](const std::string& piece, int64_t time) {
    session.receive(piece, time);
    requireScans(session, time);
    emulator.receive(session.poll(time), time);
    session.receive(emulator.transmit(time), time);
  });
}

/// A scanner started by its emulator; then both get the bytes.
template <class Session, class Emulator>
void scanner(const uint8_t* bytes, size_t size) {
  Session session({});
  Emulator emulator{sim::LaserParameters{}};
  int64_t now = 10'000'000;
  session.open(now);
  for (int i = 0; i < 8; ++i, now += 100'000) {
    emulator.receive(session.poll(now), now);
    session.receive(emulator.transmit(now), now);
  }
  inPieces(bytes, size, now, [&](const std::string& piece, int64_t time) {
    session.receive(piece, time);
    requireScans(session, time);
    emulator.receive(piece, time);
    emulator.transmit(time);
  });
}

/// Packets from a network line, or a capture file.
void velodyne(const uint8_t* bytes, size_t size) {
  lidar::VelodyneSession session({1, 1, 0.0});
  int64_t now = 10'000'000;
  session.open(now);
  inPieces(bytes, size, now, [&](const std::string& piece, int64_t time) {
    session.receive(piece, now = time);
    requireScans(session, time);
  });
  session.close();
  requireScans(session, now + 1'000'000'000);
}

/// Payloads of a capture are parts of its bytes, and none follows after damage was found.
void capture(const uint8_t* bytes, size_t size) {
  PcapStream stream;
  size_t carried = 0;
  inPieces(bytes, size, 0, [&](const std::string& piece, int64_t) {
    const bool damaged = !stream.problem().empty();
    stream.push(piece);
    while (const auto payload = stream.next()) {
      require(!damaged);
      carried += payload->bytes.size() + 1;
    }
    stream.takeLeftOut();
  });
  require(carried <= size);
}

void carmenPlayer(const uint8_t* bytes, size_t size) {
  lidar::CarmenPlayer player({});
  player.open(1'000'000);
  player.receive(textOf(bytes, size), 1'000'000);
  requireScans(player, INT64_MAX);
}

}  // namespace

void addRangeFinderTargets(std::map<std::string, Target>& targets) {
  targets["capture"] = capture;
  targets["carmen_player"] = carmenPlayer;
  targets["cola"] = cola;
  targets["cola_command"] = colaCommand;
  targets["hokuyo"] = hokuyo;
  targets["lms"] = scanner<lidar::LmsSession, sim::LmsEmulator>;
  targets["rplidar"] = scanner<lidar::RplidarSession, sim::RplidarEmulator>;
  targets["velodyne"] = velodyne;
}

}  // namespace tread::fuzz
