// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/measurement.hpp"

#include <algorithm>
#include <cmath>

#include "common/vehicle/effects.hpp"
#include "common/vehicle/model.hpp"

namespace tread {
namespace {

/// Index of the sample with which the interval around `time` begins.
size_t intervalAt(const std::vector<MotionSample>& motion, double time) {
  const auto later =
      std::upper_bound(motion.begin(), motion.end(), time,
                       [](double moment, const MotionSample& pose) { return moment < pose.time; });
  const auto index = static_cast<size_t>(std::distance(motion.begin(), later));
  return std::min(std::max<size_t>(index, 1) - 1, motion.size() - 2);
}

}  // namespace

Pose2 poseAt(const std::vector<MotionSample>& motion, double time) {
  if (motion.size() < 2) return motion.front().T_map_body;
  const size_t i = intervalAt(motion, time);
  const MotionSample& from = motion[i];
  const MotionSample& to = motion[i + 1];
  if (time == from.time || to.time <= from.time) return from.T_map_body;
  if (time == to.time) return to.T_map_body;
  const Twist2 v_body = twistTo(between(from.T_map_body, to.T_map_body), to.time - from.time);
  return from.T_map_body * integrate(v_body, time - from.time);
}

double yawRateAt(const std::vector<MotionSample>& motion, double time) {
  if (motion.size() < 2 || time <= motion.front().time) return motion.front().omega;
  if (time >= motion.back().time) return motion.back().omega;
  const size_t i = intervalAt(motion, time);
  const double span = motion[i + 1].time - motion[i].time;
  if (span <= 0.0) return motion[i].omega;
  const double share = (time - motion[i].time) / span;
  return motion[i].omega + share * (motion[i + 1].omega - motion[i].omega);
}

bool isPerfect(const MeasurementModel& measurement) {
  const std::vector<Effect>& effects = effectCatalogue();
  return std::none_of(effects.begin(), effects.end(), [&](const Effect& effect) {
    return effect.kind() == EffectKind::kMeasurement && isOn(effect, {}, measurement);
  });
}

std::vector<MotionSample> measure(const std::vector<MotionSample>& motion,
                                  const MeasurementModel& measurement) {
  std::vector<MotionSample> said;
  said.reserve(motion.size());
  for (const MotionSample& now : motion) said.push_back(measured(motion, measurement, now));
  return said;
}

MotionSample measuredAt(const std::vector<MotionSample>& motion,
                        const MeasurementModel& measurement, double time) {
  return measured(motion, measurement, {time, poseAt(motion, time), yawRateAt(motion, time)});
}

}  // namespace tread
