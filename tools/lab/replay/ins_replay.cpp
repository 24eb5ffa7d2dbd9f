// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/replay/ins_replay.hpp"

#include "tools/lab/replay/mapping_replay.hpp"

#include <algorithm>
#include <ctime>
#include <functional>
#include <iomanip>
#include <sstream>
#include <stdexcept>

#include "common/bus/virtual_bus.hpp"
#include "common/capture/pcap_stream.hpp"
#include "common/link/make_link.hpp"
#include "common/messages/ins_messages.hpp"
#include "common/report/plot.hpp"
#include "common/store/store.hpp"
#include "modules/ins_driver/nmea/nmea_framer.hpp"
#include "modules/ins_driver/nmea/nmea_ins.hpp"

namespace tread {
namespace {

constexpr double kDegPerRad = 180.0 / kPi;
/// After the last bytes: the last epoch ends and HEALTH gets the final counts.
constexpr int64_t kAfterwardsUs = 200'000;
/// A larger burst is played in pieces, as a line would deliver it.
constexpr size_t kPieceBytes = 4096;
constexpr int64_t kPieceUs = 5'000;
constexpr int64_t kUntimedUs = 100'000;      ///< between bursts without a usable time
constexpr int64_t kMaxPauseUs = 60'000'000;  ///< longer pauses are shortened to it

/// Bytes that arrived together.
struct Burst {
  int64_t utime = 0;  ///< [us] since the log's start
  std::string bytes;
};
using MakeScout = std::function<std::unique_ptr<ins::InsSource>()>;

/// Pause between two bursts, by the times of the device or the capture.
int64_t pauseBetween(int64_t before, int64_t after) {
  return after > before ? std::min(after - before, kMaxPauseUs) : kUntimedUs;
}

/// Cuts a log of bytes at each change of the messages' time stamp.
std::vector<Burst> cutByMessages(const std::string& log, ins::InsSource& scout) {
  std::vector<Burst> bursts(1);
  std::optional<int64_t> time;
  size_t message = 0;  // start of the current message
  for (size_t i = 0; i < log.size(); ++i) {
    const auto now = static_cast<int64_t>(i);
    scout.push(std::string_view(log).substr(i, 1), now);
    if (scout.lastMessage() != now) continue;
    const auto told = scout.deviceTime();
    if (told && time && *told != *time) {
      bursts.push_back({bursts.back().utime + pauseBetween(*time, *told), {}});
    }
    if (told) time = told;
    bursts.back().bytes += log.substr(message, i + 1 - message);
    message = i + 1;
    while (scout.next(now)) {
    }
  }
  bursts.back().bytes += log.substr(message);
  return bursts;
}

std::vector<Burst> cutNmea(const std::string& log) {
  std::vector<Burst> bursts;
  for (const ins::NmeaBurst& burst : ins::scheduleNmeaLog(log))
    bursts.push_back({burst.utime, std::string(burst.bytes)});
  return bursts;
}

/// Number of payloads that the instrument's decoder understood.
int64_t messagesIn(const std::vector<CapturedPayload>& payloads, ins::InsSource& scout) {
  int64_t messages = 0;
  int64_t now = 0;
  for (const CapturedPayload& payload : payloads) {
    scout.push(payload.bytes, ++now);
    if (scout.lastMessage() == now) ++messages;
    while (scout.next(now)) {
    }
  }
  return messages;
}

/// Content of a capture by stream; `notes` gets what was left out.
std::map<std::string, std::vector<CapturedPayload>> streamsOf(const std::string& file,
                                                              std::string& notes) {
  std::map<std::string, std::vector<CapturedPayload>> streams;
  ins::ReasonCounts left_out;
  PcapStream capture;
  for (size_t at = 0; at < file.size(); at += kPieceBytes) {
    capture.push(std::string_view(file).substr(at, kPieceBytes));
    while (auto payload = capture.next()) {
      const std::string ends = payload->from + " to " + payload->to;
      streams[(payload->tcp ? "TCP " : "UDP ") + ends].push_back(std::move(*payload));
    }
    for (const auto& [what, times] : capture.takeLeftOut()) left_out[what] += times;
  }
  if (!capture.problem().empty()) notes += capture.problem() + "\n";
  if (!left_out.empty()) notes += "left out: " + ins::listed(left_out) + "\n";
  return streams;
}

std::vector<Burst> cutCapture(const std::string& file, const MakeScout& make_scout,
                              std::string& notes) {
  const auto streams = streamsOf(file, notes);
  const std::pair<const std::string, std::vector<CapturedPayload>>* found = nullptr;
  int64_t most = 0;
  for (const auto& stream : streams) {
    const int64_t messages = messagesIn(stream.second, *make_scout());
    if (messages > most) found = &stream;
    most = std::max(most, messages);
  }
  if (found == nullptr) {
    notes += "none of the capture's " + std::to_string(streams.size()) +
             " UDP and TCP streams contains a message of this instrument\n";
    return {};
  }
  notes += "played: " + found->first + "\n";
  std::vector<Burst> bursts;
  int64_t time = found->second.front().time;
  int64_t utime = 0;
  for (const CapturedPayload& payload : found->second) {
    if (payload.time != time) utime += pauseBetween(time, payload.time);
    time = payload.time;
    bursts.push_back({utime, payload.bytes});
  }
  return bursts;
}

std::vector<Burst> burstsOf(const std::string& log, const ins::InsDriverConfig& config,
                            std::string& notes) {
  const MakeScout make_scout = [&] { return config.make_source(std::nullopt); };
  if (log.rfind("\x1F\x8B", 0) == 0)
    throw std::runtime_error("the log is gzipped; unpack it with gunzip first");
  if (PcapStream::begins(log)) return cutCapture(log, make_scout, notes);
  return config.source == "nmea" ? cutNmea(log) : cutByMessages(log, *make_scout());
}

void play(const std::vector<Burst>& bursts, VirtualBus& bus, Link& device) {
  const int64_t start = bus.now();
  for (const Burst& burst : bursts) {
    bus.runUntil(std::max(bus.now(), start + burst.utime));
    for (size_t at = 0; at < burst.bytes.size(); at += kPieceBytes) {
      if (at > 0) bus.runUntil(bus.now() + kPieceUs);
      const std::string_view piece = std::string_view(burst.bytes).substr(at, kPieceBytes);
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

int64_t sumOf(const ins::ReasonCounts& counts) {
  int64_t sum = 0;
  for (const auto& [name, count] : counts) sum += count;
  return sum;
}

/// GPS counts weeks modulo 1024, so a receiver with old firmware is 19.6 years behind. A date is
/// taken as correct if the corrected one would be in the future.
std::string dateOf(int64_t utc) {
  constexpr int64_t kEra = 1024 * int64_t{7} * 86400;
  const auto written = [](int64_t seconds) {
    const std::time_t time = seconds;
    std::ostringstream text;
    text << std::put_time(std::gmtime(&time), "%Y-%m-%d");
    return text.str();
  };
  const int64_t seconds = utc / 1'000'000;
  if (utc < 0) return "";
  if (seconds + kEra > std::time(nullptr)) return " (" + written(seconds) + ")";
  return " (" + written(seconds) + "; if the drive was on " + written(seconds + kEra) +
         ", the receiver's GPS week has rolled over)";
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
      << " s" << dateOf(message->device_utc) << "\n";
}

/// Number of headings drawn along a track.
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
  const std::vector<Burst> bursts = burstsOf(log, config, replay.notes);
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
  play(bursts, bus, *device);
  const ins::InsSource& source =
      dynamic_cast<ins::InsDriverNode&>(*bus.node("ins_driver")).source();
  replay.tally = source.tally();
  replay.remedy = source.advice().refused;
  replay.epochs = source.epochs();
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
  const ins::InsTally& tally = replay.tally;
  const int64_t decoded = sumOf(tally.decoded);
  out << replay.notes << "messages in: " << tally.messages << " (" << tally.bytes << " bytes, "
      << tally.stray_bytes << " of them in no message)\ndecoded: " << decoded;
  if (decoded > 0) out << ", " << ins::listed(tally.decoded);
  out << "\nrefused: " << sumOf(tally.refused);
  if (!tally.refused.empty()) out << ", " << ins::listed(tally.refused);
  if (decoded == 0 && !replay.remedy.empty())
    out << "\n" << replay.remedy;
  else if (decoded == 0)
    out << "\nno message of this instrument: name another `source` with --config";
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
