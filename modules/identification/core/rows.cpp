// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/rows.hpp"

#include <algorithm>
#include <cmath>

namespace tread::gap {
namespace {

/// Fixes around one, averaged where there are many; the pose at their mean time.
struct Endpoint {
  double time = 0.0;
  Pose2 T_map_body{};
  size_t next = 0;  ///< first fix after those that were used
};

bool hasPose(const InsSample& sample) {
  return std::isfinite(sample.T_map_body.x) && std::isfinite(sample.T_map_body.y) &&
         std::isfinite(sample.T_map_body.yaw);
}

std::vector<InsSample> fixesOf(const Stretch& stretch) {
  std::vector<InsSample> fixes;
  for (const InsSample& sample : stretch.ins)
    if (hasPose(sample)) fixes.push_back(sample);
  return fixes;
}

Endpoint endpointFrom(const std::vector<InsSample>& fixes, size_t first, double width) {
  Endpoint mean;
  size_t count = 0;
  for (size_t i = first; i < fixes.size() && fixes[i].time <= fixes[first].time + width; ++i) {
    mean.time += fixes[i].time;
    mean.T_map_body.x += fixes[i].T_map_body.x;
    mean.T_map_body.y += fixes[i].T_map_body.y;
    mean.T_map_body.yaw += fixes[i].T_map_body.yaw;
    ++count;
  }
  const auto n = static_cast<double>(count);
  mean.time /= n;
  mean.T_map_body = {mean.T_map_body.x / n, mean.T_map_body.y / n, mean.T_map_body.yaw / n};
  mean.next = first + count;
  return mean;
}

/// First fix at or after a moment.
size_t fixAfter(const std::vector<InsSample>& fixes, size_t from, double time) {
  while (from < fixes.size() && fixes[from].time < time) ++from;
  return from;
}

/// Yaw of poseAt(), at a tenth of its cost: along an arc it is linear in time. Looks from piece
/// `i` on, and leaves there where it was found.
double yawAt(const std::vector<MotionSample>& motion, double time, size_t& i) {
  if (motion.size() < 2) return motion.front().T_map_body.yaw;
  if (i + 1 >= motion.size()) i = 0;
  while (i > 0 && motion[i].time > time) --i;
  while (i + 2 < motion.size() && motion[i + 1].time <= time) ++i;
  const MotionSample& from = motion[i];
  const MotionSample& to = motion[i + 1];
  return from.T_map_body.yaw +
         (to.T_map_body.yaw - from.T_map_body.yaw) * (time - from.time) / (to.time - from.time);
}

}  // namespace

const char* channelName(Channel channel) {
  static constexpr const char* kNames[kChannels] = {"yaw rate", "heading rate", "along", "lateral"};
  return kNames[static_cast<size_t>(channel)];
}

const char* channelUnit(Channel channel) {
  return channel == Channel::kYawRate || channel == Channel::kHeading ? "rad/s" : "m/s";
}

Rows::Rows(const std::vector<Drive>& drives, const RowSettings& settings)
    : drives_(drives), settings_(settings) {
  size_t all = 0;
  for (const Drive& drive : drives) {
    first_stretch_.push_back(all);
    all += drive.stretches.size();
  }
  for (size_t i = 0; i < drives.size(); ++i) addDrive(i, settings.block);
  // Poses are simulated where rows begin and end: only latencies have them interpolated.
  std::vector<std::vector<double>> cuts(all);
  for (const Row& row : rows_)
    for (double time : {row.begin, row.end})
      cuts[stretchIndex(row.drive, row.stretch)].push_back(time);
  for (size_t i = 0; i < drives.size(); ++i)
    for (size_t s = 0; s < drives[i].stretches.size(); ++s) {
      std::vector<double>& moments = cuts[stretchIndex(i, s)];
      std::sort(moments.begin(), moments.end());
      plans_.emplace_back(drives[i], drives[i].stretches[s], settings.piece, moments);
    }
  measured_.resize(static_cast<Eigen::Index>(rows_.size()));
  for (size_t i = 0; i < rows_.size(); ++i)
    measured_[static_cast<Eigen::Index>(i)] = rows_[i].measured;
}

void Rows::addDrive(size_t index, double block) {
  const Drive& drive = drives_[index];
  const double driven = drive.driven();
  const int count = driven <= 0.0 ? 0 : std::max(1, static_cast<int>(driven / block + 1e-6));
  drive_blocks_.emplace_back(blocks_, count);
  drive_lengths_.push_back(count > 0 ? driven / count : block);
  double before = 0.0;
  for (size_t s = 0; s < drive.stretches.size(); ++s) {
    const Stretch& stretch = drive.stretches[s];
    driven_.emplace_back(before, stretch.end - stretch.begin());
    before += stretch.end - stretch.begin();
    Row like;
    like.drive = index;
    like.stretch = s;
    const size_t first = rows_.size();
    addGyro(stretch, like);
    addPoses(stretch, like);
    for (size_t i = first; i < rows_.size(); ++i)
      rows_[i].block = blockAt(index, s, (rows_[i].begin + rows_[i].end) / 2.0);
  }
  block_length_ = std::max(block_length_, count > 0 ? drive_lengths_.back() : 0.0);
  blocks_ += count;
}

int Rows::blockAt(size_t drive, size_t stretch, double time) const {
  const auto& [before, duration] = driven_[stretchIndex(drive, stretch)];
  const double length = drive_lengths_[drive];
  // A short run is never split: its rows share what chance did to it.
  const double at =
      duration < length ? duration / 2.0 : time - drives_[drive].stretches[stretch].begin();
  const auto& [first, count] = drive_blocks_[drive];
  return first + std::clamp(static_cast<int>((before + at) / length), 0, std::max(0, count - 1));
}

void Rows::addGyro(const Stretch& stretch, const Row& like) {
  std::vector<const InsSample*> gyro;
  for (const InsSample& sample : stretch.ins)
    if (std::isfinite(sample.omega)) gyro.push_back(&sample);
  size_t at = 0;
  while (at < gyro.size()) {
    const double from = gyro[at]->time;
    double sum = 0.0;
    size_t count = 0;
    for (; at + count < gyro.size() && gyro[at + count]->time < from + settings_.gyro_bin - 1e-6;
         ++count)
      sum += gyro[at + count]->omega;
    const double last = gyro[at + count - 1]->time;
    at += count;
    if (count < 3 || last - from < 0.5 * settings_.gyro_bin) continue;
    // Samples stand for the time around them.
    const double half = (last - from) / (2.0 * static_cast<double>(count - 1));
    Row row = like;
    row.channel = Channel::kYawRate;
    row.begin = from - half;
    row.end = last + half;
    row.measured = sum / static_cast<double>(count);
    rows_.push_back(row);
  }
}

void Rows::addPoses(const Stretch& stretch, const Row& like) {
  const std::vector<InsSample> fixes = fixesOf(stretch);
  if (fixes.empty()) return;
  const double width = 2.0 * settings_.smoothing;
  Endpoint from = endpointFrom(fixes, 0, width);
  while (true) {
    const size_t next =
        fixAfter(fixes, from.next, from.time + settings_.pose_interval - settings_.smoothing);
    if (next >= fixes.size()) return;
    const Endpoint to = endpointFrom(fixes, next, width);
    const double duration = to.time - from.time;
    if (duration <= settings_.longest) {
      const Pose2 moved = between(from.T_map_body, to.T_map_body);
      Row row = like;
      row.begin = from.time;
      row.end = to.time;
      for (const auto& [channel, value] :
           {std::pair{Channel::kHeading, moved.yaw}, std::pair{Channel::kAlong, moved.x},
            std::pair{Channel::kAcross, moved.y}}) {
        row.channel = channel;
        row.measured = value / duration;
        rows_.push_back(row);
      }
    }
    from = to;
  }
}

std::vector<std::vector<MotionSample>> Rows::simulate(const VehicleModel& vehicle) const {
  std::vector<std::vector<MotionSample>> motions;
  motions.reserve(plans_.size());
  for (const StretchPlan& plan : plans_) motions.push_back(plan.simulate(vehicle));
  return motions;
}

Eigen::VectorXd Rows::predict(const ModelDocument& model) const {
  return predict(simulate(model.vehicle), model.measurement);
}

Eigen::VectorXd Rows::predict(const std::vector<std::vector<MotionSample>>& motions,
                              const MeasurementModel& ins) const {
  Eigen::VectorXd predicted(static_cast<Eigen::Index>(rows_.size()));
  const double gyro_latency = ins.ins_latency_gyro * ins.ins_latency;
  Pose2 moved;
  Pose2 from;
  double from_time = kNotMeasured;
  const std::vector<MotionSample>* of = nullptr;
  size_t piece = 0;
  for (size_t i = 0; i < rows_.size(); ++i) {
    const Row& row = rows_[i];
    const std::vector<MotionSample>& motion = motions[stretchIndex(row.drive, row.stretch)];
    const double duration = row.end - row.begin;
    double value = 0.0;
    if (row.channel == Channel::kYawRate) {
      const double before = yawAt(motion, row.begin - gyro_latency, piece);
      value = (yawAt(motion, row.end - gyro_latency, piece) - before) / duration + ins.gyro_bias;
    } else {
      // The three rows of an interval follow one another, and intervals share their ends.
      if (row.channel == Channel::kHeading) {
        const Pose2 start = of == &motion && from_time == row.begin
                                ? from
                                : measuredAt(motion, ins, row.begin).T_map_body;
        from = measuredAt(motion, ins, row.end).T_map_body;
        from_time = row.end;
        of = &motion;
        moved = between(start, from);
      }
      value = (row.channel == Channel::kHeading ? moved.yaw
               : row.channel == Channel::kAlong ? moved.x
                                                : moved.y) /
              duration;
    }
    predicted[static_cast<Eigen::Index>(i)] = value;
  }
  return predicted;
}

}  // namespace tread::gap
