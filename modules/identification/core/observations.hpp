// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "common/soundness/core/drive.hpp"
#include "common/vehicle/kernel.hpp"
#include "common/vehicle/model_document.hpp"

namespace tread::gap {

/// Inputs of unnamed terms over one piece.
struct TermSample {
  double begin = 0.0;  ///< [s]
  double end = 0.0;    ///< [s]
  TermInputs inputs;   ///< means
};

/// The commands of a segment cut into short pieces, each with the drive context at its time.
/** Made once per drive; each simulation with other parameters is one pass over it. */
class SegmentPlan {
 public:
  /// Pieces of at most `piece` seconds, or twice that where a command has held for a while; also
  /// cut at these times [s], in order, at which poses are needed: within a piece they are
  /// interpolated. The segment need not outlive it.
  SegmentPlan(const Drive& drive, const Segment& segment, double piece,
              const std::vector<double>& cuts = {});

  /// True poses of a model through the segment, relative to its beginning; one entry per piece. Yaw
  /// rates are 0: rows derive theirs from the yaws.
  std::vector<MotionSample> simulate(const VehicleModel& vehicle) const;
  /// Inputs of unnamed terms in each piece, for a model with such terms.
  std::vector<TermSample> termInputs(const VehicleModel& vehicle) const;

 private:
  struct Piece {
    double duration;                 ///< [s]
    std::optional<Command> command;  ///< given at its beginning; nullopt = the last one holds
    DriveContext context;
  };

  /// Ends of the pieces between two times, including the last one.
  static std::vector<double> endsBetween(double from, double to, double longest,
                                         const std::vector<double>& cuts);

  EntryState entryFor(const VehicleModel& vehicle) const;
  /// Poses of a kernel that is initialised at the beginning of the segment.
  template <class Kernel>
  std::vector<MotionSample> motionOf(Kernel kernel) const;

  double begin_ = 0.0;
  double longest_ = 1e-3;  ///< piece [s]
  std::vector<Piece> pieces_;
  std::optional<Command> entry_speeds_;
  Command command_before_;
};

/// True motions of all segments of several drives, drive after drive.
using Motions = std::vector<std::vector<MotionSample>>;

/// Kind of an observation: mean rates over an interval, in the body frame of its beginning.
enum class ObservedRate { kYawRate, kHeading, kAlong, kAcross };
inline constexpr size_t kChannels = 4;

/// Name of a channel in reports: "yaw rate", "heading rate", "along", "lateral".
const char* channelName(ObservedRate channel);
/// Its unit: rad/s or m/s.
const char* channelUnit(ObservedRate channel);

/// One comparison of measurement and simulation.
struct Observation {
  ObservedRate channel = ObservedRate::kYawRate;
  size_t drive = 0;
  size_t segment = 0;     ///< of the drive
  double begin = 0.0;     ///< [s] since the drive's first message
  double end = 0.0;       ///< [s]
  double measured = 0.0;  ///< [rad/s] or [m/s], mean over the interval
  int block = 0;          ///< index of the block of driving that contains it
};

/// How drives are cut.
struct ObservationSettings {
  double gyro_bin = 0.25;      ///< [s] averaging time of the gyro
  double pose_interval = 0.4;  ///< [s] least time between fixes
  double longest = 1.2;        ///< [s] largest time between fixes
  double smoothing = 0.05;     ///< [s] to either side, for averaging frequent fixes
  double block = 20.0;         ///< [s] of driving, at least
  /// [s] the same if the drives have fewer than kLeastBlocks otherwise
  double shortest_block = 20.0;
  double piece = 0.05;  ///< [s] of simulation
};

/// Fewest blocks of measured driving for a statistical conclusion.
inline constexpr int kLeastBlocks = 10;

/// For drives from one minute on: a log of 60 s may lack the seconds before its first and after its
/// last command.
inline ObservationSettings fromOneMinute() {
  ObservationSettings settings;
  settings.shortest_block = 5.5;
  return settings;
}

/// Rows of drives, and a model's predictions for them.
/** Increments instead of poses: the integral form needs no differentiation and lets the simulation
 * run open loop over any time. The measurement part of a model acts on the simulated motion, so
 * that the INS's data are compared with its predicted data. */
class Observations {
 public:
  /// The drives must outlive the rows.
  Observations(const std::vector<Drive>& drives, const ObservationSettings& settings);

