// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/hide/instruments.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "modules/simulator/core/noise.hpp"

namespace tread::blind {
namespace {

constexpr double kWarmUpTime = 200.0;  // of a gyro [s]

/// Interpolates between two values every 10 ms.
struct Place {
  size_t before = 0;
  double share = 0.0;

  Place(double time, size_t count) {
    const double at = std::clamp(time * 1e6 / Track::kStepUs, 0.0, static_cast<double>(count - 1));
    before = std::min(static_cast<size_t>(at), count - 2);
    share = at - static_cast<double>(before);
  }
  template <class Number>
  double of(const std::vector<Number>& values) const {
    return static_cast<double>(values[before]) +
           share * (static_cast<double>(values[before + 1]) - static_cast<double>(values[before]));
  }
};

Pose2 poseAt(const std::vector<Pose2>& poses, double time) {
  const Place place(time, poses.size());
  const Pose2& a = poses[place.before];
  const Pose2& b = poses[place.before + 1];
  return {a.x + place.share * (b.x - a.x), a.y + place.share * (b.y - a.y),
          a.yaw + place.share * (b.yaw - a.yaw)};
}

/// The gyro is synchronous with the poses.
double yawRateAt(const std::vector<Twist2>& twists, double time) {
  const Place place(time, twists.size());
  const double before = twists[place.before].omega;
  return before + place.share * (twists[place.before + 1].omega - before);
}

/// Only the noise of NoiseLevel: an offset that lasts longer than a pattern would be a separate
/// effect. A filter's pose errors are correlated for a moment, so a mean over .1 s is hardly better
/// than a single pose.
sim::InsParameters insParameters(const NoiseLevel& noise) {
  constexpr double kSamplesPerBin = 0.25 / 0.02;
  sim::InsParameters ins;
  ins.latency_us = 0;
  ins.bias_time = 0.15;
  ins.position_noise = 0.0;
  ins.position_bias = noise.fix;
  ins.height_noise = noise.fix;
  ins.heading_noise = 0.0;
  ins.heading_bias = noise.heading;
  ins.attitude_noise = 0.002;
  ins.rate_noise = noise.gyro_bin * std::sqrt(kSamplesPerBin);
  return ins;
}

/// Gyro values without noise.
double sensedYawRate(const std::vector<Twist2>& v_body, const InstrumentFault& fault, double time) {
  const double warm_up = fault.gyro_warm_up * std::exp(-time / kWarmUpTime);
  return yawRateAt(v_body, time - fault.all_latency) + fault.gyro_bias + warm_up;
}

sim::InsInput sensed(const Track& track, const InstrumentFault& fault, double time) {
  const double now = time - fault.all_latency;
  const Place place(now, track.pitch.size());
  const Pose2 pose = sensedPose(track.T_map_body, fault, time);
  sim::InsInput input;
  input.body.p_map = {pose.x, pose.y, place.of(track.height)};
  input.body.pitch = place.of(track.pitch);
  input.body.roll = place.of(track.roll);
  input.yaw = pose.yaw;
  input.rate_body.z() = sensedYawRate(track.v_body, fault, time);
  return input;
}

/// Median and rms of errors.
ErrorSize sizeOf(std::vector<double> errors) {
  if (errors.empty()) return {};
  double squares = 0.0;
  for (const double error : errors) squares += error * error;
  std::sort(errors.begin(), errors.end());
  const size_t middle = errors.size() / 2;
  const double median =
      errors.size() % 2 == 1 ? errors[middle] : 0.5 * (errors[middle - 1] + errors[middle]);
  return {median, std::sqrt(squares / static_cast<double>(errors.size()))};
}

double rmsOf(const std::vector<double>& errors) {
  return sizeOf(errors).rms;
}

/// Compares relative end poses, one pair per execution.
class EndPoses {
 public:
  void add(const Pose2& T_start_end, const Pose2& T_start_measured) {
    position_.push_back(
        std::hypot(T_start_measured.x - T_start_end.x, T_start_measured.y - T_start_end.y));
    yaw_.push_back(std::abs(wrapAngle(T_start_measured.yaw - T_start_end.yaw)));
  }
  void addYawRate(double error) { yaw_rate_.push_back(error); }
  EndPoseError error() const {
    return {sizeOf(position_), sizeOf(yaw_), rmsOf(yaw_rate_), static_cast<int>(yaw_.size())};
  }

