// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/replay/sensor_replay.hpp"

#include <algorithm>
#include <iomanip>
#include <sstream>

#include "common/bus/virtual_bus.hpp"
#include "common/messages/ins_messages.hpp"
#include "common/report/plot.hpp"
#include "common/store/store.hpp"
#include "modules/ins_driver/nmea/nmea_framer.hpp"

namespace tread {
namespace {

constexpr double kDegPerRad = 180.0 / kPi;
/// After the last bytes, so that the last epoch ends and HEALTH holds the final counts.
constexpr int64_t kAfterwardsUs = 200'000;
/// A burst larger than this is played in pieces, as a line would deliver it.
constexpr size_t kPieceBytes = 4096;
constexpr int64_t kPieceUs = 5'000;

void play(const std::string& log, VirtualBus& bus, Link& device) {
  const int64_t start = bus.now();
  for (const ins::NmeaBurst& burst : ins::scheduleNmeaLog(log)) {
    bus.runUntil(std::max(bus.now(), start + burst.utime));
    for (size_t at = 0; at < burst.bytes.size(); at += kPieceBytes) {
      if (at > 0) bus.runUntil(bus.now() + kPieceUs);
      const std::string_view piece = burst.bytes.substr(at, kPieceBytes);
      device.write(reinterpret_cast<const uint8_t*>(piece.data()), piece.size());
    }
  }
  bus.runUntil(bus.now() + kAfterwardsUs);
}

void findPoses(InsReplay& replay) {
  for (const ins_t& message : replay.track) {
    if (!planarPose(message)) continue;
    ++replay.poses;
    if (!replay.first_pose) replay.first_pose = message;
    replay.last_pose = message;
  }
}

void writePose(std::ostream& out, const char* which, const std::optional<ins_t>& message) {
  out << which << " pose: ";
  const auto pose = message ? planarPose(*message) : std::nullopt;
  if (!pose) {
    out << "none\n";
    return;
  }
  out << "x " << pose->x << " m, y " << pose->y << " m, z " << message->position[2] << " m, yaw "
      << pose->yaw * kDegPerRad << " deg, UTC " << static_cast<double>(message->device_utc) * 1e-6
      << " s\n";
}

/// Headings drawn along a track, whatever its length.
constexpr size_t kHeadings = 40;

std::vector<Pose2> posesOf(const InsReplay& replay) {
  std::vector<Pose2> poses;
  for (const ins_t& message : replay.track)
    if (const auto pose = planarPose(message)) poses.push_back(*pose);
  return poses;
}

report::Panel::Axes axesAround(const std::vector<Pose2>& poses) {
  Eigen::Array2d low = poses.front().position().array();
  Eigen::Array2d high = low;
  for (const Pose2& pose : poses) {
    low = low.min(pose.position().array());
    high = high.max(pose.position().array());
  }
  const double margin = std::max(1.0, 0.05 * (high - low).maxCoeff());
  report::Panel::Axes axes;
  axes.x_label = "x [m]";
  axes.y_label = "y [m]";
  axes.x_min = low.x() - margin;
  axes.x_max = high.x() + margin;
  axes.y_min = low.y() - margin;
  axes.y_max = high.y() + margin;
  axes.equal = true;
  return axes;
}

}  // namespace

InsReplay replayIns(const std::string& log, ins::InsDriverConfig config) {
  if (!config.make_source) config.make_source = ins::sourceOf<ins::NmeaIns>({});
  InsReplay replay;
  VirtualBus bus(0);
  MemoryStore store;
  auto [device, robot] = makePipe();
  bus.outside().subscribe<ins_t>(kIns,
                                 [&](const ins_t& message) { replay.track.push_back(message); });
  bus.outside().subscribe<health_t>(
      kHealth, [&](const health_t& health) { replay.health = health.health_reason; });
  Link& robot_end = *robot;
  bus.addNode("ins_driver", [&](Bus& end) {
    return std::make_unique<ins::InsDriverNode>(config, end, robot_end, store);
  });
  play(log, bus, *device);
  const auto& node = dynamic_cast<ins::InsDriverNode&>(*bus.node("ins_driver"));
  const auto& source = dynamic_cast<const ins::NmeaIns&>(node.source());
  replay.counts = source.counts();
  replay.epochs = source.assembler().counts();
  replay.origin = source.origin();
  findPoses(replay);
  return replay;
}

InsReplay replayInsFile(const std::string& path, const ins::InsDriverConfig& config) {
  return replayIns(readText(path), config);
}

std::string reportOf(const InsReplay& replay) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(3);
  const ins::NmeaCounts& counts = replay.counts;
  out << "sentences in: " << counts.sentences << " (" << counts.bytes << " bytes, "
      << counts.stray_bytes << " of them in no sentence)\ndecoded: " << counts.decoded;
  for (size_t i = 0; i < ins::kSentenceTypes; ++i) {
    if (counts.of_type[i] == 0) continue;
    out << ", " << ins::kSentenceNames[i] << " " << counts.of_type[i];
    if (counts.empty[i] > 0) out << " (" << counts.empty[i] << " without a value)";
  }
  out << "\nrefused: " << counts.refused.total();
  if (!counts.reasons.empty()) out << ", " << ins::listed(counts.reasons);
  out << "\nINS messages: " << replay.track.size() << ", with position and heading " << replay.poses
      << ", gaps " << replay.epochs.gaps << ", jumps " << replay.epochs.jumps << "\n";
  if (!replay.health.empty()) out << "HEALTH at the end: " << replay.health << "\n";
  writePose(out, "first", replay.first_pose);
  writePose(out, "last", replay.last_pose);
  return out.str();
}

void drawTrack(const InsReplay& replay, const std::string& title, const std::string& path) {
  report::Picture canvas(900, 900, title);
  const std::vector<Pose2> poses = posesOf(replay);
  if (poses.empty()) {
    canvas.text(60, 100, "no pose in this log");
    return canvas.save(path);
  }
  const report::Panel::Axes axes = axesAround(poses);
  report::Panel panel(canvas, {80, 60, 780, 760}, axes);
  std::vector<Eigen::Vector2d> track;
  track.reserve(poses.size());
  for (const Pose2& pose : poses) track.push_back(pose.position());
  report::Style line;
  line.colour = report::kBlue;
  line.label = "position";
  panel.line(track, line);
  const double length = 0.03 * std::max(axes.x_max - axes.x_min, axes.y_max - axes.y_min);
  report::Style heading;
  heading.colour = report::kOrange;
  heading.label = "heading";
  for (size_t i = 0; i < poses.size(); i += std::max<size_t>(1, poses.size() / kHeadings)) {
    panel.line({poses[i].position(), poses[i] * Eigen::Vector2d(length, 0.0)}, heading);
    heading.label.clear();
  }
  panel.dot(track.front(), report::kGreen, 6.0);
  panel.dot(track.back(), report::kRed, 6.0);
  panel.finish();
  canvas.save(path);
}

}  // namespace tread