  const std::vector<Observation>& all() const { return all_; }
  const std::vector<Drive>& drives() const { return drives_; }
  int blocks() const { return blocks_; }
  double blockLength() const { return block_length_; }  ///< [s] of driving
  /// [s] of driving that a block has at least.
  double leastBlock() const { return block_; }
  /// Whether blocks had to be shorter than usual.
  bool isBrief() const { return block_ < settings_.block; }
  /// Factor on the scatter of a sum over blocks: 1 for usual blocks, which count as independent.
  /** Neighbouring short blocks share their ground, so that a short drive needs more evidence, not
   * less. Measured on 16 long drives without a hidden effect, simulated, foreign and real: the
   * variance over blocks of 20 s is that over blocks of 6 s times 1.1 in the median of the
   * effects, 1.5 for the worst; the root of the ratio of lengths is 1.8. */
  double dependence() const { return std::pow(settings_.block / block_, 0.25); }

  /// True motions of all segments.
  Motions simulate(const VehicleModel& vehicle) const;
  /// The same only for segments whose entry is not 0; the others stay empty.
  Motions simulate(const VehicleModel& vehicle, const std::vector<char>& segments) const;
  /// The rows predicted by the model's vehicle and INS (rows x 1).
  Eigen::VectorXd predict(const ModelDocument& model) const {
    return predict(simulate(model.vehicle), model.measurement);
  }
  /// The same from simulated motions; 0 for segments that were not simulated.
  Eigen::VectorXd predict(const Motions& motions, const MeasurementModel& ins) const;
  /// Measured minus predicted (rows x 1).
  Eigen::VectorXd residuals(const Eigen::VectorXd& predicted) const {
    return measured_ - predicted;
  }
  /// Inputs of unnamed terms, averaged over each row (as many as rows); for a model with such
  /// terms.
  std::vector<TermInputs> termInputs(const VehicleModel& vehicle) const;
  /// Which blocks have rows whose mask is not 0.
  std::vector<char> blocksOf(const std::vector<char>& mask) const;
  /// Which segments, among all, have rows whose mask is not 0.
  std::vector<char> segmentsOf(const std::vector<char>& mask) const;
  /// Number of blocks with measurements.
  int measuredBlocks() const;
  /// Block that contains a time of a segment.
  int blockAt(size_t drive, size_t segment, double time) const;
  /// Index of a segment among all, as in simulate().
  size_t segmentIndex(size_t drive, size_t segment) const {
    return first_segment_[drive] + segment;
  }

 private:
  void addDrive(size_t drive);
  void addGyro(const Segment& segment, const Observation& like);
  void addPoses(const Segment& segment, const Observation& like);

  const std::vector<Drive>& drives_;
  ObservationSettings settings_;
  double block_;  ///< [s] of driving, at least
  std::vector<SegmentPlan> plans_;
  std::vector<size_t> first_segment_;  ///< of each drive among all
  /// For each segment: driving before it in its drive, and its own [s].
  std::vector<std::pair<double, double>> driven_;
  /// For each drive: first block and number of blocks
  std::vector<std::pair<int, int>> drive_blocks_;
  std::vector<double> drive_lengths_;  ///< for each drive: length of its blocks [s]
  std::vector<Observation> all_;
  Eigen::VectorXd measured_;
  int blocks_ = 0;
  double block_length_ = 0.0;
};

/// Degrees of freedom of the residuals' Student distribution: limits the influence of an INS jump.
inline constexpr double kFreedom = 4.0;

/// Empty if the rows suffice for a conclusion; otherwise one line with the amount of driving
/// needed.
std::string tooLittleDriving(const Observations& data);

}  // namespace tread::gap
