// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors

#include "common/soundness/segments.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tread::gap {
namespace {

constexpr double kLead = 3.0;                  // [s] of commands before poses; longer than any lag
constexpr double kEncoderDelay = 0.3;          // [s] at the begin for which encoders are valid
constexpr double kSameSpeed = 0.35;            // [m/s] of encoders held for a quarter second
constexpr size_t kFewest = 3;                  // fewest useful readings
constexpr double kStepSilence[] = {1.8, 3.2};  // [s] between steps of an imported recording

/// Track speeds at a time, if the encoders cover it.
std::optional<Command> speedAt(const std::vector<EncoderSample>& encoders, double time) {
  const auto next =
      std::lower_bound(encoders.begin(), encoders.end(), time - 1e-6,
                       [](const EncoderSample& sample, double t) { return sample.time < t; });
  if (next != encoders.end() && next->time - time <= kEncoderDelay) return next->speed;
  return std::nullopt;
}

/// Track speeds before a time, if the encoders cover it.
std::optional<Command> speedBefore(const std::vector<EncoderSample>& encoders, double time) {
  const auto next =
      std::lower_bound(encoders.begin(), encoders.end(), time,
                       [](const EncoderSample& sample, double t) { return sample.time < t; });
  if (next != encoders.begin() && time - std::prev(next)->time <= kEncoderDelay)
    return std::prev(next)->speed;
  return std::nullopt;
}

/// Commands from a time on, and the one before them.
void takeCommands(const CommandSpan& span, double begin, double end, Segment& segment) {
  segment.end = end;
  segment.commands.push_back({begin, commandAt(span, begin)});
  for (const CommandSample& sample : span.commands) {
    if (sample.time < begin) segment.command_before = sample.command;
    if (sample.time > begin && sample.time < end) segment.commands.push_back(sample);
  }
}

/// Unwraps a yaw along the gyro, which counts whole turns.
class Unwrapper {
 public:
  void gyro(double time, double omega) {
    if (!std::isfinite(omega)) return;
    if (known_) turned_ += 0.5 * (omega + omega_) * (time - gyro_time_);
    gyro_time_ = time;
    omega_ = omega;
    known_ = true;
  }

  double pose(double time, double yaw) {
    // Over a short time the nearest turn is right, whatever the gyro gives.
    const double expected = yaw_ + (time - time_ > kShort ? turned_ : 0.0);
    yaw_ = begun_ ? expected + wrapAngle(yaw - expected) : yaw;
    time_ = time;
    turned_ = 0.0;
    begun_ = true;
    return yaw_;
  }

 private:
  static constexpr double kShort = 0.7;  // [s]
  bool begun_ = false;
  bool known_ = false;
  double yaw_ = 0.0;
  double time_ = 0.0;
  double turned_ = 0.0;
  double omega_ = 0.0;
  double gyro_time_ = 0.0;
};

void unwrap(std::vector<InsSample>& samples) {
  Unwrapper unwrapper;
  for (InsSample& sample : samples) {
    unwrapper.gyro(sample.time, sample.omega);
    if (std::isfinite(sample.T_map_body.yaw))
      sample.T_map_body.yaw = unwrapper.pose(sample.time, sample.T_map_body.yaw);
  }
}

/// First readings of the tracks of a span; the first one is 0.
std::vector<size_t> trackBegins(const std::vector<InsReading>& readings) {
  std::vector<size_t> begins{0};
  std::optional<double> last;
  for (size_t i = 0; i < readings.size(); ++i) {
    if (!readings[i].fresh) continue;
    const double time = readings[i].sample.time;
    if (last && (readings[i].new_track || time - *last > kInsSilence)) begins.push_back(i);
    last = time;
  }
  return begins;
}

class Cutter {
 public:
  explicit Cutter(const std::vector<EncoderSample>& encoders) : encoders_(encoders) {}

  void add(const HeardSpan& heard) {
    const auto& readings = heard.ins.readings;
    const std::vector<size_t> begins = trackBegins(readings);
    for (size_t track = 0; track < begins.size(); ++track) {
      const bool last = track + 1 == begins.size();
      const size_t end = last ? readings.size() : begins[track + 1];
      Segment segment;
      const double begin = track == 0 ? heard.commands.begin()
                                      : std::max(heard.commands.begin(),
                                                 readings[begins[track]].sample.time - kLead);
      takeCommands(heard.commands, begin,
                   last ? heard.commands.end : readings[end - 1].sample.time + 1e-3, segment);
      for (size_t i = begins[track]; i < end; ++i) segment.ins.push_back(readings[i].sample);
      segment.entry_speeds = speedAt(encoders_, begin);
      if (track == 0) enter(heard.commands, segment);
      if (segment.ins.size() < kFewest) continue;
      unwrap(segment.ins);
      segments_.push_back(std::move(segment));
    }
    before_ = &heard.commands;
  }

