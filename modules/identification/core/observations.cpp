// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/observations.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "common/vehicle/omni_kernel.hpp"
#include "common/words/words.hpp"

namespace tread::gap {
namespace {

constexpr double kTransient =
    0.8;                         // [s] after a change of command; later everything changes slowly
constexpr double kSlowly = 2.0;  // factor on the length of pieces after that
constexpr double kShortest = 1e-3;  // [s] closer cuts are merged

/// Roll and pitch at a time; without INS data the last known ones, initially level.
void levelAt(const std::vector<InsSample>& ins, double time, size_t& next, DriveContext& context) {
  for (; next < ins.size() && ins[next].time <= time; ++next) {
    if (std::isfinite(ins[next].roll)) context.roll = ins[next].roll;
    if (std::isfinite(ins[next].pitch)) context.pitch = ins[next].pitch;
  }
}

/// Relative drop of the battery's voltage since the first sample.
double dropAt(const std::vector<VoltageSample>& voltage, double time, size_t& at) {
  if (voltage.empty() || voltage.front().voltage <= 0.0) return 0.0;
  while (at + 1 < voltage.size() && voltage[at + 1].time <= time) ++at;
  return 1.0 - voltage[at].voltage / voltage.front().voltage;
}

/// Fixes around one, averaged if there are many; the pose at their mean time.
struct Endpoint {
  double time = 0.0;
  Pose2 T_map_body{};
  size_t next = 0;  ///< first fix after the used ones
};

std::vector<InsSample> fixesOf(const Segment& segment) {
  std::vector<InsSample> fixes;
  for (const InsSample& sample : segment.ins)
    if (sample.hasPose()) fixes.push_back(sample);
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

/// First fix at or after a time.
size_t fixAfter(const std::vector<InsSample>& fixes, size_t from, double time) {
  while (from < fixes.size() && fixes[from].time < time) ++from;
  return from;
}

/// Yaw of poseAt(), at a tenth of its cost: linear in time along an arc. Searches from piece `i`
/// on, and leaves `i` at the result.
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

void giveTo(VehicleKernel& kernel, const Command& command) {
  kernel.give(command.tracks());
}

void giveTo(OmniKernel& kernel, const Command& command) {
  kernel.give(command);
}

Pose2 saidPose(const std::vector<MotionSample>& motion, const MeasurementModel& ins, double time) {
  return measuredPose(motion, ins, time, poseAt(motion, time - ins.ins_latency));
}

}  // namespace

std::vector<double> SegmentPlan::endsBetween(double from, double to, double longest,
                                             const std::vector<double>& cuts) {
  std::vector<double> fixed;
  for (auto cut = std::upper_bound(cuts.begin(), cuts.end(), from + kShortest);
       cut != cuts.end() && *cut < to - kShortest; ++cut)
    if (fixed.empty() || *cut > fixed.back() + kShortest) fixed.push_back(*cut);
  fixed.push_back(to);
  std::vector<double> ends;
  for (double end : fixed) {
    const int count = std::max(1, static_cast<int>(std::ceil((end - from) / longest - 1e-6)));
    for (int n = 1; n < count; ++n) ends.push_back(from + n * (end - from) / count);
    ends.push_back(end);
    from = end;
  }
  return ends;
}

SegmentPlan::SegmentPlan(const Drive& drive, const Segment& segment, double piece,
                         const std::vector<double>& cuts)
    : begin_(segment.begin()),
      entry_speeds_(segment.entry_speeds),
      command_before_(segment.command_before) {
  DriveContext context;
  size_t ins_next = 0;
  size_t voltage_at = 0;
  for (size_t i = 0; i < segment.commands.size(); ++i) {
    const double from = segment.commands[i].time;
    const double to = i + 1 < segment.commands.size() ? segment.commands[i + 1].time : segment.end;
    std::optional<Command> command = segment.commands[i].command;
    const double settled = to - from > 1.5 * kTransient ? from + kTransient : to;
    for (const auto& [begin, end, longest] :
         {std::tuple{from, settled, piece}, std::tuple{settled, to, kSlowly * piece}}) {
      double time = begin;
      for (double next : endsBetween(begin, end, longest, cuts)) {
        const double duration = next - time;
        if (duration <= 0.0) continue;
        context.session_time = time;
        levelAt(segment.ins, time + duration / 2.0, ins_next, context);
        context.battery_drop = dropAt(drive.voltage, time, voltage_at);
        pieces_.push_back({duration, command, context});
        command.reset();
        longest_ = std::max(longest_, duration);
        time = next;
      }
    }
  }
}

EntryState SegmentPlan::entryFor(const VehicleModel& vehicle) const {
  EntryState entry = steadyEntry(vehicle, command_before_.tracks(), pieces_.front().context);
  if (entry_speeds_) entry.track_speeds = entry_speeds_->tracks();
  return entry;
}

std::vector<MotionSample> SegmentPlan::simulate(const VehicleModel& vehicle) const {
  VehicleModel model = vehicle;
  model.step = longest_;  // lags and ramps are exact within a step
  if (model.isOmni())
    return motionOf(OmniKernel(model, command_before_, {}, pieces_.front().context, entry_speeds_));
  return motionOf(VehicleKernel(model, entryFor(model)));
}

template <class Kernel>
std::vector<MotionSample> SegmentPlan::motionOf(Kernel kernel) const {
  std::vector<MotionSample> motion;
  motion.reserve(pieces_.size() + 1);
  double time = begin_;
  motion.push_back({time, kernel.pose()});
  for (const Piece& piece : pieces_) {
    if (piece.command) giveTo(kernel, *piece.command);
    kernel.hold(piece.duration, piece.context);
    time += piece.duration;
    motion.push_back({time, kernel.pose()});
  }
  return motion;
}

std::vector<TermSample> SegmentPlan::termInputs(const VehicleModel& vehicle) const {
  VehicleModel model = vehicle;
  model.step = longest_;
  VehicleKernel kernel(model, entryFor(model));
  std::vector<TermSample> samples;
  samples.reserve(pieces_.size());
  double time = begin_;
  for (const Piece& piece : pieces_) {
    if (piece.command) giveTo(kernel, *piece.command);
    kernel.hold(piece.duration, piece.context);
    samples.push_back({time, time + piece.duration, kernel.termInputs()});
    time += piece.duration;
  }
  return samples;
}

namespace {

/// Mean of consecutive samples over a time.
TermInputs meanInputs(const std::vector<TermSample>& samples, double from, double to) {
  TermInputs mean;
  double all = 0.0;
  auto sample = std::upper_bound(samples.begin(), samples.end(), from,
                                 [](double time, const TermSample& one) { return time < one.end; });
  for (; sample != samples.end() && sample->begin < to; ++sample) {
    const double share = std::min(to, sample->end) - std::max(from, sample->begin);
    all += share;
    for (const TermInput& input : kTermInputs)
      mean.*input.value += share * sample->inputs.*input.value;
  }
  if (all > 0.0)
    for (const TermInput& input : kTermInputs) mean.*input.value /= all;
  return mean;
}

}  // namespace

const char* channelName(ObservedRate channel) {
  static constexpr const char* kNames[kChannels] = {"yaw rate", "heading rate", "along", "lateral"};
  return kNames[static_cast<size_t>(channel)];
}

const char* channelUnit(ObservedRate channel) {
  return channel == ObservedRate::kYawRate || channel == ObservedRate::kHeading ? "rad/s" : "m/s";
}

namespace {

constexpr double kBlockStep = 0.5;  // [s]

/// Number of blocks of a drive.
int blocksIn(const Drive& drive, double block) {
  const double driven = drive.driven();
  return driven <= 0.0 ? 0 : std::max(1, static_cast<int>(driven / block + 1e-6));
}

/// Length of a block [s]: shorter than usual if there would be too few.
double blockFor(const std::vector<Drive>& drives, const ObservationSettings& settings) {
  const auto areFew = [&drives](double block) {
    int count = 0;
    for (const Drive& drive : drives) count += blocksIn(drive, block);
    return count < kLeastBlocks;
  };
  double block = settings.block;
  while (block > settings.shortest_block && areFew(block))
    block = std::max(settings.shortest_block, block - kBlockStep);
  return block;
}

}  // namespace

Observations::Observations(const std::vector<Drive>& drives, const ObservationSettings& settings)
    : drives_(drives), settings_(settings), block_(blockFor(drives, settings)) {
  size_t all = 0;
  for (const Drive& drive : drives) {
    first_segment_.push_back(all);
    all += drive.segments.size();
  }
  for (size_t i = 0; i < drives.size(); ++i) addDrive(i);
  // Poses are simulated at the ends of rows: only latencies require interpolation.
  std::vector<std::vector<double>> cuts(all);
  for (const Observation& row : all_)
    for (double time : {row.begin, row.end})
      cuts[segmentIndex(row.drive, row.segment)].push_back(time);
  for (size_t i = 0; i < drives.size(); ++i)
    for (size_t s = 0; s < drives[i].segments.size(); ++s) {
      std::vector<double>& times = cuts[segmentIndex(i, s)];
      std::sort(times.begin(), times.end());
      plans_.emplace_back(drives[i], drives[i].segments[s], settings.piece, times);
    }
  measured_.resize(static_cast<Eigen::Index>(all_.size()));
  for (size_t i = 0; i < all_.size(); ++i)
    measured_[static_cast<Eigen::Index>(i)] = all_[i].measured;
}

void Observations::addDrive(size_t index) {
  const Drive& drive = drives_[index];
  const int count = blocksIn(drive, block_);
  drive_blocks_.emplace_back(blocks_, count);
  drive_lengths_.push_back(count > 0 ? drive.driven() / count : block_);
  double before = 0.0;
  for (size_t s = 0; s < drive.segments.size(); ++s) {
    const Segment& segment = drive.segments[s];
    driven_.emplace_back(before, segment.end - segment.begin());
    before += segment.end - segment.begin();
    Observation like;
    like.drive = index;
    like.segment = s;
    const size_t first = all_.size();
    addGyro(segment, like);
    addPoses(segment, like);
    for (size_t i = first; i < all_.size(); ++i)
      all_[i].block = blockAt(index, s, (all_[i].begin + all_[i].end) / 2.0);
  }
  block_length_ = std::max(block_length_, count > 0 ? drive_lengths_.back() : 0.0);
  blocks_ += count;
}

std::vector<char> Observations::blocksOf(const std::vector<char>& mask) const {
  std::vector<char> counts(static_cast<size_t>(blocks_), 0);
  for (size_t i = 0; i < mask.size(); ++i)
    if (mask[i]) counts[static_cast<size_t>(all_[i].block)] = 1;
  return counts;
}

std::vector<char> Observations::segmentsOf(const std::vector<char>& mask) const {
  std::vector<char> segments(plans_.size(), 0);
  for (size_t i = 0; i < mask.size(); ++i)
    if (mask[i]) segments[segmentIndex(all_[i].drive, all_[i].segment)] = 1;
  return segments;
}

int Observations::measuredBlocks() const {
  const std::vector<char> counts = blocksOf(std::vector<char>(all_.size(), 1));
  return static_cast<int>(std::count(counts.begin(), counts.end(), char{1}));
}

int Observations::blockAt(size_t drive, size_t segment, double time) const {
  const auto& [before, duration] = driven_[segmentIndex(drive, segment)];
  const double length = drive_lengths_[drive];
  // A short segment is not split, because its rows share their disturbance.
  const double at =
      duration < length ? duration / 2.0 : time - drives_[drive].segments[segment].begin();
  const auto& [first, count] = drive_blocks_[drive];
  return first + std::clamp(static_cast<int>((before + at) / length), 0, std::max(0, count - 1));
}

void Observations::addGyro(const Segment& segment, const Observation& like) {
  std::vector<const InsSample*> gyro;
  for (const InsSample& sample : segment.ins)
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
    // Each sample represents the time around it.
    const double half = (last - from) / (2.0 * static_cast<double>(count - 1));
    Observation row = like;
    row.channel = ObservedRate::kYawRate;
    row.begin = from - half;
    row.end = last + half;
    row.measured = sum / static_cast<double>(count);
    all_.push_back(row);
  }
}

void Observations::addPoses(const Segment& segment, const Observation& like) {
  const std::vector<InsSample> fixes = fixesOf(segment);
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
      Observation row = like;
      row.begin = from.time;
      row.end = to.time;
      for (const auto& [channel, value] :
           {std::pair{ObservedRate::kHeading, moved.yaw}, std::pair{ObservedRate::kAlong, moved.x},
            std::pair{ObservedRate::kAcross, moved.y}}) {
        row.channel = channel;
        row.measured = value / duration;
        all_.push_back(row);
      }
    }
    from = to;
  }
}