 private:
  std::vector<double> position_;
  std::vector<double> yaw_;
  std::vector<double> yaw_rate_;
};

/// Mean over 0.25 s from a time on.
template <class YawRate>
double binOf(double time, YawRate yaw_rate) {
  constexpr int kSamples = 12;
  double sum = 0.0;
  for (int i = 0; i < kSamples; ++i) sum += yaw_rate(time + 0.02 * (i + 0.5));
  return sum / kSamples;
}

/// Bins of 0.25 s per pattern.
constexpr int kBins = 8;

Pose2 measuredAt(const std::vector<sim::InsMeasurement>& samples, int64_t time) {
  const auto after = std::lower_bound(
      samples.begin(), samples.end(), time,
      [](const sim::InsMeasurement& sample, int64_t t) { return sample.utime < t; });
  if (after == samples.begin()) return {after->p_map.x(), after->p_map.y(), after->yaw};
  if (after == samples.end()) {
    const sim::InsMeasurement& last = samples.back();
    return {last.p_map.x(), last.p_map.y(), last.yaw};
  }
  const sim::InsMeasurement& a = *std::prev(after);
  const sim::InsMeasurement& b = *after;
  const double share = static_cast<double>(time - a.utime) / static_cast<double>(b.utime - a.utime);
  const Eigen::Vector3d p = a.p_map + share * (b.p_map - a.p_map);
  return {p.x(), p.y(), a.yaw + share * (b.yaw - a.yaw)};
}

constexpr int64_t kBinUs = 250'000;

/// Mean of measured minus true yaw rate over one bin.
double yawRateError(const HiddenDrive& drive, const InstrumentFault& fault,
                    const std::vector<sim::InsMeasurement>& measured, int64_t begin) {
  auto sample = std::lower_bound(
      measured.begin(), measured.end(), begin,
      [](const sim::InsMeasurement& one, int64_t time) { return one.utime < time; });
  double sum = 0.0;
  int count = 0;
  for (; sample != measured.end() && sample->utime < begin + kBinUs; ++sample, ++count) {
    const double time = static_cast<double>(sample->utime) * 1e-6;
    sum += sample->rate_body.z() - sensedYawRate(drive.track.v_clean, fault, time);
  }
  return count > 0 ? sum / count : 0.0;
}

}  // namespace

InstrumentFault faultOf(const std::vector<Hidden>& hidden) {
  InstrumentFault fault;
  for (const Hidden& one : hidden)
    if (one.hider.sense) one.hider.sense(fault);
  return fault;
}

Pose2 sensedPose(const std::vector<Pose2>& T_map_body, const InstrumentFault& fault, double time) {
  const double then = time - fault.all_latency - fault.pose_latency;
  const Pose2 pose = poseAt(T_map_body, then);
  const double yaw =
      fault.heading_latency > 0.0 ? poseAt(T_map_body, then - fault.heading_latency).yaw : pose.yaw;
  const Eigen::Vector2d p_map = pose * Eigen::Vector2d(fault.antenna_x, fault.antenna_y);
  const double scale = 1.0 + fault.position_scale;
  return {scale * p_map.x(), scale * p_map.y(), yaw - fault.misalignment};
}

std::vector<sim::InsMeasurement> measure(const Track& track, const InstrumentFault& fault,
                                         const NoiseLevel& noise, uint64_t seed, int64_t phase) {
  sim::Ins ins(insParameters(noise), sim::streamSeed(seed, kInsStream), phase);
  std::vector<sim::InsMeasurement> samples;
  const int64_t end = static_cast<int64_t>(track.pitch.size() - 1) * Track::kStepUs;
  for (int64_t time = phase; time <= end; time += ins.parameters().period_us) {
    ins.measure(time, sensed(track, fault, static_cast<double>(time) * 1e-6));
    for (const sim::InsMeasurement& sample : ins.takeSamples(time)) samples.push_back(sample);
  }
  return samples;
}

EndPoseError oracleFloor(const HiddenDrive& drive, const InstrumentFault& fault,
                         const std::vector<sim::InsMeasurement>& measured) {
  EndPoses ends;
  for (const Pattern& pattern : drive.programme.patterns) {
    const int64_t end = pattern.start + kPatternUs;
    const auto truth = [&](int64_t time) {
      return sensedPose(drive.track.T_map_clean, fault, static_cast<double>(time) * 1e-6);
    };
    ends.add(between(truth(pattern.start), truth(end)),
             between(measuredAt(measured, pattern.start), measuredAt(measured, end)));
    for (int bin = 0; bin < kBins; ++bin)
      ends.addYawRate(yawRateError(drive, fault, measured, pattern.start + bin * kBinUs));
  }
  return ends.error();
}

EndPoseError hiddenGap(const HiddenDrive& with, const InstrumentFault& fault,
                       const HiddenDrive& without) {
  EndPoses ends;
  for (const Pattern& pattern : with.programme.patterns) {
    const double start = static_cast<double>(pattern.start) * 1e-6;
    const double end = start + kPatternSeconds;
    const auto relative = [&](const HiddenDrive& drive, const InstrumentFault& told) {
      return between(sensedPose(drive.track.T_map_clean, told, start),
                     sensedPose(drive.track.T_map_clean, told, end));
    };
    ends.add(relative(without, {}), relative(with, fault));
    for (int bin = 0; bin < kBins; ++bin)
      ends.addYawRate(binOf(start + 0.25 * bin, [&](double time) {
        return sensedYawRate(with.track.v_clean, fault, time) -
               sensedYawRate(without.track.v_clean, {}, time);
      }));
  }
  return ends.error();
}

}  // namespace tread::blind
