// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/experiment/trials.hpp"

#include <algorithm>
#include <cmath>

#include "tools/lab/experiment/trial_drive.hpp"

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
  // Var(A/B) = sum((a - r b)^2) / (sum b)^2 n / (n - 1), with a and b the sums of each of n runs.
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
  // Two terms of the expansion around the normal quantile: exact to 0.002 from here on.
  const double freedom = static_cast<double>(samples - 1);
  return kNormal99 + (std::pow(kNormal99, 3) + kNormal99) / (4.0 * freedom);
}

namespace {

constexpr size_t kSettling = 60;  // executions before the long run
constexpr size_t kLongRun = 240;  // executions of the long run

/// All sequences concatenated.
Sequence joined(const std::vector<Sequence>& sequences) {
  Sequence all;
  for (const Sequence& sequence : sequences)
    all.insert(all.end(), sequence.begin(), sequence.end());
  return all;
}

}  // namespace

SequenceErrors driveSequences(Methods& methods, const TrialSite& site,
                              const std::vector<Sequence>& sequences, Histogram position_bins,
                              Histogram orientation_bins) {
  SequenceErrors result{MethodErrors(methods.size()),
                        std::vector<Histogram>(methods.size(), position_bins),
                        std::vector<Histogram>(methods.size(), orientation_bins)};
  const auto count = [&](size_t i, double position, double orientation, const ExecutionEnd& end) {
    result.position[i].add(position / end.metres);
    result.orientation[i].add(orientation / end.radians);
  };
  TrialDrive drive(methods, site);
  for (int64_t repetition = 0; repetition < site.repetitions; ++repetition) {
    drive.clear();
    for (const Sequence& sequence : sequences) {
      methods.reset();
      // The result of the last execution is not needed.
      drive.executeFirst(sequence[0], sequence.size() > 1, count);
      for (size_t j = 1; j < sequence.size(); ++j)
        drive.execute(sequence[j], j + 1 < sequence.size(), count);
    }
    drive.addTo(result.errors);
  }
  return result;
}

std::vector<MethodErrors> driveAllPatterns(Methods& methods, const TrialSite& site,
                                           const std::vector<Sequence>& sequences,
                                           const std::vector<int>& executions) {
  std::vector<MethodErrors> result(executions.size(), MethodErrors(methods.size()));
  TrialDrive drive(methods, site);
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

std::vector<MethodErrors> driveDevelopment(Methods& methods, const TrialSite& site,
                                           const std::vector<Sequence>& sequences,
                                           size_t executions) {
  std::vector<MethodErrors> result(executions, MethodErrors(methods.size()));
  const Sequence& sequence = sequences.front();
  TrialDrive drive(methods, site);
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

MethodErrors driveLong(Methods& methods, const TrialSite& site,
                       const std::vector<Sequence>& sequences) {
  MethodErrors result(methods.size());
  const Sequence order = joined(sequences);
  TrialDrive drive(methods, site);
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
  TrialDrive drive(methods, site);
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
