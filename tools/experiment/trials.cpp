// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/experiment/trials.hpp"

#include <algorithm>
#include <cmath>

namespace tread::experiment {

void RatioMoments::add(double covered, const double* errors) {
  repetitions_ += 1.0;
  for (size_t i = 0; i < size_; ++i) {
    const double value = i == 0 ? covered : errors[i - 1];
    sums_[i] += value;
    squares_[i] += value * value;
  }
}

void RatioMoments::addRun(const RatioMoments& run) {
  repetitions_ += run.repetitions_;
  ++runs_;
  for (size_t i = 0; i < size_; ++i) {
    sums_[i] += run.sums_[i];
    squares_[i] += run.squares_[i];
    for (size_t j = i; j < size_; ++j) products_[i * size_ + j] += run.sums_[i] * run.sums_[j];
  }
}

Estimate RatioMoments::quotient(size_t above, size_t below) const {
  // Var(A/B) = sum((a - r b)^2) / (sum b)^2 n / (n - 1), a and b the sums of each of n runs.
  const double ratio = sums_[above] / sums_[below];
  if (runs_ < 2) return {ratio};
  const double squares = product(above, above) - 2.0 * ratio * product(above, below) +
                         ratio * ratio * product(below, below);
  const auto n = static_cast<double>(runs_);
  const double variance = std::max(0.0, squares) / (sums_[below] * sums_[below]) * n / (n - 1.0);
  const double half = student99(runs_) * std::sqrt(variance);
  return {ratio, ratio - half, ratio + half};
}

double RatioMoments::deviation(size_t method) const {
  const double mean = sums_[method + 1] / repetitions_;
  const double square = squares_[method + 1] / repetitions_;
  return std::sqrt(std::max(0.0, square - mean * mean)) / (sums_[0] / repetitions_);
}

double student99(size_t samples) {
  constexpr double kNormal99 = 2.5758293035489;
  constexpr double kQuantiles[] = {63.657, 9.925, 5.841, 4.604, 4.032, 3.707, 3.499, 3.355,
                                   3.250,  3.169, 3.106, 3.055, 3.012, 2.977, 2.947, 2.921,
                                   2.898,  2.878, 2.861, 2.845, 2.831, 2.819, 2.807, 2.797,
                                   2.787,  2.779, 2.771, 2.763, 2.756};
  constexpr size_t kListed = sizeof kQuantiles / sizeof kQuantiles[0];
  if (samples < 2) return std::numeric_limits<double>::infinity();
  if (samples - 2 < kListed) return kQuantiles[samples - 2];
  // Two terms of the expansion about the normal quantile: exact to 0.002 from here on.
  const double freedom = static_cast<double>(samples - 1);
  return kNormal99 + (std::pow(kNormal99, 3) + kNormal99) / (4.0 * freedom);
}

namespace {

using learner::ConstTrajectory;

constexpr size_t kSettling = 60;  // executions before the long run counts
constexpr size_t kLongRun = 240;  // executions that count

double positionError(const Pose2& predicted, const Pose2& driven) {
  const double dx = predicted.x - driven.x;
  const double dy = predicted.y - driven.y;
  return std::sqrt(dx * dx + dy * dy);
}

double orientationError(const Pose2& predicted, const Pose2& driven) {
  const double difference = std::abs(predicted.yaw - driven.yaw);
  return difference <= kPi ? difference : std::abs(wrapAngle(difference));
}

/// All sequences, one after the other.
Sequence joined(const std::vector<Sequence>& sequences) {
  Sequence all;
  for (const Sequence& sequence : sequences)
    all.insert(all.end(), sequence.begin(), sequence.end());
  return all;
}

/// Executions by chance, and what all rules made of them since the last clear().
class Drive {
 public:
  Drive(Methods& methods, const TrialSite& site)
      : methods_(methods),
        site_(site),
        random_(site.seed),
        position_(methods.size()),
        orientation_(methods.size()) {
    for (const Executions& executions : site.to.tests)
      joined_.resize(std::max(joined_.size(), 3 * executions.samples()));
  }

