// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "common/soundness/core/drive.hpp"
#include "common/vehicle/kernel.hpp"
#include "common/vehicle/model_document.hpp"

namespace tread::gap {

/// What unnamed terms depend on for a while.
struct TermSample {
  double begin = 0.0;  ///< [s]
  double end = 0.0;    ///< [s]
  TermInputs inputs;   ///< means
};

/// The commands of a segment cut into short pieces, each with the drive context at its time.
/** Made once a drive; simulating again with other parameters is then one pass over it. */
class SegmentPlan {
 public:
  /// Pieces of at most `piece` seconds, of twice that where a command has held for a while; cut
  /// also at these times [s], in order, at which poses will be asked for: within a piece they are
  /// interpolated. The segment may go away afterwards.
  SegmentPlan(const Drive& drive, const Segment& segment, double piece,
              const std::vector<double>& cuts = {});

  /// True poses of a model through the segment, relative to its beginning; one entry a piece.
  /// Yaw rates are left at 0: rows take theirs from the yaws.
  std::vector<MotionSample> simulate(const VehicleModel& vehicle) const;
  /// What unnamed terms depend on in each piece, of a model that has some.
  std::vector<TermSample> termInputs(const VehicleModel& vehicle) const;

 private:
  struct Piece {
    double duration;                 ///< [s]
    std::optional<Command> command;  ///< given at its beginning; none = the last one holds
    DriveContext context;
  };

  /// Where pieces end between two times, the last one included.
  static std::vector<double> endsBetween(double from, double to, double longest,
                                         const std::vector<double>& cuts);

  EntryState entryFor(const VehicleModel& vehicle) const;
  /// Poses of a kernel that stands at the beginning of the segment.
  template <class Kernel>
  std::vector<MotionSample> motionOf(Kernel kernel) const;

  double begin_ = 0.0;
  double longest_ = 1e-3;  ///< piece [s]
  std::vector<Piece> pieces_;
  std::optional<Command> entry_speeds_;
  Command command_before_;
};

/// True motions of all segments of some drives, drive after drive.
using Motions = std::vector<std::vector<MotionSample>>;

/// What an observation is: mean rates over an interval, in the body frame of its beginning.
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
  int block = 0;          ///< index of the block of driving in which it lies
};

/// How drives are cut.
struct ObservationSettings {
  double gyro_bin = 0.25;      ///< [s] over which the gyro is averaged
  double pose_interval = 0.4;  ///< [s] at least, between fixes
  double longest = 1.2;        ///< [s] at most, between fixes
  double smoothing = 0.05;     ///< [s] to either side over which frequent fixes are averaged
  double block = 20.0;         ///< [s] of driving, at least
  double piece = 0.05;         ///< [s] of simulation
};

/// Rows of drives, and what a model predicts for them.
/** Increments instead of poses: the integral form, which needs no differentiation and lets the
 * simulation run open loop over any time. The measurement part of a model acts on the
 * simulated motion, so that data compare what the INS says with what it would say. */
class Observations {
 public:
  /// The drives must outlive the rows.
  Observations(const std::vector<Drive>& drives, const ObservationSettings& settings);

  const std::vector<Observation>& all() const { return all_; }
  const std::vector<Drive>& drives() const { return drives_; }
  int blocks() const { return blocks_; }
  double blockLength() const { return block_length_; }  ///< [s] of driving