Motions Observations::simulate(const VehicleModel& vehicle) const {
  return simulate(vehicle, std::vector<char>(plans_.size(), 1));
}

Motions Observations::simulate(const VehicleModel& vehicle,
                               const std::vector<char>& segments) const {
  Motions motions(plans_.size());
  for (size_t i = 0; i < plans_.size(); ++i)
    if (segments[i]) motions[i] = plans_[i].simulate(vehicle);
  return motions;
}

std::vector<TermInputs> Observations::termInputs(const VehicleModel& vehicle) const {
  std::vector<std::vector<TermSample>> of_segment;
  of_segment.reserve(plans_.size());
  for (const SegmentPlan& plan : plans_) of_segment.push_back(plan.termInputs(vehicle));
  std::vector<TermInputs> inputs;
  inputs.reserve(all_.size());
  for (const Observation& row : all_)
    inputs.push_back(
        meanInputs(of_segment[segmentIndex(row.drive, row.segment)], row.begin, row.end));
  return inputs;
}

Eigen::VectorXd Observations::predict(const Motions& motions, const MeasurementModel& ins) const {
  Eigen::VectorXd predicted = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(all_.size()));
  const double gyro_latency = ins.ins_latency_gyro * ins.ins_latency;
  Pose2 moved;
  Pose2 from;
  double from_time = kNotMeasured;
  const std::vector<MotionSample>* of = nullptr;
  size_t piece = 0;
  for (size_t i = 0; i < all_.size(); ++i) {
    const Observation& row = all_[i];
    const std::vector<MotionSample>& motion = motions[segmentIndex(row.drive, row.segment)];
    if (motion.empty()) continue;
    const double duration = row.end - row.begin;
    double value = 0.0;
    if (row.channel == ObservedRate::kYawRate) {
      const double before = yawAt(motion, row.begin - gyro_latency, piece);
      value = (yawAt(motion, row.end - gyro_latency, piece) - before) / duration + ins.gyro_bias;
    } else {
      // The three rows of an interval are consecutive, and intervals share their ends.
      if (row.channel == ObservedRate::kHeading) {
        const Pose2 start =
            of == &motion && from_time == row.begin ? from : saidPose(motion, ins, row.begin);
        from = saidPose(motion, ins, row.end);
        from_time = row.end;
        of = &motion;
        moved = between(start, from);
      }
      value = (row.channel == ObservedRate::kHeading ? moved.yaw
               : row.channel == ObservedRate::kAlong ? moved.x
                                                     : moved.y) /
              duration;
    }
    predicted[static_cast<Eigen::Index>(i)] = value;
  }
  return predicted;
}

std::string tooLittleDriving(const Observations& data) {
  const int measured = data.measuredBlocks();
  if (measured >= kLeastBlocks) return "";
  double driven = 0.0;
  for (const Drive& drive : data.drives()) driven += drive.driven();
  if (data.blocks() > measured && data.blockLength() > 0.0) driven = measured * data.blockLength();
  return "only " + fixed(driven, 0) +
         " s of measured driving, too little to tell chance from cause: drive at least " +
         fixed(std::ceil(data.leastBlock()) * kLeastBlocks, 0) + " s";
}

}  // namespace tread::gap