  void clear() {
    metres_ = radians_ = 0.0;
    std::fill(position_.begin(), position_.end(), 0.0);
    std::fill(orientation_.begin(), orientation_.end(), 0.0);
  }
  void addTo(Errors& errors) const {
    errors.position.add(metres_, position_.data());
    errors.orientation.add(radians_, orientation_.data());
  }

  /// One execution on the new surface; each(rule, position error, orientation error, end).
  template <class Each>
  void execute(size_t pattern, bool learn, const Each& each) {
    const Executions& executions = site_.to.tests[pattern];
    const size_t index = drawIndex(random_, executions.size());
    score(pattern, executions.of(index), executions.endOf(index), learn, each);
  }
  void execute(size_t pattern, bool learn) {
    execute(pattern, learn, [](size_t, double, double, const ExecutionEnd&) {});
  }

  /// Any pattern, by chance.
  size_t any() { return drawIndex(random_, site_.to.tests.size()); }

  /// The first one after the transition.
  template <class Each>
  void executeFirst(size_t pattern, bool learn, const Each& each) {
    if (!site_.change_inside) return execute(pattern, learn, each);
    const ConstTrajectory measured = joinedAt(pattern);
    score(pattern, measured, executionEnd(measured), learn, each);
  }
  void executeFirst(size_t pattern, bool learn) {
    executeFirst(pattern, learn, [](size_t, double, double, const ExecutionEnd&) {});
  }

 private:
  template <class Each>
  void score(size_t pattern, const ConstTrajectory& measured, const ExecutionEnd& end, bool learn,
             const Each& each) {
    metres_ += end.metres;
    radians_ += end.radians;
    for (size_t i = 0; i < methods_.size(); ++i) {
      const Pose2 predicted = methods_.predictEnd(i, pattern);
      const double position = positionError(predicted, end.pose);
      const double orientation = orientationError(predicted, end.pose);
      position_[i] += position;
      orientation_[i] += orientation;
      each(i, position, orientation, end);
      if (learn) methods_.learn(i, pattern, measured);
    }
  }

  /// First half of an execution on the old surface, continued by the second half of one on the new.
  ConstTrajectory joinedAt(size_t pattern) {
    const Executions& before = site_.from.tests[pattern];
    const Executions& after = site_.to.tests[pattern];
    const ConstTrajectory first = before.of(drawIndex(random_, before.size()));
    const ConstTrajectory second = after.of(drawIndex(random_, after.size()));
    const Eigen::Index samples = first.rows(), half = samples / 2;
    learner::Trajectory joined(joined_.data(), samples, 3);
    joined.topRows(half) = first.topRows(half);
    const auto poseAt = [](const ConstTrajectory& of, Eigen::Index row) {
      return row < 0 ? Pose2{} : Pose2{of(row, 0), of(row, 1), of(row, 2)};
    };
    const Pose2 T_start_change = poseAt(first, half - 1);
    const Pose2 T_other_change = poseAt(second, half - 1);
    for (Eigen::Index row = half; row < samples; ++row) {
      const Pose2 pose = T_start_change * between(T_other_change, poseAt(second, row));
      joined.row(row) << pose.x, pose.y, pose.yaw;
    }
    return {joined_.data(), samples, 3};
  }