  std::vector<Segment> finished() { return std::move(segments_); }

 private:
  /// Sets the initial state of a span.
  void enter(const CommandSpan& span, Segment& segment) const {
    if (segment.entry_speeds) {
      segment.command_before = wentOnAtOnce(span, *segment.entry_speeds)
                                   ? before_->commands.back().command
                               : span.layout == VehicleLayout::kCar ? span.commands.front().command
                                                                    : *segment.entry_speeds;
      return;
    }
    const bool stood =
        !span.after_silence ||
        (before_ != nullptr && standsBetween(*before_, before_->end - 1.0, before_->end) &&
         driveOf(span.layout, span.commands.front().command) == 0.0);
    if (stood) return;
    auto& ins = segment.ins;
    ins.erase(
        std::remove_if(ins.begin(), ins.end(),
                       [&](const InsSample& sample) { return sample.time < span.begin() + kLead; }),
        ins.end());
  }

  /// Whether this is the next step of an imported recording, separated only by the import.
  bool wentOnAtOnce(const CommandSpan& span, const Command& speed) const {
    if (before_ == nullptr || !span.after_silence) return false;
    const double silence = span.begin() - before_->end;
    const auto previous = speedBefore(encoders_, before_->end);
    if (!previous || silence < kStepSilence[0] || silence > kStepSilence[1]) return false;
    for (size_t channel = 0; channel < Command::kMaxChannels; ++channel)
      if (!(std::abs((*previous)[channel] - speed[channel]) <= kSameSpeed)) return false;
    return true;
  }

  const std::vector<EncoderSample>& encoders_;
  const CommandSpan* before_ = nullptr;
  std::vector<Segment> segments_;
};

constexpr double kTolerance = 0.03;         // [s] of tolerance on the length of an execution
constexpr double kMostlyNamed = 1.0 / 3.0;  // share of a segment that named executions should cover

/// Cuts pieces of the required length from `begin` on.
void cut(size_t segment, double begin, double end, std::vector<Execution>& pieces) {
  while (begin + kExecutionLength <= end + kTolerance) {
    pieces.push_back({segment, begin, begin + kExecutionLength});
    begin += kExecutionLength;
  }
}

/// Whether a command is not zero in a piece or in the second before it.
bool drives(VehicleLayout layout, const Segment& segment, const Execution& piece) {
  for (size_t i = 0; i < segment.commands.size(); ++i) {
    const double begin = segment.commands[i].time;
    const double end = i + 1 < segment.commands.size() ? segment.commands[i + 1].time : segment.end;
    if (begin < piece.end && end > piece.begin - 1.0 &&
        driveOf(layout, segment.commands[i].command) != 0.0)
      return true;
  }
  return false;
}

/// From when on a segment has poses [s].
double posesBegin(const Segment& segment) {
  for (const InsSample& sample : segment.ins)
    if (sample.hasPose()) return sample.time;
  return segment.end;
}

std::vector<Execution> namedIn(size_t index, const Segment& segment, double from,
                               const std::vector<Execution>& records) {
  std::vector<Execution> pieces;
  for (const Execution& record : records)
    if (record.begin >= from - kTolerance && record.end <= segment.end + kTolerance)
      cut(index, record.begin, record.end, pieces);
  return pieces;
}

}  // namespace

std::vector<Segment> segmentsOf(const std::vector<HeardSpan>& spans,
                                const std::vector<EncoderSample>& encoders) {
  Cutter cutter(encoders);
  for (const HeardSpan& span : spans) cutter.add(span);
  return cutter.finished();
}

std::vector<Execution> executionsOf(VehicleLayout layout, const std::vector<Segment>& segments,
                                    const std::vector<Execution>& records) {
  std::vector<Execution> all;
  for (size_t index = 0; index < segments.size(); ++index) {
    const Segment& segment = segments[index];
    // If commands begin before the poses, executions begin with the poses.
    const double first_pose = posesBegin(segment);
    const double from = first_pose - segment.begin() > 1.5 ? first_pose : segment.begin();
    std::vector<Execution> pieces = namedIn(index, segment, from, records);
    const double covered = kExecutionLength * static_cast<double>(pieces.size());
    if (covered < kMostlyNamed * (segment.end - from)) {
      pieces.clear();
      cut(index, from, segment.end, pieces);
    }
    for (const Execution& piece : pieces)
      if (drives(layout, segment, piece)) all.push_back(piece);
  }
  return all;
}

}  // namespace tread::gap