  /// True motions of all segments.
  Motions simulate(const VehicleModel& vehicle) const;
  /// The same of those segments alone whose entry is not 0; the others remain empty.
  Motions simulate(const VehicleModel& vehicle, const std::vector<char>& segments) const;
  /// What the rows would be if the vehicle and the INS were the model's (rows x 1).
  Eigen::VectorXd predict(const ModelDocument& model) const {
    return predict(simulate(model.vehicle), model.measurement);
  }
  /// The same from simulated motions; 0 where the segment was not simulated.
  Eigen::VectorXd predict(const Motions& motions, const MeasurementModel& ins) const;
  /// Measured less predicted (rows x 1).
  Eigen::VectorXd residuals(const Eigen::VectorXd& predicted) const {
    return measured_ - predicted;
  }
  /// What unnamed terms depend on, means over each row (as many as rows); of a model that has some.
  std::vector<TermInputs> termInputs(const VehicleModel& vehicle) const;
  /// Which blocks have rows whose mask is not 0.
  std::vector<char> blocksOf(const std::vector<char>& mask) const;
  /// Which segments, among all, have rows whose mask is not 0.
  std::vector<char> segmentsOf(const std::vector<char>& mask) const;
  /// Blocks in which something was measured.
  int measuredBlocks() const;
  /// Block in which a time of a segment lies.
  int blockAt(size_t drive, size_t segment, double time) const;
  /// Index of a segment among all, as in simulate().
  size_t segmentIndex(size_t drive, size_t segment) const {
    return first_segment_[drive] + segment;
  }

 private:
  void addDrive(size_t drive, double block);
  void addGyro(const Segment& segment, const Observation& like);
  void addPoses(const Segment& segment, const Observation& like);

  const std::vector<Drive>& drives_;
  ObservationSettings settings_;
  std::vector<SegmentPlan> plans_;
  std::vector<size_t> first_segment_;  ///< of each drive among all
  /// Of each segment: driving before it in its drive, and its own [s].
  std::vector<std::pair<double, double>> driven_;
  std::vector<std::pair<int, int>> drive_blocks_;  ///< of each drive: first block and their number
  std::vector<double> drive_lengths_;              ///< of each drive: length of its blocks [s]
  std::vector<Observation> all_;
  Eigen::VectorXd measured_;
  int blocks_ = 0;
  double block_length_ = 0.0;
};

/// Normal quantile of 97.5 %.
inline constexpr double kNormal975 = 1.959964;

/// Quantile of Student's distribution that has the probability of a normal quantile.
/** Cornish and Fisher's expansion: within .5 % from 3 degrees of freedom on for 97.5 %, too large
 * by a tenth at 8 degrees for 1e-4. */
double studentQuantile(double freedom, double normal_quantile = kNormal975);

/// Normal quantile that is exceeded, either way, with a probability of `chance` (0 to 1).
double normalQuantileOf(double chance);

/// Chance that a normal number exceeds a quantile, either way.
double chanceBeyond(double normal_quantile);

/// Degrees of freedom of the residuals' Student distribution: a jump of the INS must not decide.
inline constexpr double kFreedom = 4.0;

/// Negative log likelihood of a residual over its scale, without constants [nats].
double lossOf(double residual, double scale);
/// Its derivative by the prediction, negated: positive for a positive residual.
double pullOf(double residual, double scale);
/// Weight with which an iterated least squares fit takes a row: pull over residual.
double weightOf(double residual, double scale);

/// How large residuals of one channel are: scale^2 = still^2 + (share activity)^2.
/** The ground disturbs a motion in proportion to it, the INS by itself. */
struct ChannelNoise {
  double still = 1.0;  ///< [rad/s or m/s]
  double share = 0.0;  ///< [1]
};
using Noise = std::array<ChannelNoise, kChannels>;

/// Size of the motion at each observation: |yaw rate| for the yaw channels, speed for the others.
Eigen::VectorXd activityOf(const std::vector<Observation>& data, const Eigen::VectorXd& predicted);

/// Noise of greatest likelihood for residuals; rows whose mask is 0 do not count.
Noise estimateNoise(const std::vector<Observation>& data, const Eigen::VectorXd& residuals,
                    const Eigen::VectorXd& activity, const std::vector<char>& mask);

/// Scale of every row.
Eigen::VectorXd scalesOf(const std::vector<Observation>& data, const Noise& noise,
                         const Eigen::VectorXd& activity);

/// Sum of the losses of rows whose mask is not 0.
double totalLoss(const Eigen::VectorXd& residuals, const Eigen::VectorXd& scales,
                 const std::vector<char>& mask);

}  // namespace tread::gap