  Methods& methods_;
  const TrialSite& site_;
  std::mt19937_64 random_;
  double metres_ = 0.0;
  double radians_ = 0.0;
  std::vector<double> position_;
  std::vector<double> orientation_;
  std::vector<double> joined_;
};

}  // namespace

SequenceErrors driveSequences(Methods& methods, const TrialSite& site,
                              const std::vector<Sequence>& sequences, Histogram position_bins,
                              Histogram orientation_bins) {
  SequenceErrors result{Errors(methods.size()),
                        std::vector<Histogram>(methods.size(), position_bins),
                        std::vector<Histogram>(methods.size(), orientation_bins)};
  const auto count = [&](size_t i, double position, double orientation, const ExecutionEnd& end) {
    result.position[i].add(position / end.metres);
    result.orientation[i].add(orientation / end.radians);
  };
  Drive drive(methods, site);
  for (int64_t repetition = 0; repetition < site.repetitions; ++repetition) {
    drive.clear();
    for (const Sequence& sequence : sequences) {
      methods.reset();
      // What the last one teaches is not asked for any more.
      drive.executeFirst(sequence[0], sequence.size() > 1, count);
      for (size_t j = 1; j < sequence.size(); ++j)
        drive.execute(sequence[j], j + 1 < sequence.size(), count);
    }
    drive.addTo(result.errors);
  }
  return result;
}

std::vector<Errors> driveAllPatterns(Methods& methods, const TrialSite& site,
                                     const std::vector<Sequence>& sequences,
                                     const std::vector<int>& executions) {
  std::vector<Errors> result(executions.size(), Errors(methods.size()));
  Drive drive(methods, site);
  for (int64_t repetition = 0; repetition < site.repetitions; ++repetition) {
    for (const Sequence& sequence : sequences) {
      methods.reset();
      int driven = 0;
      for (size_t k = 0; k < executions.size(); ++k) {
        for (; driven < executions[k]; ++driven) {
          const size_t pattern = sequence[static_cast<size_t>(driven) % sequence.size()];
          if (driven == 0)
            drive.executeFirst(pattern, true);
          else
            drive.execute(pattern, true);
        }
        drive.clear();
        for (size_t p = 0; p < site.to.tests.size(); ++p) drive.execute(p, false);
        drive.addTo(result[k]);
      }
    }
  }
  return result;
}

std::vector<Errors> driveDevelopment(Methods& methods, const TrialSite& site,
                                     const std::vector<Sequence>& sequences, size_t executions) {
  std::vector<Errors> result(executions, Errors(methods.size()));
  const Sequence& sequence = sequences.front();
  Drive drive(methods, site);
  for (int64_t repetition = 0; repetition < site.repetitions; ++repetition) {
    methods.reset();
    for (size_t j = 0; j < executions; ++j) {
      drive.clear();
      const size_t pattern = sequence[j % sequence.size()];
      if (j == 0)
        drive.executeFirst(pattern, true);
      else
        drive.execute(pattern, true);
      drive.addTo(result[j]);
    }
  }
  return result;
}

Errors driveLong(Methods& methods, const TrialSite& site, const std::vector<Sequence>& sequences) {
  Errors result(methods.size());
  const Sequence order = joined(sequences);
  Drive drive(methods, site);
  for (int64_t repetition = 0; repetition < site.repetitions; ++repetition) {
    methods.reset();
    for (size_t j = 0; j < kSettling + kLongRun; ++j) {
      if (j == kSettling) drive.clear();
      drive.execute(order.empty() ? drive.any() : order[j % order.size()], true);
    }
    drive.addTo(result);
  }
  return result;
}

std::vector<std::vector<double>> driveDrift(Methods& methods, const TrialSite& site,
                                            const std::vector<Sequence>& sequences, size_t watched,
                                            size_t executions) {
  std::vector<std::vector<double>> sums(methods.size(), std::vector<double>(executions + 1, 0.0));
  const Sequence order = joined(sequences);
  Drive drive(methods, site);
  const auto note = [&](size_t j) {
    for (size_t i = 0; i < methods.size(); ++i)
      sums[i][j] += std::abs(methods.predictEnd(i, watched).y);
  };
  for (int64_t repetition = 0; repetition < site.repetitions; ++repetition) {
    methods.reset();
    note(0);
    for (size_t j = 0; j < executions; ++j) {
      drive.execute(order[j % order.size()], true);
      note(j + 1);
    }
  }
  const double shipped =
      static_cast<double>(site.repetitions) * std::abs(site.from.averaged_ends[watched].y);
  for (std::vector<double>& widths : sums)
    for (double& width : widths) width /= shipped;
  return sums;
}

}  // namespace tread::experiment
