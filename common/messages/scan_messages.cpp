// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/messages/scan_messages.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>

#include "common/geometry/se2.hpp"

namespace tread {
namespace {

constexpr int kMostBeams = 15000;
constexpr int kLongestScan = 1'000'000;
constexpr double kFarthestMount = 20.0;
constexpr double kFarthestRange = 1000.0;

std::optional<Eigen::Isometry3d> sensorPose(const scan_t& message) {
  const Eigen::Vector3d position(message.sensor_position[0], message.sensor_position[1],
                                 message.sensor_position[2]);
  const Eigen::Quaterniond orientation(message.sensor_orientation[0], message.sensor_orientation[1],
                                       message.sensor_orientation[2],
                                       message.sensor_orientation[3]);
  const double off_unit = std::abs(orientation.norm() - 1.0);
  // maxCoeff() misses a NaN that is not in the first place.
  if (!position.allFinite() || position.cwiseAbs().maxCoeff() >= kFarthestMount ||
      !(off_unit < 1e-3))
    return std::nullopt;
  Eigen::Isometry3d T_body_sensor = Eigen::Isometry3d::Identity();
  T_body_sensor.linear() = orientation.normalized().toRotationMatrix();
  T_body_sensor.translation() = position;
  return T_body_sensor;
}

/// The first thing that is wrong with the message's frame, or nullptr.
const char* faultOf(const scan_t& message) {
  const auto beams = static_cast<size_t>(message.num_beams);
  const auto points = static_cast<size_t>(message.num_points);
  // The end of the scan must also be a valid time.
  if (message.utime <= 0 || message.utime > INT64_MAX - kLongestScan) return "no time";
  if (message.duration < 0 || message.duration > kLongestScan) return "duration out of 0..1 s";
  if (message.num_beams < 0 || message.num_points < 0 ||
      message.num_beams + message.num_points == 0 || message.num_beams > kMostBeams ||
      message.num_points > kMostBeams)
    return "no beams, or too many";
  if (message.ranges.size() != beams || message.points.size() != points)
    return "another number of beams than stated";
  return nullptr;
}

/// The same for the fields of a range scan.
const char* rangeFaultOf(const scan_t& message) {
  const double turn = message.angle_step * (message.num_beams - 1);
  if (!std::isfinite(message.angle_first) || !(std::abs(turn) < 2.0 * kPi + 0.01) ||
      std::abs(message.angle_first) > 4.0 * kPi)
    return "angles out of one turn";
  if (message.num_beams > 1 && message.angle_step == 0.0) return "angle step is zero";
  if (!(message.range_min >= 0.0) || !(message.range_max > message.range_min) ||
      !(message.range_max <= kFarthestRange))
    return "range limits are not 0 <= range_min < range_max <= 1000 m";
  return nullptr;
}

double shareOf(int i, int count) {
  return count > 1 ? static_cast<double>(i) / (count - 1) : 0.0;
}

void takeRanges(const scan_t& message, std::vector<Beam>& beams) {
  for (int i = 0; i < message.num_beams; ++i) {
    const auto range = static_cast<double>(message.ranges[static_cast<size_t>(i)]);
    if (std::isnan(range) || range < message.range_min) continue;
    const double angle = message.angle_first + i * message.angle_step;
    const bool hit = range <= message.range_max;
    const double reach = hit ? range : message.range_max;
    beams.push_back({{reach * std::cos(angle), reach * std::sin(angle), 0.0},
                     shareOf(i, message.num_beams),
                     hit});
  }
}

void takePoints(const scan_t& message, std::vector<Beam>& beams) {
  for (int i = 0; i < message.num_points; ++i) {
    const std::vector<float>& point = message.points[static_cast<size_t>(i)];
    if (point.size() != 3) continue;
    const Eigen::Vector3d p_sensor = Eigen::Vector3f(point[0], point[1], point[2]).cast<double>();
    if (!(p_sensor.norm() <= kFarthestRange)) continue;
    beams.push_back({p_sensor, shareOf(i, message.num_points), true});
  }
}

/// Hash of all measured values of a scan, bit for bit (FNV-1a).
uint64_t fingerprint(const scan_t& message) {
  uint64_t hash = 0xcbf29ce484222325ULL;
  const auto add = [&hash](const std::vector<float>& values) {
    for (const float value : values) {
      uint32_t bits = 0;
      std::memcpy(&bits, &value, sizeof bits);
      hash = (hash ^ bits) * 0x100000001b3ULL;
    }
  };
  add(message.ranges);
  for (const std::vector<float>& point : message.points) add(point);
  return hash;
}

}  // namespace

std::optional<ReceivedScan> readScan(const scan_t& message, std::string& refusal) {
  const char* fault = faultOf(message);
  if (fault == nullptr && message.num_beams > 0) fault = rangeFaultOf(message);
  const auto T_body_sensor = sensorPose(message);
  if (fault == nullptr && !T_body_sensor) fault = "sensor pose is no pose";
  if (fault != nullptr) {
    refusal = fault;
    return std::nullopt;
  }
  ReceivedScan scan{
      message.utime, message.utime + message.duration, *T_body_sensor, {}, fingerprint(message)};
  takeRanges(message, scan.beams);
  takePoints(message, scan.beams);
  return scan;
}

}  // namespace tread
