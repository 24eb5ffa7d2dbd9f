// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/lidar_driver/velodyne/velodyne_session.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tread::lidar {
namespace {

constexpr uint32_t kHour = 3'600'000'000U;    // [us]
constexpr double kRangeMin = 0.4;             // [m] nearer is the housing, or the robot
constexpr double kRangeMax = 130.0;           // [m] of the ranges' 16 bits
constexpr int64_t kSilence = 1'000'000;       // [us]
constexpr int64_t kLongestPause = 1'000'000;  // [us] in a capture
constexpr size_t kMostScans = 100;            // for a node that does not fetch them
constexpr int64_t kFirings = 24;              // of a packet
constexpr const char* kWhichCapture = "is this a capture of a Velodyne's UDP packets?";
constexpr const char* kWhatIsRead =
    "this driver reads VLP-16, Puck LITE and Puck Hi-Res, in return modes strongest, last and dual";

}  // namespace

VelodyneConfig readVelodyneConfig(ConfigReader& reader) {
  VelodyneConfig config;
  reader.integer("packets", config.packets, {1, 80}, "packets");
  reader.integer("every", config.every, {1, 24}, "firings");
  const int64_t points =
      config.packets * kFirings * static_cast<int64_t>(kVelodyneLasers) / config.every;
  if (points > static_cast<int64_t>(kMostPoints))
    throw reader.error("packets",
                       "make " + std::to_string(points) + " points a slice; a message holds " +
                           std::to_string(kMostPoints) + ": take fewer, or `every` more");
  return config;
}

void VelodyneSession::open(int64_t now) {
  forget();
  open_ = true;
  opened_at_ = now;
  last_packet_ = 0;
  reasons().note(Rank::kStarting, "no packet yet", now);
}

void VelodyneSession::close() {
  if (!open_) return;
  open_ = false;
  // Data read from a capture before its end are still played.
  if (!capture_) forget();
  capture_.reset();
  capture_offset_.reset();
  buffer_.clear();
}

void VelodyneSession::forget() {
  waiting_.clear();
  scans_.clear();
  slice_ = {};
  packets_ = 0;
  clock_.forget();
  last_past_hour_.reset();
}

void VelodyneSession::receive(std::string_view bytes, int64_t now) {
  if (capture_) return receiveCapture(bytes, now);
  if (buffer_.empty() && last_packet_ == 0 && PcapStream::begins(bytes)) {
    capture_.emplace();
    return receiveCapture(bytes, now);
  }
  receiveLive(bytes, now);
}

void VelodyneSession::receiveLive(std::string_view bytes, int64_t now) {
  for (; !bytes.empty(); bytes.remove_prefix(std::min(bytes.size(), kVelodynePacket))) {
    buffer_.append(bytes.substr(0, kVelodynePacket));
    size_t at = 0;
    while (buffer_.size() - at >= kVelodynePacket) {
      const auto packet = std::string_view(buffer_).substr(at, kVelodynePacket);
      const bool whole = isVelodynePacket(packet);
      if (whole) takePacket(packet, now);
      if (!whole)
        skipUnreadable("bytes outside of packets", now,
                       "is this a Velodyne's data (port 2368), or a capture of it?", 1);
      at += whole ? kVelodynePacket : 1;
    }
    buffer_.erase(0, at);
  }
}

void VelodyneSession::receiveCapture(std::string_view bytes, int64_t now) {
  capture_->push(bytes);
  while (auto datagram = capture_->next()) {
    if (datagram->tcp || datagram->bytes.size() != kVelodynePacket) {
      skipUnreadable("captured datagrams of another length", now, kWhichCapture, 1);
      continue;
    }
    int64_t due = datagram->time + capture_offset_.value_or(now - datagram->time);
    const int64_t before = waiting_.empty() ? now : std::max(now, waiting_.back().time);
    // Times that go back or jump do not determine the pace.
    if (due < before - kLongestPause || due > before + kLongestPause) due = before;
    capture_offset_ = due - datagram->time;
    datagram->time = std::max(due, waiting_.empty() ? due : waiting_.back().time);
    waiting_.push_back(std::move(*datagram));
  }
  refuseOfCapture(now);
}

void VelodyneSession::refuseOfCapture(int64_t now) {
  for (const auto& [what, times] : capture_->takeLeftOut())
    skipUnreadable(what, now, kWhichCapture, times);
  if (capture_->problem().empty() || capture_refused_) return;
  capture_refused_ = true;
  const std::string& problem = capture_->problem();
  const size_t end = problem.find("; ");
  refuse(problem.substr(0, end), now, end == std::string::npos ? "" : problem.substr(end + 2));
}

std::string VelodyneSession::poll(int64_t now) {
  if (open_ && !capture_ && now - std::max(last_packet_, opened_at_) > kSilence)
    reasons().note(Rank::kSilent, "no packets", now, 1,
                   "is this host's address the sensor's destination, and the port the same?");
  return {};
}

std::vector<RangeScan> VelodyneSession::take(int64_t now) {
  for (; !waiting_.empty() && waiting_.front().time <= now; waiting_.pop_front())
    takePacket(waiting_.front().bytes, waiting_.front().time);
  if (!open_ && waiting_.empty()) finishSlice();
  return std::exchange(scans_, {});
}

void VelodyneSession::takePacket(std::string_view bytes, int64_t arrival) {
  std::string problem;
  const auto packet = parseVelodynePacket(bytes, problem);
  if (!packet) return refuse("refused: " + problem, arrival, kWhatIsRead);
  count("packets");
  last_packet_ = arrival;
  const int64_t duration =
      std::llround(kVelodyneFiringPeriod * static_cast<double>(packet->firings.size()));
  const int64_t begin = hostTime(packet->past_hour, arrival) - duration;
  // The next packet begins where this one ends; a lost one leaves a gap.
  if (packets_ > 0 && std::abs(begin - end_) > duration / 2) {
    count("slices cut short: packets lost or clock moved");
    finishSlice();
  }
  if (packets_ == 0) slice_.utime = begin;
  end_ = begin + duration;
  append(*packet);
  if (++packets_ >= config_.packets) finishSlice();
}

int64_t VelodyneSession::hostTime(uint32_t past_hour, int64_t arrival) {
  // At the full hour it restarts.
  const int64_t back = int64_t{last_past_hour_.value_or(past_hour)} - past_hour;
  if (back > kHour / 2) hours_ += kHour;
  last_past_hour_ = past_hour;
  if (!clock_.observe(hours_ + past_hour, arrival)) count("restarts of the device's clock");
  return clock_.hostTime() - std::llround(1e6 * config_.latency);
}

void VelodyneSession::append(const VelodynePacket& packet) {
  for (const VelodyneFiring& firing : packet.firings)
    if (firing_++ % static_cast<size_t>(config_.every) == 0)
      slice_.points.insert(slice_.points.end(), firing.points.begin(), firing.points.end());
}

void VelodyneSession::finishSlice() {
  RangeScan slice = std::exchange(slice_, {});
  packets_ = 0;
  firing_ = 0;
  if (slice.points.empty()) return;
  const auto firings = static_cast<double>(slice.points.size() / kVelodyneLasers);
  slice.duration_us =
      std::llround((firings - 1.0) * static_cast<double>(config_.every) * kVelodyneFiringPeriod);
  slice.range_min = kRangeMin;
  slice.range_max = kRangeMax;
  count("slices");
  reasons().clear();
  if (scans_.size() < kMostScans)
    scans_.push_back(std::move(slice));
  else
    count("slices dropped: not fetched");
}

}  // namespace tread::lidar
